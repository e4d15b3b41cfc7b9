"""Baselines as text: one entry a line, modal like an NC program, so that they are small and diff well.

    twin baseline 5
    cycle_time_s 12.5
    contour_um 3.2
    axes X Y Z C
    cut removed_mm3 812.5
    cut tool.1 812.5
    job tolerance.contour_um 20.0
    job "offsets.G54.1 P1.X" 10.0
    source N10 G01 X50 F600
    M3 S3000
    start X0 Y0 Z50 C0
    corner exact-path
    rapid Z0
    feed X50 F600
    arc X0 center 25 0 0 normal 0 0 1 sweep 180
    dwell 0.5

An axis, a feed, a corner mode (``corner continuous 0.05``) or a programmed acceleration
(``acceleration 500 400``) is written where it changes; source lines are not, so that a comment more changes
nothing; the program's words are there once, to say which of its lines has changed.
"""

import dataclasses
import itertools
import json
import math
import operator
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import NamedTuple, TextIO

from twin.nc.canonical import Chunk, Corner, Dwell, Event, Function, Motion, Moves, Shape

HEADING = "twin baseline 5"
_DECIMALS = 6
"""Of coordinates in the file: a nanometre, far below any tolerance."""


@dataclasses.dataclass(frozen=True, slots=True)
class RunFigures:
    """What a baseline keeps in addition to the path.

    Attributes:
        cycle_time_s: Machine time of the program [s].
        contour_um: Greatest contour error [µm].
        cut: Figures of the cut by name; none where nothing is cut.
    """

    cycle_time_s: float
    contour_um: float
    cut: Mapping[str, float] = dataclasses.field(default_factory=dict)


class Head(NamedTuple):
    """What is before the entries.

    Attributes:
        source: The lines of the program without comments; none where it is too long to keep.
    """

    figures: RunFigures
    axes: tuple[str, ...]
    settings: Mapping[str, str]
    source: Sequence[str] = ()


@dataclasses.dataclass(frozen=True, slots=True)
class BaselineEntry:
    """A move, dwell or function as a baseline knows it.

    Attributes:
        kind: ``rapid``, ``feed``, ``arc``, ``rapid arc``, ``dwell``, or a function with its
            arguments, such as ``M3 S3000``.
        line: Source line; 0 in a stored baseline, which knows none.
        start: Of a move [mm or deg].
        end: Of a move [mm or deg].
        feed: Of a move, per minute; 0 for rapids.
        center: Of an arc [mm].
        normal: Of an arc.
        value: Sweep of an arc [deg], or length of a dwell [s].
        corner: How the end of a move is passed, such as ``exact-path`` or ``continuous 0.05``.
        acceleration: Programmed acceleration and deceleration, or ``machine`` for its own.
        shown: What the control's screen adds to the positions of a move, such as a tool length; a stored
            baseline does not know it [mm or deg].
    """

    kind: str
    line: int = 0
    start: tuple[float, ...] = ()
    end: tuple[float, ...] = ()
    feed: float = 0.0
    center: tuple[float, ...] = ()
    normal: tuple[float, ...] = ()
    value: float = 0.0
    corner: str = ""
    acceleration: str = ""
    shown: tuple[float, ...] = ()

    @property
    def as_shown(self) -> "BaselineEntry":
        """A move in the coordinates that the control shows."""
        if not self.shown:
            return self
        start, end = (
            tuple(map(operator.add, place, self.shown)) for place in (self.start, self.end)
        )
        center = tuple(map(operator.add, self.center, self.shown)) if self.center else ()
        return dataclasses.replace(self, start=start, end=end, center=center)

    @property
    def is_path(self) -> bool:
        """Whether it moves or waits, rather than being a function."""
        return self.kind == "dwell" or self.kind in _MOVES


_KINDS = {
    (Motion.RAPID, Shape.LINE): "rapid",
    (Motion.FEED, Shape.LINE): "feed",
    (Motion.RAPID, Shape.ARC): "rapid arc",
    (Motion.FEED, Shape.ARC): "arc",
    (Motion.RAPID, Shape.CURVE): "rapid curve",
    (Motion.FEED, Shape.CURVE): "curve",
}
_MOVES = frozenset(_KINDS.values())
_CORNERS = {
    Corner.EXACT_STOP: "exact-stop",
    Corner.EXACT_PATH: "exact-path",
    Corner.CONTINUOUS: "continuous",
}
_MODAL = ("corner", "acceleration")


