"""The speed profile over pieces."""
