"""Tells the user when kernels are compiled, which keeps the first run of an installation waiting."""

import sys
from collections.abc import Callable
from typing import Any

from numba.core import event

from twin.compilation.folders import lasts
from twin.compilation.inventory import inventory

MESSAGE = "compiling what this run needs for this computer, which happens once and takes a minute at most\n"


class _Announcer(event.Listener):
    """Numba tells it of every function that its cache did not hold."""

    def __init__(self) -> None:
        self.listens = False
        self.is_first: Callable[[], bool] | None = None
        self.meanwhile: Callable[[], object] = lambda: None

    def on_start(self, event: Any) -> None:  # noqa: ARG002 (Numba passes it)
        """A compilation begins."""
        is_first, self.is_first = self.is_first, None
        if is_first is not None and is_first():
            sys.stderr.write(MESSAGE if lasts() else f"kernels are {inventory()}\n")
            sys.stderr.flush()
            self.meanwhile()

    def on_end(self, event: Any) -> None:
        """It has ended."""


_announcer = _Announcer()


def announce_compilation(
    is_first: Callable[[], bool] = lambda: True, meanwhile: Callable[[], object] = lambda: None
) -> None:
    """Print a message on stderr at the first compilation of this process.

    Args:
        is_first: Whether no other process has said so; asked once.
        meanwhile: Called then too, to begin what can go on in parallel with the compiler.
    """
    if not _announcer.listens:
        _announcer.listens, _announcer.is_first = True, is_first
        _announcer.meanwhile = meanwhile
        event.register("numba:compile", _announcer)
