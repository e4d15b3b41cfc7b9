"""The controls, one module or folder each, loaded when they are first asked for."""

import re
from collections.abc import Container, Iterator, Mapping
from functools import cache
from importlib import import_module
from importlib.metadata import EntryPoint, entry_points

from twin.errors import UsageError
from twin.nc.control.dialect import Dialect
from twin.nc.text.source import Source

GROUP = "twin.dialects"
"""Entry points by which other packages bring dialects; each names a ``Dialect``."""


def dialects_from_outside(
    taken: Container[str],
) -> tuple[dict[str, Dialect], dict[str, str]]:
    """Load the dialects that other packages bring; those that are ``taken`` cannot be replaced.

    ``tests/nc/dialects/test_dialects.py`` shows a package of twenty lines.

    Returns:
        Those that could be loaded, by name, and why the others could not.
    """
    found: dict[str, Dialect] = {}
    failed: dict[str, str] = {}
    for point in entry_points(group=GROUP):
        reason = _load(point, taken, found)
        if reason:
            failed[point.name] = reason
    return found, failed


def _load(point: EntryPoint, taken: Container[str], found: dict[str, Dialect]) -> str:
    """Load one; why that fails, or nothing."""
    package = point.dist.name if point.dist is not None else point.value
    try:
        dialect = point.load()
    except Exception as error:  # noqa: BLE001 (a foreign package may raise anything)
        return f"{point.value} of {package} cannot be loaded: {type(error).__name__}: {error}"
    if not isinstance(dialect, Dialect):
        return f"{point.value} of {package} is a {type(dialect).__name__}, not a Dialect"
    if dialect.name != point.name:
        return f"{point.value} of {package} is called '{dialect.name}'"
    if point.name in taken or point.name in found:
        return f"{point.value} of {package} has the name of another dialect"
    found[point.name] = dialect
    return ""


_MODULES = {
    "gost": "gost",
    "codesys": "codesys",
    "fagor8070": "fagor8070",
    "mefi": "mefi",
    "fanuc": "fanuc",
    "haas": "fanuc",
    "linuxcnc": "linuxcnc",
    "grbl": "grbl",
    "heidenhain": "heidenhain",
    "sinumerik": "sinumerik",
}
"""Where each dialect of this package is defined, as a constant of its name in upper case."""


class _Own(Mapping[str, Dialect]):
    """The dialects of this package; the modules of the others take a tenth of a second to load."""

    def __getitem__(self, name: str) -> Dialect:
        dialect: Dialect = getattr(import_module(f"{__name__}.{_MODULES[name]}"), name.upper())
        return dialect

    def __iter__(self) -> Iterator[str]:
        return iter(_MODULES)

    def __len__(self) -> int:
        return len(_MODULES)


class _All(Mapping[str, Dialect]):
    """Those of this package, and those of other packages behind."""

    def __getitem__(self, name: str) -> Dialect:
        return OWN[name] if name in OWN else _outside()[0][name]

    def __iter__(self) -> Iterator[str]:
        yield from OWN
        yield from _outside()[0]

    def __len__(self) -> int:
        return len(OWN) + len(_outside()[0])


@cache
def _outside() -> tuple[dict[str, Dialect], dict[str, str]]:
    return dialects_from_outside(OWN)


OWN: Mapping[str, Dialect] = _Own()
"""Those of this package by name."""
DIALECTS: Mapping[str, Dialect] = _All()
"""Every known dialect by name, those of other packages behind."""


def dialect_named(name: str) -> Dialect:
    """The dialect called ``name``.

    Raises:
        UsageError: There is none; the message lists the known ones.
    """
    dialect = DIALECTS.get(name)
    if dialect is None and name in _outside()[1]:
        raise UsageError(f"no dialect '{name}': {_outside()[1][name]}")
    if dialect is None:
        raise UsageError(f"no dialect '{name}': known are {', '.join(DIALECTS)}")
    return dialect


def recognise(source: Source) -> Dialect:
    """Tell a program's dialect by its own words.

    Raises:
        UsageError: No dialect's own words are in it, or those of several, none of which has all.
    """
    found = marks_found(source)
    fitting = [name for name, marks in found.items() if marks]
    everything = {mark for marks in found.values() for mark in marks}
    complete = [name for name in fitting if everything <= set(found[name])]
    if len(complete) == 1:
        return DIALECTS[complete[0]]
    if complete:
        seen = ", ".join(found[complete[0]])
        raise UsageError(f"{source.name}: could be {' or '.join(complete)} ({seen}); {_SAY}")
    if fitting:
        seen = _listed({name: found[name] for name in fitting})
        raise UsageError(
            f"{source.name}: words of several dialects stand in it; {_SAY}. What was seen:{seen}"
        )
    if not any(line.strip() for line in source.lines):
        raise UsageError(f"{source.name}: the program is empty")
    deciding = _listed({d.name: [mark.shown for mark in d.marks] for d in DIALECTS.values()})
    raise UsageError(
        f"{source.name}: could be any dialect; {_SAY}. Words that would decide:{deciding}"
    )


_SAY = "say which by --dialect or in the job file"


def _listed(words: Mapping[str, list[str]]) -> str:
    return "".join(f"\n    {name}: {', '.join(shown)}" for name, shown in words.items())


def marks_found(source: Source) -> dict[str, list[str]]:
    """The marks of each dialect that are in a program."""
    patterns = {
        (dialect.name, mark.shown): re.compile(mark.pattern, re.IGNORECASE)
        for dialect in DIALECTS.values()
        for mark in dialect.marks
    }
    found: set[tuple[str, str]] = set()
    seen: set[str] = set()
    for page in source.lines.pages():
        text = _REMARK.sub("; remark", _BRACKETS.sub(" ", _SLASHES.sub("", page.joined)))
        shapes = set(_VALUES.sub("0", text).split("\n")) - seen
        found |= {mark for mark, pattern in patterns.items() if any(map(pattern.search, shapes))}
        if len(seen) < _MOST_SHAPES:
            seen |= shapes
    decided = {
        dialect.name
        for dialect in DIALECTS.values()
        if any(mark.decides and (dialect.name, mark.shown) in found for mark in dialect.marks)
    }
    return {
        dialect.name: [
            mark.shown
            for mark in dialect.marks
            if (dialect.name, mark.shown) in found and (not decided or dialect.name in decided)
        ]
        for dialect in DIALECTS.values()
    }


_BRACKETS = re.compile(r"\([^()\n]*\)")
"""A comment in every dialect: what it says decides nothing."""
_SLASHES = re.compile(r"^[ \t]*//.*", re.MULTILINE)
"""A line of comment for some controls: two slashes begin a block nowhere."""
_REMARK = re.compile(r";(?![ \t]*\$PATH)[ \t]*[^ \t;\n].*")
"""Text behind ; likewise, but for what names a SINUMERIK's folder."""
_VALUES = re.compile(
    r"(?<=[XYZABCIJKRUVWN])(?!360(?![0-9.]))[-+]?(?=[.]?[0-9])[0-9.]+(?![0-9.]|[ \t]*=)",
    re.IGNORECASE,
)
"""Values of words that no mark looks at: without them most lines of long programs are the same."""
_MOST_SHAPES = 10_000


__all__ = ["DIALECTS", "OWN", "dialect_named", "recognise"]
