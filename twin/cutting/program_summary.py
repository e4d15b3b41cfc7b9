"""What a program says in addition to its moves, by the number of the move that it holds from."""

import bisect
import dataclasses
from collections.abc import Sequence
from typing import Generic, NamedTuple, TypeVar

import numpy as np
import numpy.typing as npt

from twin.cutting.tools import EMPTY_SPINDLE
from twin.errors import ConfigError
from twin.job.job_file import JobFile, ToolTable
from twin.motion.setpoints.setpoints import Setpoints
from twin.nc.canonical import Chunk, FloatArray, Function, IntArray, Motion, Moves, Shape
from twin.nc.functions import (
    PROGRAM_ENDS,
    SPINDLE_SPEED,
    SPINDLE_STARTS,
    SPINDLE_STOPS,
    TOOL_CHANGE,
    SpindleState,
)
from twin.toolpath.part_frame import PartFrame
from twin.toolpath.tool_plan import ToolChange, ToolPlan

BoolArray = npt.NDArray[np.bool_]
ValueT = TypeVar("ValueT")

_OF_SPINDLE = SPINDLE_STARTS | SPINDLE_STOPS | {SPINDLE_SPEED}
"""Words of a program that speaks of the spindle."""
_BEFORE_THE_NEXT = 1.0 - 1e-12
"""The end of a move's path still belongs to it: a function between two moves is not yet in effect."""
_ENDS_SPINDLE = PROGRAM_ENDS | {TOOL_CHANGE}
"""Words that stop a spindle that was spoken of."""


@dataclasses.dataclass(frozen=True, slots=True)
class Steps(Generic[ValueT]):
    """A value that changes between moves.

    Attributes:
        first_move: Number of the first move that each value holds for, never falling from 0; a
            fraction counts within the move.
    """

    first_move: tuple[float, ...]
    values: tuple[ValueT, ...]

    def at(self, move: int) -> ValueT:
        """The value during a move."""
        return self.values[bisect.bisect_right(self.first_move, max(move, 0)) - 1]


class Screen(NamedTuple):
    """What the control's screen shows: ``matrix · place + shift``, further axes shifted only.

    Attributes:
        matrix: Of the place, X, Y and Z of the axes in part coordinates, shape (3, 3).
        shift: Shape (k,) [mm or deg].
        led: The place is that of the tip in the part.
    """

    matrix: FloatArray
    shift: FloatArray
    led: bool = False


