"""What raises an alarm: limits, following error, clearance between bodies."""
