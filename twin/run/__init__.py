"""One run of a job: preparation, dry run, the order of the rooms, results."""
