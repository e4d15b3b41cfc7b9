"""Hot loops that hold the surface of one tri-dexel stock against another's on the same lattice.

A surface is known by where lines cross it: places and normals. About each of them the plane of its normal is taken for
the surface as far as the next lines are; the distance of a point from a surface is that from the nearest of these discs.
"""

import math
from typing import NamedTuple

from twin.compilation.compilable import inlined
from twin.compilation.kernel import arithmetic_kernel
from twin.cutting.tridexel.dexels import Dexels, FacetArray, Lattice
from twin.cutting.tridexel.intervals import Node, worth
from twin.cutting.tridexel.normals import unpacked
from twin.nc.canonical import FloatArray, IntArray

FIRST_REACH = 2
"""Cells around a point in which its nearest disc is looked for at first; without one in twice as many, and so on."""
DISC_CELLS = 1.01
"""Radius of a disc: a little more than from one line to the next [cells]."""
_ON_LINE = 1e-6
"""So near to a line a point is on it, which tells exactly whether it is in the material [cells]."""
_LATERAL_SHARE = 1e-6
"""Of two discs that are as near the one whose middle is nearer counts."""


class Gaps(NamedTuple):
    """How far n points are from a surface.

    Attributes:
        away: Out of the material positive, shape (n,) [mm]; NaN: no surface is within reach.
        beside: Of the middle of the nearest disc, along it, shape (n,) [mm].
        normal: Of the disc, shape (n, 3).
        facet: Normal and tool of the surface there, shape (n,).
    """

    away: FloatArray
    beside: FloatArray
    normal: FloatArray
    facet: FacetArray


@arithmetic_kernel
def find_gaps(
    dexels: Dexels, lattice: Lattice, points: FloatArray, farthest: int, found: Gaps
) -> None:
    """How far points are from the surface of a stock.

    Args:
        points: Shape (n, 3) [mm].
        farthest: Cells around a point beyond which nothing is looked for.
        found: Set to it.
    """
    for number in range(len(points)):
        reach = FIRST_REACH
        best = math.inf
        while True:
            best = _nearest(dexels, lattice, points, number, reach, found)
            if best <= ((reach - 1) * lattice.cell) ** 2 or reach >= farthest:
                break
            reach = min(2 * reach, farthest)
        if best == math.inf:
            found.away[number] = math.nan
            continue
        inside, off = _is_inside(dexels, lattice, points, number)
        if off < _ON_LINE or found.beside[number] > DISC_CELLS * lattice.cell:
            found.away[number] = (-1.0 if inside else 1.0) * abs(found.away[number])


@arithmetic_kernel
def _is_inside(
    dexels: Dexels, lattice: Lattice, points: FloatArray, number: int
) -> tuple[bool, float]:
    """Whether a point is in the material, by the line that goes past it most closely, and how far off that is [cells]."""
    least, inside = math.inf, False
    for d in range(3):
        u, v = (d + 1) % 3, (d + 2) % 3
        x = (points[number, u] - lattice.origin[u]) / lattice.cell
        y = (points[number, v] - lattice.origin[v]) / lattice.cell
        column, row = math.floor(x + 0.5), math.floor(y + 0.5)
        off = abs(x - column) + abs(y - row)
        if off < least and 0 <= column < lattice.shape[u] and 0 <= row < lattice.shape[v]:
            least, inside = off, False
            line = lattice.base[d] + row * lattice.shape[u] + column
            for place in range(dexels.first[line], dexels.first[line] + dexels.filled[line]):
                if dexels.ends[place, 0] < points[number, d] < dexels.ends[place, 1]:
                    inside = True
    return inside, least


