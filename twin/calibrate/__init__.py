"""From logs of a real machine to its machine file: what they tell, how well, and what they do not."""
