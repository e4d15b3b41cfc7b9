"""The dialect of a raw program: where its words fit several, all of them read it and are compared."""

import dataclasses
import math
import re
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import numpy.typing as npt

from twin.errors import UsageError
from twin.nc.canonical import Function, Motion, Moves, concatenate
from twin.nc.control.dialect import Dialect, JobKey
from twin.nc.control.settings import ControlSettings, MachineFunction
from twin.nc.dialects import DIALECTS
from twin.nc.dialects.foreign import require_program
from twin.nc.dialects.recognition import head_of, reading_of
from twin.nc.interpreter import Interpretation
from twin.nc.line_kernel.plain_state import LineKernel, usual_kernel
from twin.nc.text.diagnostics.diagnostics import Diagnostic, ProgramError
from twin.nc.text.source import Source, read_source
from twin.run.reading.assumed_reading import UNKNOWN_FUNCTION, functions_of, unknown_functions

BoolArray = npt.NDArray[np.bool_]
_PREFERENCE = ("fanuc", "haas", "linuxcnc")
"""Which of several dialects that make the same of a program is taken: what most posts write for comes first."""
_MOST_LINES = 200_000
"""Longer programs are not read by several dialects for comparison: that would take minutes."""
_SAME = 1e-6
"""Positions that differ less are the same [mm or deg]; feeds by this share."""
_CLEARANCE = 1.0
"""How far between pecks a drill withdraws is a parameter of the control; rapids that differ by less are accepted [mm]."""
_NEARLY = 0.1
"""Feeds on the same path that differ by less are reported, and accepted: F of a helix counts its arc or its path."""
_CRAWLS = 1.0
"""A dialect that alone reads a program, and in which it feeds slower than this, was not meant [mm/min]."""
_TOO_SLOW = 1.0 / 200.0
"""A dialect in which a feed is less than this share of another's is not the one that was meant: a Haas counts F300
without a point as 0.3 mm/min, and a post for it writes F300."""
_INCH = 25.4
_PROGRAM_NUMBER = re.compile(r"\s*[:O]\s*(?:\d+|<)", re.IGNORECASE)
_ROUTERS = "grbl"
"""The control of most routers, which passes over words that others refuse: taken where these refuse a program without a number."""
_POSTS = re.compile(r"pcb2gcode|\bpycam|dxf2gcode|gcodetools|heekscnc", re.IGNORECASE)
_OF_POSTS = "linuxcnc"
"""What these posts write: it is taken also where other dialects would move differently."""
_NUMBERED = ("fanuc", "haas")
"""Controls whose programs begin with their number."""


@dataclasses.dataclass(frozen=True)
class DialectChoice:
    """A dialect, and why it was taken.

    Attributes:
        reason: Why, for people; empty: nothing was chosen.
    """

    dialect: Dialect
    reason: str


@dataclasses.dataclass(frozen=True)
class _DialectReading:
    """What one dialect makes of a program."""

    name: str
    moves: Moves
    functions: list[tuple[int, str]]
    unknown: tuple[int, ...]
    error: Diagnostic | None

    @property
    def fastest(self) -> float:
        """Its fastest feed [mm/min]."""
        return float(np.nanmax(self.moves.feed, initial=0.0))

    @property
    def slowest(self) -> float:
        """Its slowest feed [mm/min]."""
        return float(np.nanmin(self.moves.feed, initial=math.inf))


