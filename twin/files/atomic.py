"""Files that are either complete or absent: written beside their place, then renamed."""

import contextlib
import os
import secrets
from collections.abc import Iterator
from pathlib import Path

LEFTOVERS = ".*.part.*"
"""Files that a killed process left half-written."""


@contextlib.contextmanager
def complete_or_absent(path: Path) -> Iterator[Path]:
    """Yield a temporary path in the same folder; rename it to ``path`` when the block succeeds.

    The temporary name keeps the suffix, because encoders choose a format by it. When the block
    raises, the temporary file is removed and ``path`` is as it was.

    Args:
        path: Where the complete file shall stand. Its folder is made when missing.

    Raises:
        OSError: The folder cannot be written to.
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    temporary = path.with_name(f".{path.stem}.{secrets.token_hex(4)}.part{path.suffix}")
    try:
        yield temporary
        os.replace(temporary, path)  # noqa: PTH105 (atomic on every platform; Path.replace is this)
    finally:
        temporary.unlink(missing_ok=True)


def write_text(path: Path, text: str) -> None:
    """Write ``text`` as UTF-8, complete or not at all."""
    with complete_or_absent(path) as temporary:
        temporary.write_text(text, encoding="utf-8")
