"""The arguments and options of each command; the rooms are loaded when a command runs."""
