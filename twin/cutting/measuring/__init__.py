"""A machined part held against what it should be."""
