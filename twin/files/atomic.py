"""Files that are either complete or absent: written beside their place, then renamed.

What is no file of its own, a pipe, a terminal or another device, is written to as it stands; a link
stays a link, and the file that it leads to is replaced. ``-`` is the standard output.
"""

import contextlib
import errno
import os
import secrets
import shutil
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

LEFTOVERS = ".*.part.*"
"""Files that a killed process left half-written."""
STDOUT = Path("-")

_STDOUT_NAMES = (STDOUT, Path("/dev/stdout"), Path("/dev/fd/1"), Path("/proc/self/fd/1"))
_FULL = (errno.ENOSPC, errno.EDQUOT)
_WRITING_FAILED = (*_FULL, errno.EFBIG, errno.EIO)
"""Of an open file; the system does not say of which."""
_KERNEL_FOLDERS = (Path("/dev"), Path("/proc"))


@contextlib.contextmanager
def complete_or_absent(path: Path) -> Iterator[Path]:
    """Yield a temporary path in the same folder; rename it to ``path`` when the block succeeds.

    The temporary name keeps the suffix, because encoders choose a format by it. When the block
    raises, the temporary file is removed and ``path`` is as it was.

    Args:
        path: Where the complete file shall stand, or what it shall be written to. Its folder is made
            when missing.

    Raises:
        OSError: The folder cannot be written to.
    """
    if _is_stream(path):
        with tempfile.TemporaryDirectory() as folder:
            whole = Path(folder) / f"whole{path.suffix}"
            yield whole
            _pour(whole, path)
        return
    path = Path(os.path.realpath(path))
    path.parent.mkdir(parents=True, exist_ok=True)
    temporary = path.with_name(f".{path.stem}.{secrets.token_hex(4)}.part{path.suffix}")
    try:
        yield temporary
        os.replace(temporary, path)  # noqa: PTH105 (atomic on every platform; Path.replace is this)
    except OSError as error:
        if error.filename is None and error.errno not in _WRITING_FAILED:
            raise  # of something else than a file
        if error.filename not in (None, str(temporary), temporary):
            raise
        raise with_path(error, path) from error
    finally:
        temporary.unlink(missing_ok=True)


def with_path(error: OSError, path: Path | str) -> OSError:
    """An error of the system with the path that the user knows.

    Args:
        error: Names a temporary file, or none.
        path: What the user asked to be written.
    """
    reason = "the disk is full" if error.errno in _FULL else error.strerror or str(error)
    return OSError(error.errno, reason, str(path))


def write_text(path: Path, text: str) -> None:
    """Write ``text`` as UTF-8, complete or not at all."""
    with complete_or_absent(path) as temporary:
        temporary.write_text(text, encoding="utf-8")


def require_writable(path: Path) -> None:
    """Make sure that a file can be written, before much is done for what shall stand in it.

    Args:
        path: The file to be. Its folder is made when missing.

    Raises:
        OSError: It cannot be written; the error names it.
    """
    if _is_stream(path):
        if path not in _STDOUT_NAMES and not os.access(path, os.W_OK):
            raise PermissionError(errno.EACCES, os.strerror(errno.EACCES), str(path))
        return
    if path.is_dir():
        raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR), str(path))
    require_folder(Path(os.path.realpath(path)).parent, named=path)


def remove_earlier(path: Path) -> None:
    """Remove a file that is to be written anew, so that nobody reads it for the new one where that never comes.

    What is no file of its own stays: a pipe, a terminal, a folder.
    """
    if path not in _STDOUT_NAMES and path.is_file():
        path.unlink()


def require_folder(folder: Path, *, named: Path | None = None) -> None:
    """Make sure that files can be put into a folder, which is made when missing.

    Args:
        named: What an error names instead of it.

    Raises:
        OSError: It cannot be made or written to.
    """
    try:
        folder.mkdir(parents=True, exist_ok=True)
        tempfile.TemporaryFile(dir=folder).close()
    except OSError as error:
        raise with_path(error, named or folder) from error


def _is_stream(path: Path) -> bool:
    """Whether a path leads to something that is written to, and that no other file may replace."""
    if path in _STDOUT_NAMES or any(map(path.is_relative_to, _KERNEL_FOLDERS)):
        return True
    return path.exists() and not path.is_file() and not path.is_dir()


def _pour(whole: Path, path: Path) -> None:
    if path in _STDOUT_NAMES:
        sys.stdout.flush()
        sys.stdout.buffer.write(whole.read_bytes())
        sys.stdout.buffer.flush()
        return
    try:
        with whole.open("rb") as source, path.open("wb") as stream:
            shutil.copyfileobj(source, stream)
    except OSError as error:
        raise with_path(error, path) from error