def chosen_dialect(
    path: Path, settings: ControlSettings, source: Source | None = None
) -> DialectChoice:
    """Tell the dialect of a raw program.

    Args:
        settings: What its control knows about machine and job.
        source: The program, where it was read already.

    Raises:
        UsageError: It is no program, or one for another control, or several dialects would move differently.
        ProgramError: Every dialect that it may be written in refuses it; the error is that of the one that
            reads it farthest.
    """
    require_program(path)
    source = read_source(path) if source is None else source
    reading = reading_of(source)
    candidates = sorted(reading.candidates, key=_rank)
    if len(candidates) == 1:
        return DialectChoice(DIALECTS[candidates[0]], reading.reason)
    if len(source.lines) > _MOST_LINES:
        raise UsageError(f"{source.name}: could be {_either(candidates)}; {_type(candidates)}")
    settings = dataclasses.replace(settings, strict=False)
    if settings.machine_zero is None:  # the dialect does not depend on where that lies
        zero = dict.fromkeys(settings.axes.names, 0.0)
        settings = dataclasses.replace(settings, machine_zero=zero)
    if (
        settings.tool_change_height is None
    ):  # nor on where a control goes by itself for another tool
        settings = dataclasses.replace(settings, tool_change_height=-math.inf)
    rolling = [name for name in candidates if JobKey.ROLLOVER in DIALECTS[name].job_keys]
    rolls = settings.rollover is not None and bool(rolling) and rolling != candidates
    candidates = rolling if rolls else candidates
    common = [name for name in candidates if name in _PREFERENCE]
    rare = [name for name in candidates if name not in _PREFERENCE]
    trying = _Trying(path, settings, functions_of(source), len(common or rare))
    tried = [trying.read_as(DIALECTS[name]) for name in (common or rare)]
    good = [each for each in tried if each.error is None]
    refusing = [each for each in tried if each.error is not None]
    if refusing and all(0.0 < each.fastest < _CRAWLS for each in good):
        good, tried = [], refusing
    numbered = any(map(_PROGRAM_NUMBER.match, source.lines))
    if not good and _ROUTERS in rare and not numbered:
        router = trying.read_as(DIALECTS[_ROUTERS])
        if router.error is None:
            return DialectChoice(
                DIALECTS[_ROUTERS], f"no other control reads it; {_first_refusal(tried)}"
            )
    if not good:
        further = [trying.read_as(DIALECTS[name]) for name in rare] if common else []
        raise _refused(tried, [each.name for each in further if each.error is None])
    quick = [each for each in good if not any(_crawls(each, other) for other in good)]
    least = min(len(each.unknown) for each in quick)
    meant = [each for each in quick if len(each.unknown) == least]
    why = _dropped(good, quick, meant)
    left = [each for each in meant if (each.name in _NUMBERED) == numbered]
    apart = any(_difference(meant[0], other) for other in meant[1:])
    if apart and left and (numbered or not any(_paths_apart(meant[0], each) for each in meant)):
        others = [each.name for each in meant if each not in left]
        reason = f"programs of {_either(_NUMBERED, 'and')} begin with their number, O"
        meant, why = left, "; ".join(filter(None, (why, reason if others else "")))
    post = _POSTS.search(head_of(source)) if apart and not numbered else None
    own = [each for each in meant if each.name == _OF_POSTS]
    if post is not None and own:
        meant, why = own, f"its head names {post[0]}, which writes {_OF_POSTS}'s language"
    return _choice(source.name, meant, why or (_ROLLS if rolls else ""))


_ROLLS = "it is the only one of the possible controls whose rotary axes roll over"


def _crawls(one: _DialectReading, other: _DialectReading) -> bool:
    """Whether a dialect counts feeds of which another makes at least two hundred times as much."""
    slow, fast = one.moves.feed, other.moves.feed
    if len(slow) != len(fast):
        return one.fastest < other.fastest * _TOO_SLOW
    return bool(((slow < _CRAWLS * _INCH) & (slow < fast * _TOO_SLOW)).any())


def _farthest(tried: Sequence[_DialectReading]) -> _DialectReading:
    """The one that reads a program farthest before it refuses it."""
    return max(tried, key=lambda each: each.error.line if each.error else 0)


def _first_refusal(tried: Sequence[_DialectReading]) -> str:
    farthest = _farthest(tried)
    assert farthest.error is not None
    return f"{farthest.name}, which reads it farthest of others, refuses line {farthest.error.line}: {farthest.error.message}"


