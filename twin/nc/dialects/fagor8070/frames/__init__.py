"""Planes, offsets and coordinate systems of the Fagor CNC 8070."""
