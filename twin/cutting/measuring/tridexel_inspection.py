"""How far a part that was cut from several sides is from what it should be."""

from pathlib import Path
from typing import NamedTuple

import numpy as np

from twin.cutting.measuring.inspection import Inspection
from twin.cutting.tridexel.blanks import require_closed
from twin.cutting.tridexel.closed_mesh import mesh_dexels
from twin.cutting.tridexel.dexels import DIRECTIONS, FacetArray, Lattice, TriDexel
from twin.cutting.tridexel.intervals import Node
from twin.cutting.tridexel.normals import OWN, normals, tools
from twin.cutting.tridexel.surface.mesh import Surface
from twin.cutting.tridexel.surface.surface_gap import DISC_CELLS, Gaps, difference, find_gaps
from twin.errors import ConfigError
from twin.files.stl import read_stl
from twin.nc.canonical import BoolArray, FloatArray, IntArray

EXACT_MM = 2e-3
"""What the places of two plane surfaces are off by at most: bends of the sweep, samples that count as on a line [mm]."""
RAW_MM = 5e-3
"""A surface that is so near to the blank's own is that [mm]."""
NEAR_CELLS = 4
"""Around a point, in which most surfaces lie."""
FAR_CELLS = 64
"""Around a point, beyond which no surface is looked for."""
FAR_POINTS = 20_000
"""Points for which one is looked for beyond ``NEAR_CELLS``; more are thinned, and the rest is not measured."""
_MAIN = 3.0**-0.5
"""Part of a normal along one direction that one of the three has at least."""
_ROUNDING = 1e-9


class LineCrossings(NamedTuple):
    """Where lines cross the surface of a stock: of each piece of it those of the line that is most upright on it.

    Attributes:
        points: Shape (n, 3) [mm].
        facet: Normal and tool there, shape (n,).
        line: Number of the line, shape (n,).
        along: Its direction, shape (n,).
    """

    points: FloatArray
    facet: FacetArray
    line: IntArray
    along: IntArray

    def only(self, rows: BoolArray) -> "LineCrossings":
        """Some of them."""
        return LineCrossings(self.points[rows], self.facet[rows], self.line[rows], self.along[rows])


