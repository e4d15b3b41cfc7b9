"""The folder of a run: one run at a time, nothing in it that an earlier run left."""

import contextlib
import fcntl
import os
import re
from collections.abc import Iterable, Iterator
from pathlib import Path

from twin.errors import UsageError
from twin.files.atomic import LEFTOVERS

INSPECTION_FILES = ("inspection.json", "inspection.png", "part.glb")
"""What measuring a part leaves: figures, picture and the part in colours."""
VERDICT_FILES = ("result.json", "report.html", "part.stl", *INSPECTION_FILES)
"""What a run that came to its end leaves, and what was measured of its part."""
_PROGRAM = re.compile(r"^\s*program\s*=\s*[\"'](?P<name>[^\"']+)", re.MULTILINE)


def program_stem(path: Path) -> str:
    """The name of the folder that a run of a program or job file gets, be the file right or wrong."""
    if path.suffix == ".toml" and path.is_file():
        named = _PROGRAM.search(path.read_text(encoding="utf-8", errors="replace"))
        if named is not None:
            return Path(named["name"]).stem
    return path.stem


@contextlib.contextmanager
def without_verdict(folder: Path, files: Iterable[str] = VERDICT_FILES) -> Iterator[None]:
    """Leave no earlier verdict where a run fails, or is interrupted, before it holds its folder.

    A folder that another run holds is left as it is.

    Args:
        folder: Of the results; it need not exist.
        files: Names of those that would say something of what was not done.
    """
    try:
        yield
    except BaseException:
        if folder.is_dir():
            with contextlib.suppress(OSError, UsageError), run_folder(folder, files):
                pass
        raise


@contextlib.contextmanager
def run_folder(folder: Path, results: Iterable[str]) -> Iterator[None]:
    """Hold a folder for one run; at its begin the files of an earlier run are removed, where it fails its verdict.

    What a killed run left half-written under a temporary name is removed too. The folder itself
    carries the lock, so that nothing stays behind when the holder is killed.

    Args:
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
        _remove([*(folder / name for name in results), *folder.glob(LEFTOVERS)])
        try:
            yield
        except Exception:
            _remove(folder / name for name in VERDICT_FILES)
            raise
    finally:
        os.close(handle)


def _remove(paths: Iterable[Path]) -> None:
    for path in paths:
        path.unlink(missing_ok=True)
