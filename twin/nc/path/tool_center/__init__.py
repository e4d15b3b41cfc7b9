"""Tool centre point control: where the tip is, how the rotary axes turn, what X, Y and Z do meanwhile."""
