"""Commands that run until they are interrupted."""
