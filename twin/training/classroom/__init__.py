"""A class: a room for each pupil, each in a process of its own, behind one address."""
