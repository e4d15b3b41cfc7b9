"""The training room: a machine that an operator runs, and wrecks, in a browser or a window."""
