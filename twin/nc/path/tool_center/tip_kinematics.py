"""Where the tip of a tool is while axes move, and how X, Y and Z have to move for it: place and two derivatives."""

from typing import NamedTuple

import numpy as np

from twin.kinematics import Kinematics, tool_direction, tool_point, turned
from twin.nc.canonical import FloatArray
from twin.nc.path.tool_center.tip_path import PathMotion
from twin.units import DEGREE

_SINGULAR = 1e-6
"""Volume that the directions of X, Y and Z span, below which they leave the tip a direction short."""


class TipKinematics(NamedTuple):
    """The axes of a machine and the tip of its tool.

    Attributes:
        zero: Machine coordinates of program zero, shape (k,) [mm or deg].
        counted_zero: The same as the chain counts them: the axes that turn the part from the work offset's zeros.
        length_difference: How much longer than the first the tool is [mm].
    """

    chain: Kinematics
    zero: FloatArray
    counted_zero: FloatArray
    length_difference: float

    def tip(self, axes: FloatArray) -> FloatArray:
        """Where the tip is at n places of the axes, shapes (n, k) and (n, 3)."""
        joints = axes + self.counted_zero
        return tool_point(self.chain, joints, self.length_difference) - self.zero[:3]

    def direction(self, axes: FloatArray) -> FloatArray:
        """Direction from the tip of the tool to the spindle, seen from the part, shapes (n, k) and (n, 3)."""
        return tool_direction(self.chain, axes + self.counted_zero)

    def linear_axes_for(self, tip: PathMotion, axes: PathMotion) -> PathMotion:
        """X, Y and Z that bring the tip along its path, with their derivatives by the path fraction.

        Args:
            axes: Rotary axes and all further ones along it, shape (n, k) each; X, Y and Z are not looked at.

        Raises:
            ValueError: With the rotary axes there X, Y and Z do not reach every point.
        """
        rest, steps = self.carried(axes)
        matrix, matrix_first, matrix_second = (
            np.stack([getattr(step, name) for step in steps], axis=2) for name in PathMotion._fields
        )
        if np.any(np.abs(np.linalg.det(matrix)) < _SINGULAR):
            raise ValueError("with the rotary axes there X, Y and Z do not reach every point")
        inverse = np.linalg.inv(matrix)

        def times(matrices: FloatArray, vectors: FloatArray) -> FloatArray:
            return np.einsum("nij,nj->ni", matrices, vectors)

        value = times(inverse, tip.value + self.zero[:3] - rest.value)
        first = times(inverse, tip.first - rest.first - times(matrix_first, value))
        bent = times(matrix_second, value) + 2.0 * times(matrix_first, first)
        second = times(inverse, tip.second - rest.second - bent)
        return PathMotion(value - self.counted_zero[:3], first, second)

    def carried(self, axes: PathMotion) -> tuple[PathMotion, list[PathMotion]]:
        """The tip with X, Y and Z at zero, and what a millimetre of each moves it by."""
        chain, count = self.chain, len(axes.value)
        joints = axes.value + self.counted_zero
        none = np.zeros((count, 3))
        point = PathMotion(np.tile(-self.length_difference * chain.tool, (count, 1)), none, none)
        steps: list[PathMotion] = [point] * 3
        begun: list[int] = []
        for joint, column in enumerate(chain.column.tolist()):
            axis = chain.axis[joint]
            value, first, second = (
                each[:, column, None] for each in (joints, axes.first, axes.second)
            )
            if chain.rotary[joint]:
                angle = PathMotion(value, first * DEGREE, second * DEGREE)
                anchor = chain.anchor[joint]
                moved = _turned(point._replace(value=point.value - anchor), axis, angle)
                point = moved._replace(value=moved.value + anchor)
                for each in begun:
                    steps[each] = _turned(steps[each], axis, angle)
            elif column < 3:
                steps[column] = PathMotion(np.tile(axis, (count, 1)), none, none)
                begun.append(column)
            else:
                point = PathMotion(
                    point.value + value * axis,
                    point.first + first * axis,
                    point.second + second * axis,
                )
        return point, steps


def still(value: FloatArray) -> PathMotion:
    """Places at which nothing moves."""
    return PathMotion(value, np.zeros_like(value), np.zeros_like(value))


def _turned(motion: PathMotion, axis: FloatArray, angle: PathMotion) -> PathMotion:
    """Vectors in motion, turned about an axis through the origin by an angle [deg] in motion [rad]."""
    value, first, second = (turned(each, axis, angle.value) for each in motion)
    across, rate = np.cross(axis, value), angle.first
    return PathMotion(
        value,
        first + rate * across,
        second
        + 2.0 * rate * np.cross(axis, first)
        + rate * rate * np.cross(axis, across)
        + angle.second * across,
    )
