"""Tells the user when kernels are compiled, which keeps the first run of an installation waiting."""

import sys
from typing import Any

from numba.core import event

MESSAGE = "compiling kernels for this computer, which happens once and takes about a minute\n"


class _Announcer(event.Listener):
    """Numba tells it of every function that its cache did not hold."""

    def __init__(self) -> None:
        self._told = False

    def on_start(self, event: Any) -> None:  # noqa: ARG002 (Numba passes it)
        """A compilation begins."""
        if not self._told:
            self._told = True
            sys.stderr.write(MESSAGE)
            sys.stderr.flush()

    def on_end(self, event: Any) -> None:
        """It has ended."""


def announce_compilation() -> None:
    """From now on, say so on stderr at the first compilation of this process."""
    event.register("numba:compile", _Announcer())
