"""NC text to canonical moves. Knows nothing of time, machines or MuJoCo."""
