"""What commands do with runs and their recordings: run, repeat, draw, export, compare."""
