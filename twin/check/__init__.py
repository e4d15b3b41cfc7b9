"""Many programs at once, as a build server wants them: found, run in parallel, reported in its forms."""
