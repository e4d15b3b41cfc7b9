"""Circular figures after ISO 230-4."""
