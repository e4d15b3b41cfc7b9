"""How the axes of a machine carry the tool against the part: a chain of joints, as arrays.

The chain leads from the tool over the machine's base to the part. Every joint is reported as the motion of
the tool against the part that a positive machine coordinate brings (ISO 841), whether it carries the one
or the other, so that one rule holds for tables and heads: a point of the tool is moved by one joint after
the other, each about or along where that joint lies with all axes at zero (product of exponentials, Brockett
1984; Lynch and Park, Modern Robotics, chapter 4). What results is where the point is, seen from the part.

All is in the machine's frame: its axes are the directions of X, Y and Z, its origin is the spindle nose
with all axes at zero. The part's frame here is fixed to the part and is the machine's while all axes are at zero.
"""

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from twin.units import DEGREE

_Floats = npt.NDArray[np.float64]


class Kinematics(NamedTuple):
    """m joints between tool and part, from the tool to the part; arrays, so that kernels take it as it is.

    Attributes:
        column: Column of the axis of each joint, shape (m,).
        rotary: Whether it turns, shape (m,).
        on_tool: Whether it carries the tool; else the part, shape (m,).
        axis: Unit vector along which, or about which, it moves the tool against the part, shape (m, 3).
        anchor: A point on its axis with all axes at zero, shape (m, 3) [mm]; of linear axes zeros.
        tool: Unit vector from the tip of the tool to the spindle with all axes at zero, shape (3,).
        table: Middle of the work-holding surface with all axes at zero, shape (3,) [mm].
        table_axes: Directions of the surface's own x, y and z with all axes at zero, as columns, shape (3, 3).
    """

    column: npt.NDArray[np.int64]
    rotary: npt.NDArray[np.bool_]
    on_tool: npt.NDArray[np.bool_]
    axis: _Floats
    anchor: _Floats
    tool: _Floats
    table: _Floats
    table_axes: _Floats


class ToolPoses(NamedTuple):
    """A tool in n places, seen from the part.

    Attributes:
        tip: Shape (n, 3) [mm].
        along_x: Direction of machine X on the tool, which turns with a head, shape (n, 3).
        axis: Direction from the tip of the tool to the spindle, shape (n, 3).
    """

    tip: _Floats
    along_x: _Floats
    axis: _Floats


def tool_point(chain: Kinematics, joints: _Floats, length: float | _Floats = 0.0) -> _Floats:
    """Where a point on the axis of the tool is, seen from the part.

    Args:
        joints: Machine coordinates of all axes, shape (n, k) [mm or deg].
        length: From the spindle nose to the point, one or shape (n,) [mm].

    Returns:
        Shape (n, 3) [mm].
    """
    points = np.broadcast_to(length, len(joints))[:, None] * -chain.tool
    for joint in range(len(chain.column)):
        value = joints[:, chain.column[joint], None]
        if chain.rotary[joint]:
            anchor = chain.anchor[joint]
            points = turned(points - anchor, chain.axis[joint], value) + anchor
        else:
            points = points + value * chain.axis[joint]
    return points


def tool_direction(chain: Kinematics, joints: _Floats) -> _Floats:
    """Direction from the tip of the tool to the spindle, seen from the part.

    Returns:
        Unit vectors, shape (n, 3).
    """
    return rotated(chain, np.tile(chain.tool, (len(joints), 1)), joints)


def rotated(chain: Kinematics, vectors: _Floats, joints: _Floats, after: int = -1) -> _Floats:
    """Directions that are fixed to the tool, or to what a joint carries, seen from the part.

    Args:
        vectors: In the machine's frame with all axes at zero, shape (n, 3).
        joints: Shape (n, k) [mm or deg].
        after: Joint beyond which the chain turns them; -1: all of it does.
    """
    for joint in np.flatnonzero(chain.rotary):
        if joint <= after:
            continue
        vectors = turned(vectors, chain.axis[joint], joints[:, chain.column[joint], None])
    return vectors


def with_rotary_at_rest(
    chain: Kinematics, joints: _Floats, length: float | _Floats = 0.0
) -> tuple[_Floats, _Floats]:
    """Where X, Y and Z carry the tip of a tool while the rotary axes stand still.

    Args:
        joints: Where the rotary axes stand, shape (n, k) [deg]; X, Y and Z are not looked at.
        length: From the spindle nose to the tip, one or shape (n,) [mm].

    Returns:
        The tip with X, Y and Z at zero, shape (n, 3) [mm], and what a millimetre of each moves it by, as
        columns, shape (n, 3, 3).
    """
    still = joints.copy()
    still[:, :3] = 0.0
    steps = np.zeros((len(joints), 3, 3))
    for joint in np.flatnonzero(~chain.rotary & (chain.column < 3)).tolist():
        along = np.tile(chain.axis[joint], (len(joints), 1))
        steps[:, :, chain.column[joint]] = rotated(chain, along, joints, after=joint)
    return tool_point(chain, still, length), steps


def counted_from(chain: Kinematics, zero: _Floats, length: float) -> Kinematics:
    """The chain of a part that was measured with a tool while the rotary axes were at a part zero.

    Its frame is that of the machine while the axes that turn the part are there: their joints have
    the places that they have then, and their coordinates count from there. Its origin is the tip of the tool with X, Y
    and Z at zero.

    Args:
        zero: Coordinates of the axes that turn the part, shape (k,) [deg]; others are not looked at.
        length: From the spindle nose to the tip of the tool [mm].
    """
    axis, anchor, axes = chain.axis.copy(), chain.anchor.copy(), chain.table_axes.T
    table = chain.table[None]
    for joint in reversed(np.flatnonzero(turns_part(chain)).tolist()):
        back = np.array([[-zero[chain.column[joint]]]])
        about, through, later = chain.axis[joint], chain.anchor[joint], slice(joint + 1, None)
        axis[later] = turned(axis[later], about, back)
        anchor[later] = turned(anchor[later] - through, about, back) + through
        table = turned(table - through, about, back) + through
        axes = turned(axes, about, back)
    up = length * chain.tool
    anchor[chain.rotary] += up
    return chain._replace(axis=axis, anchor=anchor, table=table[0] + up, table_axes=axes.T)


def turns_part(chain: Kinematics) -> npt.NDArray[np.bool_]:
    """Which joints turn the part, shape (m,)."""
    return chain.rotary & ~chain.on_tool


def is_turntable(chain: Kinematics) -> bool:
    """Whether X, Y and Z carry tool and part, and at most one table turns the part about Z."""
    if not chain.rotary.any():
        return True
    return bool(
        chain.rotary[-1]
        and chain.rotary.sum() == 1
        and not chain.on_tool[-1]
        and np.array_equal(chain.axis[-1], (0.0, 0.0, 1.0))
    )


def turned(vectors: _Floats, axis: _Floats, angle: _Floats) -> _Floats:
    """Vectors turned about an axis through the origin (Rodrigues).

    Args:
        vectors: Shape (n, 3).
        axis: Unit vector, shape (3,).
        angle: Shape (n, 1) [deg].
    """
    cosine, sine = np.cos(angle * DEGREE), np.sin(angle * DEGREE)
    along = (vectors @ axis)[:, None] * axis
    return along + cosine * (vectors - along) + sine * np.cross(axis, vectors)
