"""How far the teeth's forces are off hand integration: ``python -m tests.cutting.forces.narrow_cuts``.

From cuts of a hundredth of the diameter to slots, on both sides, in several directions and depths,
with straight and with helical edges.
"""

import itertools
import math
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from tests.cutting.forces.test_tooth_forces import (
    Plate,
    along,
    by_hand,
    cut,
    forces,
    plate,
    turned,
)
from twin.cutting.kernels.teeth import ToothScratch
from twin.job.job_file import ToolTable
from twin.nc.canonical import FloatArray

CLEARING = ToolTable(number=2, diameter=40.0)
RADIUS = 5.0
TOOLS = tuple(
    ToolTable(number=1, diameter=2.0 * RADIUS, teeth=4, helix=helix) for helix in (0.0, 30.0)
)
CELLS = (0.5, 0.1)
WIDTHS = (0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0)
DEPTHS = (0.5, 3.0, 8.0)
DIRECTIONS = (0.0, 17.0, 45.0)
DOWN, UP = -1.0, 1.0
LENGTH = 12.0
"""Of a cut [mm]."""


class Off(NamedTuple):
    """How far a force is off, as shares of what hand integration gives: mean force, peak, torque."""

    mean: float
    peak: float
    torque: float


def cleared(cell: float, width: float, side: float, direction: float) -> Plate:
    """A plate of which all but the width [mm] of the way has been milled off, for a cut down or up."""
    part = plate(cell)
    if width < 2.0 * RADIUS:
        way = along(direction, 10.0, -side * (0.5 * CLEARING.diameter - RADIUS + width))
        ahead = (way[-1] - way[0]) / np.linalg.norm(way[-1] - way[0])
        cut(part, CLEARING, np.concatenate([way, way[-1:] + 40.0 * ahead]))
    return part


def engaged(width: float, side: float) -> tuple[float, float]:
    """Angles between which a cut of a width meets the cutter, from its way to the left [rad]."""
    begins, quarter = math.asin(1.0 - width / RADIUS), 0.5 * math.pi
    return (begins, quarter) if side == UP else (-quarter, -begins)


def off(
    part: Plate,
    tool: ToolTable,
    way: tuple[float, float],
    expected: tuple[FloatArray, float, float],
) -> Off:
    """How far one cut is off.

    Args:
        part: It stays as it is.
        tool: Cuts it.
        way: Direction [deg] and depth [mm].
        expected: Of ``by_hand``.
    """
    mean, peak, torque = expected
    again = Plate(part.map.copy(), part.walls.copy())
    scratch: ToothScratch = forces(again, tool, along(*way)[-round(10.0 * LENGTH) :])
    by = float(np.linalg.norm(turned(scratch, way[0]) - mean) / np.linalg.norm(mean))
    return Off(by, abs(scratch.figures[0] / peak - 1.0), abs(scratch.figures[1] / torque - 1.0))


def worst(cell: float, width: float) -> Off:
    """The greatest over both sides and all directions, depths and tools."""
    found: list[Off] = []
    for side in (DOWN, UP):
        expected = {
            (tool, depth): by_hand(TOOLS[tool], depth, *engaged(width, side))
            for tool, depth in itertools.product(range(len(TOOLS)), DEPTHS)
        }
        for direction in DIRECTIONS:
            part = cleared(cell, width, side, direction)
            for (tool, depth), told in expected.items():
                found.append(off(part, TOOLS[tool], (direction, depth), told))
    return Off(*np.array(found).max(axis=0).tolist())


def rows() -> Iterator[str]:
    """A line for each width and cell [%]."""
    for width, cell in itertools.product(WIDTHS, CELLS):
        mean, peak, torque = (100.0 * share for share in worst(cell, width))
        yield f"| {width:g} mm | {cell:g} mm | {mean:.1f} % | {peak:.1f} % | {torque:.1f} % |"


if __name__ == "__main__":
    for row in rows():
        print(row, flush=True)
