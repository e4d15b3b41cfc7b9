"""A machine file from logs of a real machine: what they determine, how well, and what they do not."""
