"""A program as it reaches the machine: read in parts, planned, and stepped block by block."""