def crossings(stock: TriDexel, box: FloatArray | None = None) -> LineCrossings:
    """Where lines cross the surface of a stock.

    Args:
        box: Two opposite corners of where it is looked at, shape (2, 3) [mm]; None: everywhere.
    """
    lattice, dexels = stock.lattice, stock.dexels
    lines = np.arange(lattice.lines) if box is None else _lines_within(lattice, box)
    count = dexels.filled[lines].astype(np.int64)
    within = np.arange(int(count.sum())) - np.repeat(np.cumsum(count) - count, count)
    place = np.repeat(dexels.first[lines], count) + within
    line = np.repeat(lines, 2 * count)
    ends, facet = dexels.ends[place].ravel(), dexels.facet[place].ravel()
    along = np.searchsorted(lattice.base, line, "right") - 1
    part = np.take_along_axis(normals(facet), along[:, None], axis=1)[:, 0]
    chosen = np.abs(part) >= _MAIN - _ROUNDING
    if box is not None:
        chosen &= (ends >= box[0][along]) & (ends <= box[1][along])
    line, ends, facet, along = line[chosen], ends[chosen], facet[chosen], along[chosen]
    rows, u, v = np.arange(len(line)), (along + 1) % 3, (along + 2) % 3
    number = line - lattice.base[along]
    points = np.zeros((len(line), 3))
    points[rows, along] = ends
    points[rows, u] = lattice.origin[u] + lattice.cell * (number % lattice.shape[u])
    points[rows, v] = lattice.origin[v] + lattice.cell * (number // lattice.shape[u])
    return LineCrossings(points, facet, line, along)


def _lines_within(lattice: Lattice, box: FloatArray) -> IntArray:
    """Numbers of the lines that go through a box."""
    low = np.clip(np.floor((box[0] - lattice.origin) / lattice.cell), 0, lattice.shape)
    high = np.clip(np.ceil((box[1] - lattice.origin) / lattice.cell) + 1.0, 0, lattice.shape)
    nodes = [np.arange(a, b) for a, b in zip(low.astype(int), high.astype(int), strict=True)]
    found = []
    for d in range(DIRECTIONS):
        u, v = (d + 1) % 3, (d + 2) % 3
        number = nodes[v][:, None] * lattice.shape[u] + nodes[u]
        found.append(lattice.base[d] + number.ravel())
    return np.concatenate(found)


def nominal_stock(part: TriDexel, file: Path, corner: FloatArray) -> TriDexel:
    """A nominal part on the lattice of a machined one.

    Args:
        file: STL of the nominal part in program coordinates [mm].
        corner: Where these have their origin in the part's frame, shape (3,) [mm].

    Raises:
        ConfigError: The file cannot be read, or its surface is not closed.
    """
    mesh = require_closed(read_stl(file), file)
    triangles = np.ascontiguousarray(mesh.triangles + corner, np.float64)
    sign = 1.0 if mesh.volume > 0 else -1.0
    dexels = mesh_dexels(part.lattice, triangles, sign * np.asarray(mesh.face_normals))
    return TriDexel(part.lattice, dexels, part.corners)


def gaps(stock: TriDexel, points: FloatArray) -> Gaps:
    """How far points are from the surface of a stock; see ``FAR_POINTS``."""
    found = _gaps(stock, points, NEAR_CELLS)
    # What was found at the border of what was looked at may have something nearer behind it.
    far = np.isnan(found.away) | (np.abs(found.away) > (NEAR_CELLS - 1) * stock.cell)
    rows = np.flatnonzero(far)
    found.away[rows] = np.nan
    rows = rows[:: max(1, -(-len(rows) // FAR_POINTS))]
    if len(rows):
        for column, further in zip(found, _gaps(stock, points[rows], FAR_CELLS), strict=True):
            column[rows] = further
    return found


def _gaps(stock: TriDexel, points: FloatArray, farthest: int) -> Gaps:
    count = len(points)
    found = Gaps(np.zeros(count), np.zeros(count), np.zeros((count, 3)), np.zeros(count, np.int32))
    find_gaps(stock.dexels, stock.lattice, points, farthest, found)
    return found


def deviations(nominal: TriDexel, found: Surface) -> FloatArray:
    """How far the vertices of a part's surface stand out of the nominal one, shape (n,) [mm]; NaN on the blank's own surface."""
    result, cut = np.full(len(found.points), np.nan), tools(found.facet) != OWN
    result[cut] = gaps(nominal, found.points[cut]).away
    return result


def inspect_stock(part: TriDexel, nominal: TriDexel, tolerance_um: float) -> Inspection:
    """Measure a part against its nominal shape.

    Where a tool went the part's surface is held against the nominal one, and the nominal surface against the part's where
    that is not the blank's own surface. Where two surfaces are not parallel, their distance is known to how far the nearest
    crossing lies beside a point, times the sine of the angle between them; the greatest of these is the bound.

    Args:
        nominal: What it should be, on the same lattice.
        tolerance_um: Deviation that is still good [µm].

    Raises:
        ConfigError: The two do not lie on the same lattice.
    """
    if any(not np.array_equal(a, b) for a, b in zip(part.lattice, nominal.lattice, strict=True)):
        raise ConfigError("the two parts do not lie on the same grid of the same blank")
    machined = crossings(part)
    machined = machined.only(tools(machined.facet) != OWN)
    ideal = crossings(nominal)
    low, high = part.corners
    within = ((ideal.points >= low - RAW_MM) & (ideal.points <= high + RAW_MM)).all(axis=1)
    ideal = ideal.only(within)
    of_part, of_ideal = gaps(nominal, machined.points), gaps(part, ideal.points)
    raw = (tools(of_ideal.facet) == OWN) & (np.abs(of_ideal.away) <= RAW_MM)
    deviation = np.concatenate([of_part.away, -of_ideal.away[~raw]])
    unsure = [
        _unsure(found, each.facet, part.cell)[chosen]
        for found, each, chosen in (
            (of_part, machined, slice(None)),
            (of_ideal, ideal, ~raw),
        )
    ]
    return Inspection(
        deviation_mm=deviation,
        bound_mm=EXACT_MM + float(np.nanmax(np.concatenate(unsure), initial=0.0)),
        judged=len(deviation),
        tolerance_um=tolerance_um,
        standing_mm3=volume_alone(part, nominal),
        missing_mm3=volume_alone(nominal, part),
    )


def volume_alone(one: TriDexel, other: TriDexel) -> float:
    """What lies in one of two stocks on the same lattice alone [mm³]."""
    lattice = one.lattice
    ends = [*lattice.base.tolist(), lattice.lines]
    nodes = [Node(d, float(lattice.origin[d]), lattice.cell) for d in range(DIRECTIONS)]
    lines = (
        difference(one.dexels, other.dexels, ends[d], ends[d + 1], nodes[d])
        for d in range(DIRECTIONS)
    )
    return max(0.0, lattice.cell**2 * sum(lines))


def _unsure(found: Gaps, facet: FacetArray, cell: float) -> FloatArray:
    """How far the distance of points, whose surface is known, from another surface may be off, shape (n,) [mm]."""
    sine = np.linalg.norm(np.cross(found.normal, normals(facet)), axis=1)
    unsure = np.where(found.beside <= DISC_CELLS * cell, found.beside * np.minimum(sine, 1.0), cell)
    return np.where(np.isnan(found.away), 0.0, unsure)
