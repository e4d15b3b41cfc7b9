"""Bodies about the tool's axis, at rest and moving, and the lines through them."""
