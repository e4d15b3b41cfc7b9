"""Compilation in another process, while this one does its work without.

There is one such process for all that share a folder of kernels. It yields to everything else, and
ends with the process that wants what it compiles.
"""

import atexit
import contextlib
import fcntl
import functools
import os
import subprocess
import sys
import threading
import time
from pathlib import Path

_AGAIN_S = 5.0
"""Between two processes that are started for the same kernels: the first may have found another at work."""
_LESS_URGENT = 10


class Beside:
    """The compilation of what one module compiles when it is run."""

    def __init__(self, module: str) -> None:
        self._module = module
        self._process: subprocess.Popen[bytes] | None = None
        self._started = -_AGAIN_S

    def is_running(self) -> bool:
        """Whether it goes on."""
        return self._process is not None and self._process.poll() is None

    def start(self) -> None:
        """Begin, unless it goes on already or has only just ended."""
        if self.is_running() or time.monotonic() - self._started < _AGAIN_S:
            return
        self._started = time.monotonic()
        # The end of the pipe tells the process that this one has ended.
        with contextlib.suppress(OSError):
            self._process = subprocess.Popen(  # noqa: S603 (this interpreter, a module of this package)
                [sys.executable, "-m", self._module],
                stdin=subprocess.PIPE,
                stdout=subprocess.DEVNULL,
                stderr=subprocess.DEVNULL,
                env={
                    **os.environ,
                    "PYTHONPATH": os.pathsep.join(path for path in sys.path if path),
                },
            )
            atexit.register(self.stop)

    def stop(self) -> None:
        """End it; what is not compiled by then is lost."""
        if self._process is not None and self._process.stdin is not None:
            self._process.stdin.close()
            self._process.kill()
            self._process.wait()
            self._process = None
        atexit.unregister(self.stop)


@functools.cache
def beside(module: str) -> Beside:
    """The compilation of a module's kernels: one in a process."""
    return Beside(module)


def serve(folder: Path) -> None:
    """Become such a process: less urgent than others, alone in its folder, and gone with its parent.

    Args:
        folder: Where kernels are kept; another process that compiles into it ends this one.
    """
    os.nice(_LESS_URGENT)
    threading.Thread(target=_end_with_parent, daemon=True).start()
    with contextlib.suppress(OSError):
        # The lock is held until the process ends.
        lock = os.open(folder / "beside.lock", os.O_CREAT | os.O_RDWR, 0o600)
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            sys.exit()


def _end_with_parent() -> None:
    os.read(sys.stdin.fileno(), 1)
    os._exit(0)
