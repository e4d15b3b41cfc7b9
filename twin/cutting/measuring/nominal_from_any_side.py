"""Whether the tool has cut into the nominal part, of a part that is cut from any side."""

from pathlib import Path

import numpy as np

from twin.cutting.measuring.nominal import Deep, NominalWatch
from twin.cutting.measuring.tridexel_inspection import (
    crossings,
    gaps,
    nominal_stock,
    volume_alone,
)
from twin.cutting.tridexel.dexels import TriDexel
from twin.cutting.tridexel.engagement import volume
from twin.cutting.tridexel.material import TriDexelMaterial
from twin.cutting.tridexel.normals import OWN, tools
from twin.cutting.tridexel.surface.surface_gap import depths_along_lines
from twin.recording.reader import Samples


class TriDexelNominalWatch(NominalWatch[TriDexel]):
    """What counts is how deep in the nominal part the surface lies that a tool has left."""

    @property
    def _material(self) -> TriDexelMaterial:
        assert isinstance(self.cutter.material, TriDexelMaterial)
        return self.cutter.material

    def _laid(self, file: Path) -> TriDexel:
        return nominal_stock(self._material.stock, file, self._corner)

    def _is_empty(self) -> bool:
        return not self.nominal.dexels.filled.any()

    def _outside_share(self) -> float:
        return volume_alone(self.nominal, self._material.stock) / volume(self.nominal)

    def _too_deep(self, samples: Samples) -> Deep | None:
        if not self._material.changed:
            return None
        path = self._tool_path(samples)
        ends = np.concatenate([path.tip, path.tip + path.flute[:, None] * path.axis])
        radius = float(path.radius.max())
        around = radius + self._allowed
        box = np.stack([ends.min(axis=0) - around, ends.max(axis=0) + around])
        found = crossings(self._material.stock, box)
        found = found.only(tools(found.facet) != OWN)
        # Along a line a place is as deep at least as it is by the nearest surface.
        along = np.zeros(len(found.line))
        places = found.points[np.arange(len(along)), found.along]
        depths_along_lines(self.nominal.dexels, found.line, places, along)
        points = found.only(along > self._allowed).points
        depth = -gaps(self.nominal, points).away
        points, depth = points[depth > self._allowed], depth[depth > self._allowed]
        return Deep(points, depth, points, np.full(len(depth), self._allowed), radius)
