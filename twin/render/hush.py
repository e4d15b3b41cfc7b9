"""Silence for a library that prints by itself, past Python."""

import contextlib
import os
import sys
from collections.abc import Iterator

STREAMS = (1, 2)
"""File descriptors of standard output and standard error."""


@contextlib.contextmanager
def hushed() -> Iterator[None]:
    """Drop what this process prints meanwhile."""
    sys.stdout.flush()
    sys.stderr.flush()
    kept = [os.dup(stream) for stream in STREAMS]
    nowhere = os.open(os.devnull, os.O_WRONLY)
    try:
        for stream in STREAMS:
            os.dup2(nowhere, stream)
        yield
    finally:
        for stream, copy in zip(STREAMS, kept, strict=True):
            os.dup2(copy, stream)
            os.close(copy)
        os.close(nowhere)
