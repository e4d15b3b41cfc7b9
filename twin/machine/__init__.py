"""Setpoints to a recording, through a MuJoCo model. Knows nothing of G-codes."""
