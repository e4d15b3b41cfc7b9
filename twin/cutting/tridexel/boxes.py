"""Boxes that go with the tool, such as the spindle's housing, held against a tri-dexel stock."""

import math
from typing import NamedTuple

import numpy as np

from twin.compilation.kernel import arithmetic_kernel
from twin.cutting.tridexel.dexels import Dexels, Lattice, TriDexel
from twin.cutting.tridexel.intervals import overlap
from twin.cutting.tridexel.solids.moving_solid import Poses
from twin.nc.canonical import FloatArray, IntArray

STEP_CELLS = 2.0
"""Between the places on its path at which a box is held against the stock, at its corners [cells]."""


_LEVEL = 1e-12
"""Part of a side's direction along a line below which the line is parallel to it."""

Place = tuple[float, float, float]


class Box(NamedTuple):
    """A box that is fixed to the tool.

    Attributes:
        low: Its lowest corner in the tool's frame, whose origin is the tip and whose Z is its axis, shape (3,) [mm].
        high: Its highest corner.
    """

    low: tuple[float, float, float]
    high: tuple[float, float, float]


def boxes_met(stock: TriDexel, poses: Poses, along_x: FloatArray, box: Box) -> FloatArray:
    """How deep a box is in the material during each of n steps, shape (n,) [mm]; 0: nowhere.

    As for ``engagement.met`` the longest line of material within it is taken in each direction, and the shortest of these.
    It is looked at in places on its path that lie no farther from each other than ``STEP_CELLS``.

    Args:
        along_x: Direction of machine X on the tool, seen from the part, shape (n + 1, 3).
    """
    depth = np.zeros(len(poses.tip) - 1)
    if len(depth):
        low, high = np.array(box.low), np.array(box.high)
        travel = _corner_travel(poses, along_x, low, high)
        steps = np.maximum(1, np.ceil(travel / (STEP_CELLS * stock.cell))).astype(np.int64)
        hold_box(stock.dexels, stock.lattice, poses, along_x, np.stack([low, high]), steps, depth)
    return depth


def _corner_travel(
    poses: Poses, along_x: FloatArray, low: FloatArray, high: FloatArray
) -> FloatArray:
    """How far a corner of a box goes in each step at most, shape (n,) [mm]."""
    farthest = float(np.linalg.norm(np.maximum(np.abs(low), np.abs(high))))
    turned = np.linalg.norm(np.diff(poses.axis, axis=0), axis=1)
    turned += np.linalg.norm(np.diff(along_x, axis=0), axis=1)
    return np.linalg.norm(np.diff(poses.tip, axis=0), axis=1) + farthest * turned


@arithmetic_kernel
def hold_box(
    dexels: Dexels,
    lattice: Lattice,
    poses: Poses,
    along_x: FloatArray,
    box: FloatArray,
    steps: IntArray,
    depth: FloatArray,
) -> None:
    """Hold a moving box against the lines of a stock.

    Args:
        poses: Ends of n steps.
        along_x: Direction of machine X on the tool at these ends, shape (n + 1, 3).
        box: Its lowest and highest corner in the tool's frame, shape (2, 3) [mm].
        steps: In how many places each step is looked at, shape (n,).
        depth: Set to how deep it is, shape (n,) [mm].
    """
    for number in range(len(depth)):
        for part in range(1, steps[number] + 1):
            share = part / steps[number]
            depth[number] = max(
                depth[number], _depth(dexels, lattice, poses, along_x, box, number, share)
            )


