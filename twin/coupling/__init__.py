"""Coupling of machine and cut: the force of the teeth acts on the axes while they move."""
