"""What the axes do while the tip of the tool moves and rotary axes turn: curves, cut short enough to be exact.

A move that turns an axis becomes parts short enough for one polynomial of the fifth degree for each
axis, which has the place, the first and the second derivative of the true path at both ends (Hermite).
Along a part its error is at most ``h^6 / 46080`` times the sixth derivative. So the tip is on the programmed
line or arc at every instant, whatever lies between two blocks, and the planner keeps every axis' limits.
"""

import dataclasses
import math
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from twin.nc.canonical import Corner, FloatArray
from twin.nc.path.move_columns import Curve, Segment
from twin.nc.path.tool_center.great_circle import RotaryTurn, TwoAxes
from twin.nc.path.tool_center.tip_kinematics import TipKinematics
from twin.nc.path.tool_center.tip_path import (
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

TIP_ERROR = 1e-10
"""How far the tip may leave its path between two places where it is exact [mm]."""

DIRECTION_ERROR = 1e-8
"""How far the direction may leave the plane that it turns in [rad]."""

MOST_PARTS = 20_000
"""Into which a move is cut."""

_PROBES = (0.25, 0.5, 0.75)
"""Fractions of a part at which it is looked at."""

_HERMITE = 46080.0
"""``6! 2^6``: what the error of a polynomial of the fifth degree through both ends is divided by."""


class TipCurves(NamedTuple):
    """Cuts moves of the tip into curves of the axes.

    Attributes:
        seen_from_part: The machine's directions at the work offset's zeros as the part sees them, shape (3, 3).
    """

    kinematics: TipKinematics
    seen_from_part: FloatArray

    def evenly(self, move: Segment, rates: FloatArray) -> Iterator[Segment]:
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

    def in_plane(self, move: Segment, axes: TwoAxes) -> Iterator[Segment]:
        """The direction of the tool turns in the plane of both ends."""
        offset = self.kinematics.counted_zero
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
                yield from self.evenly(part, rates)
            else:
                yield from self._along_circle(part, rates, axes, turning)

    def _along_circle(
        self, move: Segment, rates: FloatArray, axes: TwoAxes, turning: RotaryTurn
    ) -> Iterator[Segment]:
        """The rotary axes follow a great circle; parts are halved until they lead tip and direction closely enough."""
        fraction = np.linspace(0.0, 1.0, self._parts(move, rates) + 1)
        while len(fraction) <= MOST_PARTS:
            places = np.array(move.start) + fraction[:, None] * rates
            first = np.tile(rates, (len(fraction), 1))
            led = PathMotion(places, first, np.zeros_like(first))
            angles = axes.motion(turning, fraction)
            led.value[:, axes.columns] = angles.value - self.kinematics.counted_zero[axes.columns]
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
        turning: RotaryTurn,
        fraction: FloatArray,
        places: FloatArray,
        coefficients: FloatArray,
    ) -> NDArray[np.bool_]:
        """Which of n curves lead the tip or the direction too far from where they are meant to be, shape (n,)."""
        assert turning.circle is not None
        loose = np.zeros(len(coefficients), np.bool_)
        for within in _PROBES:
            at = fraction[:-1] + within * np.diff(fraction)
            there = places[:-1] + coefficients @ (within ** np.arange(1, 6))
            off = np.linalg.norm(self.kinematics.tip(there) - tip_motion(move, at).value, axis=1)
            leaning = self.kinematics.direction(there) - turning.circle.at(at)
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
        linear = self.kinematics.linear_axes_for(tip, axes)
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
        screen = screen_from(move, self.seen_from_part.T)
        (fraction, steps), advance, last = cuts, advance_of(move), len(coefficients) - 1
        for part, step in enumerate(steps.tolist()):
            center = None
            if move.center is not None:
                height = advance * fraction[part]
                from_tip = np.array(move.center) + height * np.array(move.normal) - tip.value[part]
                center = vector(self.seen_from_part @ from_tip)
            yield dataclasses.replace(
                move,
                start=places[part].tolist(),
                end=places[part + 1].tolist(),
                display=shown[part + 1].tolist(),
                corner=move.corner if part == last else Corner.EXACT_PATH,
                center=center,
                normal=vector(self.seen_from_part @ np.array(move.normal)),
                sweep=move.sweep * step,
                curve=Curve(coefficients[part], length * step, turning),
                screen=screen,
            )

    def _parts(self, move: Segment, rates: FloatArray) -> int:
        """Into how many parts a move is cut so that none leaves its path by more than ``TIP_ERROR``."""
        chain = self.kinematics.chain
        turning = chain.column[chain.rotary]
        angle = math.radians(float(np.abs(rates[turning]).sum()) + abs(move.sweep))
        far = self.kinematics.zero[:3] - chain.anchor[chain.rotary]
        ends = np.array([move.start[:3], move.end[:3]])
        reach = np.linalg.norm(ends[:, None] + far[None], axis=2).max(initial=0.0)
        if move.center is not None:
            reach += 2.0 * math.dist(move.start[:3], move.center)
        # Of a product of sines and a straight line: the sines' own, and six times the line's share.
        bound = (
            reach + abs(self.kinematics.length_difference) + 6.0 * math.dist(*ends.tolist())
        ) / (_HERMITE * TIP_ERROR)
        return max(1, math.ceil(angle * bound ** (1.0 / 6.0)))
