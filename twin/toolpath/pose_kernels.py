"""Position and direction of the tool at the end of a chain of joints, in one pass over the joints.

The rule is that of ``twin.kinematics``, which is used where programs are translated without a compiler.
"""

import math

import numpy as np

from twin.compilation.compilable import inlined
from twin.compilation.kernel import threaded_kernel
from twin.kinematics import Kinematics, ToolPoses
from twin.nc.canonical import BoolArray, FloatArray, IntArray
from twin.units import DEGREE


def tool_poses(
    chain: Kinematics, joints: FloatArray, length: float | FloatArray = 0.0
) -> ToolPoses:
    """The poses that a chain brings a tool into.

    Args:
        joints: Machine coordinates of all axes as the chain counts them, shape (n, k) [mm or deg].
        length: From what the chain calls the spindle nose to the tip, one or shape (n,) [mm].
    """
    count = len(joints)
    poses = ToolPoses(np.empty((count, 3)), np.empty((count, 3)), np.empty((count, 3)))
    values, lengths = np.ascontiguousarray(joints, np.float64), np.full(count, length, np.float64)
    carry(chain.column, chain.rotary, chain.axis, chain.anchor, chain.tool, values, lengths, poses)
    return poses


@inlined
def turned(x, y, z, ax, ay, az, cosine, sine):
    """A vector turned about an axis through the origin (Rodrigues)."""
    along = (1.0 - cosine) * (ax * x + ay * y + az * z)
    return (
        cosine * x + sine * (ay * z - az * y) + along * ax,
        cosine * y + sine * (az * x - ax * z) + along * ay,
        cosine * z + sine * (ax * y - ay * x) + along * az,
    )


@threaded_kernel
def carry(
    column: IntArray,
    rotary: BoolArray,
    axis: FloatArray,
    anchor: FloatArray,
    tool: FloatArray,
    joints: FloatArray,
    lengths: FloatArray,
    poses: ToolPoses,
) -> None:
    """Carry tools from joint to joint; the first five are columns of ``Kinematics``.

    Args:
        joints: Shape (n, k) [mm or deg].
        lengths: Of the tools, shape (n,) [mm].
        poses: Set to theirs.
    """
    tip, along_x, direction = poses
    for n in range(len(joints)):
        wx, wy, wz = tool[0], tool[1], tool[2]
        px, py, pz = -lengths[n] * wx, -lengths[n] * wy, -lengths[n] * wz
        ux, uy, uz = 1.0, 0.0, 0.0
        for joint in range(len(column)):
            value = joints[n, column[joint]]
            ax, ay, az = axis[joint, 0], axis[joint, 1], axis[joint, 2]
            if not rotary[joint]:
                px, py, pz = px + value * ax, py + value * ay, pz + value * az
                continue
            cosine, sine = math.cos(value * DEGREE), math.sin(value * DEGREE)
            cx, cy, cz = anchor[joint, 0], anchor[joint, 1], anchor[joint, 2]
            px, py, pz = turned(px - cx, py - cy, pz - cz, ax, ay, az, cosine, sine)
            px, py, pz = px + cx, py + cy, pz + cz
            ux, uy, uz = turned(ux, uy, uz, ax, ay, az, cosine, sine)
            wx, wy, wz = turned(wx, wy, wz, ax, ay, az, cosine, sine)
        tip[n, 0], tip[n, 1], tip[n, 2] = px, py, pz
        along_x[n, 0], along_x[n, 1], along_x[n, 2] = ux, uy, uz
        direction[n, 0], direction[n, 1], direction[n, 2] = wx, wy, wz
