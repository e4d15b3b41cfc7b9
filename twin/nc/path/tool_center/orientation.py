"""Rotary axes that point the tool in a direction of the part."""

import math
from itertools import product

import numpy as np

from twin.kinematics import Kinematics, turned
from twin.nc.canonical import FloatArray

_SAME = 1e-9
"""Directions, of unit length, that differ by no more are the same."""

_ON_AXIS = 1e-12
"""What is nearer to an axis of unit vectors is on it: rounding alone."""

_SAME_ANGLE = 1e-7
"""Angles [deg]."""

_DIGITS = 9
"""Of angles, behind the point: finer than any control counts."""


def rotary_axes_for(
    chain: Kinematics,
    direction: FloatArray,
    here: FloatArray,
    travel: FloatArray,
    sense: float = 0.0,
    *,
    only: bool = False,
    main: float = 0.0,
) -> FloatArray:
    """Where the rotary axes point the tool in a direction.

    Decision: of the solutions within the travel that one counts to which the axes go least, all of them together;
    of two that are as far, the one in which the axis nearest to the tool is at the greater angle. An axis
    that changes nothing of the direction stays.

    Args:
        direction: From the tip to the spindle, seen from the part, unit vector, shape (3,).
        here: Where the axes are, as the chain counts them, shape (k,) [mm or deg].
        travel: Of each axis, as the chain counts them, shape (k, 2) [mm or deg]; of endless axes infinite.
        sense: Sign of the axis next to the tool that is preferred; 0: none is.
        only: A solution with another sign is none.
        main: 1: the one whose main axis is nearest to zero by less than a turn, -1: farthest from it, 0: either. The main axis carries the
            other one: of a head the one farthest from the tool, else the one farthest from the part.

    Returns:
        ``here`` with the rotary axes put in, shape (k,).

    Raises:
        ValueError: No rotary axes of this machine do, within their travel.
    """
    joints = np.flatnonzero(chain.rotary).tolist()
    found = [
        row
        for angles in _solutions(chain, joints, direction, here)
        for row in _within_travel(chain, joints, angles, here, travel)
    ]
    first = int(chain.column[joints[0]]) if joints else 0
    if only:
        found = [row for row in found if float(row[first]) * sense >= -_SAME_ANGLE]
    if not found:
        x, y, z = direction
        signed = " with that sign of their first one" if only else ""
        raise ValueError(
            f"the machine's rotary axes do not point the tool along {x:.4g}, {y:.4g}, {z:.4g} of the part{signed}"
        )

    heads = [joint for joint in joints if chain.on_tool[joint]]
    carrier = int(chain.column[heads[-1]]) if heads else first

    def cost(row: FloatArray) -> tuple[bool, float, float, float]:
        travel = round(float(np.abs(row - here).sum()) / _SAME_ANGLE)
        off = round(main * abs(math.remainder(float(row[carrier]), 360.0)) / _SAME_ANGLE)
        return (float(row[first]) * sense < -_SAME_ANGLE, off, travel, -float(row[first]))

    return min(found, key=cost)


def _solutions(
    chain: Kinematics, joints: list[int], direction: FloatArray, here: FloatArray
) -> list[list[float]]:
    """Angles of the rotary joints within a turn [deg], those next to the tool first."""
    tool = chain.tool
    now = [float(here[chain.column[joint]]) for joint in joints]
    if len(joints) > 2:
        raise ValueError("planes are tilted by two rotary axes at most")
    axes = [chain.axis[joint] for joint in joints]
    if not axes:
        return [[]] if _same(tool, direction) else []
    if len(axes) == 1:
        if _same(_about(tool, axes[0], now[0]), direction):
            return [now]
        angle = _angle_about(axes[0], tool, direction)
        return [] if angle is None else [[angle]]
    return _two_axes(axes[0], axes[1], tool, direction, now)


def _two_axes(
    inner: FloatArray, outer: FloatArray, tool: FloatArray, goal: FloatArray, now: list[float]
) -> list[list[float]]:
    """Turns about the inner axis, then the outer one, that bring the tool to the goal.

    Paden and Kahan's second problem (Murray, Li and Sastry, A Mathematical Introduction to Robotic
    Manipulation, 3.3): both circles meet in two directions at most.
    """
    cosine = float(outer @ inner)
    if 1.0 - abs(cosine) < _SAME:
        return []
    found: list[list[float]] = []
    height, share = float(outer @ goal), math.sqrt(1.0 - cosine * cosine)
    # The distance from the outer axis by the vector itself: next to the axis its sine by the cosine is lost in rounding.
    distance = float(np.linalg.norm(goal - height * outer))
    toward = (float(inner @ tool) - cosine * height) / share
    if abs(toward) > distance + _SAME:
        return []
    toward = min(distance, max(-distance, toward))
    aside = math.sqrt(distance * distance - toward * toward)
    first_side, second_side = (inner - cosine * outer) / share, np.cross(outer, inner) / share
    for sign in (1.0, -1.0):
        between = height * outer + toward * first_side + sign * aside * second_side
        first, second = _angle_about(inner, tool, between), _angle_about(outer, between, goal)
        if first is None:
            first = now[0]
        found.append([first, now[1] if second is None else second])
    return found


def _angle_about(axis: FloatArray, start: FloatArray, goal: FloatArray) -> float | None:
    """The turn about an axis that brings one vector to another [deg]; None where any or none does."""
    from_axis, to_axis = start - (axis @ start) * axis, goal - (axis @ goal) * axis
    if min(np.linalg.norm(from_axis), np.linalg.norm(to_axis)) < _ON_AXIS:
        return None
    if abs(float(axis @ (start - goal))) > _SAME:
        return None
    sine, cosine = float(axis @ np.cross(from_axis, to_axis)), float(from_axis @ to_axis)
    return math.degrees(math.atan2(sine, cosine))


def _within_travel(
    chain: Kinematics, joints: list[int], angles: list[float], here: FloatArray, travel: FloatArray
) -> list[FloatArray]:
    """A solution by whole turns nearest to where the axes are, and those one turn off, within the travel."""
    choices = []
    for joint, angle in zip(joints, angles, strict=True):
        column = int(chain.column[joint])
        near = round(angle + 360.0 * round((float(here[column]) - angle) / 360.0), _DIGITS)
        low, high = travel[column] + (-_SAME_ANGLE, _SAME_ANGLE)
        choices.append([each for each in (near, near - 360.0, near + 360.0) if low <= each <= high])
    rows = []
    for chosen in product(*choices):
        row = here.copy()
        row[chain.column[joints]] = chosen
        rows.append(row)
    return rows


def _about(vector: FloatArray, axis: FloatArray, angle: float) -> FloatArray:
    return turned(vector[None], axis, np.array([[angle]]))[0]


def _same(left: FloatArray, right: FloatArray) -> bool:
    return bool(np.linalg.norm(left - right) < _SAME)
