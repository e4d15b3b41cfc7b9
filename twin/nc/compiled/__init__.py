"""The compiled tier: state transfer, tables, the virtual machine."""
