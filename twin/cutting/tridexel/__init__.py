"""A part that is cut from any side: intervals of material along three directions."""
