"""Logs of real machines, in the forms that controls write them: one reader for every command."""
