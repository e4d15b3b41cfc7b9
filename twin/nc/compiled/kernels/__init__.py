"""Compiled functions of the language."""
