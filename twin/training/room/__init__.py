"""The machine of a scene while it runs: its control, its panel, and what is clamped on its table."""
