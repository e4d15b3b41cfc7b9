"""Compiled functions of cutting."""
