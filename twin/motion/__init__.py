"""Canonical moves to setpoints at the servo period. Knows nothing of G-codes or MuJoCo."""
