"""Curves driven faster: the time law of a plan, changed along runs of arcs."""
