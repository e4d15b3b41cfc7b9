"""Whether a point is in the material of a tri-dexel stock, closer than by whole cells."""

import math
from typing import NamedTuple

from twin.compilation.kernel import arithmetic_kernel
from twin.cutting.tridexel.dexels import Dexels, Lattice
from twin.cutting.tridexel.normals import unpacked

_REACH = 1.0
"""How far beside a point the surface is looked for, along a line [cells]."""
_OTHER_FACE = 0.75
"""Squared cosine of the angle between two normals, 30 degrees, below which they are of different faces."""

_Place = tuple[float, float, float]


class _Crossing(NamedTuple):
    """Where a line crosses the surface: squared distance from the point [mm²], the place off it [mm], the normal."""

    squared: float
    place: _Place
    normal: _Place


@arithmetic_kernel
def inside(dexels: Dexels, lattice: Lattice, point: _Place) -> bool:
    """Whether a point is in the material.

    Of the twelve lines around the point the crossing that is nearest to it says on which side of the surface it is, by
    the plane of its normal. At an edge of the part a second face has its say: of two planes that
    are convex to each other the point must be below both, of two that are concave below one.

    Args:
        dexels: The material.
        lattice: Where it lies.
        point: The point [mm].
    """
    cell = lattice.cell
    for d in range(3):
        off = point[d] - lattice.origin[d]
        if off < -cell or off > cell * lattice.shape[d]:
            return False
    nowhere = _Crossing(math.inf, (0.0, 0.0, 0.0), (0.0, 0.0, 0.0))
    first, filled = _nearest(dexels, lattice, point, nowhere)
    if first.squared == math.inf:
        return filled
    below = _dot(first.place, first.normal) > 0.0
    other, _ = _nearest(dexels, lattice, point, first)
    if other.squared == math.inf:
        return below
    # One says above, one below: of an edge that is concave the material is on either side.
    return _dot(other.place, first.normal) >= _dot(first.place, first.normal)


@arithmetic_kernel
def _nearest(
    dexels: Dexels, lattice: Lattice, point: _Place, than: _Crossing
) -> tuple[_Crossing, bool]:
    """The crossing that is nearest to a point, and whether any line has material there.

    Args:
        dexels: The material.
        lattice: Where it lies.
        point: The point [mm].
        than: One whose face is left out; only those count that put the point on the other side of the
            surface. At an infinite distance: there is none.
    """
    cell = lattice.cell
    squared, place, normal = math.inf, than.place, than.normal
    filled, any_face = False, than.squared == math.inf
    below = _dot(than.place, than.normal) > 0.0
    for d in range(3):
        u, v = (d + 1) % 3, (d + 2) % 3
        column = math.floor((point[u] - lattice.origin[u]) / cell)
        row = math.floor((point[v] - lattice.origin[v]) / cell)
        for j in range(max(row, 0), min(row + 2, lattice.shape[v])):
            dv = lattice.origin[v] + j * cell - point[v]
            for i in range(max(column, 0), min(column + 2, lattice.shape[u])):
                du = lattice.origin[u] + i * cell - point[u]
                line = lattice.base[d] + j * lattice.shape[u] + i
                for at in range(dexels.first[line], dexels.first[line] + dexels.filled[line]):
                    begin, end = dexels.ends[at, 0] - point[d], dexels.ends[at, 1] - point[d]
                    if begin > _REACH * cell or end < -_REACH * cell:
                        continue
                    filled |= begin <= 0.0 <= end
                    for k in range(2):
                        gap = begin if k == 0 else end
                        away = gap * gap + du * du + dv * dv
                        if abs(gap) > _REACH * cell or away >= squared:
                            continue
                        face = unpacked(dexels.skin[at, k])
                        here = _along(d, gap, du, dv)
                        if any_face or (
                            (_dot(here, face) > 0.0) != below and _differ(face, than.normal)
                        ):
                            squared, place, normal = away, here, face
    return _Crossing(squared, place, normal), filled


@arithmetic_kernel
def _along(d: int, gap: float, du: float, dv: float) -> _Place:
    """A vector told along a direction and the two across it."""
    if d == 0:
        return gap, du, dv
    if d == 1:
        return dv, gap, du
    return du, dv, gap


@arithmetic_kernel
def _dot(a: _Place, b: _Place) -> float:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@arithmetic_kernel
def _differ(a: _Place, b: _Place) -> bool:
    """Whether two normals, of any length, are of different faces."""
    cosine = _dot(a, b)
    return cosine <= 0.0 or cosine * cosine < _OTHER_FACE * _dot(a, a) * _dot(b, b)
