"""Room on the disk that is taken before it is needed.

HDF5 cannot close a file that it could not write, and brings the process down when it ends. A disk
that is full shall be met before HDF5 writes, where it is an error like any other.
"""

import os
from pathlib import Path

from twin.files.atomic import with_path

_STEP = 8 << 20
"""Bytes that are taken at a time."""


class DiskRoom:
    """What an open file may still grow by."""

    def __init__(self, handle: int, path: Path) -> None:
        """Take nothing yet.

        Args:
            handle: The descriptor of the file.
            path: Its path, for messages.
        """
        self._handle = handle
        self._path = path
        self._end = 0

    def hold(self, end: int) -> None:
        """Make sure that the file can be written up to ``end`` [bytes].

        Raises:
            OSError: The disk is full, or the file would be larger than is allowed.
        """
        if end <= self._end:
            return
        try:
            os.posix_fallocate(self._handle, 0, end + _STEP)
        except OSError as error:
            raise with_path(error, self._path) from error
        self._end = end + _STEP
