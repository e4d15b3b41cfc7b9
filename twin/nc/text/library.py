"""Files that a program calls: they are read with it and follow its text.

So calls, jumps and diagnostics treat them like the rest of the program.
"""

from collections.abc import Callable, Iterable, Iterator
from pathlib import Path

from twin.nc.text.source import Source, read_source
from twin.nc.text.syntax import Language

MOST_FILES = 100
"""Files that one program may call: more is no library but a slip."""


def with_called_files(
    source: Source,
    files: Callable[[], dict[str, Path]],
    calls: Callable[[Source], Iterable[str]],
    mark: str,
    dialect: Language,
) -> Source:
    """The program with the files that it calls, and those that they call, as far as found.

    Args:
        source: The program.
        files: Gives the files that can be called, by the name that calls them.
        calls: Names that a text calls.
        mark: Begins the line before each file, in front of its name.
        dialect: How the files are read.
    """
    found: set[str] = set()
    wanted = list(calls(source))
    known = files() if wanted else {}
    while wanted and len(found) < MOST_FILES:
        name = wanted.pop(0)
        if name in known and name not in found:
            found.add(name)
            fresh = read_source(known[name], dialect)
            source = source.followed_by(f"{mark}{name}", fresh)
            wanted += calls(fresh)
    return source


def named_files(folder: Path, suffixes: Iterable[str]) -> dict[str, Path]:
    """Files of a folder by their names in upper case without a suffix, an earlier one first."""
    found: dict[str, Path] = {}
    for suffix in suffixes:
        for path in _files(folder):
            if path.suffix.lower() == suffix:
                found.setdefault(path.stem.upper(), path)
    return found


def _files(folder: Path) -> Iterator[Path]:
    return (path for path in sorted(folder.iterdir()) if path.is_file())
