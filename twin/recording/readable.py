"""Whether HDF5 can read a file without hanging: tried in a process of its own.

A damaged file can make HDF5 search for ever or crash, which no exception reports. Recordings carry
a checksum trailer against that; one that lost it, because it was cut short or because another program
added to it, is read here first.
"""

import resource
import subprocess
import sys
from pathlib import Path

_SECONDS = 5
_BYTES_PER_SECOND = 2_000_000
"""Processor time that reading takes at the very most: this and what goes with the file's size."""
_ROWS = 65536
"""Rows that are read at once."""


def reading_ends(path: Path) -> bool:
    """Whether all that a file holds can be read, or is refused with an error."""
    command = [sys.executable, "-m", "twin.recording.readable", str(path)]
    return subprocess.run(command, capture_output=True, check=False).returncode >= 0  # noqa: S603 (this module)


def _read_all(path: Path) -> None:
    import h5py

    def read(_name: str, part: object) -> None:
        if isinstance(part, (h5py.Group, h5py.Dataset)):
            list(part.attrs.items())
        if isinstance(part, h5py.Dataset):
            for first in range(0, len(part), _ROWS):
                part[first : first + _ROWS]

    with h5py.File(path, "r") as file:
        read("", file)
        file.visititems(read)


if __name__ == "__main__":
    longest = _SECONDS + Path(sys.argv[1]).stat().st_size // _BYTES_PER_SECOND
    resource.setrlimit(resource.RLIMIT_CPU, (longest, longest))
    _read_all(Path(sys.argv[1]))
