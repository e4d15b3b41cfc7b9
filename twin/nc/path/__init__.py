"""From axis targets to canonical moves: contour, compensation, rounding."""
