"""Tool radius compensation: the contour, its leads and corners, what it has passed."""
