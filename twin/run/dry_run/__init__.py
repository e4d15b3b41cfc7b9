"""What the program shows before anything moves."""
