"""Tool offsets of a Fanuc control, what programs write into them, and the led tool tip."""
