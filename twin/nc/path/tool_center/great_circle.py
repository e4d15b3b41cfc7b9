"""The direction of the tool interpolated as a vector: it turns evenly in the plane of both its ends.

Its path on the unit sphere is a great circle, so it turns about one axis of the part at a constant rate. Two rotary
axes follow it on one of their two solutions. Where the direction lies along the axis next to the part, the pole, that
axis changes nothing of it, and next to the pole it would have to turn at once. Decisions, the same for every control:

* A direction within ``POLE`` of the pole is the pole: a great circle that comes so near goes through it.
* At the pole the tip rests while the axes turn to where the circle leads away from it; they do not turn where the one
  next to the tool can go on through its zero.
* The axes end where the circle leads them, on the solution that they are on, whatever angles the program gives.
"""

import math
from typing import NamedTuple

import numpy as np

from twin.kinematics import Kinematics, tool_direction, turned
from twin.nc.canonical import FloatArray
from twin.nc.path.tool_center.tip_path import PathMotion

POLE = 1e-5
"""What is nearer to the pole is at it, and how far the direction may leave its plane there [rad]."""

_STILL = 1e-9
"""A direction that turns by less does not turn, and one that is nearer to the pole is as good as on it [rad]."""

_OPPOSITE = 3.0 * POLE
"""Directions that lack no more to a half turn name no plane [rad]."""

_SAME_ANGLE = 1e-7
"""Angles of rotary axes [deg]."""

_DIGITS = 6
"""Of angles that are compared, behind the point."""

_TURN = 360.0


class GreatCircle(NamedTuple):
    """A turn of a direction.

    Attributes:
        start: Where it begins, unit vector, shape (3,).
        axis: About which it turns, unit vector, shape (3,).
        angle: By which [rad].
    """

    start: FloatArray
    axis: FloatArray
    angle: float

    def at(self, fraction: FloatArray) -> FloatArray:
        """The direction at n fractions of the turn, shape (n, 3)."""
        angles = np.degrees(fraction * self.angle)[:, None]
        return turned(np.tile(self.start, (len(fraction), 1)), self.axis, angles)


class RotaryTurn(NamedTuple):
    """How the rotary axes go in a part of a move.

    Attributes:
        end: Likewise; the same while the tip rests.
        angles: Of the axis next to the tool and the one next to the part, at both ends, shape (2, 2) [deg].
        circle: Of the direction; None: the axes go evenly.
        side: Which of both solutions they are on, 1 or -1.
    """

    begin: float
    end: float
    angles: FloatArray
    circle: GreatCircle | None = None
    side: float = 1.0


