"""One run, in the order of the rooms."""
