"""The nominal part of a job: whether the tool has cut into it, and in which line."""

import dataclasses
from pathlib import Path
from typing import Any

import numpy as np

from twin.cutting.cut import Cutter
from twin.cutting.height_map import HeightMap
from twin.cutting.kernels.drape import drape
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
    corner = part_zero[:3] - np.array([*part_frame.center, 0.0])
    result = part.copy()
    result.heights[:] = part.bottom
    triangles = np.ascontiguousarray(read_stl(file).triangles + corner, dtype=np.float64)
    drape(result.heights, result.origin, result.cell, triangles)
    return result


class NominalWatch:
    """Looks after every chunk whether what it cut reaches into the nominal part.

    On a wall of it, which may lie anywhere between two rows of cells, a cell counts as what is lowest in
    it and its neighbours: a gouge into a wall is seen from one and a half cells on.

    Attributes:
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
        surface = nominal_map(cutter.map, Path(nominal.file), part_frame, part_zero)
        if not surface.solid().any():
            raise ConfigError(
                f"job key 'nominal.file': {nominal.file} has nothing over the stock: it counts in "
                "program coordinates, in mm"
            )
        self._floor = _lowest_around(surface.heights)
        self._allowed = nominal.gouge_um / UM_PER_MM
        self._cutter, self._frame = cutter, part_frame
        self._corner = part_zero[:3] - np.array([*part_frame.center, 0.0])
        self.worst: NominalGouge | None = None

    def look(self, samples: Samples) -> tuple[NominalGouge, int] | None:
        """Look at what the cutter's last chunk cut.

        Args:
            samples: That chunk.

        Returns:
            Where it first went too deep, and in which sample; None where it did not.
        """
        row, row_end, column, column_end = self._cutter.changed
        window = (slice(row, row_end), slice(column, column_end))
        heights, floor = self._cutter.map.heights[window], self._floor[window]
        depth = floor - heights
        if not depth.size or depth.max() <= self._allowed:
            return None
        deepest = np.unravel_index(int(depth.argmax()), depth.shape)
        greatest = float(depth[deepest])
        rows, columns = np.nonzero(depth > self._allowed)
        thin = slice(None, None, max(1, len(rows) // _CELLS))
        rows, columns = np.append(rows[thin], deepest[0]), np.append(columns[thin], deepest[1])
        limit = floor[rows, columns] - self._allowed
        limit[-1] = heights[deepest]
        cells = np.column_stack([rows + row, columns + column])
        reached = self._first_samples(samples, cells, limit)
        if self.worst is None or greatest > self.worst.depth_mm:
            self.worst = self._gouge(samples, int(reached[-1]), cells[-1], greatest)
        first = int(reached.argmin())
        depth_there = float(depth[rows[first], columns[first]])
        sample = int(reached[first])
        return self._gouge(samples, sample, cells[first], depth_there), sample

    def _gouge(
        self, samples: Samples, sample: int, cell: IntArray, depth_mm: float
    ) -> NominalGouge:
        height_map = self._cutter.map
        x, y = height_map.x[cell[1]], height_map.y[cell[0]]
        place = np.array([x, y, height_map.heights[cell[0], cell[1]]]) - self._corner
        asked = samples.setpoint
        spot = (float(place[0]), float(place[1]), float(place[2]))
        return NominalGouge(depth_mm, int(asked.line[sample]), float(asked.time[sample]), spot)

    def _first_samples(self, samples: Samples, cells: IntArray, height: FloatArray) -> IntArray:
        """In which sample the tool is first over each cell at a height or below it."""
        tip = self._frame.position(samples.real(self._frame))
        radius = np.zeros(len(tip))
        for run, tool in self._cutter.plan.runs(samples.setpoint.move):
            tip[run, 2] -= self._cutter.plan.longer(tool)
            radius[run] = tool.diameter / 2.0
        height_map = self._cutter.map
        x, y = height_map.x[cells[:, 1]], height_map.y[cells[:, 0]]
        found = np.full(len(cells), len(tip) - 1)
        for index in range(len(cells)):
            away = np.hypot(tip[:, 0] - x[index], tip[:, 1] - y[index])
            over = (away <= radius + height_map.cell) & (tip[:, 2] <= height[index] + 1e-6)
            if over.any():
                found[index] = int(over.argmax())
        return found


def _lowest_around(heights: FloatArray) -> FloatArray:
    """The lowest of every cell and its eight neighbours."""
    result = heights
    for axis in (0, 1):
        before, after = np.roll(result, 1, axis), np.roll(result, -1, axis)
        first, last = (0, slice(None)), (-1, slice(None))
        if axis == 1:
            first, last = first[::-1], last[::-1]
        before[first], after[last] = result[first], result[last]
        result = np.minimum(np.minimum(before, after), result)
    return result
