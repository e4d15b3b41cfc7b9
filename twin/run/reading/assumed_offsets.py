"""Work offsets of a raw program: the one that it feeds in lies at program zero."""

import dataclasses
import re
from collections.abc import Iterator

import numpy as np

from twin.nc.canonical import FloatArray, Motion, concatenate
from twin.nc.control.dialect import Dialect
from twin.nc.control.settings import Consulted, ControlSettings
from twin.nc.interpreter import Interpretation
from twin.nc.text.diagnostics.diagnostics import ProgramError
from twin.nc.text.source import Source

USUAL = "G54"
"""Which lies at program zero in any case."""
_G = r"(?<![A-Z0-9.])G[ \t]*"
_NAMES = (
    (rf"{_G}(5[4-9](?:\.[1-3])?|50[5-9]|5[1-9][0-9])(?![0-9.])(?![ \t]*P)", "G{}"),
    (rf"{_G}(?:54(?:\.1)?|154)[ \t]*P[ \t]*0*([1-9][0-9]{{0,2}})(?![0-9.])", "G54.1 P{}"),
    (r"\bCYCL DEF 7\.1 *#[ \t]*([1-9][0-9]{0,3})(?![0-9.])", "DATUM{}"),
    (r"\bQ339[ \t]*=[ \t]*\+?([1-9][0-9]{0,3})(?![0-9.])", "PRESET{}"),
)
"""How programs write work offsets, and how jobs call these."""
_SHORT = re.compile(rf"{_G}(11[0-9]|12[0-9])(?![0-9.])", re.IGNORECASE)
_BEFORE_FIRST = 109
"""G110 to G129 are G154 P1 to P20 of a Haas."""
_APART = 1.0
"""So far from each other offsets are put to see in which of them the program feeds [mm]."""


def named_offsets(blocks: str) -> tuple[str, ...]:
    """The work offsets that a program's blocks name besides the usual one; some dialects mean other things by some."""
    found = {
        form.format(match[1])
        for pattern, form in _NAMES
        for match in re.finditer(pattern, blocks, re.IGNORECASE)
    }
    found |= {f"G54.1 P{int(match[1]) - _BEFORE_FIRST}" for match in _SHORT.finditer(blocks)}
    return tuple(sorted(found - {USUAL}))


def offsets_of_one_zero(
    names: tuple[str, ...], source: Source, dialect: Dialect, settings: ControlSettings
) -> tuple[str, ...]:
    """Those of the work offsets that a dialect reads, where the program feeds in one offset alone; else none.

    It is run twice: where offsets lie apart from each other, each axis of a feed shows in which of them it is.
    """
    if settings.machine_zero is None:  # where that lies changes nothing
        zero = dict.fromkeys(settings.axes.names, 0.0)
        settings = dataclasses.replace(settings, machine_zero=zero)
    axes = settings.axes.names[:3]
    every = (USUAL, *names)
    together = Consulted({name: dict.fromkeys(axes, 0.0) for name in every})
    apart = Consulted({name: dict.fromkeys(axes, at * _APART) for at, name in enumerate(every, 1)})
    try:
        first = _ends_of_feeds(source, dialect, dataclasses.replace(settings, offsets=together))
    except ProgramError:  # which the run itself will report
        return tuple(name for name in names if name not in together.unread)
    try:
        second = _ends_of_feeds(source, dialect, dataclasses.replace(settings, offsets=apart))
    except ProgramError:  # what is right in one offset goes from one to another
        return ()
    if len(first) != len(second):
        return ()
    shifts = (second - first)[:, :3]
    # An axis that was not programmed yet lies in none. Of the first that is rare: there it is another zero, without a name here.
    known = shifts[np.abs(shifts) > _APART / 2.0]
    apart_by = max((np.ptp(each) for each in (known, shifts[:, 0]) if each.size), default=0.0)
    one = apart_by < _APART / 2.0
    return tuple(name for name in names if name not in together.unread) if one else ()


def _ends_of_feeds(source: Source, dialect: Dialect, settings: ControlSettings) -> FloatArray:
    """Ends of a program's feeds, shape (n, k); of one that feeds nowhere those of its rapids."""
    chunks = list(Interpretation(source, dialect, settings).chunks())
    moves = concatenate((chunk.moves for chunk in chunks), settings.axes)
    feeds = moves.motion == Motion.FEED
    return moves.end[feeds | (not feeds.any())]


def notes_of_offsets(names: tuple[str, ...]) -> Iterator[str]:
    """What was assumed of work offsets, a line."""
    if len(names) == 1:
        yield f"{names[0]} lies at program zero: the program feeds in no other work offset"
    elif names:
        yield f"{', '.join(names)} lie at program zero: the program feeds in one work offset alone"
