"""Tool centre point control: X, Y and Z say where the tip is in the part, while rotary axes turn it or the tool.

A move that turns an axis becomes curves: parts short enough for one polynomial of the fifth degree for each
axis, which has the place, the first and the second derivative of the true path at both ends (Hermite).
Along a part its error is at most ``h^6 / 46080`` times the sixth derivative. So the tip is on the programmed
line or arc at every instant, whatever lies between two blocks, and the planner keeps every axis' limits.
"""

import dataclasses
import math
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from twin.kinematics import (
    Kinematics,
    counted_from,
    rotated,
    tool_direction,
    tool_point,
    turned,
    turns_part,
)
from twin.nc.canonical import Corner, FloatArray
from twin.nc.geometry.matrices import Matrix
from twin.nc.geometry.planes import Vector
from twin.nc.path.move_columns import Curve, Segment
from twin.nc.path.moves import arc_length, line_length
from twin.nc.path.orientation import rotary_axes_for
from twin.units import DEGREE

TIP_ERROR = 1e-10
"""How far the tip may leave its path between two places where it is exact [mm]."""

FARTHEST_TURN = 36_000.0
"""What an axis may turn in one move of a tip that is led [deg]: beyond it, it is a slip of the pen."""

_HERMITE = 46080.0
"""``6! 2^6``: what the error of a polynomial of the fifth degree through both ends is divided by."""

_SINGULAR = 1e-6
"""Volume that the directions of X, Y and Z span, below which they leave the tip a direction short."""

_SQUARE = 1e-12


class Setup(NamedTuple):
    """A part on a machine.

    Attributes:
        chain: The machine's joints.
        zero: Machine coordinates of program zero, shape (k,) [mm or deg].
        length: Of the first tool, with which it was measured [mm].
        travel: Of each axis, machine coordinates, shape (k, 2) [mm or deg]; of endless axes infinite.
    """

    chain: Kinematics
    zero: FloatArray
    length: float
    travel: FloatArray


class _Motion(NamedTuple):
    """Values at n places with their first and second derivatives by the path fraction, shape (n, 3) each."""

    value: FloatArray
    first: FloatArray
    second: FloatArray


