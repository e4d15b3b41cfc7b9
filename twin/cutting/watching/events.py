"""What a cut must not do, noted once per move with its greatest depth."""

import dataclasses
from collections.abc import Hashable

import numpy as np

from twin.cutting.heights.height_map import BoolArray
from twin.nc.canonical import FloatArray, IntArray

TAIL_MM = 0.2
"""A rapid's removal on its first millimetres counts as the end of the feed before it [mm]: the axes lag
behind the setpoints, so that the last of a feed is cut when the rapid has already begun. As long
as the lag at its beginning, and so much more. The same holds for a feed after the spindle stopped."""

SCRAPE_MM = 0.01
"""Depth below which a removal is the grid's doing [mm]."""

THINNEST_MM = 1e-3
"""What is thinner is no chip [mm]: samples that are joined are off their line by half of it. Nor is what is
thinner than twice what the machine is off its path, here and where the wall was cut that it comes along again."""


@dataclasses.dataclass(frozen=True, slots=True)
class CutEvent:
    """Something that a cut must not do.

    Attributes:
        time_s: When it began [s].
        depth_mm: Its greatest depth below the material that was first met [mm].
        position: Tool tip in the part's frame at its beginning [mm].
        what: ``rapid``; ``standing``, a feed with the spindle off; ``arrival``, the edge of a tool that
            comes into the spindle; or which part of the tool gouges: ``flute`` (the cut is deeper than the flutes are long), ``shank``, ``holder``, or
            by its name what is above it.
    """

    line: int
    time_s: float
    depth_mm: float
    position: tuple[float, float, float]
    what: str


@dataclasses.dataclass(frozen=True, slots=True)
class Stretches:
    """A chunk of n straight stretches and what each took off.

    Attributes:
        points: Tool tip positions at their ends, shape (n + 1, 3) [mm].
        time: When each ended, shape (n,) [s].
        line: Source line, shape (n,).
        rapid: Which belong to rapids, shape (n,).
        removed: Material taken off, shape (n,) [mm³].
        depth: Greatest depth of it, shape (n,) [mm].
        aside: How far left of the path it lay in the mean, shape (n,) [mm].
        thickness: How thick it was across the path at most, shape (n,) [mm].
        off: From the tip to its setpoint at the end of each, shape (n, 3) [mm].
        axis: Direction from the tool's tip to the spindle at the end of each, shape (n, 3); None: +Z.
    """

    points: FloatArray
    time: FloatArray
    line: IntArray
    rapid: BoolArray
    removed: FloatArray
    depth: FloatArray
    aside: FloatArray
    thickness: FloatArray
    off: FloatArray
    axis: FloatArray | None = None

    @property
    def in_air(self) -> BoolArray:
        """Which take off no material worth the name, shape (n,)."""
        way = np.diff(self.points, axis=0) / np.maximum(self.path, 1e-12)[:, None]
        beside = np.linalg.norm(np.cross(self.off, way), axis=1)
        return self.thickness < THINNEST_MM + 2.0 * beside

    @property
    def travel(self) -> FloatArray:
        """From begin to end of each, in the tool's own frame, whose Z is its axis, shape (n, 3) [mm]."""
        travel = np.diff(self.points, axis=0)
        return travel if self.axis is None else in_tool_frame(travel, self.axis)

    def lowest(self, index: int) -> float:
        """The lower of both places of the tip of one, along the tool's axis [mm]."""
        ends = self.points[index : index + 2]
        return float(min(ends[:, 2] if self.axis is None else ends @ self.axis[index]))

    @property
    def path(self) -> FloatArray:
        """Length of each, shape (n,) [mm]."""
        return np.linalg.norm(np.diff(self.points, axis=0), axis=1)