def _refused(tried: Sequence[_DialectReading], others: Sequence[str]) -> ProgramError:
    """The error of the dialect that reads a program farthest, and what else may be tried."""
    farthest, name = _farthest(tried).error, _farthest(tried).name
    assert farthest is not None
    message = f"read as {name}, which reads it farthest: {farthest.message}"
    further = f"; {_either(others, 'and')} would read it" if others else ""
    elsewhere = [each for each in tried if each.error and each.error.line != farthest.line]
    names = [each.name for each in elsewhere] + list(others)
    another = f"another control: {_type(names)}{further}" if names else ""
    hint = "; ".join(filter(None, (farthest.hint, another)))
    return ProgramError(dataclasses.replace(farthest, message=message, hint=hint or None))


def _dropped(
    good: Sequence[_DialectReading],
    quick: Sequence[_DialectReading],
    meant: Sequence[_DialectReading],
) -> str:
    """Why some of the dialects that read a program are not the one that was meant; empty: all may be."""
    slow = [each for each in good if each not in quick]
    ignorant = [each.name for each in quick if each not in meant]
    reasons = [f"{each.name} would feed {each.slowest:g} mm/min" for each in slow]
    if ignorant:
        lack = "lack" if len(ignorant) > 1 else "lacks"
        reasons.append(f"{_either(ignorant, 'and')} {lack} some of its M codes")
    return "; ".join(reasons)


def _choice(name: str, meant: Sequence[_DialectReading], why: str) -> DialectChoice:
    """The dialect that is taken of those that may be meant."""
    slightly = ""
    for other in meant[1:]:
        difference = _difference(meant[0], other)
        if not difference and not slightly:
            slightly = _slight_difference(meant[0], other)
        if difference:
            names = [each.name for each in meant]
            raise UsageError(
                f"{name}: could be {_either(names)}, and they would not move alike: "
                f"{difference}; {_type(names)}"
            )
    names = [each.name for each in meant]
    if len(names) == 1:
        return DialectChoice(DIALECTS[names[0]], why or "no other reads it without an error")
    same = f"{_either(names, 'and')} make the same moves of it"
    if slightly:
        same += f", but {slightly}; {_type(names[1:])}"
    return DialectChoice(DIALECTS[names[0]], f"{same}; {why}" if why else same)


def _rank(name: str) -> int:
    return _PREFERENCE.index(name) if name in _PREFERENCE else len(_PREFERENCE)


def _either(names: Sequence[str], word: str = "or") -> str:
    return f"{', '.join(names[:-1])} {word} {names[-1]}" if len(names) > 1 else names[0]


def _type(names: Sequence[str]) -> str:
    return f"type {_either([f'--dialect {name}' for name in names])}"


@dataclasses.dataclass(frozen=True)
class _Trying:
    """A program that several dialects read.

    Attributes:
        functions: Its M codes.
        times: How many read it.
    """

    path: Path
    settings: ControlSettings
    functions: set[int]
    times: int

    def read_as(self, dialect: Dialect) -> _DialectReading:
        """What a dialect makes of it."""
        source, declared = read_source(self.path, dialect), self.settings.m_functions
        unknown = unknown_functions(self.functions, dialect, frozenset(declared))
        functions_of_the_builder = dict.fromkeys(unknown, MachineFunction(UNKNOWN_FUNCTION))
        settings = dataclasses.replace(
            self.settings, m_functions={**declared, **functions_of_the_builder}
        )
        chunks, error = [], None
        try:
            if dialect.library is not None:
                source = dialect.library(source, self.path.parent, dialect)
            chunks.extend(Interpretation(source, dialect, settings, kernel=self._kernel).chunks())
        except ProgramError as raised:
            error = raised.diagnostic
        functions = [
            (event.line, f"{event.word} {sorted(event.arguments.items())}")
            for chunk in chunks
            for event in chunk.events
            if isinstance(event, Function)
        ]
        moves = concatenate((chunk.moves for chunk in chunks), settings.axes)
        return _DialectReading(dialect.name, moves, functions, unknown, error)

    def _kernel(self, lines: int) -> LineKernel | None:
        """What runs its plain lines: the compiler pays as for a program that is as long as all of the readings."""
        return usual_kernel(lines * self.times)


