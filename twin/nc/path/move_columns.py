"""Collects moves and events one by one and hands them out as columns."""

import dataclasses
import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from twin.nc.canonical import (
    Axes,
    Chunk,
    Corner,
    Event,
    FeedUnit,
    FloatArray,
    IntArray,
    Motion,
    Moves,
    Shape,
)
from twin.nc.geometry.matrices import IDENTITY, Matrix
from twin.nc.geometry.planes import Vector

CHUNK = 4096
"""Moves in a chunk: enough to make NumPy's overhead vanish, little to hold in memory."""

NAN = math.nan
_NOWHERE = (NAN, NAN, NAN)
"""The centre of a line."""

LINE, ARC, CURVE = int(Shape.LINE), int(Shape.ARC), int(Shape.CURVE)
RAPID, FEED = Motion.RAPID, Motion.FEED
"""Members of enumerations by names of their own: CPython 3.11 looks each of them up by a call of Python."""


class Curve(NamedTuple):
    """How the axes go in a part of a move under tool centre point control.

    Attributes:
        coefficients: What is added to the start, by powers 1 to 5 of the path fraction, shape (k, 5)
            [mm or deg].
        length: Of the tip's path in the part [mm]; where it rests, of the rotary axes' [deg].
        turning: The tip rests: F counts degrees.
    """

    coefficients: FloatArray
    length: float
    turning: bool


@dataclasses.dataclass(slots=True)
class Segment:
    """One move in part coordinates, before it becomes a row.

    Attributes:
        block: N number or ``NO_BLOCK_NUMBER``.
        start: Shape (k,) [mm or deg].
        end: Shape (k,) [mm or deg].
        display: What the screen shows at the end, shape (k,).
        feed: [mm/min or deg/min]; NaN for rapids.
        corner_tolerance: [mm]; NaN: the machine's.
        acceleration: [mm/s²]; NaN: the machine's.
        deceleration: [mm/s²]; NaN: the machine's.
        center: Centre of an arc at the height of its start [mm], or None for a line.
        normal: Unit normal of an arc.
        sweep: Signed angle of an arc [deg].
        curve: How the axes go, where that is neither a line nor an arc; the arc is the tip's in the part then.
        screen: What a millimetre of X, Y and Z, of a curve of the tip in the part, adds to what the screen shows, as
            columns; None: the same.
        in_plane: Under tool centre point control the direction of the tool turns in the plane of both ends; else the
            rotary axes go evenly.
    """

    motion: Motion
    line: int
    block: int
    start: list[float]
    end: list[float]
    display: list[float]
    feed: float = NAN
    corner: Corner = Corner.EXACT_PATH
    corner_tolerance: float = NAN
    acceleration: float = NAN
    deceleration: float = NAN
    center: Vector | None = None
    normal: Vector = (NAN, NAN, NAN)
    sweep: float = 0.0
    curve: Curve | None = None
    screen: Matrix | None = None
    in_plane: bool = False


class Refused(NamedTuple):
    """A block that was refused while it ran: whatever it did is not to happen.

    What it let go of earlier blocks, which were waiting for it, stays.
    """

    moves: int
    events: int
    line: int

    def kept_events(self, events: list[Event], kept: NDArray[np.bool_]) -> list[Event]:
        """The events of other blocks, at their places among the moves that are kept, shape (n,)."""
        places = np.concatenate(([0], np.cumsum(kept)))
        return [
            dataclasses.replace(event, before=int(places[event.before]))
            for number, event in enumerate(events)
            if number < self.events or event.line != self.line
        ]


def segment_of(codes: IntArray, values: FloatArray, positions: FloatArray) -> Segment:
    """A move of columns, as ``MoveColumns.add_rows`` takes them."""
    motion, _, line, block, corner = codes.tolist()
    a, b, c, i, j, k, *others = values.tolist()
    sweep, feed, tolerance, acceleration, deceleration = others
    center = None if math.isnan(a) else (a, b, c)
    start, end, display = positions.tolist()
    begun = (Motion(motion), line, block, start, end, display, feed, Corner(corner))
    return Segment(*begun, tolerance, acceleration, deceleration, center, (i, j, k), sweep)


