"""Subroutines of LinuxCNC in files of their own beside the program."""

import re
from collections.abc import Iterator

from twin.nc.dialects.linuxcnc.structure import FILE, named_o_word
from twin.nc.text.library import Library
from twin.nc.text.source import Source

_PROGRAM = re.compile(r"\bM[ \t]*0*98[ \t]*P[ \t]*([0-9]+)", re.IGNORECASE)
_SOMEWHERE = re.compile(rb"CALL|M[ \t]*0*98", re.IGNORECASE)


def _calls(source: Source) -> Iterator[str]:
    if source.lines.any_holds(_SOMEWHERE):
        for line in source.lines:
            named = named_o_word(line)
            if named is not None and named[1] == "CALL":
                yield named[0].upper()
            elif (program := _PROGRAM.search(line)) is not None:
                yield str(int(program[1]))


LIBRARY = Library(_calls, FILE, (".ngc", ".nc"))