class TwoAxes:
    """The two rotary axes of a machine, as they turn the direction of the tool in the part."""

    def __init__(self, chain: Kinematics, travel: FloatArray) -> None:
        """Look at a machine.

        Args:
            travel: Of each axis, as the chain counts them, shape (k, 2) [mm or deg]; of endless axes infinite.

        Raises:
            ValueError: It has not two rotary axes that differ.
        """
        joints = np.flatnonzero(chain.rotary)
        if len(joints) != 2:
            raise ValueError("a direction is interpolated as a vector by two rotary axes")
        self.columns = chain.column[joints]
        self._chain, self._travel = chain, travel[self.columns]
        self._inner, self._outer = chain.axis[joints[0]], chain.axis[joints[1]]
        self._cosine = float(self._outer @ self._inner)
        share = math.sqrt(max(0.0, 1.0 - self._cosine * self._cosine))
        if share < _STILL:
            raise ValueError("both rotary axes of the machine are parallel")
        self._share = share
        self._along = (self._inner - self._cosine * self._outer) / share
        self._aside = np.cross(self._outer, self._inner) / share

    def turnings(self, start: FloatArray, end: FloatArray) -> list[RotaryTurn]:
        """How the axes turn the tool from where it points to where it would point at the end of a move.

        Args:
            start: Where the axes are, as the chain counts them, shape (k,) [mm or deg].
            end: Where the program has them, likewise; the direction there counts.

        Raises:
            ValueError: Both directions are opposite, or the axes do not follow within their travel.
        """
        first, last = tool_direction(self._chain, np.stack([start, end]))
        here = start[self.columns]
        across = np.cross(first, last)
        angle = math.atan2(float(np.linalg.norm(across)), float(first @ last))
        if angle < _OPPOSITE and self._is_pole(first) and self._is_pole(last):
            return [RotaryTurn(0.0, 1.0, np.stack([here, end[self.columns]]))]
        if angle < _STILL:
            return [RotaryTurn(0.0, 1.0, np.stack([here, here]))]
        if math.pi - angle < _OPPOSITE:
            raise ValueError("the tool would turn to the opposite direction, which names no plane")
        circle = GreatCircle(first, across / np.linalg.norm(across), angle)
        pole = self._pole_on(circle)
        if pole is not None:
            return self._through(circle, pole, here)
        return [self._followed(circle, here, self._side_of(first, here))]

    def motion(self, turning: RotaryTurn, fraction: FloatArray) -> PathMotion:
        """Angles of both axes at n fractions of a turning, with their derivatives, shape (n, 2) each [deg].

        Args:
            fraction: From 0 to 1, shape (n,).
        """
        circle = turning.circle
        if circle is None:
            travel = turning.angles[1] - turning.angles[0]
            value = turning.angles[0] + fraction[:, None] * travel
            rate = np.tile(travel, (len(fraction), 1))
            return PathMotion(value, rate, np.zeros_like(rate))
        directions = circle.at(fraction)
        value = self._solved(directions, turning.side)
        # There the axis next to the part is what the circle leads it to, and no solution tells it.
        value[0], value[-1] = turning.angles
        return self._derivatives(circle, directions, np.unwrap(value, period=_TURN, axis=0))

    def _solved(self, directions: FloatArray, side: float) -> FloatArray:
        """Angles of one solution for n directions, shape (n, 2) [deg] (Paden and Kahan's second problem)."""
        tool, inner, outer = self._chain.tool, self._inner, self._outer
        height = directions @ outer
        distance = np.linalg.norm(directions - height[:, None] * outer, axis=1)
        toward = (float(inner @ tool) - self._cosine * height) / self._share
        if np.any(np.abs(toward) > distance + POLE):
            raise ValueError("the rotary axes do not point the tool along every direction between")
        toward = np.clip(toward, -distance, distance)
        aside = side * np.sqrt(np.maximum(distance * distance - toward * toward, 0.0))
        between = (
            height[:, None] * outer + toward[:, None] * self._along + aside[:, None] * self._aside
        )
        tools = np.tile(tool, (len(directions), 1))
        first = _angles_about(inner, tools, between)
        return np.stack([first, _angles_about(outer, between, directions)], axis=1)

    def _side_of(self, direction: FloatArray, here: FloatArray) -> float:
        """The solution that the axes are on."""

        def far(side: float) -> float:
            off = self._solved(direction[None], side)[0] - here
            return float(np.abs(off - _TURN * np.round(off / _TURN)).sum())

        return min((1.0, -1.0), key=far)

    def _followed(self, circle: GreatCircle, here: FloatArray, side: float) -> RotaryTurn:
        """The axes along a circle that does not meet the pole."""
        ends = self._solved(circle.at(np.array([0.0, 1.0])), side)
        ends += _TURN * np.round((here - ends[0]) / _TURN)
        angles = np.unwrap(ends, period=_TURN, axis=0)
        self._require_travel(angles[1])
        return RotaryTurn(0.0, 1.0, np.stack([here, angles[1]]), circle, side)

    # --- the pole

    def _is_pole(self, direction: FloatArray) -> bool:
        return float(np.linalg.norm(np.cross(direction, self._outer))) < POLE

    def _pole_on(self, circle: GreatCircle) -> float | None:
        """Where a circle goes through the pole, as a fraction of it; None: nowhere."""
        for pole in (self._outer, -self._outer):
            if abs(float(circle.axis @ pole)) > math.sin(POLE):
                continue
            at = math.atan2(
                float(np.cross(circle.start, pole) @ circle.axis), float(circle.start @ pole)
            )
            if -POLE <= at <= circle.angle + POLE:
                if at < POLE:
                    return 0.0
                return 1.0 if at > circle.angle - POLE else at / circle.angle
        return None

    def _through(self, circle: GreatCircle, at: float, here: FloatArray) -> list[RotaryTurn]:
        """The axes along a circle that goes through the pole at a fraction of it."""
        pole = (
            self._outer if float(circle.at(np.array([at]))[0] @ self._outer) > 0.0 else -self._outer
        )
        found: list[RotaryTurn] = []
        if at > 0.0:
            side = self._side_of(circle.start, here)
            to = _between(circle.start, pole)
            there = self._nearest(self._at_pole(pole, np.cross(to.axis, pole), side, 1.0), here)
            self._require_travel(there)
            found.append(RotaryTurn(0.0, at, np.stack([here, there]), to, side))
            here = there
        if at == 1.0:
            return found
        last = circle.at(np.array([1.0]))[0]
        away = _between(pole, last)
        return found + self._away(away, pole, at, here)

    def _away(
        self, circle: GreatCircle, pole: FloatArray, at: float, here: FloatArray
    ) -> list[RotaryTurn]:
        """The turn at the pole, where the axes need one, and what leads away: by the solution that they turn to least."""
        tangent = np.cross(circle.axis, pole)
        choices = [
            self._led_away(
                circle, self._nearest(self._at_pole(pole, tangent, side, -1.0), here), side, at
            )
            for side in (1.0, -1.0)
        ]

        def cost(turning: RotaryTurn) -> tuple[bool, float, float]:
            travel = round(float(np.abs(turning.angles[0] - here).sum()), _DIGITS)
            return (not self._within_travel(turning.angles), travel, -float(turning.angles[1, 0]))

        best = min(choices, key=cost)
        self._require_travel(best.angles)
        turn = RotaryTurn(at, at, np.stack([here, best.angles[0]]))
        still = np.abs(best.angles[0] - here).max() < _SAME_ANGLE
        return [best._replace(angles=np.stack([here, best.angles[1]]))] if still else [turn, best]

    def _led_away(
        self, circle: GreatCircle, here: FloatArray, side: float, at: float
    ) -> RotaryTurn:
        ends = self._solved(circle.at(np.array([1.0])), side)[0]
        # From the pole on the axis next to the part turns by less than a quarter.
        ends += _TURN * np.round((here - ends) / _TURN)
        return RotaryTurn(at, 1.0, np.stack([here, ends]), circle, side)

    def _at_pole(
        self, pole: FloatArray, tangent: FloatArray, side: float, ahead: float
    ) -> FloatArray:
        """Angles at the pole where the direction goes along a tangent, on one solution, shape (2,) [deg].

        Args:
            pole: Along the axis next to the part, unit vector.
            tangent: Along which the direction goes there, unit vector.
            ahead: 1: that before the pole; -1: behind it.
        """
        sideways = np.cross(self._inner, pole)
        # The axis next to the tool goes so that it comes from, or to, that side of the plane of both axes.
        rate = -ahead * side if float(sideways @ self._aside) > 0.0 else ahead * side
        first = _angles_about(self._inner, self._chain.tool[None], pole[None])[0]
        second = _angles_about(self._outer, rate * sideways[None], tangent[None])[0]
        return np.array([first, second])

    def _nearest(self, angles: FloatArray, here: FloatArray) -> FloatArray:
        """The same by whole turns, as near as the travel lets them be."""
        found = angles + _TURN * np.round((here - angles) / _TURN)
        low, high = self._travel[:, 0] - _SAME_ANGLE, self._travel[:, 1] + _SAME_ANGLE
        return np.where(found > high, found - _TURN, np.where(found < low, found + _TURN, found))

    def _within_travel(self, angles: FloatArray) -> bool:
        low, high = self._travel[:, 0] - _SAME_ANGLE, self._travel[:, 1] + _SAME_ANGLE
        return bool(np.all(angles >= low) and np.all(angles <= high))

    def _require_travel(self, angles: FloatArray) -> None:
        if not self._within_travel(angles):
            at = " and ".join(f"{angle:.4g}" for angle in angles.reshape(-1, 2)[-1])
            raise ValueError(
                f"in the plane of both directions the rotary axes would go to {at} degrees, outside their travel"
            )

    # --- derivatives

    def _derivatives(
        self, circle: GreatCircle, directions: FloatArray, value: FloatArray
    ) -> PathMotion:
        """Derivatives of the angles: the turns of both axes add up to the circle's."""
        outer = self._outer
        first = circle.angle * np.cross(circle.axis, directions)
        second = -circle.angle * circle.angle * directions
        inner = turned(np.tile(self._inner, (len(value), 1)), outer, value[:, 1:])
        by_inner, by_outer = np.cross(inner, directions), np.cross(outer, directions)
        at_pole = np.linalg.norm(by_outer, axis=1) < _STILL
        rates = _shares(by_inner, by_outer, first, at_pole)
        if np.any(at_pole):
            there = (each[at_pole] for each in (inner, directions, rates[:, 0], first, second))
            rates[at_pole, 1] = self._rate_at_pole(*there)
        bent = rates[:, :1] * (
            np.cross(rates[:, 1:] * np.cross(outer, inner), directions) + np.cross(inner, first)
        )
        bent += rates[:, 1:] * np.cross(outer, first)
        accelerations = _shares(by_inner, by_outer, second - bent, at_pole)
        return PathMotion(value, np.degrees(rates), np.degrees(accelerations))

    def _rate_at_pole(
        self,
        inner: FloatArray,
        directions: FloatArray,
        rate: FloatArray,
        first: FloatArray,
        second: FloatArray,
    ) -> FloatArray:
        """Of the axis next to the part at the pole, where its own share of the direction vanishes, shape (n,).

        What both turns add to the second derivative together is twice ``rate`` times this along the inner axis' part
        across the outer one.
        """
        sideways = inner - (inner @ self._outer)[:, None] * self._outer
        left = second - rate[:, None] * np.cross(inner, first)
        sense = np.sign(directions @ self._outer)
        return _dots(left, sideways) / (2.0 * rate * sense * _dots(sideways, sideways))