@arithmetic_kernel
def _depth(
    dexels: Dexels,
    lattice: Lattice,
    poses: Poses,
    along_x: FloatArray,
    box: FloatArray,
    a: int,
    share: float,
) -> float:
    """How deep a box is in the material at a share of a step; 0: nowhere."""
    tip = _between(poses.tip, a, share)
    up = _unit(_between(poses.axis, a, share))
    first = _unit(_between(along_x, a, share))
    second = (
        up[1] * first[2] - up[2] * first[1],
        up[2] * first[0] - up[0] * first[2],
        up[0] * first[1] - up[1] * first[0],
    )
    sides = (first, second, up)
    if _apart(lattice, tip, sides, box):
        return 0.0
    least = math.inf
    for d in range(3):
        u, v = (d + 1) % 3, (d + 2) % 3
        first_column, last_column = _span(lattice, tip, sides, box, u)
        first_row, last_row = _span(lattice, tip, sides, box, v)
        longest = 0.0
        for row in range(first_row, last_row + 1):
            y = lattice.origin[v] + row * lattice.cell - tip[v]
            for column in range(first_column, last_column + 1):
                x = lattice.origin[u] + column * lattice.cell - tip[u]
                low, high = -math.inf, math.inf
                for number, side in enumerate(sides):
                    here, slope = x * side[u] + y * side[v] - tip[d] * side[d], side[d]
                    one, other = box[0, number] - here, box[1, number] - here
                    if abs(slope) < _LEVEL:
                        if one > 0.0 or other < 0.0:
                            high = -math.inf
                    else:
                        low = max(low, min(one / slope, other / slope))
                        high = min(high, max(one / slope, other / slope))
                if low < high:
                    line = lattice.base[d] + row * lattice.shape[u] + column
                    longest = max(longest, overlap(dexels, line, low, high))
        if longest > 0.0:
            least = min(least, longest)
    return least if least < math.inf else 0.0


@arithmetic_kernel
def _reach(tip: Place, sides: tuple[Place, Place, Place], box: FloatArray, d: int) -> Place:
    """Where a box begins and ends along X, Y or Z; the third is not used [mm]."""
    middle, half = tip[d], 0.0
    for number, side in enumerate(sides):
        middle += 0.5 * (box[0, number] + box[1, number]) * side[d]
        half += 0.5 * (box[1, number] - box[0, number]) * abs(side[d])
    return middle - half, middle + half, 0.0


@arithmetic_kernel
def _span(
    lattice: Lattice, tip: Place, sides: tuple[Place, Place, Place], box: FloatArray, d: int
) -> tuple[int, int]:
    """The first and the last node along X, Y or Z that a box reaches."""
    low, high, _ = _reach(tip, sides, box, d)
    first = math.ceil((low - lattice.origin[d]) / lattice.cell)
    last = math.floor((high - lattice.origin[d]) / lattice.cell)
    return max(0, first), min(lattice.shape[d] - 1, last)


@arithmetic_kernel
def _apart(
    lattice: Lattice, tip: Place, sides: tuple[Place, Place, Place], box: FloatArray
) -> bool:
    """Whether a plane along a face of the box, or of the blank's own, lies between them.

    The blank reaches less than a cell beyond the outermost lines.
    """
    for d in range(3):
        least, most, _ = _reach(tip, sides, box, d)
        begin = lattice.origin[d] - lattice.cell
        if most < begin or least > begin + lattice.cell * (lattice.shape[d] + 1):
            return True
    for number, side in enumerate(sides):
        low, high = 0.0, 0.0
        for d in range(3):
            begin = (lattice.origin[d] - lattice.cell - tip[d]) * side[d]
            end = begin + lattice.cell * (lattice.shape[d] + 1) * side[d]
            low, high = low + min(begin, end), high + max(begin, end)
        if high < box[0, number] or low > box[1, number]:
            return True
    return False


@arithmetic_kernel
def _between(ends: FloatArray, a: int, share: float) -> Place:
    rest = 1.0 - share
    return (
        rest * ends[a, 0] + share * ends[a + 1, 0],
        rest * ends[a, 1] + share * ends[a + 1, 1],
        rest * ends[a, 2] + share * ends[a + 1, 2],
    )


@arithmetic_kernel
def _unit(vector: Place) -> Place:
    x, y, z = vector
    scale = 1.0 / math.sqrt(x * x + y * y + z * z)
    return x * scale, y * scale, z * scale
