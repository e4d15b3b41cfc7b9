"""The circular test of ISO 230-4."""
