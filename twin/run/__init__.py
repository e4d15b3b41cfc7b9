"""One run of a job: preparation, dry run, pipeline, observers, outcome, results."""
