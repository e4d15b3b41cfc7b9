"""Cutting force by Kienzle, from what a piece of the path took off."""

import dataclasses
import math

import numpy as np

from twin.columns import Columns
from twin.compilation.kernel import kernel
from twin.cutting.forces.materials import Kienzle
from twin.cutting.kernels.teeth import THINNEST_CHIP_MM
from twin.cutting.watching.events import Stretches
from twin.job.job_file import ToolTable
from twin.nc.canonical import FloatArray, IntArray
from twin.units import SECONDS_PER_MINUTE


@dataclasses.dataclass(frozen=True, slots=True)
class CutPieces(Columns):
    """What n pieces of the tool's path took off, as columns.

    Attributes:
        line: Source line, shape (n,).
        path: Length, shape (n,) [mm].
        seconds: Shape (n,) [s].
        removed: Shape (n,) [mm³].
        area: Path times depth of cut, of all of its stretches, shape (n,) [mm²].
    """

    line: IntArray
    path: FloatArray
    seconds: FloatArray
    removed: FloatArray
    area: FloatArray

    def width(self, diameter: float) -> FloatArray:
        """Mean width of cut, shape (n,) [mm].

        Args:
            diameter: Of the tool, which the width cannot exceed [mm].
        """
        width = np.zeros_like(self.area)
        np.divide(self.removed, self.area, out=width, where=self.area > 0.0)
        return np.minimum(width, diameter)


def each_alone(stretches: Stretches, duration: FloatArray) -> CutPieces:
    """Every stretch as a piece.

    Args:
        duration: How long each took, shape (n,) [s].
    """
    path = stretches.path
    return CutPieces(stretches.line, path, duration, stretches.removed, path * stretches.depth)


class MeanPieces:
    """Puts stretches of the same line together to pieces over which a mean force means something.

    A piece takes a turn of the spindle at least, as the mean over all its teeth asks, and goes a cell at least, to which
    the material is known. What is left at the end of a line counts where the whole line is shorter than that.
    """

    def __init__(self, cell: float) -> None:
        """Begin with nothing.

        Args:
            cell: Side of the material's cells [mm].
        """
        self._cell = cell
        self._open = np.zeros(len(dataclasses.fields(CutPieces)))
        self._whole = False

    def add(self, stretches: CutPieces, turn: float) -> CutPieces:
        """Take in stretches that follow the last ones.

        Args:
            turn: How long a turn of the spindle takes [s].

        Returns:
            The pieces that have ended.
        """
        columns = np.column_stack(
            [getattr(stretches, f.name) for f in dataclasses.fields(CutPieces)]
        )
        ended = np.zeros((2 * len(columns), columns.shape[1]))
        count, self._whole = _gather(columns, self._open, self._whole, (self._cell, turn), ended)
        return _pieces(ended[:count])

    def end(self) -> CutPieces:
        """What is left of a line that is shorter than a piece; what follows begins another one."""
        only = self._open[2] > 0.0 and not self._whole
        rest = _pieces(self._open[None].copy() if only else np.zeros((0, len(self._open))))
        self._open[:], self._whole = 0.0, False
        return rest


def _pieces(rows: FloatArray) -> CutPieces:
    return CutPieces(rows[:, 0].astype(np.int64), *rows[:, 1:].T)


@kernel
def _gather(
    stretches: FloatArray,
    left: FloatArray,
    whole: bool,
    least: tuple[float, float],
    ended: FloatArray,
) -> tuple[int, bool]:
    """Put stretches together.

    Args:
        stretches: The columns of ``CutPieces``, shape (n, 5).
        left: What is left of those before, in the same columns; changed.
        whole: Whether any piece of its line has ended.
        least: Path [mm] and time [s] of a piece.
        ended: Set to the pieces that end, shape (2 n, 5).

    Returns:
        How many these are, and ``whole`` of what is left.
    """
    count, columns = 0, len(left)
    for i in range(len(stretches)):
        if stretches[i, 1] == 0.0:
            continue
        if stretches[i, 0] != left[0]:
            if left[2] > 0.0 and not whole:
                count = _close(left, ended, count)
            left[1:], whole = 0.0, False
            left[0] = stretches[i, 0]
        for k in range(1, columns):
            left[k] += stretches[i, k]
        if left[1] >= least[0] and left[2] >= least[1]:
            count = _close(left, ended, count)
            left[1:], whole = 0.0, True
    return count, whole


@kernel
def _close(left: FloatArray, ended: FloatArray, count: int) -> int:
    for k in range(len(left)):
        ended[count, k] = left[k]
    return count + 1


@dataclasses.dataclass(frozen=True, slots=True)
class SpindleLoad:
    """What each of n pieces asks of the spindle.

    Attributes:
        force: Mean tangential force of all teeth, shape (n,) [N].
        power: Mean cutting power, shape (n,) [W].
    """

    force: FloatArray
    power: FloatArray


def cutting_load(pieces: CutPieces, tool: ToolTable, material: Kienzle) -> SpindleLoad:
    """Mean cutting force and power.

    The width of cut ae is what was removed over path and depth. The engagement angle is
    phi = arccos(1 - 2 ae / D), the mean chip thickness h = 2 ae fz / (D phi), the power
    kc1.1 h^-mc times the material removed per second, the force the power over the cutting speed
    (mean values over the engagement; Klocke, Fertigungsverfahren 1, milling).

    Args:
        tool: Its ``speed`` must be given.
    """
    assert tool.speed is not None
    turns_per_second = tool.speed / SECONDS_PER_MINUTE
    seconds = np.maximum(pieces.seconds, 1e-9)
    per_tooth = pieces.path / seconds / (turns_per_second * tool.teeth)
    share = np.clip(pieces.width(tool.diameter) / tool.diameter, 1e-9, 1.0)
    engaged = np.arccos(1.0 - 2.0 * share)
    chip = np.maximum(2.0 * share * per_tooth / engaged, THINNEST_CHIP_MM)
    power = 1e-3 * material.kc * chip**-material.mc * pieces.removed / seconds
    speed = 1e-3 * math.pi * tool.diameter * turns_per_second
    return SpindleLoad(power / speed, power)
