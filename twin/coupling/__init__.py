"""The machine and the cut together: the force of the teeth acts on the axes while they move."""
