"""The four controls, one module each."""

import re
from collections.abc import Mapping

from twin.errors import UsageError
from twin.nc.dialect import Dialect
from twin.nc.dialects.codesys import CODESYS
from twin.nc.dialects.fagor8070 import FAGOR8070
from twin.nc.dialects.gost import GOST
from twin.nc.dialects.mefi import MEFI
from twin.nc.source import Source

DIALECTS: Mapping[str, Dialect] = {
    dialect.name: dialect for dialect in (GOST, CODESYS, FAGOR8070, MEFI)
}
"""Every known dialect by name."""


def dialect_named(name: str) -> Dialect:
    """The dialect called ``name``.

    Raises:
        UsageError: There is none; the message lists the known ones.
    """
    dialect = DIALECTS.get(name)
    if dialect is None:
        raise UsageError(f"no dialect '{name}': known are {', '.join(DIALECTS)}")
    return dialect


def recognise(source: Source) -> Dialect:
    """Tell a program's dialect by its own words.

    Raises:
        UsageError: No dialect's own words stand in it, or those of several.
    """
    found = {dialect.name: _marks_in(source, dialect) for dialect in DIALECTS.values()}
    fitting = [name for name, marks in found.items() if marks]
    if len(fitting) == 1:
        return DIALECTS[fitting[0]]
    if fitting:
        seen = "; ".join(f"{name}: {', '.join(found[name])}" for name in fitting)
        raise UsageError(
            f"{source.name}: words of several dialects stand in it ({seen}); "
            "say which by --dialect or in the job file"
        )
    deciding = "; ".join(
        f"{dialect.name}: {', '.join(mark.shown for mark in dialect.marks)}"
        for dialect in DIALECTS.values()
    )
    raise UsageError(
        f"{source.name}: could be any dialect; words that would decide ({deciding}); "
        "say which by --dialect or in the job file"
    )


def _marks_in(source: Source, dialect: Dialect) -> list[str]:
    lines = [_BRACKETS.sub(" ", line) for line in source.lines]
    return [
        mark.shown
        for mark in dialect.marks
        if any(_mark(mark.pattern).search(line) for line in lines)
    ]


_BRACKETS = re.compile(r"\([^()]*\)")
"""A comment in every dialect: what it says decides nothing."""


def _mark(pattern: str) -> re.Pattern[str]:
    return re.compile(pattern, re.IGNORECASE)


__all__ = ["DIALECTS", "dialect_named", "recognise"]
