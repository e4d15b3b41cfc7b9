"""Sweep the tool through a height map, on another core too where there is one."""

from concurrent.futures import ThreadPoolExecutor
from typing import NamedTuple

import numpy as np

from twin.cutting.heights.height_map import HeightMap
from twin.cutting.kernels.covered_cells import Marks
from twin.cutting.kernels.sweep import (
    ALL_ROWS,
    EVEN_ROWS,
    ODD_ROWS,
    Removal,
    removal_of_sums,
    sweep,
)
from twin.cutting.tools import Profile
from twin.nc.canonical import FloatArray
from twin.processor import available_cores

FEWEST_LINES = 1000
"""Lines that are worth another thread: it takes as long to begin as a hundred lines."""

Rectangle = tuple[int, int, int, int]
"""Row, row end, column, column end of cells."""


class Swept(NamedTuple):
    """What a sweep did.

    Attributes:
        changed: Cells that changed.
    """

    removal: Removal
    changed: Rectangle


def sweep_lines(
    material: HeightMap,
    points: FloatArray,
    edge: Profile,
    marks: Marks | None = None,
    *,
    stood: bool = False,
    cores: int | None = None,
) -> Swept:
    """Cut the material that a tool meets along its path from point to point.

    Two threads take every other row of the map each, and each row's share of what a line took off
    is added up in one order: the result does not depend on how many cores there are.

    Args:
        points: Tool tip positions, shape (n, 3) [mm].
        marks: What each line leaves where it cut; None: nothing.
        stood: Whether the tool has been at the first point, and has cut what it meets there.
        cores: Cores to use, by default those that this process may run on.
    """
    count = max(len(points) - 1, 0)
    sums, grid = np.zeros((count, 2, 4)), material.grid
    marks = Marks(np.zeros((0, 0)), np.zeros(count)) if marks is None else marks

    def cut(rows: tuple[int, int]) -> Rectangle:
        return sweep(material.cells, points, edge, sums, marks, stood, rows)

    if count >= FEWEST_LINES and (available_cores() if cores is None else cores) > 1:
        with ThreadPoolExecutor(1, "sweep") as other:
            odd = other.submit(cut, ODD_ROWS)
            changed = union(cut(EVEN_ROWS), odd.result())
    else:
        changed = cut(ALL_ROWS)
    removal = Removal(*np.zeros((3, count)))
    removal_of_sums(sums, points, grid, removal)
    return Swept(removal, changed)


def union(a: Rectangle, b: Rectangle) -> Rectangle:
    """The smallest rectangle around two; one that ends before it begins is empty."""
    if a[0] >= a[1]:
        return b
    if b[0] >= b[1]:
        return a
    return (min(a[0], b[0]), max(a[1], b[1]), min(a[2], b[2]), max(a[3], b[3]))
