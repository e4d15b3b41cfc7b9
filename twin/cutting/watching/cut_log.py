"""What was cut when and by which line, in memory that does not grow with the time."""

import dataclasses
import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from twin.columns import Columns, join
from twin.cutting.watching.events import CutEvent, Stretches
from twin.nc.canonical import FloatArray, IntArray

TIME_BINS = 512
"""Stretches of time that removal is noted in; they grow longer as the run does."""

FIRST_BIN_S = 0.01

LINES_REPORTED = 1000
"""Lines that are reported at most: those that took off the most or met the greatest force."""
CHUNKS_FRESH = 64
"""Chunks that are entered before they are put together: a live cut comes in thirty a second."""
LINES_REMEMBERED = 1 << 14
"""Lines that are kept at least, where there are so many: 3 MB, and 16 times what is reported."""


HEIGHT_MAP, TRI_DEXEL = "height map", "tri-dexel"
"""What describes the material."""


@dataclasses.dataclass(slots=True)
class BlockCut:
    """What one program line took off.

    Attributes:
        path_mm: Path of the tool in the part, cutting.
        width_mm: Greatest width of cut, a mean as the force is.
        force_n: Greatest mean cutting force over a turn of the spindle, and a cell of the path at least; None where it is
            not computed.
    """

    removed_mm3: float = 0.0
    path_mm: float = 0.0
    depth_mm: float = 0.0
    width_mm: float = 0.0
    force_n: float | None = None


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class CutResult:
    """What was cut."""

    removed_mm3: float
    """Material taken off [mm³]."""
    removed_by_tool_mm3: Mapping[int, float]
    """What each tool took off, by its number, in the order of use [mm³]."""
    stock: str
    """What described the material: ``HEIGHT_MAP`` where the tool kept to the part's Z, else ``TRI_DEXEL``."""
    cell_mm: float
    """Side of a cell of it [mm]."""
    air_share: float
    """Share of the cutting feed's path that met no material."""
    gouges: tuple[CutEvent, ...]
    """Flutes too short, shank, holder or head in the material; one each per line, of many the
    deepest."""
    rapid_into_stock: tuple[CutEvent, ...]
    """Rapids that met material, one per move."""
    spindle_off: tuple[CutEvent, ...]
    """Feeds that met material with the spindle off, one per move."""
    blocks: Mapping[int, BlockCut]
    """What each line took off; of many those that took off the most or met the greatest force."""
    blocks_forgotten: int
    """How often a line was dropped because enough others took off more."""
    bin_s: float
    """Length of a bin of ``removed_over_time`` [s]."""
    removed_over_time: tuple[float, ...]
    """Material taken off in each bin of time, from 0 on [mm³]."""
    force_n: float | None
    """Greatest mean cutting force [N]; None: the job names no material or no spindle speed."""
    power_w: float | None
    """Greatest mean cutting power [W]; None as for the force."""

    def as_json(self) -> dict[str, Any]:
        """The ``cut`` object of ``result.json``."""
        result = dataclasses.asdict(self)
        blocks = {line: dataclasses.asdict(block) for line, block in self.blocks.items()}
        result["blocks"] = [{"line": line, **block} for line, block in sorted(blocks.items())]
        return result


@dataclasses.dataclass(frozen=True, slots=True)
class _Lines(Columns):
    """What n program lines took off, as columns; the force is NaN where it is not known."""

    line: IntArray
    removed: FloatArray
    path: FloatArray
    depth: FloatArray
    width: FloatArray
    force: FloatArray

    def each_once(self) -> "_Lines":
        """Rows of the same line put together, by line."""
        lines, row = np.unique(self.line, return_inverse=True)
        removed, path, depth, width = np.zeros((4, len(lines)))
        force = np.full(len(lines), math.nan)
        # One after the other: what was put together before is the first of its line.
        np.add.at(removed, row, self.removed)
        np.add.at(path, row, self.path)
        np.maximum.at(depth, row, self.depth)
        np.maximum.at(width, row, self.width)
        np.fmax.at(force, row, self.force)
        return _Lines(lines, removed, path, depth, width, force)

    def foremost(self, count: int) -> "_Lines":
        """As many rows as that: those that took off the most or met the greatest force, by line."""
        if len(self) <= count:
            return self
        by_force = np.nan_to_num(self.force, nan=-1.0)
        rank = np.minimum(_rank(-self.removed), _rank(-by_force))
        return self[np.sort(np.argsort(rank, kind="stable")[:count])]


