"""Tables on terminals, in logs and in files."""

import sys

from rich.console import Console

_LEAST_WIDTH = 72
"""Narrower terminals fold the lines themselves: figures that are cut off are worse."""
_LOG_WIDTH = 160
"""Width in logs, where tables should not be folded at 80 columns."""


def table_console(*, stderr: bool = False) -> Console:
    """Where a table for a person is printed.

    Args:
        stderr: Print it there, because the standard output belongs to something else.
    """
    stream = sys.stderr if stderr else sys.stdout
    if not stream.isatty():
        return Console(file=stream, width=_LOG_WIDTH)
    console = Console(file=stream)
    console.width = max(console.width, _LEAST_WIDTH)
    return console
