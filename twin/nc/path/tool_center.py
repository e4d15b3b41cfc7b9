"""Tool centre point control: X, Y and Z say where the tip is in the part, while rotary axes turn it or the tool.

A move that turns an axis becomes curves: parts short enough for one polynomial of the fifth degree for each
axis, which has the place, the first and the second derivative of the true path at both ends (Hermite).
Along a part its error is at most ``h^6 / 46080`` times the sixth derivative. So the tip is on the programmed
line or arc at every instant, whatever lies between two blocks, and the planner keeps every axis' limits.
"""

import dataclasses
import functools
import math
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

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
from twin.nc.geometry.planes import Vector
from twin.nc.path.great_circle import Turning, TwoAxes
from twin.nc.path.move_columns import Curve, Segment
from twin.nc.path.orientation import rotary_axes_for
from twin.nc.path.tip_path import (
    PathMotion,
    advance_of,
    hermite,
    length_of,
    part_of,
    screen_from,
    screen_matrix,
    tip_motion,
    vector,
)
from twin.units import DEGREE

TIP_ERROR = 1e-10
"""How far the tip may leave its path between two places where it is exact [mm]."""

FARTHEST_TURN = 36_000.0
"""What an axis may turn in one move of a tip that is led [deg]: beyond it, it is a slip of the pen."""

DIRECTION_ERROR = 1e-8
"""How far the direction may leave the plane that it turns in [rad]."""

MOST_PARTS = 20_000
"""Into which a move is cut."""

_PROBES = (0.25, 0.5, 0.75)
"""Fractions of a part at which it is looked at."""

_HERMITE = 46080.0
"""``6! 2^6``: what the error of a polynomial of the fifth degree through both ends is divided by."""

_SINGULAR = 1e-6
"""Volume that the directions of X, Y and Z span, below which they leave the tip a direction short."""

_SQUARE = 1e-12


