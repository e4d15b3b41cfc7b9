"""Pieces of equal limits that blocks are cut into."""