class MoveColumns:
    """The moves and events since the last ``take``.

    Attributes:
        events: Each with its place among the moves.
    """

    def __init__(self, axes: Axes) -> None:
        self._axes = axes
        self._other_linear = np.array([kind == "linear" for kind in axes.kinds])
        self._other_linear[:3] = False
        self._rotary = axes.rotary()
        self._clear()

    def _clear(self) -> None:
        self._parts: list[tuple[IntArray, FloatArray, FloatArray]] = []
        self._curves: list[tuple[int, Curve]] = []
        self._screens: list[tuple[int, int, Matrix]] = []
        self.events: list[Event] = []
        self.count = 0
        self._clear_lists()

    def _clear_lists(self) -> None:
        self._codes: list[int] = []
        self._values: list[float] = []
        self._positions: list[float] = []

    def add(self, move: Segment) -> None:
        """Append a move."""
        center = move.center
        shape = LINE if center is None else ARC
        if move.curve is not None:
            shape = CURVE
            self._curves.append((self.count, move.curve))
        if move.screen is not None:
            self._screens.append((self.count, self.count + 1, move.screen))
        self._codes += (move.motion, shape, move.line, move.block, move.corner)
        values, positions = self._values, self._positions
        values += _NOWHERE if center is None else center
        values += move.normal
        values += (
            move.sweep,
            move.feed,
            move.corner_tolerance,
            move.acceleration,
            move.deceleration,
        )
        positions += move.start
        positions += move.end
        positions += move.display
        self.count += 1

    def add_rows(
        self,
        codes: IntArray,
        values: FloatArray,
        positions: FloatArray,
        screen: Matrix | None = None,
    ) -> None:
        """Append moves that are columns already.

        Args:
            codes: Motion, shape, line, block and corner, shape (n, 5).
            values: Centre, normal, sweep, feed, corner tolerance, acceleration and deceleration,
                shape (n, 11).
            positions: Start, end and display, shape (n, 3, k).
            screen: As for ``Segment``.
        """
        self._close_lists()
        if screen is not None:
            self._screens.append((self.count, self.count + len(codes), screen))
        self._parts.append((codes.copy(), values.copy(), positions.copy()))
        self.count += len(codes)

    def _close_lists(self) -> None:
        """Make the moves that were appended one by one a part of columns."""
        if self._codes:
            codes = np.array(self._codes, np.int64).reshape(-1, 5)
            values = np.array(self._values, np.float64).reshape(-1, 11)
            positions = np.array(self._positions, np.float64).reshape(len(codes), 3, -1)
            self._parts.append((codes, values, positions))
            self._clear_lists()

    def add_event(self, event: Event) -> None:
        """Append an event after the moves so far."""
        self.events.append(dataclasses.replace(event, before=self.count))

    def withdraw_events(self, line: int) -> list[Event]:
        """Take back the events of a line that no move has followed."""
        first = len(self.events)
        while first and (self.events[first - 1].line, self.events[first - 1].before) == (
            line,
            self.count,
        ):
            first -= 1
        withdrawn = self.events[first:]
        del self.events[first:]
        return withdrawn

    def refusal(self, line: int) -> Refused:
        """That the block of a line, which comes next, is refused."""
        return Refused(self.count, len(self.events), line)

    def take(self, refused: "Refused | None" = None) -> Chunk:
        """All that was appended but for what a refused block did, as columns; nothing is left here."""
        self._close_lists()
        k = len(self._axes)
        none = (np.zeros((0, 5), np.int64), np.zeros((0, 11)), np.zeros((0, 3, k)))
        columns = zip(*(self._parts or [none]), strict=True)
        codes, values, positions = (np.concatenate(each) for each in columns)
        curve, lengths, units = self._curve_columns(len(codes))
        screen = self._screen_column(len(codes))
        events = self.events
        if refused is not None:
            kept = codes[:, 2] != refused.line
            kept[: refused.moves] = True
            events = refused.kept_events(events, kept)
            codes, values, positions = codes[kept], values[kept], positions[kept]
            curve = None if curve is None else curve[kept]
            screen = None if screen is None else screen[kept]
            lengths, units = lengths[kept], units[kept]
        self._clear()
        start, end = positions[:, 0], positions[:, 1]
        shape = codes[:, 1].astype(np.uint8)
        center, normal = values[:, 0:3], values[:, 3:6]
        radius = _norms(start[:, :3] - center)
        length, unit = self._measure(start, end, normal, radius, values[:, 6])
        if curve is not None:
            curved = shape == CURVE
            radius[curved] = _norms(center[curved])
            length[curved], unit[curved] = lengths[curved], units[curved]
        moves = Moves(
            axes=self._axes,
            motion=codes[:, 0].astype(np.uint8),
            shape=shape,
            line=codes[:, 2].copy(),
            block=codes[:, 3].copy(),
            start=start.copy(),
            end=end.copy(),
            display=positions[:, 2].copy(),
            feed=values[:, 7].copy(),
            feed_unit=unit.astype(np.uint8),
            length=length,
            center=center.copy(),
            normal=normal.copy(),
            radius=radius,
            sweep=values[:, 6].copy(),
            corner=codes[:, 4].astype(np.uint8),
            corner_tolerance=values[:, 8].copy(),
            acceleration=values[:, 9].copy(),
            deceleration=values[:, 10].copy(),
            curve=curve,
            screen=screen,
        )
        return Chunk(moves, tuple(events))

    def _curve_columns(self, count: int) -> tuple[FloatArray | None, FloatArray, FloatArray]:
        """Of so many moves the column of curves, their lengths and the units of their feeds."""
        lengths, units = np.zeros(count), np.zeros(count)
        if not self._curves:
            return None, lengths, units
        column = np.zeros((count, len(self._axes), 5))
        for row, (coefficients, length, turning) in self._curves:
            column[row], lengths[row] = coefficients, length
            units[row] = FeedUnit.DEG_PER_MIN if turning else FeedUnit.MM_PER_MIN
        return column, lengths, units

    def _screen_column(self, count: int) -> FloatArray | None:
        """Of so many moves what their X, Y and Z add to what the screen shows; None: of all of them the same."""
        if not self._screens:
            return None
        column = np.tile(np.array(IDENTITY), (count, 1, 1))
        for first, end, screen in self._screens:
            column[first:end] = screen
        return column

    def _measure(
        self,
        start: FloatArray,
        end: FloatArray,
        normal: FloatArray,
        radius: FloatArray,
        sweep: FloatArray,
    ) -> tuple[FloatArray, FloatArray]:
        """Length that the feed counts and its unit, by the convention of ``canonical``."""
        delta = end - start
        spatial = _norms(delta[:, :3])
        advance = _row_sums(delta[:, :3] * normal)
        arc = np.hypot(radius * np.deg2rad(sweep), advance)
        path = np.where(np.isnan(radius), spatial, arc)
        linear = _norms(delta[:, self._other_linear])
        rotary = _norms(delta[:, self._rotary])
        length = np.where(path > 0.0, path, np.where(linear > 0.0, linear, rotary))
        turning = (path == 0.0) & (linear == 0.0) & (rotary > 0.0)
        return length, np.where(turning, float(FeedUnit.DEG_PER_MIN), float(FeedUnit.MM_PER_MIN))


def _norms(vectors: FloatArray) -> FloatArray:
    """Length of each row, shape (n,)."""
    return np.sqrt(_row_sums(vectors * vectors))


def _row_sums(rows: FloatArray) -> FloatArray:
    """Sum of each row from left to right, shape (n,).

    NumPy's own order depends on the layout, and a move must have the same length in every chunk.
    """
    total = np.zeros(len(rows))
    for column in rows.T:
        total += column
    return total