def _between(start: FloatArray, end: FloatArray) -> GreatCircle:
    across = np.cross(start, end)
    size = float(np.linalg.norm(across))
    return GreatCircle(start, across / size, math.atan2(size, float(start @ end)))


def _angles_about(axis: FloatArray, start: FloatArray, goal: FloatArray) -> FloatArray:
    """Turns about an axis that bring n vectors to others, seen along it, shape (n,) [deg]."""
    from_axis = start - (start @ axis)[:, None] * axis
    to_axis = goal - (goal @ axis)[:, None] * axis
    sine = np.cross(from_axis, to_axis) @ axis
    return np.degrees(np.arctan2(sine, _dots(from_axis, to_axis)))


def _shares(
    left: FloatArray, right: FloatArray, whole: FloatArray, left_alone: FloatArray
) -> FloatArray:
    """Of two vectors each, how often both are in a third one, shape (n, 2); by the left one alone where that is asked."""
    a, b, c = _dots(left, left), _dots(left, right), _dots(right, right)
    u, v = _dots(left, whole), _dots(right, whole)
    determinant = np.where(left_alone, 1.0, a * c - b * b)
    first = np.where(left_alone, u / a, (c * u - b * v) / determinant)
    return np.stack([first, np.where(left_alone, 0.0, (a * v - b * u) / determinant)], axis=1)


def _dots(left: FloatArray, right: FloatArray) -> FloatArray:
    return np.einsum("ni,ni->n", left, right)
