"""What a cut should not do although no machine would stop it: sideways drills, plunges, stops in the material."""

import dataclasses

import numpy as np

from twin.cutting.watching.events import Stretches
from twin.job.job_file import ToolTable
from twin.nc.canonical import FloatArray

ENGAGED_MM = 0.2
"""A tool that took material off within so much of its last path is still in the cut [mm]."""
SIDEWAYS_MM = 0.05
"""How far a drill may wander in the material while it feeds [mm]."""
STEEP = 1.7
"""Descent over advance from which on a move is a plunge and no ramp: 60 degrees."""
FULL_SHARE = 0.5
"""Share of its whole cross-section that a plunging tool takes off where its centre is in the material."""


@dataclasses.dataclass(frozen=True, slots=True)
class CutSlip:
    """Something that a cut should not do.

    Attributes:
        what: ``sideways``, a drill; or ``plunge``, another tool straight down into the full material.
    """

    what: str
    line: int
    tool: int


class CutWatch:
    """Follows the stretches of a cut, chunk by chunk.

    Attributes:
        slips: What was found, once for each kind, line and tool.
    """

    def __init__(self) -> None:
        """Begin in the air."""
        self.slips: dict[CutSlip, None] = {}
        self._time = np.zeros(0)
        self._path = np.zeros(0)
        self._cuts = np.zeros(0, np.bool_)
        self._aside = 0.0
        self._aside_line = 0

    def add(self, stretches: Stretches, tool: ToolTable) -> None:
        """Look at the stretches that one tool has just made."""
        cuts = ~stretches.in_air
        self._remember(stretches.time, stretches.path, cuts)
        # What the lag lets a rapid take off belongs to the feed before it.
        cuts = cuts & ~stretches.rapid
        if not cuts.any():
            return
        travel = stretches.travel
        advance = np.hypot(travel[:, 0], travel[:, 1])
        if tool.kind == "drill":
            self._watch_drill(stretches, cuts, advance, tool)
        else:
            whole = np.pi * (0.5 * tool.diameter) ** 2
            down = -travel[:, 2]
            full = stretches.removed > FULL_SHARE * whole * np.maximum(down, 1e-9)
            self._note("plunge", stretches, cuts & full & (down > STEEP * advance), tool)

    def _watch_drill(
        self, stretches: Stretches, cuts: np.ndarray, advance: FloatArray, tool: ToolTable
    ) -> None:
        for row in np.flatnonzero(cuts & (advance > 1e-6)).tolist():
            line = int(stretches.line[row])
            self._aside = float(advance[row]) + (self._aside if line == self._aside_line else 0.0)
            self._aside_line = line
            if self._aside > SIDEWAYS_MM:
                self.slips[CutSlip("sideways", line, tool.number)] = None

    def _note(self, what: str, stretches: Stretches, found: np.ndarray, tool: ToolTable) -> None:
        for line in np.unique(stretches.line[found]).tolist():
            self.slips[CutSlip(what, int(line), tool.number)] = None

    def _remember(self, time: FloatArray, path: FloatArray, cuts: np.ndarray) -> None:
        """Keep this chunk and as much of the path before it as tells whether the tool is in the cut."""
        # By where each stretch ends: the last one may be longer than that.
        tail = np.cumsum(self._path[::-1])[::-1] - self._path <= 2.0 * ENGAGED_MM
        self._time = np.concatenate([self._time[tail], time])
        self._path = np.concatenate([self._path[tail], path])
        self._cuts = np.concatenate([self._cuts[tail], cuts])

    def engaged(self, time: float) -> bool:
        """Whether the tool is in the cut at a time of the last chunk, or at its end [s]."""
        until = int(np.searchsorted(self._time, time, side="right"))
        behind = np.cumsum(self._path[:until][::-1])[::-1] - self._path[:until]
        return bool(np.any(self._cuts[:until] & (behind <= ENGAGED_MM)))
