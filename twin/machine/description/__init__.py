"""What a machine is: its file, its variants, its limits."""
