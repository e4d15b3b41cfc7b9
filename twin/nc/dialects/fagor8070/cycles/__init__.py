"""Canned cycles of the Fagor CNC 8070: drilling, tapping, pockets."""
