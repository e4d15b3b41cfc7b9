"""Commands on runs and recordings: run, sweep, render, export, compare."""
