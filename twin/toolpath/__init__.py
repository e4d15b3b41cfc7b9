"""The exact geometry of canonical moves. Knows nothing of G-codes or time."""
