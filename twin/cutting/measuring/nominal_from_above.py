"""Whether the tool has cut into the nominal part, of a part that is cut from above alone."""

from pathlib import Path

import numpy as np

from twin.cutting.heights.height_map import HeightMap
from twin.cutting.kernels.rasterize import note_sides, rasterize
from twin.cutting.kernels.surface_distance import (
    REACH,
    SAME_MM,
    FoundBy,
    MapSurface,
    surface_distances,
)
from twin.cutting.kernels.wall_distance import KNOWN, WallColumn
from twin.cutting.measuring.inspection import RAW, STEEPEST, steepness
from twin.cutting.measuring.nominal import Deep, NominalWatch
from twin.files.stl import read_stl
from twin.nc.canonical import FloatArray
from twin.recording.reader import Samples

_ROUNDING = 1e-6
"""[mm]"""


def nominal_map(part: HeightMap, file: Path, corner: FloatArray) -> HeightMap:
    """A nominal part on the grid of a machined one: seen from above, the highest surface counts.

    Args:
        file: STL of the nominal part in program coordinates [mm].
        corner: Where these have their origin in the part's frame, shape (3,) [mm].

    Raises:
        ConfigError: The file cannot be read.
    """
    result = part.copy()
    result.heights[:] = part.bottom
    triangles = np.ascontiguousarray(read_stl(file).triangles + corner, dtype=np.float64)
    rasterize(result.heights, result.origin, result.cell, triangles)
    result.behind[:] = 0.0
    note_sides(result.heights, result.behind, result.origin, result.cell, triangles)
    return result


class HeightMapNominalWatch(NominalWatch[HeightMap]):
    """What counts is how far from what is left of the part the nominal surface is, straight down or sideways.

    A gouge into a wall whose place is not known closer than by cells is seen from a cell more on.
    """

    def _laid(self, file: Path) -> HeightMap:
        return nominal_map(self.cutter.map, file, self._corner)

    def _is_empty(self) -> bool:
        return not self.nominal.solid().any()

    def _outside_share(self) -> float:
        blank, nominal = self.cutter.map, self.nominal
        above = (nominal.heights - blank.heights).clip(min=0.0).sum()
        return float(above / (nominal.heights - nominal.bottom).sum())

    def _too_deep(self, samples: Samples) -> Deep | None:  # noqa: ARG002 - the cutter knows where it cut
        """See ``NominalWatch``; walls are noted beside what was cut, and what is left is looked for around it."""
        row, row_end, column, column_end = self.cutter.changed
        if row >= row_end:
            return None
        rows, columns = (
            slice(max(0, first - REACH), end + REACH)
            for first, end in ((row, row_end), (column, column_end))
        )
        depth = self._depths(rows, columns)
        row, column = np.nonzero(depth > self._allowed)
        depth = depth[row, column]
        row, column = row + rows.start, column + columns.start
        cut, nominal = self.cutter.map, self.nominal
        left, top = cut.heights[row, column], nominal.heights[row, column]
        # Where it stands, the wall before it is where it should not be.
        stands = left >= top - self._allowed
        behind = (nominal.behind[row, column, WallColumn.DISTANCE] - KNOWN) * cut.cell
        place = cut.x[column], cut.y[row]
        return Deep(
            points=np.stack([*place, left], axis=1),
            depth=depth,
            marks=np.stack([*place, top - np.where(stands, SAME_MM, self._allowed)], axis=1),
            aside=np.where(stands, behind - self._allowed, 0.0),
            above=_ROUNDING,
        )

    def _depths(self, rows: slice, columns: slice) -> FloatArray:
        """How deep it is cut into the nominal part over the cells of a window [mm]."""
        cut, cell = self.cutter.map, self.cutter.map.cell
        heights, behind = cut.heights[rows, columns], cut.behind[rows, columns]
        nominal, walls = self.nominal.heights[rows, columns], self.nominal.behind[rows, columns]
        before = (walls[..., WallColumn.DISTANCE] - behind[..., WallColumn.DISTANCE]) * cell
        before[
            (walls[..., WallColumn.DISTANCE] <= KNOWN) | (behind[..., WallColumn.DISTANCE] <= KNOWN)
        ] = 0.0
        inside = cut.outline.inside(cut.x[columns], cut.y[rows, None]) / cell
        before[np.abs(behind[..., WallColumn.DISTANCE] - KNOWN - inside) < RAW] = 0.0
        wanted = (nominal - heights > self._allowed) | (before > self._allowed)
        found, found_by = np.zeros(heights.shape), np.zeros(heights.shape, np.int64)
        flat = np.maximum(steepness(heights, cell), steepness(nominal, cell)) <= STEEPEST
        part, whole = MapSurface(heights, behind), MapSurface(nominal, walls)
        surface_distances(part, whole, cell, wanted, flat, found, found_by)
        depth = np.where(found_by == FoundBy.CELLS, -found - cell, -found)
        # The nearest surface is no farther than the one straight above or that of the wall.
        return np.minimum(depth, np.maximum(nominal - heights, before))
