"""What a program says beside its moves, by the number of the move that it holds from."""

import bisect
import dataclasses
from collections.abc import Callable, Sequence
from typing import Generic, TypeVar

import numpy as np
import numpy.typing as npt

from twin.cutting.tools import EMPTY_SPINDLE
from twin.errors import ConfigError
from twin.job.job_file import JobFile, ToolTable
from twin.motion.setpoints.setpoints import Setpoints
from twin.nc.canonical import Chunk, FloatArray, Function, IntArray, Motion
from twin.nc.functions import (
    PROGRAM_ENDS,
    SPINDLE_SPEED,
    SPINDLE_STARTS,
    SPINDLE_STOPS,
    TOOL_CHANGE,
    SpindleState,
)
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
        values: As many.
    """

    first_move: tuple[float, ...]
    values: tuple[ValueT, ...]

    def at(self, move: int) -> ValueT:
        """The value during a move."""
        return self.values[bisect.bisect_right(self.first_move, max(move, 0)) - 1]


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class ProgramSummary:
    """What a whole program says beside its moves.

    Attributes:
        tools: What is in the spindle when, at which speed.
        rapid: Whether each move is a rapid, shape (n,).
        spindle: Its speed [1/min], negative where it turns counter-clockwise, 0 where it stands;
            None where nothing is known of it. A program that never speaks of the spindle has one
            value: it runs with it turning, since someone has switched it on by hand. One that does
            is held to it from its first move on.
        shown: What the control's screen adds to the axes' positions, shape (k,) each [mm or deg];
            none: nothing ever.
        tilts: Whether the tool ever stands off the part's Z.
    """

    tools: ToolPlan
    rapid: BoolArray = dataclasses.field(default_factory=lambda: np.zeros(0, np.bool_))
    spindle: Steps[float | None] = Steps((0,), (None,))
    shown: Steps[FloatArray] | None = None
    tilts: bool = False

    def is_rapid(self, move: IntArray) -> BoolArray:
        """Which samples belong to rapids, by their move numbers, shape (n,); -1 does not."""
        known = (move >= 0) & (move < len(self.rapid))
        result = np.zeros(len(move), np.bool_)
        result[known] = self.rapid[move[known]]
        return result

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
        tilts: Callable[[FloatArray], bool] | None = None,
    ) -> None:
        """Begin with the job's first tool in a spindle of which nothing was said.

        Args:
            job: Its tools are those that the program may bring.
            spindle: As the machine and the control have it; None: without a limit.
            tilts: Whether the tool stands off the part's Z anywhere at program coordinates, shape (n, k);
                None: it never does.
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
        self._shown: list[tuple[int, FloatArray]] = []
        self._rapid = bytearray()
        self._stands_off, self._tilts = tilts, False

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
        if self._stands_off is not None and not self._tilts:
            way = moves.end - moves.start
            self._tilts = any(self._stands_off(moves.start + share * way) for share in _WITHIN)
        added = moves.display - moves.end
        last = self._shown[-1][1] if self._shown else np.zeros(added.shape[1])
        steps = np.abs(np.diff(added, axis=0, prepend=last[None])).max(axis=1) > _SHOWN_STEP
        self._shown += [(before + int(i), added[i].copy()) for i in np.flatnonzero(steps)]

    def summary(self) -> ProgramSummary:
        """All that was noted."""
        shown = None
        if self._shown:
            zero = np.zeros_like(self._shown[0][1])
            shown = _steps([(0, zero), *self._shown])
        first_move, tools = zip(*self._plan, strict=True)
        if self._speaks:
            self._spindle[0] = (0.0, 0.0)
        return ProgramSummary(
            tools=ToolPlan(tools, first_move, tuple(self._changes)),
            rapid=np.frombuffer(bytes(self._rapid), np.bool_),
            spindle=_steps(self._spindle),
            shown=shown,
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
_SHOWN_STEP = 1e-9
"""Changes of what the screen adds that are the arithmetic's doing [mm or deg]."""


def _steps(pairs: Sequence[tuple[float, ValueT]]) -> Steps[ValueT]:
    first_move, values = zip(*pairs, strict=True)
    return Steps(first_move, values)