def entries(chunks: Iterable[Chunk]) -> Iterator[BaselineEntry]:
    """What a program does, in order."""
    for chunk in chunks:
        events = iter(chunk.events)
        event = next(events, None)
        for row in range(len(chunk.moves) + 1):
            while event is not None and event.before == row:
                yield _event(event)
                event = next(events, None)
            if row < len(chunk.moves):
                yield _move(chunk.moves, row)


def _event(event: Event) -> BaselineEntry:
    if isinstance(event, Dwell):
        return BaselineEntry("dwell", event.line, value=event.seconds)
    return BaselineEntry(_function_text(event), event.line)


def _function_text(event: Function) -> str:
    arguments = [f"{name}{number(value)}" for name, value in event.arguments.items()]
    place = [f"at {number(event.at)}"] if event.at else []
    return " ".join([event.word, *arguments, *place])


def _move(moves: Moves, row: int) -> BaselineEntry:
    motion, shape = Motion(moves.motion[row]), Shape(moves.shape[row])
    arc = shape is Shape.ARC
    return BaselineEntry(
        kind=_KINDS[motion, shape],
        line=int(moves.line[row]),
        start=tuple(moves.start[row].tolist()),
        end=tuple(moves.end[row].tolist()),
        feed=0.0 if math.isnan(moves.feed[row]) else float(moves.feed[row]),
        center=tuple(moves.center[row].tolist()) if arc else (),
        normal=tuple(moves.normal[row].tolist()) if arc else (),
        value=float(moves.sweep[row]),
        corner=_corner(moves, row),
        acceleration=_acceleration(moves, row),
        shown=tuple((moves.display[row] - moves.end[row]).tolist()),
    )


def _corner(moves: Moves, row: int) -> str:
    corner, tolerance = Corner(moves.corner[row]), float(moves.corner_tolerance[row])
    rounded = corner is Corner.CONTINUOUS and not math.isnan(tolerance)
    return _CORNERS[corner] + (f" {number(tolerance)}" if rounded else "")


def _acceleration(moves: Moves, row: int) -> str:
    limits = (float(moves.acceleration[row]), float(moves.deceleration[row]))
    if all(map(math.isnan, limits)):
        return "machine"
    return " ".join("machine" if math.isnan(limit) else number(limit) for limit in limits)


def write(file: TextIO, head: Head, program: Iterable[BaselineEntry]) -> None:
    """Write a baseline.

    Args:
        head: What is before the entries.
    """
    figures = head.figures
    file.write(f"{HEADING}\n")
    file.write(f"cycle_time_s {figures.cycle_time_s:.6f}\ncontour_um {figures.contour_um:.3f}\n")
    file.write(f"axes {' '.join(head.axes)}\n")
    file.writelines(f"cut {name} {number(value)}\n" for name, value in figures.cut.items())
    file.writelines(f"job {_quoted(key)} {value}\n" for key, value in sorted(head.settings.items()))
    file.writelines(f"source {line}\n" for line in head.source)
    position: tuple[float, ...] = ()
    feed = 0.0
    modal = dict.fromkeys(_MODAL, "")
    for entry in program:
        if entry.start and list(map(number, entry.start)) != list(map(number, position)):
            file.write(f"start {words(head.axes, entry.start)}\n")
        for name, before in modal.items():
            value = getattr(entry, name)
            if value and value != before:
                file.write(f"{name} {value}\n")
                modal[name] = value
        file.write(text(entry, head.axes, entry.start, feed) + "\n")
        position, feed = entry.end or position, entry.feed or feed


def _quoted(key: str) -> str:
    """A key as one word: those with blanks, such as ``offsets.G54.1 P1.X``, stand in quotation marks."""
    return json.dumps(key, ensure_ascii=False) if " " in key or key.startswith('"') else key


def _key_and_value(text: str) -> tuple[str, str]:
    if text.startswith('"'):
        key, end = json.JSONDecoder().raw_decode(text)
        return key, text[end + 1 :]
    key, _, value = text.partition(" ")
    return key, value


