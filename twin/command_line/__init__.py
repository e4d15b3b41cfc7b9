"""The arguments and options of each command; other packages are loaded when a command runs."""
