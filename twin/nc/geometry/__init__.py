"""Planes, arcs, curves and frames, as mathematics."""
