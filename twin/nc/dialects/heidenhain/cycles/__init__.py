"""Cycles: CYCL DEF, CYCL CALL, patterns, and what they make of the path."""
