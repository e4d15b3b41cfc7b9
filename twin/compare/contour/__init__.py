"""The contour error of every sample, by block, feature and corner."""
