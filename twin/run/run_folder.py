"""The folder of a run: one run at a time, nothing in it that an earlier run left."""

import contextlib
import fcntl
import os
from collections.abc import Iterable, Iterator
from pathlib import Path

from twin.errors import UsageError
from twin.files.atomic import LEFTOVERS


@contextlib.contextmanager
def run_folder(folder: Path, results: Iterable[str]) -> Iterator[None]:
    """Hold a folder for one run; at its begin the files of an earlier run are removed.

    What a killed run left half-written under a temporary name is removed too. The folder itself
    carries the lock, so that nothing stays behind when the holder is killed.

    Args:
        folder: The folder; made when missing.
        results: Names of the files that a run may leave.

    Raises:
        UsageError: Another run holds the folder.
        OSError: It cannot be made or written to.
    """
    folder.mkdir(parents=True, exist_ok=True)
    handle = os.open(folder, os.O_RDONLY | os.O_DIRECTORY)
    try:
        try:
            fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError as error:
            message = f"{folder}: another run writes into this folder; give --out another one"
            raise UsageError(message) from error
        for path in [*(folder / name for name in results), *folder.glob(LEFTOVERS)]:
            path.unlink(missing_ok=True)
        yield
    finally:
        os.close(handle)