def text(
    entry: BaselineEntry, names: tuple[str, ...], position: tuple[float, ...], feed: float
) -> str:
    """One line of a baseline.

    Args:
        position: What need not be repeated [mm or deg].
        feed: What need not be repeated [mm/min or deg/min].
    """
    if entry.kind not in _MOVES:
        return f"{entry.kind} {number(entry.value)}" if entry.kind == "dwell" else entry.kind
    parts = [entry.kind]
    for name, value, before in zip(names, entry.end, position, strict=True):
        if number(value) != number(before):
            parts.append(name + number(value))
    if entry.feed and number(entry.feed) != number(feed):
        parts.append("F" + number(entry.feed))
    if entry.center:
        parts += ["center", *map(number, entry.center), "normal", *map(number, entry.normal)]
        parts += ["sweep", number(entry.value)]
    return " ".join(parts)


def words(names: tuple[str, ...], values: Iterable[float]) -> str:
    """A position, such as ``X10 Y-2.5``."""
    return " ".join(name + number(value) for name, value in zip(names, values, strict=True))


def number(value: float) -> str:
    """A number without needless zeros."""
    shown = f"{value:.{_DECIMALS}f}".rstrip("0").rstrip(".")
    return "0" if shown == "-0" else shown


def read_head(lines: Iterator[str]) -> tuple[Head, Iterator[str]]:
    """What is before the entries, and the lines of the entries.

    Raises:
        ValueError: This is no baseline.
    """
    if next(lines, "").strip() != HEADING:
        raise ValueError(f"the first line is not '{HEADING}'")
    values = {}
    for key in ("cycle_time_s", "contour_um", "axes"):
        name, *rest = next(lines, "").split() or [""]
        if name != key:
            raise ValueError(f"'{key}' is missing")
        values[key] = rest
    cut: dict[str, float] = {}
    settings: dict[str, str] = {}
    source: list[str] = []
    for line in lines:
        kind, _, rest = line.rstrip("\n").partition(" ")
        if kind == "source":
            source.append(rest)
        elif kind in ("cut", "job"):
            key, value = _key_and_value(rest)
            if kind == "cut":
                cut[key] = float(value)
            else:
                settings[key] = value
        else:
            lines = itertools.chain([line], lines)
            break
    figures = RunFigures(float(*values["cycle_time_s"]), float(*values["contour_um"]), cut)
    return Head(figures, tuple(values["axes"]), settings, source), lines


def read_entries(lines: Iterator[str], names: tuple[str, ...]) -> Iterator[BaselineEntry]:
    """The entries of a stored baseline.

    Raises:
        ValueError: A line is no entry.
    """
    position = dict.fromkeys(names, 0.0)
    feed = 0.0
    modal = dict.fromkeys(_MODAL, "")
    for line in lines:
        parts = line.split()
        if not parts:
            continue
        both = " ".join(parts[:2])
        kind = both if both in _MOVES else parts[0]
        if kind in _MODAL:
            modal[kind] = " ".join(parts[1:])
        elif kind == "dwell":
            yield BaselineEntry(kind, value=float(parts[1]))
        elif kind != "start" and kind not in _MOVES:
            yield BaselineEntry(" ".join(parts))
        else:
            start = tuple(position.values())
            parts, arc = _split_arc(parts[len(kind.split()) :])
            given = _read_words(parts, names)
            own_feed = given.pop("F", feed)
            position |= given
            if kind == "start":
                continue
            feed = own_feed
            end = tuple(position.values())
            own = 0.0 if "rapid" in kind else feed
            yield BaselineEntry(kind, 0, start, end, own, *arc, **modal)


def _split_arc(
    parts: list[str],
) -> tuple[list[str], tuple[tuple[float, ...], tuple[float, ...], float]]:
    if "center" not in parts:
        return parts, ((), (), 0.0)
    at = parts.index("center")
    tail = parts[at:]
    if len(tail) != 10 or tail[4] != "normal" or tail[8] != "sweep":
        raise ValueError(f"no arc: {' '.join(tail)}")
    center, normal = (tuple(map(float, tail[i : i + 3])) for i in (1, 5))
    return parts[:at], (center, normal, float(tail[9]))


def _read_words(parts: list[str], names: tuple[str, ...]) -> dict[str, float]:
    values = {}
    for part in parts:
        # The longest name first: an axis X2 begins like an axis X.
        known = sorted((name for name in (*names, "F") if part.startswith(name)), key=len)
        if not known:
            raise ValueError(f"'{part}' is not a word of a baseline")
        values[known[-1]] = float(part.removeprefix(known[-1]))
    return values
