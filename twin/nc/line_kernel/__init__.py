"""Runs of plain lines, compiled: what a line is made of, what it does, and when a control may let it."""
