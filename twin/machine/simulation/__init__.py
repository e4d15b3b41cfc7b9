"""Setpoints in, simulated joints out: whole runs, and live in slices."""
