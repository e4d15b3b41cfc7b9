"""Setpoints at the servo period."""
