"""What a room asks of a part that is cut from any side: how near the tool is, what it measures, how it looks from above."""

import numpy as np

from twin.cutting.tridexel.dexels import DIRECTIONS, TriDexel
from twin.cutting.tridexel.engagement import met
from twin.cutting.tridexel.solids.moving_solid import Poses
from twin.cutting.tridexel.solids.solids import cylinder
from twin.job.job_file import ToolTable
from twin.nc.canonical import FloatArray
from twin.training.room.setup.touch import CONTACT_MM, FAR_MM, Touch

_Z = 2


def touch_any_side(stock: TriDexel, tip: FloatArray, axis: FloatArray, tool: ToolTable) -> Touch:
    """Hold the end of a tool against a part, the one as it stands and the other as it was cut.

    Args:
        tip: Where the tool's tip is, seen from the part, shape (3,) [mm].
        axis: Direction from there to the spindle, shape (3,).

    Returns:
        The gap, which is exact on faces along X, Y and Z; beyond what drags paper it is far.
    """
    around = cylinder(0.5 * tool.diameter + CONTACT_MM, -CONTACT_MM, tool.flute)
    poses = Poses(np.stack([tip, tip]), np.stack([axis, axis]))
    depth = float(met(stock, poses, around)[0])
    if depth <= 0.0:
        return Touch(FAR_MM)
    low, high = stock.corners[:, :2]
    gap = tip[:2] - np.clip(tip[:2], low, high)
    length = float(np.linalg.norm(gap))
    away = (float(gap[0]) / length, float(gap[1]) / length) if length else (0.0, 0.0)
    return Touch(CONTACT_MM - depth, away)


def seen_from_above(stock: TriDexel) -> FloatArray:
    """Z of the uppermost material over every node, shape (ny, nx) [mm]; the underside where there is none."""
    dexels, lattice = stock.dexels, stock.lattice
    lines = slice(
        int(lattice.base[_Z]), int(lattice.base[_Z] + lattice.shape[0] * lattice.shape[1])
    )
    first, filled = dexels.first[lines], dexels.filled[lines]
    bottom = float(stock.corners[0, _Z])
    last = np.where(filled > 0, first + filled - 1, 0)
    top = np.where(filled > 0, dexels.ends[last, 1], bottom)
    return top.reshape(int(lattice.shape[1]), int(lattice.shape[0]))


def surface_off(stock: TriDexel, place: FloatArray) -> float:
    """How far the surface is from a place, along X, Y or Z where it is nearest [mm].

    Args:
        place: Shape (3,) [mm].

    Returns:
        Positive where the place is within the material: so much is left over it.
    """
    lattice, best = stock.lattice, np.inf
    exact = (place - lattice.origin) / lattice.cell
    node = np.clip(np.rint(exact), 0, lattice.shape - 1).astype(int)
    if (np.abs(exact - node) > 1.0).any():
        return -np.inf
    inside = False
    for direction in range(DIRECTIONS):
        u, v = (direction + 1) % DIRECTIONS, (direction + 2) % DIRECTIONS
        line = int(lattice.base[direction] + node[v] * lattice.shape[u] + node[u])
        first, count = int(stock.dexels.first[line]), int(stock.dexels.filled[line])
        ends = stock.dexels.ends[first : first + count]
        if count:
            best = min(best, float(np.abs(ends - place[direction]).min()))
        if direction == _Z:
            inside = bool(((ends[:, 0] < place[_Z]) & (place[_Z] < ends[:, 1])).any())
    return best if inside else -best