class PlacedPart(NamedTuple):
    """A part on a machine.

    Attributes:
        frame: How it turns under the tool.
        zero: Machine coordinates of program zero, shape (k,) [mm or deg].
    """

    frame: PartFrame
    zero: FloatArray

    def tilts(self, axes: FloatArray) -> bool:
        """Whether the tool is ever tilted from the part's Z, part coordinates of shape (n, k) [mm or deg]."""
        return self.frame.tilts(axes + self.zero)

    def tip(self, axes: FloatArray, length_difference: FloatArray | float) -> FloatArray:
        """Where the tip of a tool is in the part, from program zero, shape (n, 3) [mm].

        Args:
            axes: Part coordinates, shape (n, k).
            length_difference: How much longer than the first the tool is, one or shape (n,) [mm].
        """
        return self.frame.position(axes + self.zero, length_difference) - self.frame.program_zero(
            self.zero
        )


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class ProgramSummary:
    """What a whole program says in addition to its moves.

    Attributes:
        tools: What is in the spindle when, at which speed.
        rapid: Whether each move is a rapid, shape (n,).
        spindle: Its speed [1/min], negative where it turns counter-clockwise, 0 where it is at rest;
            None where nothing is known of it. A program that never speaks of the spindle has one
            value: it runs with it turning, since someone has switched it on by hand. One that does
            is held to it from its first move on.
        screen: What the control's screen shows; None: always where the axes are.
        part: Where the part is on the machine; None: its screen never shows the tip.
        tilts: Whether a height map does not hold the part: the tool is off the part's Z somewhere, or the blank is a
            cylinder that lies.
    """

    tools: ToolPlan
    rapid: BoolArray = dataclasses.field(default_factory=lambda: np.zeros(0, np.bool_))
    spindle: Steps[float | None] = Steps((0,), (None,))
    screen: Steps[Screen] | None = None
    part: PlacedPart | None = None
    tilts: bool = False

    def is_rapid(self, move: IntArray) -> BoolArray:
        """Which samples belong to rapids, by their move numbers, shape (n,); -1 does not."""
        known = (move >= 0) & (move < len(self.rapid))
        result = np.zeros(len(move), np.bool_)
        result[known] = self.rapid[move[known]]
        return result

    def shown(self, move: int, axes: FloatArray) -> FloatArray:
        """What the control's screen shows during a move while the axes are in a place, shape (k,) [mm or deg].

        Args:
            axes: Part coordinates, shape (k,).
        """
        if self.screen is None:
            return axes
        screen, place = self.screen.at(move), axes.copy()
        if screen.led and self.part is not None:
            place[:3] = self.part.tip(
                axes[None], self.tools.length_difference(self.tools.at(move))
            )[0]
        place[:3] = screen.matrix @ place[:3]
        return place + screen.shift

    def standing(self, setpoint: Setpoints) -> BoolArray:
        """During which setpoints the spindle is off, shape (n,)."""
        place = setpoint.move + np.clip(setpoint.fraction, 0.0, _BEFORE_THE_NEXT)
        off = np.array([speed == 0.0 for speed in self.spindle.values])
        step = np.searchsorted(self.spindle.first_move, place, side="right") - 1
        return off[np.maximum(step, 0)]


