"""Canonical moves as blocks of a plan, and their corners."""
