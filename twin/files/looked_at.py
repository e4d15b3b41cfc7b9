"""Which files loaders look at, there or not: what they load depends on these, and so does that they fail."""

import contextlib
from collections.abc import Iterator
from contextvars import ContextVar
from pathlib import Path

_recorders: ContextVar[tuple[set[Path], ...]] = ContextVar("recorders", default=())


@contextlib.contextmanager
def files_looked_at() -> Iterator[set[Path]]:
    """Record the files that are read or looked for in this context, resolved; an error leaves those up to it."""
    files = set[Path]()
    token = _recorders.set((*_recorders.get(), files))
    try:
        yield files
    finally:
        _recorders.reset(token)


def look_at(path: Path) -> Path:
    """Record a file before it is read or looked for."""
    for files in _recorders.get():
        files.add(path.resolve())
    return path
