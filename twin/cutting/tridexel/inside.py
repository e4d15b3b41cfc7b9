"""Whether there is material before a cutter's edge in a tri-dexel stock, known closer than by whole cells."""

import math
from typing import NamedTuple

from twin.compilation.kernel import arithmetic_kernel
from twin.cutting.kernels.tool_height import Profile
from twin.cutting.tridexel.dexels import Dexels, Lattice
from twin.cutting.tridexel.normals import unpacked
from twin.nc.canonical import FloatArray

_REACH = 1.0
"""How far beside a point the surface is looked for, along a line [cells]."""
_OWN_MM = 2e-3
"""How far a crossing may be off the edge that has left it [mm]."""
_OTHER_FACE = 0.75
"""Squared cosine of the angle between two normals, 30 degrees, below which they are of different faces."""

_Place = tuple[float, float, float]


class Standing(NamedTuple):
    """A cutter where it stands, the material cut up to there.

    Attributes:
        tip: Its tip in the part's frame, shape (3,) [mm].
        axis: Direction from there to the spindle, shape (3,).
        side_from: Height above the tip at which its side begins [mm].
    """

    tip: FloatArray
    axis: FloatArray
    profile: Profile
    side_from: float


class EdgePoint(NamedTuple):
    """A point just before an edge [mm], and the normal there into the cutter."""

    point: _Place
    normal: _Place


class _Crossing(NamedTuple):
    """Where a line crosses the surface: squared distance from the point [mm²], the place off it [mm], the normal."""

    squared: float
    place: _Place
    normal: _Place


@arithmetic_kernel
def inside(dexels: Dexels, lattice: Lattice, cutter: Standing, edge: EdgePoint) -> bool:
    """Whether a point just before a cutter's edge is in the material.

    Of the twelve lines around the point the crossing that is nearest to it says on which side of the surface it is, by
    the plane of its normal. At an edge of the part a second face has its say: of two planes that
    are convex to each other the point must be below both, of two that are concave below one. Where a cutter's end
    bends within two cells, at the point of a drill, what it has just left itself says nothing if it faces elsewhere.

    Args:
        edge: The point, and the normal of the edge there.
    """
    cell, point = lattice.cell, edge.point
    for d in range(3):
        off = point[d] - lattice.origin[d]
        if off < -cell or off > cell * lattice.shape[d]:
            return False
    nowhere = _Crossing(math.inf, (0.0, 0.0, 0.0), (0.0, 0.0, 0.0))
    first, filled = _nearest(dexels, lattice, cutter, edge, nowhere)
    if first.squared == math.inf:
        return filled
    below = _dot(first.place, first.normal) > 0.0
    other, _ = _nearest(dexels, lattice, cutter, edge, first)
    if other.squared == math.inf:
        return below
    # One says above, one below: of an edge that is concave the material is on either side.
    return _dot(other.place, first.normal) >= _dot(first.place, first.normal)


@arithmetic_kernel
def _nearest(
    dexels: Dexels, lattice: Lattice, cutter: Standing, edge: EdgePoint, than: _Crossing
) -> tuple[_Crossing, bool]:
    """The crossing that is nearest to a point, and whether any line has material beside it.

    Args:
        edge: The point, and the normal of the edge there.
        than: One whose face is left out; only those count that put the point on the other side of the
            surface. At an infinite distance: there is none.
    """
    cell, point = lattice.cell, edge.point
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
                        face = unpacked(dexels.facet[at, k])
                        here = _along(d, gap, du, dv)
                        if not any_face and (
                            (_dot(here, face) > 0.0) == below or not _differ(face, than.normal)
                        ):
                            continue
                        if not (
                            _differ(face, edge.normal)
                            and _is_point(cutter, 2.0 * cell, point, here)
                        ):
                            squared, place, normal = away, here, face
    return _Crossing(squared, place, normal), filled


@arithmetic_kernel
def _along(d: int, gap: float, du: float, dv: float) -> _Place:
    """Components of a vector along a direction and the two across it."""
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


@arithmetic_kernel
def _is_point(cutter: Standing, narrow: float, point: _Place, off: _Place) -> bool:
    """Whether a place so far off a point is on the end of a cutter, where that is narrow [mm]."""
    x = point[0] + off[0] - cutter.tip[0]
    y = point[1] + off[1] - cutter.tip[1]
    z = point[2] + off[2] - cutter.tip[2]
    height = x * cutter.axis[0] + y * cutter.axis[1] + z * cutter.axis[2]
    distance = math.sqrt(max(x * x + y * y + z * z - height * height, 0.0))
    _, flat, corner, slope = cutter.profile
    if distance <= flat or height > cutter.side_from:
        return False
    if corner > 0.0:
        away = math.hypot(distance - flat, height - corner)
        return corner < narrow and abs(away - corner) <= _OWN_MM
    within = abs(height - slope * (distance - flat)) <= _OWN_MM * math.hypot(1.0, slope)
    return distance < narrow and within
