"""Global subroutines of the Fagor CNC 8070: files of their own beside the program."""

import re
from collections.abc import Iterator

from twin.nc.text.library import Library
from twin.nc.text.source import Source

MARK = "%GLOBAL "
"""Begins the line in front of a global subroutine; a program's own heading has no blank in it."""

_CALL = re.compile(
    r"^[ \t]*/?[ \t]*(?:N[ \t]*[0-9]+[ \t]*|\[\w+\][ \t]*)?(?:L|#P?CALL|#MCALL)[ \t]+([A-Z_]\w*)",
    re.IGNORECASE,
)

_CALL_SOMEWHERE = re.compile(rb"(?:L|CALL)[ \t]+[A-Z_]", re.IGNORECASE)


def _calls(source: Source) -> Iterator[str]:
    if source.lines.any_holds(_CALL_SOMEWHERE):
        for line in source.lines:
            if (match := _CALL.match(line)) is not None:
                yield match[1].upper()


LIBRARY = Library(_calls, MARK, ("", ".nc"))
