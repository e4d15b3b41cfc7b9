"""The line of a key in a TOML file, which the parser does not report."""

import re
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

_HEADER = re.compile(r"\s*\[\[?\s*([^\[\]]+?)\s*\]")
_KEY = re.compile(r"\s*([A-Za-z0-9_.\"'-]+)\s*=\s*([^#]*)")


class _Key(NamedTuple):
    """A key of a file: its whole name, with the number of the table that it is in, if it has one."""

    name: str
    line: int


def place_of_key(files: Sequence[Path], key: str) -> tuple[Path, int]:
    """The file and the line that set a key.

    Tables of a list are known by their own ``number``, as tools are: ``tools.5.diameter``.

    Args:
        files: TOML files, the first over the others.

    Returns:
        File and line; where none sets it, those of the innermost table around it; line 1 of the first
        file where there is none either.
    """
    places = [
        {entry.name: entry.line for entry in reversed(_entries(file.read_text(encoding="utf-8")))}
        for file in files
    ]
    parts = key.split(".")
    for length in range(len(parts), 0, -1):
        name = ".".join(parts[:length])
        for file, lines in zip(files, places, strict=True):
            if name in lines:
                return file, lines[name]
    return files[0], 1


def _entries(text: str) -> list[_Key]:
    """Every key and every table, in their order."""
    found: list[_Key] = []
    table, begins = "", 0
    for line, content in enumerate(text.splitlines(), 1):
        if header := _HEADER.match(content):
            table, begins = _plain(header[1]), len(found)
            found.append(_Key(table, line))
        elif key := _KEY.match(content):
            name = _plain(key[1])
            found.append(_Key(f"{table}.{name}" if table else name, line))
            if name == "number" and table:
                numbered = f"{table}.{key[2].strip()}"
                found[begins:] = [
                    each._replace(name=numbered + each.name.removeprefix(table))
                    for each in found[begins:]
                ]
                # The list itself is where its first table begins.
                found.insert(begins, _Key(table, found[begins].line))
                table = numbered
    return found


def _plain(name: str) -> str:
    """A key without quotes and blanks around its dots."""
    return ".".join(part.strip().strip("\"'") for part in name.split("."))