def tool_frame(axis: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Unit vectors along X, Y and Z of tools, whose Z is their axis, shape (n, 3) each.

    Of an upright tool they are those of the part (Duff et al., "Building an orthonormal basis, revisited", 2017).
    """
    x, y, z = axis.T
    sign = np.copysign(1.0, z)
    a = -1.0 / (sign + z)
    b = x * y * a
    along_x = np.stack([1.0 + sign * x * x * a, sign * b, -sign * x], axis=1)
    along_y = np.stack([b, sign + y * y * a, -y], axis=1)
    return along_x, along_y, axis


def in_tool_frame(vectors: FloatArray, axis: FloatArray) -> FloatArray:
    """Vectors of the part's frame as tools along given axes see them, shape (n, 3)."""
    return np.stack([(vectors * each).sum(axis=1) for each in tool_frame(axis)], axis=1)


EVENTS_TOLD = 1000
"""Occurrences that are reported at most: the deepest."""


class EventLog:
    """Keeps the first and the worst of each occurrence.

    Attributes:
        forgotten: How often one was dropped because enough others were deeper.
    """

    def __init__(self, most: int = EVENTS_TOLD) -> None:
        self.forgotten = 0
        self._most = most
        self._events: dict[Hashable, CutEvent] = {}

    def note(
        self, key: Hashable, what: str, stretches: Stretches, index: int, depth: float
    ) -> None:
        """Add one stretch to the occurrence called ``key``."""
        known = self._events.get(key)
        if known is None:
            x, y, z = (float(value) for value in stretches.points[index])
            line, time = int(stretches.line[index]), float(stretches.time[index])
            self._events[key] = CutEvent(line, time, depth, (x, y, z), what)
            if len(self._events) > 2 * self._most:
                self._forget(key)
        elif depth > known.depth_mm:
            self._events[key] = dataclasses.replace(known, depth_mm=depth)

    def event(self, key: Hashable) -> CutEvent:
        """One occurrence."""
        return self._events[key]

    def _forget(self, latest: Hashable) -> None:
        """Let go of all but the deepest, and the latest, which may go deeper yet."""
        deepest = sorted(self._events, key=lambda key: -self._events[key].depth_mm)
        kept = {*deepest[: self._most], latest}
        self.forgotten += len(self._events) - len(kept)
        self._events = {key: event for key, event in self._events.items() if key in kept}

    def events(self) -> tuple[CutEvent, ...]:
        """The occurrences, in the order in which they began; of very many the deepest."""
        found = list(self._events.values())
        if len(found) <= self._most:
            return tuple(found)
        least = sorted(event.depth_mm for event in found)[-self._most]
        return tuple(event for event in found if event.depth_mm >= least)[: self._most]


class StockWatch:
    """Finds moves that take material although they must not; one event per move."""

    def __init__(self, what: str) -> None:
        self._what = what
        self._log = EventLog()
        self._runs = 0
        self._running = False
        self._start, self._start_axis = np.zeros(3), np.array([0.0, 0.0, 1.0])
        self._tail = TAIL_MM
        self._surface: dict[tuple[int, int], float] = {}

    def suspects(
        self,
        points: FloatArray,
        forbidden: BoolArray,
        lag: FloatArray,
        axis: FloatArray | None = None,
        reach: float = 0.0,
    ) -> IntArray:
        """Number the runs of stretches that must not cut, in a chunk that follows the last one.

        Args:
            points: Tool tip positions at the ends of n stretches, shape (n + 1, 3) [mm].
            forbidden: Which stretches must take no material, shape (n,).
            lag: How far the tool trails its setpoint at the end of each, shape (n,) [mm].
            axis: Direction from the tip to the spindle at the same places, shape (n + 1, 3); None: +Z.
            reach: How far above the tip the edge ends, which a tool that turns about its tip moves [mm].

        Returns:
            Number of the run that each stretch belongs to, from 1; 0 where it may cut, and on the
            first displacement of a run, shape (n,).
        """
        if not len(forbidden):
            return np.zeros(0, np.int64)
        begins = forbidden & ~np.append(self._running, forbidden[:-1])
        run = self._runs + np.cumsum(begins)
        latest = np.maximum.accumulate(np.where(begins, np.arange(len(forbidden)), -1))
        start = np.where(latest[:, None] < 0, self._start, points[latest])
        tail = np.where(latest < 0, self._tail, TAIL_MM + lag[latest])
        travel = points[1:] - start
        turning = np.zeros(len(forbidden))
        if axis is not None:
            travel = in_tool_frame(travel, axis[1:])
            before = np.where(latest[:, None] < 0, self._start_axis, axis[latest])
            self._start_axis = before[-1].copy()
            turning = reach * np.linalg.norm(axis[1:] - before, axis=1)
        advance = np.hypot(travel[:, 0], travel[:, 1]) + np.maximum(0.0, -travel[:, 2]) + turning
        self._runs, self._running = int(run[-1]), bool(forbidden[-1])
        self._start, self._tail = start[-1].copy(), float(tail[-1])
        return np.where(forbidden & (advance > tail), run, 0)

    def add(self, stretches: Stretches, suspects: IntArray, hits: BoolArray) -> None:
        """Note those of a chunk's suspects that met material."""
        for i in np.flatnonzero(hits & (suspects > 0)):
            key = (int(suspects[i]), int(stretches.line[i]))
            if self._surface and key[0] != next(iter(self._surface))[0]:
                self._surface.clear()  # a move that has ended
            tip = stretches.lowest(int(i))
            surface = max(self._surface.get(key, tip), tip + float(stretches.depth[i]))
            self._surface[key] = surface
            self._log.note(key, self._what, stretches, int(i), surface - tip)

    def events(self) -> tuple[CutEvent, ...]:
        """All moves that met material."""
        return self._log.events()
