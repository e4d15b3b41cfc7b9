"""An MTConnect agent: what the machine does, read over HTTP."""
