"""Where the cutting force points: from the side on which the tool is engaged."""

import math

import numpy as np

from twin.cutting.forces.materials import Kienzle
from twin.cutting.watching.events import Stretches, tool_frame
from twin.job.job_file import ToolTable
from twin.nc.canonical import FloatArray

RADIAL_SHARE = 0.3
"""Radial force of a tooth as a share of its tangential one: the usual assumption for sharp edges
(Tlusty, Manufacturing Processes and Equipment, 2000, milling)."""

_PLACES = (np.arange(24) + 0.5) / 24
"""Where along the engaged arc the tooth is looked at, as shares of it."""


def tool_force(
    stretches: Stretches,
    width: FloatArray,
    tangential: FloatArray,
    tool: ToolTable,
    material: Kienzle,
) -> FloatArray:
    """Mean force on the tool along each stretch, in the part's frame.

    A tooth at the angle a from the direction of travel (left positive) cuts a chip of the
    thickness fz cos a. With a spindle that turns clockwise, seen from above, it is pushed by Ft to
    the left of its radius and by ``RADIAL_SHARE`` Ft inwards; Ft goes with (cos a)^(1 - mc). The
    mean over the engaged arc keeps the mean tangential force as it is given. The arc is as wide as
    the cut and has its middle where the material lay, so that climb and conventional milling
    differ. On the way down the thrust is that of a drill, Ff = kc D/4 fn sin(point angle / 2)
    (Sandvik Coromant's drilling formula), which is the given force times that sine, upwards.

    Args:
        stretches: n stretches.
        width: Their widths of cut, shape (n,) [mm].
        tangential: Mean tangential force of all teeth, shape (n,) [N].

    Returns:
        Shape (n, 3) [N].
    """
    travel = stretches.travel
    length = np.maximum(np.linalg.norm(travel, axis=1), 1e-30)
    level = np.hypot(travel[:, 0], travel[:, 1])
    ahead = travel[:, :2] / np.maximum(level, 1e-30)[:, None]
    left = np.stack([-ahead[:, 1], ahead[:, 0]], axis=1)
    radius = 0.5 * tool.diameter
    first, last = (
        np.arcsin(np.clip((stretches.aside + side * 0.5 * width) / radius, -1.0, 1.0))
        for side in (-1, 1)
    )
    angle = first[:, None] + (last - first)[:, None] * _PLACES
    weight = np.cos(angle) ** (1.0 - material.mc)
    weight /= np.maximum(weight.sum(axis=1, keepdims=True), 1e-30)
    cosine, sine = (weight * np.cos(angle)).sum(axis=1), (weight * np.sin(angle)).sum(axis=1)
    forwards = -sine - RADIAL_SHARE * cosine
    sideways = cosine - RADIAL_SHARE * sine
    plunging = np.clip(-travel[:, 2] / length, 0.0, 1.0)
    point = tool.point_angle or 180.0
    upwards = plunging * math.sin(math.radians(0.5 * point))
    pushed = forwards[:, None] * ahead + sideways[:, None] * left
    force = np.column_stack([(1.0 - plunging)[:, None] * pushed, upwards]) * tangential[:, None]
    if stretches.axis is None:
        return force
    along_x, along_y, along_z = tool_frame(stretches.axis)
    return force[:, :1] * along_x + force[:, 1:2] * along_y + force[:, 2:] * along_z
