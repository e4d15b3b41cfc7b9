"""A checksum trailer: the last bytes of a file, computed from all that lies before them.

HDF5 sums up only parts of its files, and may search a damaged one for ever. A file without a
trailer was cut short or changed by another program, or comes from an earlier version: ``recording_trial``
finds out whether it can be read.
"""

import zlib
from pathlib import Path

_MARK = b"\nseal "
LENGTH = len(_MARK) + 8
"""Of the trailer [bytes]."""
_PIECE = 1 << 22


def write_checksum(path: Path) -> None:
    """Append the trailer to a complete file."""
    with path.open("rb+") as file:
        file.seek(0, 2)
        file.write(_checksum_of(path, file.tell()))


def has_checksum(path: Path) -> bool:
    """Whether a file ends with a trailer, right or wrong."""
    return _end_of(path).startswith(_MARK)


def checksum_is_wrong(path: Path) -> bool:
    """Whether a file with a trailer has changed since that was written."""
    found = _end_of(path)
    return found.startswith(_MARK) and found != _checksum_of(path, path.stat().st_size - LENGTH)


def _end_of(path: Path) -> bytes:
    with path.open("rb") as file:
        file.seek(max(0, file.seek(0, 2) - LENGTH))
        return file.read(LENGTH)


def _checksum_of(path: Path, size: int) -> bytes:
    found, left = 0, size
    with path.open("rb") as file:
        while left > 0 and (piece := file.read(min(_PIECE, left))):
            found = zlib.crc32(piece, found)
            left -= len(piece)
    return _MARK + b"%08x" % found
