"""The uncut stock as intervals along three directions: box, cylinder, tube, the shape of an STL file."""

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from twin.compilation.kernel import arithmetic_kernel
from twin.cutting.tridexel.closed_mesh import mesh_dexels
from twin.cutting.tridexel.dexels import Dexels, Lattice, TriDexel, lattice_around, no_material
from twin.cutting.tridexel.engagement import cut
from twin.cutting.tridexel.normals import OWN, packed
from twin.cutting.tridexel.solids.moving_solid import Poses, surface, within
from twin.cutting.tridexel.solids.solids import Solid, cylinder
from twin.errors import ConfigError
from twin.files.stl import read_stl
from twin.job.job_file import StockTable
from twin.nc.canonical import FloatArray

if TYPE_CHECKING:
    import trimesh

THROUGH_MM = 1.0
"""How far a tube's bore reaches beyond its ends, so that nothing is left there [mm]."""


def blank(stock: StockTable, corner: FloatArray, cell: float) -> TriDexel:
    """The uncut stock.

    Args:
        corner: Where the blank's program coordinates have their origin in the part's frame, shape (3,) [mm].
        cell: Between neighbouring lines [mm].

    Raises:
        ConfigError: The grid would be too large, or an STL file is wrong.
    """
    if stock.file is not None:
        return _from_stl(Path(stock.file), np.asarray(stock.position) + corner, cell)
    top = np.asarray(stock.position) + corner
    extent = np.array(stock.extent)
    low = top - extent * [0.5, 0.5, 1.0]
    high = low + extent
    if stock.shape == "box":
        return box(low, high, cell)
    middle = 0.5 * (low + high)
    assert stock.diameter is not None
    direction = stock.direction
    height = float(extent[direction])
    part = round_bar(middle, direction, 0.5 * stock.diameter, height, cell)
    if stock.bore is not None:
        _bore(part, middle, direction, 0.5 * stock.bore, height)
    return part


def box(low: FloatArray, high: FloatArray, cell: float) -> TriDexel:
    """A box between two corners, shapes (3,) [mm].

    Raises:
        ConfigError: The grid would be too large.
    """
    lattice = lattice_around(low, high, cell)
    dexels = no_material(lattice, np.ones(lattice.lines, np.int16))
    dexels.filled[:] = 1
    ends = [*lattice.base.tolist(), lattice.lines]
    for d in range(3):
        lines = slice(ends[d], ends[d + 1])
        x, y, z = (float(part) for part in np.eye(3)[d])
        dexels.ends[lines] = low[d], high[d]
        dexels.facet[lines] = packed(-x, -y, -z, OWN), packed(x, y, z, OWN)
    return TriDexel(lattice, dexels, np.array([low, high]))


def round_bar(
    middle: FloatArray, direction: int, radius: float, height: float, cell: float
) -> TriDexel:
    """A cylinder along X, Y or Z.

    Args:
        middle: Its middle, shape (3,) [mm].
        direction: Along which it lies: 0, 1 or 2.
        radius: [mm].
        height: Its length [mm].
        cell: Between neighbouring lines [mm].

    Raises:
        ConfigError: The grid would be too large.
    """
    half = np.full(3, radius)
    half[direction] = 0.5 * height
    lattice = lattice_around(middle - half, middle + half, cell)
    dexels = no_material(lattice, np.ones(lattice.lines, np.int16))
    poses = _standing(middle, direction)
    _fill(dexels, lattice, poses, cylinder(radius, -0.5 * height, 0.5 * height))
    return TriDexel(lattice, dexels, np.array([middle - half, middle + half]))


def _bore(part: TriDexel, middle: FloatArray, direction: int, radius: float, height: float) -> None:
    reach = 0.5 * height + THROUGH_MM
    cut(part, _standing(middle, direction), [cylinder(radius, -reach, reach)], OWN)


def _standing(middle: FloatArray, direction: int) -> Poses:
    return Poses(np.tile(middle, (2, 1)), np.tile(np.eye(3)[direction], (2, 1)))


@arithmetic_kernel
def _fill(dexels: Dexels, lattice: Lattice, poses: Poses, solid: Solid) -> None:
    """Fill the lines of an empty stock with a solid."""
    for d in range(3):
        u, v = (d + 1) % 3, (d + 2) % 3
        for row in range(lattice.shape[v]):
            y = lattice.origin[v] + row * lattice.cell
            for column in range(lattice.shape[u]):
                x = lattice.origin[u] + column * lattice.cell
                low, high = within(poses, solid, 0, 0.0, d, x, y)
                if low >= high:
                    continue
                line = lattice.base[d] + row * lattice.shape[u] + column
                place = dexels.first[line]
                dexels.filled[line] = 1
                dexels.ends[place, 0], dexels.ends[place, 1] = low, high
                for end, t in enumerate((low, high)):
                    dexels.facet[place, end] = surface(poses, solid, (d, t, x, y), 0, 0.0, 1.0, OWN)


def require_closed(mesh: "trimesh.Trimesh", path: Path) -> "trimesh.Trimesh":
    """The mesh of a file.

    Raises:
        ConfigError: Its surface is not closed.
    """
    if not mesh.is_watertight:
        raise ConfigError(
            f"{path}: its surface is not closed, which a part cut from any side needs"
        )
    return mesh


def _from_stl(path: Path, top: FloatArray, cell: float) -> TriDexel:
    """The shape of an STL file, the middle of whose box's top face is at a place, shape (3,) [mm]."""
    mesh = require_closed(read_stl(path), path)
    low, high = mesh.bounds
    shift = top - [*(0.5 * (low + high))[:2], high[2]]
    triangles = np.ascontiguousarray(mesh.triangles + shift, np.float64)
    lattice = lattice_around(low + shift, high + shift, cell)
    sign = 1.0 if mesh.volume > 0 else -1.0
    dexels = mesh_dexels(lattice, triangles, sign * np.asarray(mesh.face_normals))
    return TriDexel(lattice, dexels, np.array([low, high]) + shift)
