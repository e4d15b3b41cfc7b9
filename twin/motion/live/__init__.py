"""Motion under override, hold and resume."""
