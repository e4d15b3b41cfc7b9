"""A solid moving from pose to pose: where a line is within it, and the normal of its surface."""

import math
from typing import NamedTuple

from twin.compilation.compilable import inlined
from twin.compilation.kernel import arithmetic_kernel
from twin.cutting.tridexel.normals import packed
from twin.cutting.tridexel.solids.rays import Ray, crossing, outwards
from twin.cutting.tridexel.solids.solids import Solid
from twin.nc.canonical import FloatArray


class Poses(NamedTuple):
    """Where the tool is at the ends of n steps.

    Attributes:
        tip: Its tip in the part's frame, shape (n + 1, 3) [mm].
        axis: Direction from the tip to the spindle, shape (n + 1, 3).
    """

    tip: FloatArray
    axis: FloatArray


@arithmetic_kernel
def is_ball(solid: Solid) -> bool:
    """Whether a solid is a rounding alone."""
    return solid.rounding > 0.0 and solid.low_radius == 0.0


@inlined
def point_on_axis(
    poses: Poses, pose: int, height: float, u: int, v: int, d: int
) -> tuple[float, float, float]:
    """A place on the axis, along the two directions across the lines and along them [mm]."""
    tip, axis = poses.tip[pose], poses.axis[pose]
    return tip[u] + height * axis[u], tip[v] + height * axis[v], tip[d] + height * axis[d]


Pose = tuple[float, float, float, float, float, float]
"""Tip [mm] and direction."""


@arithmetic_kernel
def pose_at(poses: Poses, a: int, share: float) -> Pose:
    """Where the tool is at a share of a step."""
    tip, axis = poses.tip, poses.axis
    b, rest = a + 1, 1.0 - share
    x = rest * axis[a, 0] + share * axis[b, 0]
    y = rest * axis[a, 1] + share * axis[b, 1]
    z = rest * axis[a, 2] + share * axis[b, 2]
    scale = 1.0 / math.sqrt(x * x + y * y + z * z)
    return (
        rest * tip[a, 0] + share * tip[b, 0],
        rest * tip[a, 1] + share * tip[b, 1],
        rest * tip[a, 2] + share * tip[b, 2],
        x * scale,
        y * scale,
        z * scale,
    )


@arithmetic_kernel
def within(
    poses: Poses, solid: Solid, a: int, share: float, d: int, x: float, y: float
) -> tuple[float, float]:
    """Where a line is within the solid at a share of a step."""
    return within_at(pose_at(poses, a, share), solid, d, x, y)


@arithmetic_kernel
def within_at(pose: Pose, solid: Solid, d: int, x: float, y: float) -> tuple[float, float]:
    """Where a line is within the solid at a pose."""
    u, v = (d + 1) % 3, (d + 2) % 3
    px, py, pz = x - pose[u], y - pose[v], -pose[d]
    height = px * pose[3 + u] + py * pose[3 + v] + pz * pose[3 + d]
    rise = pose[3 + d]
    ray = Ray(
        height,
        rise,
        px * px + py * py + pz * pz - height * height,
        pz - height * rise,
        1.0 - rise * rise,
    )
    return crossing(solid, ray)


@arithmetic_kernel
def surface(
    poses: Poses,
    solid: Solid,
    point: tuple[int, float, float, float],
    number: int,
    share: float,
    side: float,
    tool: int,
) -> int:
    """Normal at a point of a solid's surface and the tool, as ``normals.packed`` has them.

    Args:
        point: Direction of the line it is on, place along it, and across it in both directions.
        side: 1.0: the normal out of the solid; -1.0: into it.
    """
    d, t, x, y = point
    u, v = (d + 1) % 3, (d + 2) % 3
    if is_ball(solid):
        ax, ay, az = point_on_axis(poses, number, solid.rounding + solid.low, u, v, d)
        bx, by, bz = point_on_axis(poses, number + 1, solid.rounding + solid.low, u, v, d)
        scale, rest = side / solid.rounding, 1.0 - share
        nu, nv = (x - rest * ax - share * bx) * scale, (y - rest * ay - share * by) * scale
        return _turned(nu, nv, (t - rest * az - share * bz) * scale, d, tool)
    pose = pose_at(poses, number, share)
    px, py, pz = x - pose[u], y - pose[v], t - pose[d]
    au, av, ad = pose[3 + u], pose[3 + v], pose[3 + d]
    height = px * au + py * av + pz * ad
    px, py, pz = px - height * au, py - height * av, pz - height * ad
    distance = math.sqrt(px * px + py * py + pz * pz)
    aside, along = outwards(solid, distance, height)
    aside, along = side * aside / max(distance, 1e-12), side * along
    nu, nv, nd = px * aside + along * au, py * aside + along * av, pz * aside + along * ad
    return _turned(nu, nv, nd, d, tool)


@arithmetic_kernel
def _turned(nu: float, nv: float, nd: float, d: int, tool: int) -> int:
    """A normal with components along a direction and the two across it, packed."""
    if d == 0:
        return packed(nd, nu, nv, tool)
    if d == 1:
        return packed(nv, nd, nu, tool)
    return packed(nu, nv, nd, tool)