class SummaryBuilder:
    """Reads a program along, chunk by chunk."""

    def __init__(
        self,
        job: JobFile,
        spindle: SpindleState | None = None,
        part: PlacedPart | None = None,
    ) -> None:
        """Begin with the job's first tool in a spindle of which nothing was said.

        Args:
            job: Its tools are those that the program may bring.
            spindle: As the machine and the control have it; None: without a limit.
            part: Where the part is on the machine; None: the tool is never tilted from its Z.
        """
        self._tools = {tool.number: tool for tool in job.tools}
        # Without a list of tools every number means the default tool, as in a run without one.
        self._any_tool = "tools" not in job.model_fields_set
        self._cuts = job.stock is not None
        self._selected: int | None = None
        self._tool = job.tools[0]
        self._state = spindle or SpindleState(tool_speed=self._tool.speed)
        self._speaks = False
        self._plan: list[tuple[int, ToolTable]] = [(0, self._tool)]
        self._changes: list[ToolChange] = []
        self._spindle: list[tuple[float, float | None]] = [(0.0, self._tool.speed)]
        self._shown: list[tuple[int, Screen]] = []
        self._rapid = bytearray()
        self._part, self._tilts = part, job.stock is not None and job.stock.lies

    def add(self, chunk: Chunk) -> None:
        """Take note of moves and functions that follow the last ones.

        Raises:
            ConfigError: The program brings a tool that the job does not list.
        """
        before, moves = len(self._rapid), chunk.moves
        self._rapid += (moves.motion == Motion.RAPID).tobytes()
        for event in chunk.events:
            if isinstance(event, Function):
                self._function(event, before + event.before)
        if not len(moves):
            return
        if self._part is not None and not self._tilts:
            travel = moves.end - moves.start
            self._tilts = any(self._part.tilts(moves.start + share * travel) for share in _WITHIN)
        self._note_screen(moves, before)

    def _note_screen(self, moves: Moves, before: int) -> None:
        """Note where the screen begins to show something else."""
        place, led = moves.end, moves.shape == Shape.CURVE
        turned = np.tile(np.eye(3), (len(moves), 1, 1)) if moves.screen is None else moves.screen
        if self._part is not None and led.any():
            rows = np.flatnonzero(led)
            first_move, tools = zip(*self._plan, strict=True)
            length_difference = ToolPlan(tools, first_move).lower(before + rows)
            place = place.copy()
            place[rows, :3] = self._part.tip(place[rows], length_difference)
        shift = moves.display - place
        if moves.screen is not None:
            shift[:, :3] = moves.display[:, :3] - np.einsum("nij,nj->ni", turned, place[:, :3])
        last = self._shown[-1][1] if self._shown else Screen(np.eye(3), np.zeros(shift.shape[1]))
        changes = np.abs(np.diff(shift, axis=0, prepend=last.shift[None])).max(axis=1) > _SHOWN_STEP
        changes |= np.diff(led, prepend=last.led)
        changes |= (np.diff(turned, axis=0, prepend=last.matrix[None]) != 0.0).any(axis=(1, 2))
        self._shown += [
            (before + i, Screen(turned[i].copy(), shift[i].copy(), bool(led[i])))
            for i in np.flatnonzero(changes).tolist()
        ]

    def summary(self) -> ProgramSummary:
        """All that was noted."""
        screen = None
        if self._shown:
            plain = Screen(np.eye(3), np.zeros_like(self._shown[0][1].shift))
            screen = _steps([(0, plain), *self._shown])
        first_move, tools = zip(*self._plan, strict=True)
        if self._speaks:
            self._spindle[0] = (0.0, 0.0)
        return ProgramSummary(
            tools=ToolPlan(tools, first_move, tuple(self._changes)),
            rapid=np.frombuffer(bytes(self._rapid), np.bool_),
            spindle=_steps(self._spindle),
            screen=screen,
            part=self._part,
            tilts=self._tilts,
        )

    def _function(self, event: Function, move: int) -> None:
        word = event.word
        if word[:1] == "T" and word[1:].isdigit():
            self._selected = int(word[1:])
        elif word == TOOL_CHANGE and self._selected is not None:
            self._change_tool(self._selected, event, move)
        elif word in _OF_SPINDLE or (word in _ENDS_SPINDLE and self._speaks):
            # In a program that never spoke of the spindle they say nothing about it.
            self._speaks = True
            self._turn(self._state.after(event), move, event.at)

    def _change_tool(self, number: int, event: Function, move: int) -> None:
        tool = self._tools.get(number, EMPTY_SPINDLE if number == 0 else None)
        if tool is None and not self._any_tool and self._cuts:
            known = ", ".join(str(number) for number in self._tools)
            raise ConfigError(
                f"line {event.line} of the program brings tool {number}, but the job lists {known}: "
                f"add a [[tools]] table with number = {number}"
            )
        state = self._state.after(event)
        if tool is not None:
            self._tool, state = tool, dataclasses.replace(state, tool_speed=tool.speed)
            self._changes.append(ToolChange(move, event.line, tool))
        if self._speaks:
            self._turn(state, move)
        else:
            self._state = state
            self._plan.append((move, self._tool))

    def _turn(self, state: SpindleState, move: int, at: float = 0.0) -> None:
        """The spindle goes on otherwise; the tool is at the speed that it turns at then."""
        self._state, turning = state, state.turning
        self._spindle.append((move + at, turning))
        speed = abs(turning) if turning else None
        self._plan.append((move, self._tool.model_copy(update={"speed": speed})))


_WITHIN = (0.0, 0.381966, 1.0)
"""Fractions of a move at which the direction of the tool is looked at: whole turns come back to where they began."""
_SHOWN_STEP = 1e-7
"""Changes of what the screen adds that are the arithmetic's doing [mm or deg]."""


def _steps(pairs: Sequence[tuple[float, ValueT]]) -> Steps[ValueT]:
    first_move, values = zip(*pairs, strict=True)
    return Steps(first_move, values)
