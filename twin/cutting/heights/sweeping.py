"""Sweep the tool through a height map."""

from typing import NamedTuple

import numpy as np

from twin.cutting.heights.height_map import HeightMap
from twin.cutting.kernels.covered_cells import LineColumn, Marks
from twin.cutting.kernels.sweep import Removal, removal_of_sums, sweep
from twin.cutting.tools import Profile
from twin.nc.canonical import FloatArray

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
    walls: bool = False,
) -> Swept:
    """Cut the material that a tool meets along its path from point to point.

    Args:
        points: Tool tip positions, shape (n, 3) [mm].
        marks: What each line leaves where it cut; None: nothing.
        stood: Whether the tool has been at the first point, and has cut what it meets there.
        walls: Whether the walls that it leaves are noted, and what they are off whole cells counts.
    """
    count = max(len(points) - 1, 0)
    sums = np.zeros((count, len(LineColumn)))
    marks = Marks(np.zeros((0, 0)), np.zeros(count)) if marks is None else marks
    changed = sweep(material.cells, points, edge, sums, marks, stood, walls)
    removal = Removal(*np.zeros((4, count)))
    removal_of_sums(sums, points, material.grid, removal)
    return Swept(removal, changed)


def union(a: Rectangle, b: Rectangle) -> Rectangle:
    """The smallest rectangle around two; one that ends before it begins is empty."""
    if a[0] >= a[1]:
        return b
    if b[0] >= b[1]:
        return a
    return (min(a[0], b[0]), max(a[1], b[1]), min(a[2], b[2]), max(a[3], b[3]))
