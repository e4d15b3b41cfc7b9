"""The machine, the part and the trail as they are drawn."""
