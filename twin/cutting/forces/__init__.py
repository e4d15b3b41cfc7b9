"""Cutting forces: what a material resists with, in the mean and tooth by tooth."""
