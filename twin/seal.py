"""A seal at the end of a file: a check sum of all that lies before it.

HDF5 sums up only parts of its files, and may search a damaged one for ever. A file without a seal
was changed by another program, or comes from an earlier version: nothing is said against it.
"""

import zlib
from pathlib import Path

_MARK = b"\nseal "
_LENGTH = len(_MARK) + 8
_PIECE = 1 << 22


def seal(path: Path) -> None:
    """Put a seal at the end of a complete file."""
    with path.open("rb+") as file:
        file.seek(0, 2)
        file.write(_seal_of(path, file.tell()))


def seal_is_broken(path: Path) -> bool:
    """Whether a sealed file is not what it was when the seal was put on it."""
    with path.open("rb") as file:
        size = file.seek(0, 2) - _LENGTH
        if size < 0:
            return False
        file.seek(size)
        found = file.read(_LENGTH)
    return found.startswith(_MARK) and found != _seal_of(path, size)


def _seal_of(path: Path, size: int) -> bytes:
    found, left = 0, size
    with path.open("rb") as file:
        while left > 0 and (piece := file.read(min(_PIECE, left))):
            found = zlib.crc32(piece, found)
            left -= len(piece)
    return _MARK + b"%08x" % found
