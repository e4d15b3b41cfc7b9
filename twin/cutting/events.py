"""What a cut must not do, noted once per move with its greatest depth."""

import dataclasses
from collections.abc import Hashable

import numpy as np

from twin.cutting.height_map import BoolArray
from twin.nc.canonical import FloatArray, IntArray

TAIL_MM = 0.2
"""A rapid's removal on its first way counts as the end of the feed before it [mm]: the axes lag
behind the setpoints, so that the last of a feed is cut when the rapid has already begun."""

SCRAPE_MM = 0.01
"""Depth below which a removal is the grid's doing [mm]."""


@dataclasses.dataclass(frozen=True, slots=True)
class CutEvent:
    """Something that a cut must not do.

    Attributes:
        line: Source line of the program.
        time_s: When it began [s].
        depth_mm: Its greatest depth below the material that was first met [mm].
        position: Tool tip in the part's frame at its beginning [mm].
        what: ``rapid``; or which part of the tool gouges: ``flute`` (the cut is deeper than the
            flutes are long), ``shank``, ``holder``.
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
    """

    points: FloatArray
    time: FloatArray
    line: IntArray
    rapid: BoolArray
    removed: FloatArray
    depth: FloatArray

    @property
    def path(self) -> FloatArray:
        """Length of each, shape (n,) [mm]."""
        return np.linalg.norm(np.diff(self.points, axis=0), axis=1)


class EventLog:
    """Keeps the first and the worst of each occurrence."""

    def __init__(self) -> None:
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
        elif depth > known.depth_mm:
            self._events[key] = dataclasses.replace(known, depth_mm=depth)

    def events(self) -> tuple[CutEvent, ...]:
        """All occurrences, in the order in which they began."""
        return tuple(self._events.values())


class RapidWatch:
    """Finds rapids that meet material; one event per move."""

    def __init__(self) -> None:
        self._log = EventLog()
        self._runs = 0
        self._running = False
        self._start = np.zeros(3)
        self._surface: dict[tuple[int, int], float] = {}

    def add(self, stretches: Stretches) -> None:
        """Look at a chunk that follows the last one."""
        rapid = stretches.rapid
        if not len(rapid):
            return
        begins = rapid & ~np.append(self._running, rapid[:-1])
        run = self._runs + np.cumsum(begins)
        latest = np.maximum.accumulate(np.where(begins, np.arange(len(rapid)), -1))
        start = np.where(latest[:, None] < 0, self._start, stretches.points[latest])
        way = stretches.points[1:] - start
        advance = np.hypot(way[:, 0], way[:, 1]) + np.maximum(0.0, -way[:, 2])
        hits = rapid & (stretches.depth > SCRAPE_MM) & (advance > TAIL_MM)
        for i in np.flatnonzero(hits):
            key = (int(run[i]), int(stretches.line[i]))
            tip = float(min(stretches.points[i : i + 2, 2]))
            surface = max(self._surface.get(key, tip), tip + float(stretches.depth[i]))
            self._surface[key] = surface
            self._log.note(key, "rapid", stretches, int(i), surface - tip)
        self._runs, self._running, self._start = int(run[-1]), bool(rapid[-1]), start[-1].copy()

    def events(self) -> tuple[CutEvent, ...]:
        """All rapids that met material."""
        return self._log.events()