@arithmetic_kernel
def _nearest(
    dexels: Dexels, lattice: Lattice, points: FloatArray, number: int, reach: int, found: Gaps
) -> float:
    """The nearest disc among the lines that are within some cells of a point; its squared distance."""
    best = math.inf
    cell = lattice.cell
    radius = DISC_CELLS * cell
    for d in range(3):
        u, v = (d + 1) % 3, (d + 2) % 3
        t = points[number, d]
        column = math.floor((points[number, u] - lattice.origin[u]) / cell + 0.5)
        row = math.floor((points[number, v] - lattice.origin[v]) / cell + 0.5)
        for j in range(max(0, row - reach), min(lattice.shape[v] - 1, row + reach) + 1):
            y = lattice.origin[v] + j * cell
            for i in range(max(0, column - reach), min(lattice.shape[u] - 1, column + reach) + 1):
                x = lattice.origin[u] + i * cell
                line = lattice.base[d] + j * lattice.shape[u] + i
                first = dexels.first[line]
                for place in range(first, first + dexels.filled[line]):
                    for end in range(2):
                        off = t - dexels.ends[place, end]
                        if abs(off) <= (reach + 1) * cell:
                            facet = dexels.facet[place, end]
                            across = (points[number, u] - x, points[number, v] - y)
                            best = _held(facet, d, off, across, radius, number, best, found)
    return best


@inlined
def _held(
    facet: int,
    d: int,
    off: float,
    across: tuple[float, float],
    radius: float,
    number: int,
    best: float,
    found: Gaps,
) -> float:
    """Hold a point against a disc, and keep it if none was nearer; the squared distance of the nearest."""
    a, b, c = unpacked(facet)
    scale = 1.0 / math.sqrt(a * a + b * b + c * c)
    a, b, c = a * scale, b * scale, c * scale
    if d == 0:
        away = a * off + b * across[0] + c * across[1]
    elif d == 1:
        away = b * off + c * across[0] + a * across[1]
    else:
        away = c * off + a * across[0] + b * across[1]
    squared = off * off + across[0] * across[0] + across[1] * across[1]
    beside = math.sqrt(max(squared - away * away, 0.0))
    beyond = max(beside - radius, 0.0)
    distance = away * away + beyond * beyond + _LATERAL_SHARE * beside * beside
    if distance >= best:
        return best
    found.away[number] = math.copysign(math.sqrt(away * away + beyond * beyond), away)
    found.beside[number] = beside
    found.normal[number, 0], found.normal[number, 1], found.normal[number, 2] = a, b, c
    found.facet[number] = facet
    return distance


@arithmetic_kernel
def difference(one: Dexels, other: Dexels, line: int, end: int, node: Node) -> float:
    """What lies in one stock alone, of some lines of one direction, in volume over the area of a cell (``worth``) [mm]."""
    total = 0.0
    for each in range(line, end):
        taken, last = other.first[each], other.first[each] + other.filled[each]
        for place in range(one.first[each], one.first[each] + one.filled[each]):
            stop = one.ends[place, 1]
            here, facet = one.ends[place, 0], one.facet[place, 0]
            for held in range(taken, last):
                begin, after = other.ends[held, 0], other.ends[held, 1]
                if after <= here or begin >= stop:
                    continue
                if begin > here:
                    total += worth(begin, other.facet[held, 0], node) - worth(here, facet, node)
                here, facet = after, other.facet[held, 1]
            if here < stop:
                total += worth(stop, one.facet[place, 1], node) - worth(here, facet, node)
    return total


@arithmetic_kernel
def depths_along_lines(
    dexels: Dexels, lines: IntArray, places: FloatArray, depths: FloatArray
) -> None:
    """How deep places on lines are in the material along their lines, shape (n,) [mm]; 0 outside.

    Args:
        lines: Numbers of the lines, shape (n,).
        places: Along them, shape (n,) [mm].
        depths: Set to it.
    """
    for number in range(len(lines)):
        line, t = lines[number], places[number]
        depths[number] = 0.0
        for place in range(dexels.first[line], dexels.first[line] + dexels.filled[line]):
            depth = min(t - dexels.ends[place, 0], dexels.ends[place, 1] - t)
            depths[number] = max(depths[number], depth)