class ToolCenter:
    """From the tip in the part to the axes and back, in part coordinates.

    The tip's coordinates are those of a frame that is fixed to the part, and parallel to the machine's while
    the axes that turn the part are at their zero of the work offset.
    """

    def __init__(
        self,
        setup: Setup,
        length_difference: float,
        rotary_zero: list[float],
        *,
        tilted: bool = False,
    ) -> None:
        """Control the tip of a tool.

        Args:
            setup: The part on the machine.
            length_difference: How much longer than the first the tool is [mm].
            rotary_zero: Where the work offset puts the zeros of the axes, part coordinates, shape (k,); of the
                linear ones it is not looked at.
            tilted: The tool stands across a tilted plane: no rotary axis may move.
        """
        self.tilted = tilted
        self._setup, self.length_difference, self.rotary_zero = (
            setup,
            length_difference,
            list(rotary_zero),
        )
        self._zero = np.asarray(setup.zero, np.float64)
        counted = np.zeros(len(self._zero))
        columns = setup.chain.column[turns_part(setup.chain)]
        counted[columns] = self._zero[columns] + np.array(rotary_zero)[columns]
        self._counted_zero = self._zero - counted
        self._chain = counted_from(setup.chain, counted, setup.length)
        self._seen_from_part = np.eye(3)
        if np.any(np.array(rotary_zero)[columns]):
            # The part's frame is parallel to the machine's axes at part zero, not at the work offset's.
            shifted = [0.0, 0.0, 0.0, *rotary_zero[3:]]
            level = [0.0] * len(rotary_zero)
            self._seen_from_part = ToolCenter(setup, length_difference, level).frame_there(shifted)

    def with_length(self, length_difference: float) -> "ToolCenter":
        """The same for a tool of another length."""
        return ToolCenter(self._setup, length_difference, self.rotary_zero, tilted=self.tilted)

    def with_zero(self, rotary_zero: list[float]) -> "ToolCenter":
        """The same with other zeros of the axes; itself where no rotary axis has another one."""
        if rotary_zero[3:] == self.rotary_zero[3:]:
            return self
        return ToolCenter(self._setup, self.length_difference, rotary_zero, tilted=self.tilted)

    def tip(self, axes: list[float]) -> list[float]:
        """Where the tip is while the axes are at a place, with the rotary axes as they are, shape (k,)."""
        joints = np.array([axes]) + self._counted_zero
        place = tool_point(self._chain, joints, self.length_difference)[0] - self._zero[:3]
        return [*place.tolist(), *axes[3:]]

    def direction(self, axes: list[float]) -> FloatArray:
        """Which way the tool points from its tip to the spindle, seen from the part, shape (3,)."""
        return tool_direction(self._chain, np.array([axes]) + self._counted_zero)[0]

    def pointing(
        self, direction: Vector, axes: list[float], sense: float = 0.0, *, only: bool = False
    ) -> list[float]:
        """Where the rotary axes point the tool in a direction of the part, the others as they are, shape (k,).

        Args:
            direction: The direction.
            axes: Where the axes are.
            sense: Sign of the axis next to the tool that is preferred; 0: whatever is nearest.
            only: A solution with another sign is none.

        Raises:
            ValueError: None do, within their travel (``orientation``).
        """
        offset = self._counted_zero
        travel = self._setup.travel - (self._zero - offset)[:, None]
        here = np.array(axes) + offset
        goal = np.array(direction)
        found = rotary_axes_for(self._chain, goal, here, travel, sense, only=only)
        return (found - offset).tolist()

    def axes(self, tip: list[float]) -> list[float]:
        """Where the axes bring the tip to a place; the inverse of ``tip``.

        Raises:
            ValueError: With the rotary axes there X, Y and Z do not reach every point.
        """
        point = np.array([tip])
        still = _Motion(point[:, :3], np.zeros((1, 3)), np.zeros((1, 3)))
        return [*self._solved(still, point, np.zeros(len(tip))).value[0].tolist(), *tip[3:]]

    def frame_there(self, axes: list[float]) -> FloatArray:
        """Directions of the machine's X, Y and Z as the part sees them, as columns, shape (3, 3)."""
        _, steps = self._carried(np.array([axes]), np.zeros(len(axes)))
        return np.stack([step.value[0] for step in steps], axis=1)

    def tool_frame(self, axes: list[float]) -> FloatArray:
        """Directions of X, Y and Z of the spindle, which its rotary axes carry, as the part sees them; as columns."""
        joints = np.tile(np.array(axes) + self._counted_zero, (3, 1))
        return rotated(self._chain, np.eye(3), joints).T

    def moves_of(self, move: Segment) -> Iterator[Segment]:
        """What the axes do for a move of the tip.

        Raises:
            ValueError: Somewhere on it X, Y and Z do not reach every point.
        """
        rates = np.array(move.end) - np.array(move.start)
        turning = self._chain.column[self._chain.rotary]
        if self.tilted and np.any(rates[turning]):
            raise ValueError("a rotary axis would move, and the tool stands across a tilted plane")
        if np.abs(rates[turning]).max(initial=0.0) > FARTHEST_TURN:
            raise ValueError("the tip is led through 100 turns of an axis at most")
        if not np.any(rates[turning]):
            straight = self._at_rest(move)
            if straight is not None:
                yield straight
                return
        yield from self._curves(move, rates)

    # --- rotary axes at rest

    def _at_rest(self, move: Segment) -> Segment | None:
        """A move while no rotary axis moves: turned as a whole; None where X, Y, Z are not at right angles."""
        frame = self.frame_there(move.start)
        if np.abs(frame.T @ frame - np.eye(3)).max() > _SQUARE:
            return None
        center, normal, level = move.center, move.normal, np.array_equal(frame, np.eye(3))
        if center is not None:
            there = self.axes([*center, *move.start[3:]])
            center, normal = _vector(there), _vector(frame.T @ np.array(normal))
        return dataclasses.replace(
            move,
            start=self.axes(move.start),
            end=self.axes(move.end),
            center=center,
            normal=normal,
            screen=move.screen if level else _screen(move, frame),
        )

    # --- rotary axes in motion

    def _curves(self, move: Segment, rates: FloatArray) -> Iterator[Segment]:
        length = _length(move)
        turning = length == 0.0
        if turning:
            others = rates[3:]
            length = math.sqrt(float(others @ others))
        count = self._parts(move, rates)
        fraction = np.linspace(0.0, 1.0, count + 1)
        places = np.array(move.start) + fraction[:, None] * rates
        places[-1] = move.end
        tip = _tip_motion(move, fraction)
        places[:, :3] = tip.value
        places[-1, :3] = move.end[:3]
        axes = self._solved(tip, places, rates)
        step, rows = 1.0 / count, places.copy()
        rows[:, :3] = axes.value
        coefficients = np.zeros((count, len(rates), 5))
        coefficients[:, 3:, 0] = np.diff(rows[:, 3:], axis=0)
        coefficients[:, :3] = _hermite(axes.value, axes.first * step, axes.second * step * step)
        matrix = np.eye(3) if move.screen is None else np.array(move.screen)
        shown = places - places[-1]
        shown[:, :3] = shown[:, :3] @ matrix.T
        shown += move.display
        screen = _screen(move, self._seen_from_part.T)
        advance = _advance(move)
        for part in range(count):
            last = part + 1 == count
            center = None
            if move.center is not None:
                height = advance * fraction[part]
                from_tip = np.array(move.center) + height * np.array(move.normal) - tip.value[part]
                center = _vector(self._seen_from_part @ from_tip)
            yield dataclasses.replace(
                move,
                start=rows[part].tolist(),
                end=rows[part + 1].tolist(),
                display=shown[part + 1].tolist(),
                corner=move.corner if last else Corner.EXACT_PATH,
                center=center,
                normal=_vector(self._seen_from_part @ np.array(move.normal)),
                sweep=move.sweep * step,
                curve=Curve(coefficients[part], length * step, turning),
                screen=screen,
            )

    def _parts(self, move: Segment, rates: FloatArray) -> int:
        """Into how many parts a move is cut so that none leaves its path by more than ``TIP_ERROR``."""
        turning = self._chain.column[self._chain.rotary]
        angle = math.radians(float(np.abs(rates[turning]).sum()) + abs(move.sweep))
        far = self._zero[:3] - self._chain.anchor[self._chain.rotary]
        ends = np.array([move.start[:3], move.end[:3]])
        reach = np.linalg.norm(ends[:, None] + far[None], axis=2).max(initial=0.0)
        if move.center is not None:
            reach += 2.0 * math.dist(move.start[:3], move.center)
        # Of a product of sines and a straight line: the sines' own, and six times the line's share.
        bound = (reach + abs(self.length_difference) + 6.0 * math.dist(*ends.tolist())) / (
            _HERMITE * TIP_ERROR
        )
        return max(1, math.ceil(angle * bound ** (1.0 / 6.0)))

    def _solved(self, tip: _Motion, places: FloatArray, rates: FloatArray) -> _Motion:
        """X, Y and Z that bring the tip along its path, with their derivatives by the path fraction.

        Args:
            tip: The path.
            places: Rotary axes and all further ones along it, shape (n, k); X, Y and Z are not looked at.
            rates: How they go with the fraction, shape (k,).
        """
        rest, steps = self._carried(places, rates)
        matrix, matrix_first, matrix_second = (
            np.stack([getattr(step, name) for step in steps], axis=2) for name in _Motion._fields
        )
        if np.any(np.abs(np.linalg.det(matrix)) < _SINGULAR):
            raise ValueError("with the rotary axes there X, Y and Z do not reach every point")
        inverse = np.linalg.inv(matrix)

        def times(matrices: FloatArray, vectors: FloatArray) -> FloatArray:
            return np.einsum("nij,nj->ni", matrices, vectors)

        value = times(inverse, tip.value + self._zero[:3] - rest.value)
        first = times(inverse, tip.first - rest.first - times(matrix_first, value))
        bent = times(matrix_second, value) + 2.0 * times(matrix_first, first)
        second = times(inverse, tip.second - rest.second - bent)
        return _Motion(value - self._counted_zero[:3], first, second)

    def _carried(self, places: FloatArray, rates: FloatArray) -> tuple[_Motion, list[_Motion]]:
        """The tip with X, Y and Z at zero, and what a millimetre of each moves it by."""
        chain, count = self._chain, len(places)
        joints = places + self._counted_zero
        none = np.zeros((count, 3))
        point = _Motion(np.tile(-self.length_difference * chain.tool, (count, 1)), none, none)
        steps: list[_Motion] = [point] * 3
        begun: list[int] = []
        for joint, column in enumerate(chain.column.tolist()):
            axis = chain.axis[joint]
            if chain.rotary[joint]:
                angle, rate = joints[:, column, None], float(rates[column]) * DEGREE
                anchor = chain.anchor[joint]
                moved = _turned(point._replace(value=point.value - anchor), axis, angle, rate)
                point = moved._replace(value=moved.value + anchor)
                for each in begun:
                    steps[each] = _turned(steps[each], axis, angle, rate)
            elif column < 3:
                steps[column] = _Motion(np.tile(axis, (count, 1)), none, none)
                begun.append(column)
            else:
                along = joints[:, column, None] * axis
                point = point._replace(
                    value=point.value + along, first=point.first + rates[column] * axis
                )
        return point, steps


