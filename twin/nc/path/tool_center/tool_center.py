"""Tool centre point control: X, Y and Z say where the tip is in the part, while rotary axes turn it or the tool."""

import dataclasses
import functools
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from twin.kinematics import Kinematics, counted_from, rotated, turns_part
from twin.nc.canonical import FloatArray
from twin.nc.geometry.planes import Vector
from twin.nc.path.move_columns import Segment
from twin.nc.path.tool_center.great_circle import TwoAxes
from twin.nc.path.tool_center.orientation import rotary_axes_for
from twin.nc.path.tool_center.tip_curves import TipCurves
from twin.nc.path.tool_center.tip_kinematics import TipKinematics, still
from twin.nc.path.tool_center.tip_path import screen_from, vector

FARTHEST_TURN = 36_000.0
"""What an axis may turn in one move of a tip that is led [deg]: beyond it, it is a slip of the pen."""

_SQUARE = 1e-12


class PartOnMachine(NamedTuple):
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
        setup: PartOnMachine,
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
        zero = np.asarray(setup.zero, np.float64)
        counted = np.zeros(len(zero))
        columns = setup.chain.column[turns_part(setup.chain)]
        counted[columns] = zero[columns] + np.array(rotary_zero)[columns]
        self._counted_zero = zero - counted
        self._chain = counted_from(setup.chain, counted, setup.length)
        self._kinematics = TipKinematics(self._chain, zero, self._counted_zero, length_difference)
        self._travel = setup.travel - (zero - self._counted_zero)[:, None]
        seen_from_part = np.eye(3)
        if np.any(np.array(rotary_zero)[columns]):
            # The part's frame is parallel to the machine's axes at part zero, not at the work offset's.
            shifted = [0.0, 0.0, 0.0, *rotary_zero[3:]]
            level = [0.0] * len(rotary_zero)
            seen_from_part = ToolCenter(setup, length_difference, level).frame_there(shifted)
        self._curves = TipCurves(self._kinematics, seen_from_part)

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
        return [*self._kinematics.tip(np.array([axes]))[0].tolist(), *axes[3:]]

    def direction(self, axes: list[float]) -> FloatArray:
        """Direction from the tip of the tool to the spindle, seen from the part, shape (3,)."""
        return self._kinematics.direction(np.array([axes]))[0]

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
        linear = self._kinematics.linear_axes_for(still(point[:, :3]), still(point))
        return [*linear.value[0].tolist(), *tip[3:]]

    def frame_there(self, axes: list[float]) -> FloatArray:
        """Directions of the machine's X, Y and Z as the part sees them, as columns, shape (3, 3)."""
        _, steps = self._kinematics.carried(still(np.array([axes])))
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
            yield from self._curves.in_plane(move, self._two_axes)
            return
        yield from self._curves.evenly(move, rates)

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
