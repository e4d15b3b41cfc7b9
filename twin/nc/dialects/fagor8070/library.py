"""Global subroutines of the Fagor CNC 8070: files of their own beside the program.

They are read with the program and follow it, each behind a line that no program can hold, so that
calls, jumps and diagnostics treat them like the rest of the text.
"""

import re
from collections.abc import Iterator
from pathlib import Path

from twin.nc.source import Source, read_source

MARK = "%GLOBAL "
"""Begins the line in front of a global subroutine; a program's own heading has no blank in it."""

MOST_FILES = 100
"""Files that one program may call: more is no library but a slip."""

_CALL = re.compile(
    r"^[ \t]*/?[ \t]*(?:N[ \t]*[0-9]+[ \t]*|\[\w+\][ \t]*)?(?:L|#P?CALL|#MCALL)[ \t]+([A-Z_]\w*)",
    re.IGNORECASE,
)

_CALL_SOMEWHERE = re.compile(rb"(?:L|CALL)[ \t]+[A-Z_]", re.IGNORECASE)


def with_globals(source: Source, folder: Path) -> Source:
    """The program with the global subroutines that it calls, as far as they are found.

    Args:
        source: The program.
        folder: Where their files lie, called ``NAME`` or ``NAME.nc`` in any case.
    """
    found: set[str] = set()
    wanted = list(_calls(source))
    files = _files(folder) if wanted else {}
    while wanted and len(found) < MOST_FILES:
        name = wanted.pop(0)
        if name in files and name not in found:
            found.add(name)
            fresh = read_source(files[name], _CODE_PAGE)
            source = source.followed_by(f"{MARK}{name}", fresh)
            wanted += _calls(fresh)
    return source


class _CodePage:
    """What reading a file needs to know."""

    code_page = "cp1252"


_CODE_PAGE = _CodePage()


def _calls(source: Source) -> Iterator[str]:
    if source.lines.any_holds(_CALL_SOMEWHERE):
        for line in source.lines:
            if (match := _CALL.match(line)) is not None:
                yield match[1].upper()


def _files(folder: Path) -> dict[str, Path]:
    """Files of a folder by their names in upper case, with and without ``.nc``."""
    paths = sorted(path for path in folder.iterdir() if path.is_file())
    with_suffix = {p.stem.upper(): p for p in paths if p.suffix.upper() == ".NC"}
    return with_suffix | {p.name.upper(): p for p in paths if not p.suffix}
