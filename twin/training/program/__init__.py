"""A program on its way to the machine: read in parts, planned, and stepped block by block."""
