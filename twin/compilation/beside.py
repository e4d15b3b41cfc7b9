"""Compilation in another process, while this one does its work without.

There is one such process for all that share a folder of kernels. It yields to everything else, and
goes on when the process that began it has ended: what it compiles is there for the next one.
"""

import contextlib
import fcntl
import functools
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

from twin.compilation.folders import writable_folder

_AGAIN_S = 5.0
"""Between two processes that are started for the same kernels: the first may have found another at work."""
_LESS_URGENT = 10
_LONGEST_S = 1800
"""After so long a process ends, whatever it waits for."""
_LOCK = "beside.lock"


class Beside:
    """The compilation of what one module compiles when it is run."""

    def __init__(self, module: str) -> None:
        self._module = module
        self._process: subprocess.Popen[bytes] | None = None
        self._started = -_AGAIN_S

    def is_own(self) -> bool:
        """Whether it goes on, begun by this process."""
        return self._process is not None and self._process.poll() is None

    def is_running(self) -> bool:
        """Whether it goes on, begun by this process or by another."""
        return self.is_own() or _is_locked(writable_folder() / _LOCK)

    def start(self) -> None:
        """Begin, unless it goes on already or has only just ended."""
        if time.monotonic() - self._started < _AGAIN_S or self.is_running():
            return
        self._started = time.monotonic()
        with contextlib.suppress(OSError):
            self._process = subprocess.Popen(  # noqa: S603 (this interpreter, a module of this package)
                [sys.executable, "-m", self._module],
                stdin=subprocess.DEVNULL,
                stdout=subprocess.DEVNULL,
                stderr=subprocess.DEVNULL,
                env={
                    **os.environ,
                    "PYTHONPATH": os.pathsep.join(path for path in sys.path if path),
                },
                start_new_session=True,
            )


@functools.cache
def beside(module: str) -> Beside:
    """The compilation of a module's kernels: one in a process."""
    return Beside(module)


def serve(folder: Path) -> None:
    """Become such a process: less urgent than others, and alone in its folder.

    Args:
        folder: Where kernels are kept; another process that compiles into it ends this one.
    """
    os.nice(_LESS_URGENT)
    signal.alarm(_LONGEST_S)
    with contextlib.suppress(OSError):
        # The lock is held until the process ends.
        lock = os.open(folder / _LOCK, os.O_CREAT | os.O_RDWR, 0o600)
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            sys.exit()


def _is_locked(file: Path) -> bool:
    """Whether a process holds this lock."""
    try:
        lock = os.open(file, os.O_RDONLY)
    except OSError:
        return False
    try:
        fcntl.flock(lock, fcntl.LOCK_SH | fcntl.LOCK_NB)
    except BlockingIOError:
        return True
    finally:
        os.close(lock)
    return False