class Setup(NamedTuple):
    """A part on a machine.

    Attributes:
        zero: Machine coordinates of program zero, shape (k,) [mm or deg].
        length: Of the first tool, with which it was measured [mm].
        travel: Of each axis, machine coordinates, shape (k, 2) [mm or deg]; of endless axes infinite.
    """

    chain: Kinematics
    zero: FloatArray
    length: float
    travel: FloatArray


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
        self._travel = setup.travel - (self._zero - self._counted_zero)[:, None]
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

    @functools.cached_property
    def _two_axes(self) -> TwoAxes | None:
        """What turns a direction in a plane; None: a single axis across the tool, which does so anyway."""
        axes = self._chain.axis[self._chain.rotary]
        if len(axes) == 1 and abs(float(axes[0] @ self._chain.tool)) < _SQUARE:
            return None
        return TwoAxes(self._chain, self._travel)

    def tip(self, axes: list[float]) -> list[float]:
        """Where the tip is while the axes are at a place, with the rotary axes as they are, shape (k,)."""
        joints = np.array([axes]) + self._counted_zero
        place = tool_point(self._chain, joints, self.length_difference)[0] - self._zero[:3]
        return [*place.tolist(), *axes[3:]]

    def direction(self, axes: list[float]) -> FloatArray:
        """Which way the tool points from its tip to the spindle, seen from the part, shape (3,)."""
        return tool_direction(self._chain, np.array([axes]) + self._counted_zero)[0]

    def pointing(
        self,
        direction: Vector,
        axes: list[float],
        sense: float = 0.0,
        *,
        only: bool = False,
        main: float = 0.0,
    ) -> list[float]:
        """Where the rotary axes point the tool in a direction of the part, the others as they are, shape (k,).

        Args:
            sense: Sign of the axis next to the tool that is preferred; 0: whatever is nearest.
            only: A solution with another sign is none.
            main: As for ``rotary_axes_for``.

        Raises:
            ValueError: None do, within their travel (``orientation``).
        """
        offset = self._counted_zero
        here, goal = np.array(axes) + offset, np.array(direction)
        found = rotary_axes_for(self._chain, goal, here, self._travel, sense, only=only, main=main)
        return (found - offset).tolist()

    def reached(self, start: list[float], end: list[float]) -> list[float]:
        """The end of a move in whose plane the direction turns, with the rotary axes where they come to, shape (k,).

        Raises:
            ValueError: They do not get there.
        """
        if start[3:] == end[3:] or self._two_axes is None:
            return end
        offset = self._counted_zero
        turnings = self._two_axes.turnings(np.array(start) + offset, np.array(end) + offset)
        found = list(end)
        for column, angle in zip(
            self._two_axes.columns.tolist(), turnings[-1].angles[1].tolist(), strict=True
        ):
            found[column] = angle - float(offset[column])
        return found

    def axes(self, tip: list[float]) -> list[float]:
        """Where the axes bring the tip to a place; the inverse of ``tip``.

        Raises:
            ValueError: With the rotary axes there X, Y and Z do not reach every point.
        """
        point = np.array([tip])
        return [*self._solved(_still(point[:, :3]), _still(point)).value[0].tolist(), *tip[3:]]

    def frame_there(self, axes: list[float]) -> FloatArray:
        """Directions of the machine's X, Y and Z as the part sees them, as columns, shape (3, 3)."""
        _, steps = self._carried(_still(np.array([axes])))
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
        elif move.in_plane and self._two_axes is not None:
            yield from self._in_plane(move, self._two_axes)
            return
        yield from self._evenly(move, rates)

    # --- rotary axes at rest

    def _at_rest(self, move: Segment) -> Segment | None:
        """A move while no rotary axis moves: turned as a whole; None where X, Y, Z are not at right angles."""
        frame = self.frame_there(move.start)
        if np.abs(frame.T @ frame - np.eye(3)).max() > _SQUARE:
            return None
        center, normal, level = move.center, move.normal, np.array_equal(frame, np.eye(3))
        if center is not None:
            there = self.axes([*center, *move.start[3:]])
            center, normal = vector(there), vector(frame.T @ np.array(normal))
        return dataclasses.replace(
            move,
            start=self.axes(move.start),
            end=self.axes(move.end),
            center=center,
            normal=normal,
            screen=move.screen if level else screen_from(move, frame),
        )

    # --- rotary axes in motion

    def _evenly(self, move: Segment, rates: FloatArray) -> Iterator[Segment]:
        """The rotary axes go evenly between both ends."""
        count = self._parts(move, rates)
        fraction = np.linspace(0.0, 1.0, count + 1)
        places = np.array(move.start) + fraction[:, None] * rates
        places[-1] = move.end
        first = np.tile(rates, (count + 1, 1))
        tip, axes = self._led(move, fraction, PathMotion(places, first, np.zeros_like(first)))
        steps = np.full(count, 1.0 / count)
        coefficients = np.zeros((count, len(rates), 5))
        coefficients[:, 3:, 0] = np.diff(axes.value[:, 3:], axis=0)
        linear = PathMotion(*(each[:, :3] for each in axes))
        coefficients[:, :3] = hermite(linear, steps)
        yield from self._curves(move, (fraction, steps), tip, axes.value, coefficients)

    def _in_plane(self, move: Segment, axes: TwoAxes) -> Iterator[Segment]:
        """The direction of the tool turns in the plane of both ends."""
        offset = self._counted_zero
        start, end = np.array(move.start) + offset, np.array(move.end) + offset
        columns = axes.columns
        for turning in axes.turnings(start, end):
            part = part_of(move, turning.begin, turning.end)
            for place, angles in zip((part.start, part.end), turning.angles, strict=True):
                for column, angle in zip(
                    columns.tolist(), (angles - offset[columns]).tolist(), strict=True
                ):
                    place[column] = angle
            rates = np.array(part.end) - np.array(part.start)
            if turning.circle is None:
                yield from self._evenly(part, rates)
            else:
                yield from self._along_circle(part, rates, axes, turning)

    def _along_circle(
        self, move: Segment, rates: FloatArray, axes: TwoAxes, turning: Turning
    ) -> Iterator[Segment]:
        """The rotary axes follow a great circle; parts are halved until they lead tip and direction closely enough.

        Raises:
            ValueError: They would have to be too many.
        """
        fraction = np.linspace(0.0, 1.0, self._parts(move, rates) + 1)
        while len(fraction) <= MOST_PARTS:
            places = np.array(move.start) + fraction[:, None] * rates
            first = np.tile(rates, (len(fraction), 1))
            led = PathMotion(places, first, np.zeros_like(first))
            angles = axes.motion(turning, fraction)
            led.value[:, axes.columns] = angles.value - self._counted_zero[axes.columns]
            led.first[:, axes.columns], led.second[:, axes.columns] = angles.first, angles.second
            tip, led = self._led(move, fraction, led)
            steps = np.diff(fraction)
            coefficients = hermite(led, steps)
            loose = self._loose(move, turning, fraction, led.value, coefficients)
            if not np.any(loose):
                yield from self._curves(move, (fraction, steps), tip, led.value, coefficients)
                return
            halves = 0.5 * (fraction[:-1] + fraction[1:])[loose]
            fraction = np.sort(np.concatenate([fraction, halves]))
        raise ValueError(
            "the rotary axes would turn too fast next to the pole of the one that turns the part"
        )

    def _loose(
        self,
        move: Segment,
        turning: Turning,
        fraction: FloatArray,
        places: FloatArray,
        coefficients: FloatArray,
    ) -> NDArray[np.bool_]:
        """Which of n curves lead the tip or the direction too far from where they are meant to be, shape (n,)."""
        assert turning.circle is not None
        loose = np.zeros(len(coefficients), np.bool_)
        for within in _PROBES:
            at = fraction[:-1] + within * np.diff(fraction)
            joints = places[:-1] + coefficients @ (within ** np.arange(1, 6)) + self._counted_zero
            point = tool_point(self._chain, joints, self.length_difference) - self._zero[:3]
            off = np.linalg.norm(point - tip_motion(move, at).value, axis=1)
            leaning = tool_direction(self._chain, joints) - turning.circle.at(at)
            loose |= (off > TIP_ERROR) | (np.linalg.norm(leaning, axis=1) > DIRECTION_ERROR)
        return loose

    def _led(
        self, move: Segment, fraction: FloatArray, axes: PathMotion
    ) -> tuple[PathMotion, PathMotion]:
        """The tip along a move, and all axes with X, Y and Z as they bring it there.

        Args:
            fraction: Shape (n,).
            axes: All axes there, shape (n, k) each; X, Y and Z are not looked at.
        """
        tip = tip_motion(move, fraction)
        linear = self._solved(tip, axes)
        for led, solved in zip(axes, linear, strict=True):
            led[:, :3] = solved
        return tip, axes

    def _curves(
        self,
        move: Segment,
        cuts: tuple[FloatArray, FloatArray],
        tip: PathMotion,
        places: FloatArray,
        coefficients: FloatArray,
    ) -> Iterator[Segment]:
        """The curves of the axes between n + 1 fractions of a move.

        Args:
            cuts: The fractions, shape (n + 1,), and their steps, shape (n,).
            places: Of the axes, likewise, shape (n + 1, k).
            coefficients: Between them, shape (n, k, 5).
        """
        length = length_of(move)
        turning = length == 0.0
        if turning:
            others = places[-1, 3:] - places[0, 3:]
            length = math.sqrt(float(others @ others))
        shown, points = places - places[-1], tip.value.copy()
        points[-1] = move.end[:3]
        shown[:, :3] = (points - points[-1]) @ screen_matrix(move).T
        shown += move.display
        screen = screen_from(move, self._seen_from_part.T)
        (fraction, steps), advance, last = cuts, advance_of(move), len(coefficients) - 1
        for part, step in enumerate(steps.tolist()):
            center = None
            if move.center is not None:
                height = advance * fraction[part]
                from_tip = np.array(move.center) + height * np.array(move.normal) - tip.value[part]
                center = vector(self._seen_from_part @ from_tip)
            yield dataclasses.replace(
                move,
                start=places[part].tolist(),
                end=places[part + 1].tolist(),
                display=shown[part + 1].tolist(),
                corner=move.corner if part == last else Corner.EXACT_PATH,
                center=center,
                normal=vector(self._seen_from_part @ np.array(move.normal)),
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

    def _solved(self, tip: PathMotion, axes: PathMotion) -> PathMotion:
        """X, Y and Z that bring the tip along its path, with their derivatives by the path fraction.

        Args:
            axes: Rotary axes and all further ones along it, shape (n, k) each; X, Y and Z are not looked at.
        """
        rest, steps = self._carried(axes)
        matrix, matrix_first, matrix_second = (
            np.stack([getattr(step, name) for step in steps], axis=2) for name in PathMotion._fields
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
        return PathMotion(value - self._counted_zero[:3], first, second)

    def _carried(self, axes: PathMotion) -> tuple[PathMotion, list[PathMotion]]:
        """The tip with X, Y and Z at zero, and what a millimetre of each moves it by."""
        chain, count = self._chain, len(axes.value)
        joints = axes.value + self._counted_zero
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


def _still(value: FloatArray) -> PathMotion:
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
