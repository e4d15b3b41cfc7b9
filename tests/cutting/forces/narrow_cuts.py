"""How far the teeth's forces are off hand integration in narrow cuts: ``python -m tests.cutting.forces.narrow_cuts``.

A tooth is looked at every five degrees. Where the cut is as narrow as a few of these steps, the place
where it ends falls anywhere within one, and so does the thickest chip, which is at that end.
"""

import math
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from tests.cutting.forces.test_tooth_forces import along, by_hand, cut, forces, turned
from twin.cutting.height_map import HeightMap, blank
from twin.job.job_file import StockTable, ToolTable

TOOL = ToolTable(number=1, diameter=10.0, teeth=4)
CLEARING = ToolTable(number=2, diameter=40.0)
DEPTH = 3.0
CELLS = (0.2, 0.1, 0.05)
WIDTHS = (0.25, 0.5, 1.0, 2.0, 5.0)
DIRECTIONS = (0.0, 17.0, 30.0, 45.0, 120.0, 300.0)


class Off(NamedTuple):
    """How far a force is off, as shares of what hand integration gives: mean force, peak, torque."""

    mean: float
    peak: float
    torque: float


def narrow_cut(cell: float, width: float, side: float, direction: float) -> Off:
    """One cut: the way's right (1) or left (-1) has been milled off up to the width [mm]."""
    half = 0.5 * TOOL.diameter
    way = along(direction, 2.0 * DEPTH, -side * (0.5 * CLEARING.diameter - half + width))
    ahead = (way[-1] - way[0]) / np.linalg.norm(way[-1] - way[0])
    part = _plate(cell)
    cut(part, CLEARING, np.concatenate([way, way[-1:] + 40.0 * ahead]))
    found = forces(part, TOOL, along(direction, DEPTH))
    begins = math.asin(1.0 - width / half)
    bounds = (begins, 0.5 * math.pi) if side > 0 else (-0.5 * math.pi, -begins)
    mean, peak, torque = by_hand(TOOL, DEPTH, *bounds)
    off = float(np.linalg.norm(turned(found, direction) - mean) / np.linalg.norm(mean))
    return Off(off, abs(found.figures[0] / peak - 1.0), abs(found.figures[1] / torque - 1.0))


def _plate(cell: float) -> HeightMap:
    stock = StockTable(shape="box", size=(60.0, 60.0, 30.0), position=(0.0, 0.0, 0.0), cell=cell)
    return blank(stock, np.zeros(3), cell)


def rows() -> Iterator[str]:
    """A line for each cell and width: the greatest over both sides and all directions [%]."""
    for cell in CELLS:
        for width in WIDTHS:
            cuts = [narrow_cut(cell, width, side, d) for side in (-1.0, 1.0) for d in DIRECTIONS]
            most = 100.0 * np.array(cuts).max(axis=0)
            yield f"| {cell:g} mm | {width:g} mm | {most[0]:.1f} | {most[1]:.1f} | {most[2]:.1f} |"


if __name__ == "__main__":
    for row in rows():
        print(row)
