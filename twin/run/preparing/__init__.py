"""From a job to everything that a run needs."""
