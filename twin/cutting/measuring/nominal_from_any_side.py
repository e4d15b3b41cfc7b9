"""Whether the tool has cut into the nominal part, from whatever side."""

from pathlib import Path

import numpy as np

from twin.cutting.cut import Cutter
from twin.cutting.measuring.nominal import NominalGouge, lies_beside
from twin.cutting.measuring.tridexel_inspection import Crossings, crossings, gaps, nominal_stock
from twin.cutting.tridexel.material import TriDexelMaterial
from twin.cutting.tridexel.normals import OWN, tools
from twin.cutting.tridexel.surface_gap import depths_along_lines
from twin.job.job_file import NominalTable
from twin.nc.canonical import FloatArray, IntArray
from twin.recording.reader import Samples
from twin.toolpath.part_frame import PartFrame
from twin.units import UM_PER_MM

_TRACED = 256
"""Of the places that a chunk cut too deep, so many are traced back to their samples."""


class TriDexelNominalWatch:
    """Looks after every chunk whether what it cut reaches into the nominal part; see ``NominalWatch``.

    What counts is how deep in the nominal part the surface lies that a tool has left.

    Attributes:
        nominal: The nominal part on the lattice of the machined one.
        worst: The deepest so far, None without any.
    """

    def __init__(
        self, nominal: NominalTable, cutter: Cutter, part_frame: PartFrame, part_zero: FloatArray
    ) -> None:
        """Lay the nominal part beside the blank; see ``HeightMapNominalWatch``.

        Raises:
            ConfigError: Its file cannot be read or has no closed surface, or it lies beside the blank.
        """
        assert isinstance(cutter.material, TriDexelMaterial)
        self._material, self._cutter, self._frame = cutter.material, cutter, part_frame
        self._corner = part_frame.program_zero(part_zero)
        self.nominal = nominal_stock(self._material.stock, Path(nominal.file), self._corner)
        if not self.nominal.dexels.filled.any():
            raise lies_beside(nominal.file)
        self._allowed = nominal.gouge_um / UM_PER_MM
        self.worst: NominalGouge | None = None

    def look(self, samples: Samples) -> tuple[NominalGouge, int] | None:
        """Look at what the cutter's last chunk cut; see ``NominalWatch``."""
        if not self._material.changed or not len(samples):
            return None
        joints = samples.real(self._frame)
        plan, move = self._cutter.plan, samples.setpoint.move
        tip, axis = (
            self._frame.position(joints, plan.lower(move)),
            self._frame.tool_direction(joints),
        )
        radius, flute = np.zeros((2, len(tip)))
        for run, tool in plan.runs(move):
            radius[run], flute[run] = tool.diameter / 2.0, tool.flute
        deep, depth = self._too_deep(tip, tip + flute[:, None] * axis, float(radius.max()))
        if not len(depth):
            return None
        rows = np.append(np.arange(len(depth))[:: max(1, len(depth) // _TRACED)], depth.argmax())
        points, depth = deep.points[rows], depth[rows]
        reached = _first_within(points, tip, axis, radius + self._allowed)
        if self.worst is None or depth[-1] > self.worst.depth_mm:
            self.worst = self._gouge(samples, int(reached[-1]), points[-1], float(depth[-1]))
        first = int(reached.argmin())
        sample = int(reached[first])
        return self._gouge(samples, sample, points[first], float(depth[first])), sample

    def _too_deep(
        self, tip: FloatArray, top: FloatArray, radius: float
    ) -> tuple[Crossings, FloatArray]:
        """Places that the tool has left too deep in the nominal part, and how deep they are, shape (n,) [mm].

        Args:
            tip: Where the tip of the tool went, shape (m, 3) [mm].
            top: Where the upper end of its edge went.
            radius: Of the tool [mm].
        """
        ends, around = np.concatenate([tip, top]), radius + self._allowed
        box = np.stack([ends.min(axis=0) - around, ends.max(axis=0) + around])
        found = crossings(self._material.stock, box)
        found = found.only(tools(found.facet) != OWN)
        # Along a line a place is as deep at least as it is by the nearest surface.
        along = np.zeros(len(found.line))
        places = found.points[np.arange(len(along)), found.along]
        depths_along_lines(self.nominal.dexels, found.line, places, along)
        found = found.only(along > self._allowed)
        depth = -gaps(self.nominal, found.points).away
        deep = depth > self._allowed
        return found.only(deep), depth[deep]

    def _gouge(
        self, samples: Samples, sample: int, point: FloatArray, depth_mm: float
    ) -> NominalGouge:
        x, y, z = (float(value) for value in point - self._corner)
        asked = samples.setpoint
        return NominalGouge(depth_mm, int(asked.line[sample]), float(asked.time[sample]), (x, y, z))


def _first_within(
    points: FloatArray, tip: FloatArray, axis: FloatArray, radius: FloatArray
) -> IntArray:
    """The first of m samples in which each point is as near to the tool's axis as its edge; else the nearest, shape (n,)."""
    found = np.zeros(len(points), np.int64)
    for number, point in enumerate(points):
        arm = point - tip
        height = (arm * axis).sum(axis=1)
        away = np.linalg.norm(arm - height[:, None] * axis, axis=1) - radius
        away = np.where(height < -radius, np.inf, away)
        found[number] = int((away <= max(0.0, float(away.min()))).argmax())
    return found
