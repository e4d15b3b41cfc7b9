"""A real control drives the twin: LinuxCNC, in lock-step with the simulated machine."""
