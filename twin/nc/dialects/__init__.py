"""The four controls, one module each."""
