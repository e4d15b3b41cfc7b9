"""A file that takes a failed write down instead of telling the library that writes through it.

HDF5 cannot close a file that it could not write, and brings the process down when it ends. Here the
first failure is kept for those who ask, and whatever comes after it goes to memory.
"""

import io
import os
from collections.abc import Callable
from pathlib import Path


class ForgivingFile(io.RawIOBase):
    """A new file for ``h5py.File``.

    Attributes:
        failure: The first error of the disk, or None.
    """

    def __init__(self, path: Path) -> None:
        super().__init__()
        self.failure: OSError | None = None
        self._path = path
        self._handle = os.open(path, os.O_RDWR | os.O_CREAT | os.O_TRUNC, 0o666)
        self._at = 0
        self._lost: list[tuple[int, bytes]] = []
        self._end = 0

    def check(self) -> None:
        """Tell whether the disk took everything.

        Raises:
            OSError: It did not.
        """
        if self.failure is not None:
            raise OSError(self.failure.errno, self.failure.strerror, str(self._path))

    def seekable(self) -> bool:
        """It is."""
        return True

    def seek(self, offset: int, whence: int = os.SEEK_SET) -> int:
        """Go to a place, from the start or from the end."""
        self._at = offset + (self._end if whence == os.SEEK_END else 0)
        return self._at

    def tell(self) -> int:
        """The place."""
        return self._at

    def truncate(self, size: int | None = None) -> int:
        """Set the size."""
        self._end = self._at if size is None else size
        self._try(lambda: os.ftruncate(self._handle, self._end))
        return self._end

    def write(self, data: "bytes | bytearray | memoryview") -> int:  # pyright: ignore[reportIncompatibleMethodOverride] (h5py gives memory views)
        """Write all of the data, to the disk or, since it failed, to memory."""
        content = bytes(data)
        if not self._try(lambda: self._write_all(content)):
            self._lost.append((self._at, content))
        self._at += len(content)
        self._end = max(self._end, self._at)
        return len(content)

    def readinto(self, buffer: memoryview) -> int:  # pyright: ignore[reportIncompatibleMethodOverride] (the same)
        """Read what was written."""
        wanted = min(len(buffer), max(0, self._end - self._at))
        found = os.pread(self._handle, wanted, self._at)
        buffer[: len(found)] = found
        for place, content in self._lost:
            begin, end = max(place, self._at), min(place + len(content), self._at + wanted)
            if begin < end:
                buffer[begin - self._at : end - self._at] = content[begin - place : end - place]
        self._at += wanted
        return wanted

    def close(self) -> None:
        """Close the file."""
        if not self.closed:
            os.close(self._handle)
        super().close()

    def _write_all(self, content: bytes) -> None:
        done = 0
        while done < len(content):
            done += os.pwrite(self._handle, content[done:], self._at + done)

    def _try(self, do: Callable[[], object]) -> bool:
        if self.failure is None:
            try:
                do()
            except OSError as error:
                self.failure = error
        return self.failure is None
