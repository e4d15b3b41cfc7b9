"""Subroutines of LinuxCNC in files of their own beside the program."""

import re
from collections.abc import Iterator
from pathlib import Path

from twin.nc.dialects.linuxcnc.structure import FILE, named_o_word
from twin.nc.text.library import named_files, with_called_files
from twin.nc.text.source import Source
from twin.nc.text.syntax import Language

_PROGRAM = re.compile(r"\bM[ \t]*0*98[ \t]*P[ \t]*([0-9]+)", re.IGNORECASE)
_SOMEWHERE = re.compile(rb"CALL|M[ \t]*0*98", re.IGNORECASE)


def with_files(source: Source, folder: Path, dialect: Language) -> Source:
    """The program with the subroutines that it calls, as far as they are files of their own.

    Args:
        source: The program.
        folder: Where their files lie, called ``name.ngc`` or ``100.ngc``, in any case.
        dialect: How they are read.
    """
    return with_called_files(
        source, lambda: named_files(folder, (".ngc", ".nc")), _calls, FILE, dialect
    )


def _calls(source: Source) -> Iterator[str]:
    if source.lines.any_holds(_SOMEWHERE):
        for line in source.lines:
            named = named_o_word(line)
            if named is not None and named[1] == "CALL":
                yield named[0].upper()
            elif (program := _PROGRAM.search(line)) is not None:
                yield str(int(program[1]))