def _rank(values: FloatArray) -> IntArray:
    return np.argsort(np.argsort(values, kind="stable"))


_NOTHING = _Lines(np.zeros(0, np.int64), *(np.zeros(0) for _ in range(5)))


class CutLog:
    """Adds up removal by program line and by time.

    Attributes:
        forgotten: How often a line was dropped because enough others took off more.
    """

    def __init__(self, remembered: int = LINES_REMEMBERED) -> None:
        """Begin with nothing.

        Args:
            remembered: How many lines are kept at least, where there are so many.
        """
        self.forgotten = 0
        self._remembered = remembered
        self._kept = _NOTHING
        self._fresh: list[_Lines] = []
        self._fresh_lines = 0
        self._latest = 0
        self._bin_s = FIRST_BIN_S
        self._bins = np.zeros(TIME_BINS)
        self._end = 0

    def add(self, stretches: Stretches) -> None:
        """Enter what stretches took off that follow the last ones."""
        cutting = stretches.removed > 0
        if not cutting.any():
            return
        if self._fresh_lines > self._remembered or len(self._fresh) > CHUNKS_FRESH:
            self._tidy()
        removed, nothing = stretches.removed[cutting], np.zeros(int(cutting.sum()))
        self._enter_time(stretches.time[cutting], removed)
        line, path = stretches.line[cutting], stretches.path[cutting]
        depth, unknown = stretches.depth[cutting], np.full(len(removed), math.nan)
        self._latest = int(line[-1])
        self._enter(_Lines(line, removed, path, depth, nothing, unknown))

    def add_means(self, line: IntArray, width: FloatArray, force: FloatArray | None) -> None:
        """Enter means over pieces of the path that took something off.

        Args:
            line: Source lines, shape (n,).
            width: Widths of cut, shape (n,) [mm].
            force: Cutting forces, shape (n,) [N]; None where it is not computed.
        """
        known = np.full(len(width), math.nan) if force is None else force
        nothing = np.zeros(len(width))
        self._enter(_Lines(line, nothing, nothing, nothing, width, known))

    def _enter(self, rows: _Lines) -> None:
        self._fresh.append(rows)
        self._fresh_lines += len(rows)

    def _tidy(self) -> None:
        """Put what is fresh to what is kept, and let go of the least where that is too much."""
        together = join([self._kept, *self._fresh]).each_once()
        self._fresh, self._fresh_lines = [], 0
        self._kept = together
        if len(together) > 2 * self._remembered:
            ended = together.line != self._latest
            kept = together[ended].foremost(self._remembered)
            self._kept = join([kept, together[~ended]]).each_once()
            self.forgotten += len(together) - len(self._kept)

    @property
    def blocks(self) -> Mapping[int, BlockCut]:
        """What the foremost lines that removed something took off, by line."""
        self._tidy()
        reported = self._kept.foremost(LINES_REPORTED)
        columns = [getattr(reported, field.name).tolist() for field in dataclasses.fields(reported)]
        return {
            line: BlockCut(removed, path, depth, width, None if math.isnan(force) else force)
            for line, removed, path, depth, width, force in zip(*columns, strict=True)
        }

    def _enter_time(self, time: FloatArray, removed: FloatArray) -> None:
        while time[-1] >= self._bin_s * TIME_BINS:
            self._bins = np.append(self._bins.reshape(-1, 2).sum(axis=1), np.zeros(TIME_BINS // 2))
            self._bin_s *= 2
            self._end = -(-self._end // 2)
        number = (time / self._bin_s).astype(np.int64)
        np.add.at(self._bins, number, removed)
        self._end = int(number[-1]) + 1

    @property
    def over_time(self) -> tuple[float, FloatArray]:
        """Length of a bin [s], and the material removed in each from time 0 on [mm³]."""
        return self._bin_s, self._bins[: self._end].copy()
