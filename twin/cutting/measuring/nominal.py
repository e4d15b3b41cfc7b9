"""The nominal part of a job: whether the tool has cut into it, and in which line."""

import dataclasses
from pathlib import Path
from typing import Any, Protocol

import numpy as np

from twin.cutting.cut import Cutter
from twin.cutting.height_map import HeightMap
from twin.cutting.kernels.rasterize import note_sides, rasterize
from twin.cutting.kernels.surface_distance import (
    REACH,
    SAME_MM,
    FoundBy,
    Surface,
    surface_distances,
)
from twin.cutting.kernels.wall_distance import KNOWN
from twin.cutting.measuring.inspection import RAW, STEEPEST, steepness
from twin.cutting.tridexel.dexels import TriDexel
from twin.errors import ConfigError
from twin.files.stl import read_stl
from twin.job.job_file import NominalTable
from twin.nc.canonical import FloatArray, IntArray
from twin.recording.reader import Samples
from twin.toolpath.part_frame import PartFrame
from twin.units import UM_PER_MM

_CELLS = 256
"""Of the cells that a chunk cut too deep, so many are traced back to their samples."""


@dataclasses.dataclass(frozen=True, slots=True)
class NominalGouge:
    """Where the tool cut below the nominal part.

    Attributes:
        depth_mm: Below its surface.
        line: Program line.
        time_s: When [s].
        place: Where, program coordinates with the table at its zero [mm].
    """

    depth_mm: float
    line: int
    time_s: float
    place: tuple[float, float, float]

    def as_json(self) -> dict[str, Any]:
        """The object ``nominal_gouge`` of ``result.json``."""
        return dataclasses.asdict(self)


def lies_beside(file: str) -> ConfigError:
    """That a nominal part has nothing in common with the stock."""
    return ConfigError(
        f"job key 'nominal.file': {file} has nothing over the stock: it counts in "
        "program coordinates, in mm"
    )


def nominal_map(
    part: HeightMap, file: Path, part_frame: PartFrame, part_zero: FloatArray
) -> HeightMap:
    """A nominal part on the grid of a machined one: seen from above, the highest surface counts.

    Args:
        part: The machined part.
        file: STL of the nominal part in program coordinates [mm].
        part_frame: How the part turns under the tool.
        part_zero: Machine coordinates of the program zero that the file counts from, shape (k,).

    Raises:
        ConfigError: The file cannot be read.
    """
    corner = part_frame.program_zero(part_zero)
    result = part.copy()
    result.heights[:] = part.bottom
    triangles = np.ascontiguousarray(read_stl(file).triangles + corner, dtype=np.float64)
    rasterize(result.heights, result.origin, result.cell, triangles)
    result.behind[:] = 0.0
    note_sides(result.heights, result.behind, result.origin, result.cell, triangles)
    return result


class NominalWatch(Protocol):
    """Looks after every chunk whether what it cut reaches into the nominal part."""

    worst: NominalGouge | None
    """The deepest so far, None without any."""

    @property
    def nominal(self) -> HeightMap | TriDexel:
        """The nominal part on the grid of the machined one."""
        ...

    def look(self, samples: Samples) -> tuple[NominalGouge, int] | None:
        """Look at what the cutter's last chunk cut.

        Args:
            samples: That chunk.

        Returns:
            Where it first went too deep, and in which sample; None where it did not.
        """
        ...


