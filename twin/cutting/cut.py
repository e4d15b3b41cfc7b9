"""Cutting: the recorded motion takes material off the stock, and what it did is noted."""

import dataclasses
from typing import Any

import numpy as np

from twin.cutting.events import SCRAPE_MM, CutEvent, EventLog, RapidWatch, Stretches
from twin.cutting.height_map import BoolArray, blank
from twin.cutting.sweep_kernels import sweep, thin
from twin.cutting.tools import default_cell, profile
from twin.job import StockTable, ToolTable
from twin.nc.canonical import FloatArray, IntArray
from twin.recording import Samples
from twin.toolpath.part_frame import PartFrame

STRAIGHT_SHARE = 0.01
"""Samples this share of a cell off a straight line count as on it."""

LONGEST_SHARE = 0.5
"""Longest stretch that is swept at once, as a share of the tool's radius: it is also how finely
cutting is told from air."""

MOST_JOINED = 64
"""Samples that one stretch may stand for."""

AIR_MM = 1e-3
"""A stretch that takes less than this off one cell cuts air [mm]."""


@dataclasses.dataclass(frozen=True, slots=True)
class CutResult:
    """What was cut.

    Attributes:
        removed_mm3: Material taken off [mm³].
        cell_mm: Side of a cell of the height map [mm].
        air_share: Share of the cutting feed's path that met no material.
        gouges: Cuts deeper than the flutes are long, one per program line.
        rapid_into_stock: Rapids that met material, one per move.
    """

    removed_mm3: float
    cell_mm: float
    air_share: float
    gouges: tuple[CutEvent, ...]
    rapid_into_stock: tuple[CutEvent, ...]

    def as_json(self) -> dict[str, Any]:
        """The ``cut`` object of ``result.json``."""
        return dataclasses.asdict(self)


class Cutter:
    """Cuts stock along recorded motion, chunk by chunk; memory does not grow with the program.

    Attributes:
        map: The height map as cut so far; look, but let only the cutter change it.
        changed: Cells that changed in the last ``add``: row, row end, column, column end; none
            when the rows end before they begin.
    """

    def __init__(
        self, stock: StockTable, tool: ToolTable, part_frame: PartFrame, part_zero: FloatArray
    ) -> None:
        """Lay the uncut stock on the table.

        Args:
            stock: The blank.
            tool: What is in the spindle.
            part_frame: How the part turns under the tool.
            part_zero: Machine coordinates of program zero, shape (k,) [mm or deg].

        Raises:
            ConfigError: The stock is too large for its grid.
        """
        corner = np.asarray(part_zero[:3]) - np.array([*part_frame.center, 0.0])
        self.map = blank(stock, corner, stock.cell or default_cell(tool))
        self.changed = (0, 0, 0, 0)
        self._tool = tool
        self._profile = profile(tool)
        self._part_frame = part_frame
        self._last: FloatArray | None = None
        self._removed = 0.0
        self._feed_path = 0.0
        self._air_path = 0.0
        self._gouges = EventLog()
        self._rapids = RapidWatch()

    def add(self, samples: Samples, rapid: BoolArray) -> float:
        """Cut along the simulated joints of a chunk that follows the last one.

        Args:
            samples: n samples.
            rapid: Which of them belong to rapids, shape (n,).

        Returns:
            Material that this chunk took off [mm³].
        """
        self.changed = (0, 0, 0, 0)
        if not len(samples):
            return 0.0
        points = self._part_frame.position(samples.joint_position)
        setpoint = samples.setpoint
        stretches = self._sweep(points, setpoint.time, setpoint.line, np.asarray(rapid, np.bool_))
        self._note_air(stretches)
        for i in np.flatnonzero(stretches.depth > self._tool.flute + SCRAPE_MM):
            excess = float(stretches.depth[i]) - self._tool.flute
            self._gouges.note(int(stretches.line[i]), stretches, int(i), excess)
        self._rapids.add(stretches)
        taken = float(stretches.removed.sum())
        self._removed += taken
        return taken

    def result(self) -> CutResult:
        """What was cut so far."""
        return CutResult(
            removed_mm3=self._removed,
            cell_mm=self.map.cell,
            air_share=self._air_path / self._feed_path if self._feed_path else 0.0,
            gouges=self._gouges.events(),
            rapid_into_stock=self._rapids.events(),
        )

    def _sweep(
        self, points: FloatArray, time: FloatArray, line: IntArray, rapid: BoolArray
    ) -> Stretches:
        """Cut from the last point of the chunk before through all points of this one."""
        before = points[:1] if self._last is None else self._last
        self._last = points[-1:].copy()
        points = np.concatenate([before, points])
        chosen = thin(
            points,
            np.concatenate([line[:1] * 2 + rapid[:1], line * 2 + rapid]),
            STRAIGHT_SHARE * self.map.cell,
            LONGEST_SHARE * self._profile.radius,
            MOST_JOINED,
        )
        sample = chosen[1:] - 1
        removed, depth = np.zeros(len(sample)), np.zeros(len(sample))
        self.changed = sweep(
            self.map.heights,
            self.map.origin,
            self.map.cell,
            self.map.bottom,
            points[chosen],
            dataclasses.astuple(self._profile),
            removed,
            depth,
        )
        return Stretches(points[chosen], time[sample], line[sample], rapid[sample], removed, depth)

    def _note_air(self, stretches: Stretches) -> None:
        path = np.linalg.norm(np.diff(stretches.points, axis=0), axis=1)
        air = stretches.removed < AIR_MM * self.map.cell**2
        self._feed_path += float(path[~stretches.rapid].sum())
        self._air_path += float(path[~stretches.rapid & air].sum())