def _turned(motion: _Motion, axis: FloatArray, angle: FloatArray, rate: float) -> _Motion:
    """Vectors in motion, turned about an axis through the origin that turns evenly [deg, rad by fraction]."""
    value, first, second = (turned(each, axis, angle) for each in motion)
    across = np.cross(axis, value)
    return _Motion(
        value,
        first + rate * across,
        second + 2.0 * rate * np.cross(axis, first) + rate * rate * np.cross(axis, across),
    )


def _hermite(value: FloatArray, first: FloatArray, second: FloatArray) -> FloatArray:
    """Polynomials of the fifth degree between n + 1 places, coefficients by powers 1 to 5, shape (n, 3, 5)."""
    change = np.diff(value, axis=0)
    v, w, a, b = first[:-1], first[1:], second[:-1], second[1:]
    return np.stack(
        [
            v,
            0.5 * a,
            10.0 * change - 6.0 * v - 4.0 * w - 1.5 * a + 0.5 * b,
            -15.0 * change + 8.0 * v + 7.0 * w + 1.5 * a - b,
            6.0 * change - 3.0 * (v + w) - 0.5 * (a - b),
        ],
        axis=2,
    )


def _tip_motion(move: Segment, fraction: FloatArray) -> _Motion:
    """The tip's path at fractions of a move, as ``canonical`` says it."""
    start, end = np.array(move.start[:3]), np.array(move.end[:3])
    u = fraction[:, None]
    if move.center is None:
        way = end - start
        value = start + u * way
        return _Motion(value, np.tile(way, (len(u), 1)), np.zeros_like(value))
    center, normal, sweep = np.array(move.center), np.array(move.normal), math.radians(move.sweep)
    arm, lead = start - center, _advance(move) * normal
    cosine, sine = np.cos(sweep * u), np.sin(sweep * u)
    across = np.cross(normal, arm)
    around, along = cosine * arm + sine * across, cosine * across - sine * arm
    # What rounding leaves between the arc's end and the move's is spread evenly, as in ``toolpath.geometry``.
    miss = end - (center + math.cos(sweep) * arm + math.sin(sweep) * across + lead)
    return _Motion(
        center + around + u * (lead + miss), sweep * along + lead + miss, -sweep * sweep * around
    )


def _advance(move: Segment) -> float:
    if move.center is None:
        return 0.0
    return sum((move.end[axis] - move.start[axis]) * move.normal[axis] for axis in range(3))


def _length(move: Segment) -> float:
    """Of the tip's way in the part [mm]."""
    if move.center is None:
        return line_length(move.start[:3], list(move.end[:3]))
    return arc_length(move.start, move.end, move.center, move.normal, move.sweep)


def _screen(move: Segment, frame: FloatArray) -> Matrix:
    """What a move whose X, Y and Z are reported in another frame adds to what the screen shows (``Segment.screen``)."""
    rows = frame if move.screen is None else np.array(move.screen) @ frame
    return (_vector(rows[0]), _vector(rows[1]), _vector(rows[2]))


def _vector(values: FloatArray | list[float]) -> Vector:
    x, y, z = (float(value) for value in values[:3])
    return (x, y, z)
