"""Files that a program calls: they are read with it and follow its text.

So calls, jumps and diagnostics treat them like the rest of the program.
"""

import dataclasses
from collections.abc import Callable, Iterable
from pathlib import Path

from twin.nc.text.source import Source, read_source, source_from_text
from twin.nc.text.syntax import Language

MOST_FILES = 100
"""Files that one program may call: more is no library but a slip."""

Opening = Callable[[Path, Source, int], None]
"""Called with a file before it is read, with the program that calls it and the line, from 1; may refuse it."""


@dataclasses.dataclass(frozen=True, slots=True)
class Library:
    """Which files the programs of a dialect can call.

    Attributes:
        mark: Begins the line before each file, in front of its name.
        suffixes: Of the files, lower case; a file with an earlier one comes first.
        name_of: The name that calls a file, given its own in upper case without the suffix; None: none does.
    """

    calls: Callable[[Source], Iterable[str]]
    mark: str
    suffixes: tuple[str, ...]
    name_of: Callable[[str], str | None] = lambda name: name

    def __call__(
        self, source: Source, folder: Path, dialect: Language, opening: Opening | None = None
    ) -> Source:
        """The program with the files of a folder that it calls, and those that they call, as far as found."""
        found: set[str] = set()
        wanted = [(source, name) for name in self.calls(source)]
        known = self._files(folder) if wanted else {}
        while wanted and len(found) < MOST_FILES:
            caller, name = wanted.pop(0)
            if name in known and name not in found:
                found.add(name)
                if opening is not None:
                    opening(known[name], caller, self._line_of_call(caller, name))
                fresh = read_source(known[name], dialect)
                source = source.followed_by(f"{self.mark}{name}", fresh)
                wanted += ((fresh, each) for each in self.calls(fresh))
        return source

    def _line_of_call(self, caller: Source, name: str) -> int:
        lines = enumerate(caller.lines, start=1)
        return next(line for line, text in lines if name in self.calls(source_from_text(text)))

    def _files(self, folder: Path) -> dict[str, Path]:
        found: dict[str, Path] = {}
        files = [path for path in sorted(folder.iterdir()) if path.is_file()]
        for suffix in self.suffixes:
            for path in files:
                name = self.name_of(path.stem.upper()) if path.suffix.lower() == suffix else None
                if name is not None:
                    found.setdefault(name, path)
        return found
