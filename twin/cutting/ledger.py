"""What was cut when and by which line, in memory that does not grow with the time."""

import dataclasses

import numpy as np

from twin.cutting.events import Stretches
from twin.nc.canonical import FloatArray

BINS = 512
"""Stretches of time that removal is noted in; they grow longer as the run does."""

FIRST_BIN_S = 0.01


@dataclasses.dataclass(slots=True)
class BlockCut:
    """What one program line took off.

    Attributes:
        removed_mm3: Material.
        path_mm: Way of the tool in the part, cutting.
        depth_mm: Greatest depth of cut.
        width_mm: Greatest width of cut of a stretch, each stretch's mean.
        force_n: Greatest mean cutting force; None where it is not reckoned.
    """

    removed_mm3: float = 0.0
    path_mm: float = 0.0
    depth_mm: float = 0.0
    width_mm: float = 0.0
    force_n: float | None = None


class Ledger:
    """Adds up removal by program line and by time.

    Attributes:
        blocks: By program line; only lines that removed something.
    """

    def __init__(self) -> None:
        self.blocks: dict[int, BlockCut] = {}
        self._bin_s = FIRST_BIN_S
        self._bins = np.zeros(BINS)
        self._end = 0

    def add(self, stretches: Stretches, width: FloatArray, force: FloatArray | None) -> None:
        """Enter stretches that follow the last ones.

        Args:
            stretches: n stretches.
            width: Their widths of cut, shape (n,) [mm].
            force: Their cutting forces, shape (n,) [N]; None where it is not reckoned.
        """
        cutting = np.flatnonzero(stretches.removed > 0)
        if not len(cutting):
            return
        self._enter_time(stretches.time[cutting], stretches.removed[cutting])
        path = stretches.path
        lines, first = np.unique(stretches.line[cutting], return_inverse=True)
        for number, line in enumerate(lines):
            here = cutting[first == number]
            block = self.blocks.setdefault(int(line), BlockCut())
            block.removed_mm3 += float(stretches.removed[here].sum())
            block.path_mm += float(path[here].sum())
            block.depth_mm = max(block.depth_mm, float(stretches.depth[here].max()))
            block.width_mm = max(block.width_mm, float(width[here].max()))
            if force is not None:
                block.force_n = max(block.force_n or 0.0, float(force[here].max()))

    def _enter_time(self, time: FloatArray, removed: FloatArray) -> None:
        while time[-1] >= self._bin_s * BINS:
            self._bins = np.append(self._bins.reshape(-1, 2).sum(axis=1), np.zeros(BINS // 2))
            self._bin_s *= 2
            self._end = -(-self._end // 2)
        number = (time / self._bin_s).astype(np.int64)
        np.add.at(self._bins, number, removed)
        self._end = int(number[-1]) + 1

    @property
    def over_time(self) -> tuple[float, FloatArray]:
        """Length of a bin [s], and the material removed in each from time 0 on [mm³]."""
        return self._bin_s, self._bins[: self._end].copy()
