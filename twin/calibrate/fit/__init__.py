"""The drive model of one axis, simulated and fitted to what was logged."""
