"""A height map as the material of a cut."""

from pathlib import Path

import numpy as np

from twin.cutting.heights.height_map import HeightMap
from twin.cutting.heights.part import part_picture, write_glb, write_stl
from twin.cutting.heights.sweeping import Rectangle, sweep_lines, union
from twin.cutting.kernels.covered_cells import Marks
from twin.cutting.kernels.simplify import simplify
from twin.cutting.kernels.sweep import Removal, settle
from twin.cutting.material import (
    LONGEST_SHARE,
    MOST_JOINED,
    STRAIGHT_MM,
    STRAIGHT_SHARE,
    Head,
    Points,
)
from twin.cutting.tools import Profile
from twin.cutting.watching.stock_contact import StockContact
from twin.job.job_file import ToolTable
from twin.nc.canonical import FloatArray, IntArray


class HeightMapMaterial:
    """Cuts a height map; see ``Material``.

    Attributes:
        changed: Cells that changed since ``begin_chunk``: row, row end, column, column end; none when the rows
            end before they begin.
        marks: Path of the tool at which each cell was last cut, shape (ny, nx) [mm]: its lines are
            the marks that a cutter leaves. Of no size unless asked for.
    """

    def __init__(self, height_map: HeightMap, *, keep_marks: bool = False) -> None:
        self.map = height_map
        self.changed: Rectangle = (0, 0, 0, 0)
        self.marks = np.zeros(height_map.heights.shape if keep_marks else (0, 0))
        self._owed = 0.0

    @property
    def cell(self) -> float:
        """Side of a cell [mm]."""
        return self.map.cell

    @property
    def corners(self) -> FloatArray:
        """Two opposite corners of the box around the blank, shape (2, 3) [mm]."""
        return self.map.corners

    def begin_chunk(self) -> None:
        """Forget what has changed so far."""
        self.changed = (0, 0, 0, 0)

    def straight(self, points: Points, group: IntArray, edge: Profile) -> IntArray:
        """Choose samples between which the tool moved straight."""
        tolerance = min(STRAIGHT_SHARE * self.cell, STRAIGHT_MM)
        return simplify(
            points.tip[None], group, tolerance, LONGEST_SHARE * edge.radius, MOST_JOINED
        )

    def contact(self, tool: ToolTable, edge: Profile, head: Head | None) -> StockContact:
        """What measures a tool with what is above it against the material."""
        return StockContact(self.map, tool, edge, head)

    def take_off(
        self, points: Points, tool: ToolTable, edge: Profile, travelled: FloatArray, *, stood: bool
    ) -> Removal:
        """Cut what a tool meets, and note the walls that it leaves."""
        del tool
        marks = Marks(self.marks, travelled)
        found = sweep_lines(self.map, points.tip, edge, marks, stood=stood, walls=True)
        self.changed = union(self.changed, found.changed)
        volume = found.removal.volume
        self._owed = settle(volume, np.ones(len(volume), np.bool_), 0.0, self._owed)
        return found.removal

    def write_stl(self, path: Path, zero: FloatArray) -> None:
        """Write the part as binary STL."""
        write_stl(self.map, path, zero)

    def write_glb(self, path: Path) -> None:
        """Write the part as binary glTF."""
        write_glb(self.map, path)

    def picture(self) -> bytes:
        """The part from above, PNG."""
        return part_picture(self.map)
