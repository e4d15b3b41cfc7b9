"""A recording against the toolpath: figures, verdict, report. Knows nothing of MuJoCo."""
