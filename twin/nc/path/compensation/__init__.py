"""Tool radius compensation, for both tiers: the contour, its leads and corners, what it has passed."""