def _difference(one: _DialectReading, other: _DialectReading) -> str:
    """The first thing that two dialects make differently; empty: none."""
    paths = _paths_apart(one, other)
    if paths:
        return paths
    feeds = _feeds_apart(one, other, _NEARLY)
    if feeds:
        return feeds
    for mine, theirs in zip(one.functions, other.functions, strict=False):
        if mine != theirs:
            return f"in line {mine[0]} {one.name} does {mine[1]} and {other.name} {theirs[1]}"
    return ""


def _paths_apart(one: _DialectReading, other: _DialectReading) -> str:
    """The first move that two dialects make differently; empty: none."""
    a, b = one.moves, other.moves
    count = min(len(a), len(b))
    apart = np.abs(a.end[:count] - b.end[:count]).max(axis=1, initial=0.0) > _SAME
    apart &= ~_pecks_apart(a, b, count)
    turned = np.abs(a.sweep[:count] - b.sweep[:count]) > _SAME
    kinds = (a.motion[:count] != b.motion[:count]) | (a.line[:count] != b.line[:count])
    differing = np.flatnonzero(apart | turned | kinds)
    if len(differing) or len(a) != len(b):
        row = int(differing[0]) if len(differing) else count
        longer = a if len(a) > row else b
        goals = " and ".join(
            f"{each.name} goes to {_place(each.moves, row)}"
            if len(each.moves) > row
            else f"{each.name} does not move"
            for each in (one, other)
        )
        return f"in line {longer.line[row]} {goals}"
    return ""


def _pecks_apart(a: Moves, b: Moves, count: int) -> BoolArray:
    """Rapids of two dialects that end a little apart along Z alone, as pecks do, shape (count,)."""
    off = np.abs(a.end[:count] - b.end[:count])
    rapid = (a.motion[:count] == Motion.RAPID) & (b.motion[:count] == Motion.RAPID)
    others = np.delete(off, 2, axis=1).max(axis=1, initial=0.0) <= _SAME
    return rapid & others & (off[:, 2] > _SAME) & (off[:, 2] < _CLEARANCE)


def _slight_difference(one: _DialectReading, other: _DialectReading) -> str:
    """What two dialects make differently that asks nobody; empty: nothing."""
    a, b = one.moves, other.moves
    pecks = np.flatnonzero(_pecks_apart(a, b, min(len(a), len(b))))
    if len(pecks):
        row = int(pecks[0])
        heights = f"{one.name} to Z{a.end[row, 2]:.4g} and {other.name} to Z{b.end[row, 2]:.4g}"
        return f"in line {a.line[row]} they withdraw pecks differently, {heights}"
    return _feeds_apart(one, other)


def _feeds_apart(one: _DialectReading, other: _DialectReading, share: float = _SAME) -> str:
    """The first feed that two dialects make differently; empty: none."""
    a, b = one.moves, other.moves
    apart = np.flatnonzero(~np.isclose(a.feed, b.feed, rtol=share, equal_nan=True))
    if not len(apart):
        return ""
    row = int(apart[0])
    paces = f"{one.name} feeds {a.feed[row]:g} and {other.name} {b.feed[row]:g} a minute"
    return f"in line {a.line[row]} {paces}"


def _place(moves: Moves, row: int) -> str:
    names = moves.axes.names
    return " ".join(f"{n}{v:g}" for n, v in zip(names, moves.end[row].round(4), strict=True))