class HeightMapNominalWatch:
    """Looks after every chunk whether what it cut reaches into the nominal part.

    What counts is how far from what is left of the part the nominal surface is, straight down or sideways.
    A gouge into a wall whose place is not known closer than by cells is seen from a cell more on.

    Attributes:
        nominal: The nominal part on the grid of the machined one.
        worst: The deepest so far, None without any.
    """

    def __init__(
        self, nominal: NominalTable, cutter: Cutter, part_frame: PartFrame, part_zero: FloatArray
    ) -> None:
        """Lay the nominal part beside the blank.

        Args:
            nominal: What the job says of it.
            cutter: What cuts the blank.
            part_frame: How the part turns under the tool.
            part_zero: Machine coordinates of program zero, shape (k,) [mm or deg].

        Raises:
            ConfigError: Its file cannot be read, or it lies beside the blank.
        """
        self.nominal = nominal_map(cutter.map, Path(nominal.file), part_frame, part_zero)
        if not self.nominal.solid().any():
            raise lies_beside(nominal.file)
        self._allowed = nominal.gouge_um / UM_PER_MM
        self._cutter, self._frame = cutter, part_frame
        self._corner = part_frame.program_zero(part_zero)
        self.worst: NominalGouge | None = None

    def look(self, samples: Samples) -> tuple[NominalGouge, int] | None:
        """Look at what the cutter's last chunk cut; see ``NominalWatch``."""
        row, row_end, column, column_end = self._cutter.changed
        if row >= row_end:
            return None
        # Walls are noted beside what was cut, and what is left of the part is looked for around it.
        rows, columns = (
            slice(max(0, first - REACH), end + REACH)
            for first, end in ((row, row_end), (column, column_end))
        )
        depth = self._depths(rows, columns)
        if depth.max() <= self._allowed:
            return None
        deepest = np.unravel_index(int(depth.argmax()), depth.shape)
        cells = np.argwhere(depth > self._allowed)
        cells = np.concatenate([cells[:: max(1, len(cells) // _CELLS)], [deepest]])
        depths = depth[tuple(cells.T)]
        cells += [rows.start, columns.start]
        reached = self._first_samples(samples, cells)
        if self.worst is None or depths[-1] > self.worst.depth_mm:
            self.worst = self._gouge(samples, int(reached[-1]), cells[-1], float(depths[-1]))
        first = int(reached.argmin())
        sample = int(reached[first])
        return self._gouge(samples, sample, cells[first], float(depths[first])), sample

    def _depths(self, rows: slice, columns: slice) -> FloatArray:
        """How deep it is cut into the nominal part over the cells of a window [mm]."""
        cut, cell = self._cutter.map, self._cutter.map.cell
        heights, behind = cut.heights[rows, columns], cut.behind[rows, columns]
        nominal, walls = self.nominal.heights[rows, columns], self.nominal.behind[rows, columns]
        before = (walls[..., 0] - behind[..., 0]) * cell
        before[(walls[..., 0] <= KNOWN) | (behind[..., 0] <= KNOWN)] = 0.0
        inside = cut.outline.inside(cut.x[columns], cut.y[rows, None]) / cell
        before[np.abs(behind[..., 0] - KNOWN - inside) < RAW] = 0.0
        wanted = (nominal - heights > self._allowed) | (before > self._allowed)
        found, found_by = np.zeros(heights.shape), np.zeros(heights.shape, np.int64)
        flat = np.maximum(steepness(heights, cell), steepness(nominal, cell)) <= STEEPEST
        part, whole = Surface(heights, behind), Surface(nominal, walls)
        surface_distances(part, whole, cell, wanted, flat, found, found_by)
        return np.where(found_by == FoundBy.CELLS, -found - cell, -found)

    def _gouge(
        self, samples: Samples, sample: int, cell: IntArray, depth_mm: float
    ) -> NominalGouge:
        height_map = self._cutter.map
        x, y = height_map.x[cell[1]], height_map.y[cell[0]]
        place = np.array([x, y, height_map.heights[cell[0], cell[1]]]) - self._corner
        asked = samples.setpoint
        spot = (float(place[0]), float(place[1]), float(place[2]))
        return NominalGouge(depth_mm, int(asked.line[sample]), float(asked.time[sample]), spot)

    def _first_samples(self, samples: Samples, cells: IntArray) -> IntArray:
        """In which sample the tool first cuts too deep at each cell."""
        tip = self._frame.position(samples.real(self._frame))
        radius = np.zeros(len(tip))
        for run, tool in self._cutter.plan.runs(samples.setpoint.move):
            tip[run, 2] -= self._cutter.plan.length_difference(tool)
            radius[run] = tool.diameter / 2.0
        cut = self._cutter.map
        found = np.full(len(cells), len(tip) - 1)
        for index, (row, column) in enumerate(cells):
            top = self.nominal.heights[row, column]
            below = np.full(len(tip), top - self._allowed)
            reach = radius
            if cut.heights[row, column] >= below[0]:
                # It stands, and the wall before it is where it should not be.
                below[:] = top - SAME_MM
                behind = self.nominal.behind[row, column, 0] - KNOWN
                reach = radius + behind * cut.cell - self._allowed
            away = np.hypot(tip[:, 0] - cut.x[column], tip[:, 1] - cut.y[row]) - reach
            low = tip[:, 2] <= below + 1e-6
            if low.any():
                away[~low] = np.inf
                found[index] = int((away <= max(0.0, float(away.min()))).argmax())
        return found
