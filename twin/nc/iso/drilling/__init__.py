"""Drilling cycles, and what happens at their holes."""
