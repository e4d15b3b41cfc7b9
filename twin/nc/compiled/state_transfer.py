"""Hands the location in the program, its calls and its variables to the compiled run, and back."""

import numpy as np

from twin.nc.bytecode.bytecode import location_of_number, number_of_location
from twin.nc.bytecode.frames import (
    AGAIN,
    BACK,
    BLOCKS,
    CALL_COLUMNS,
    CALLS,
    DEPTH,
    FIRST,
    FURTHEST,
    INSTRUCTION_BUDGET,
    LAST,
    LINE,
    MADE,
    MOST_CALLS,
    NO_LOCATION,
    NOTHING_RESTORED,
    OWNS_SCOPE,
    PART,
    PROGRESS,
    RESTORED_BY_CONTROL,
    RESTORES,
    ExecutionState,
    Saved,
    VariableStore,
)
from twin.nc.bytecode.registers import State
from twin.nc.bytecode.token_kinds import UNSUPPORTED
from twin.nc.canonical import IntArray
from twin.nc.control.executor import Executor
from twin.nc.control.modal import SavedModal
from twin.nc.control.program_counter import CallFrame, Progress
from twin.nc.path.compensation.contour import Contour
from twin.nc.text.blocks import Location


class StateTransfer:
    """One run: what the kernel is given of a control's program, and what it makes of it."""

    def __init__(self, control: Executor, state: State, contour: Contour) -> None:
        """Begin a run.

        Args:
            control: Stands where the run begins.
            state: What the run changes besides.
            contour: Radius compensation, in force or not.
        """
        self._contour = contour
        self._control = control
        self._saved = Saved(
            np.zeros((MOST_CALLS, len(state.modal))),
            np.zeros((MOST_CALLS, len(state.active_codes)), np.int64),
        )
        self._begin = control.program_counter.progress()
        location, furthest, instruction_budget = self._begin
        self._progress = np.zeros(PROGRESS, np.int64)
        self._progress[[LINE, PART]] = location
        self._progress[FURTHEST] = number_of_location(furthest)
        self._progress[INSTRUCTION_BUDGET] = instruction_budget
        self._progress[DEPTH] = control.variables.depth
        self._given = control.program_counter.calls
        self._progress[CALLS] = len(self._given)
        self._calls = np.zeros((MOST_CALLS, CALL_COLUMNS), np.int64)
        for row, call in enumerate(self._given):
            self._calls[row] = _numbers(call)

    @property
    def execution(self) -> ExecutionState:
        """For the kernel; the columns of variables may have grown since it was asked for last."""
        variables = self._control.variables
        memory = VariableStore(
            variables.common, variables.given_common, variables.local, variables.given_local
        )
        return ExecutionState(self._progress, self._calls, memory, self._saved, self._contour)

    @property
    def line(self) -> int:
        """The line that comes next, from 0."""
        return int(self._progress[LINE])

    @property
    def blocks(self) -> int:
        """Blocks that were run."""
        return int(self._progress[BLOCKS])

    @property
    def made(self) -> int:
        """Moves that were made."""
        return int(self._progress[MADE])

    @property
    def gone_on(self) -> bool:
        """The run has gone past a block or a line, or has let go a move that compensation held."""
        return self.blocks > 0 or self.made > 0 or self.line != self._begin.location.line

    def give_back(self) -> None:
        """The control goes on from where the run has come to; its codes are those of the begin."""
        progress, control = self._progress, self._control
        location = Location(int(progress[LINE]), int(progress[PART]))
        furthest = location_of_number(int(progress[FURTHEST]))
        calls = [
            _call(row, self._restored(index, int(row[RESTORES])))
            for index, row in enumerate(self._calls[: progress[CALLS]])
        ]
        control.program_counter.resume(
            Progress(location, furthest, int(progress[INSTRUCTION_BUDGET])), calls
        )
        control.variables.depth = int(progress[DEPTH])

    def _restored(self, index: int, by: int) -> SavedModal | None:
        """What the end of a call puts back into force."""
        if by == RESTORED_BY_CONTROL:
            return self._given[index].restores
        if by == NOTHING_RESTORED:
            return None
        control = self._control
        before = control.saved_modal()
        put_into_force(control, self._saved.active_codes[index])
        restored = control.saved_modal()
        control.restore_modal(before)
        return restored


def put_into_force(control: Executor, numbers: IntArray) -> None:
    """Apply the codes that a run has found in each group."""
    for number in numbers.tolist():
        if number != UNSUPPORTED:
            control.put_into_force(number, control.dialect.g[number])


def _numbers(call: CallFrame) -> list[int]:
    numbers = [0] * CALL_COLUMNS
    numbers[BACK] = number_of_location(call.back)
    numbers[FIRST] = number_of_location(call.first)
    numbers[AGAIN] = call.again
    numbers[LAST] = NO_LOCATION if call.last is None else number_of_location(call.last)
    numbers[OWNS_SCOPE] = call.owns_scope
    numbers[RESTORES] = NOTHING_RESTORED if call.restores is None else RESTORED_BY_CONTROL
    return numbers


def _call(row: IntArray, restores: SavedModal | None) -> CallFrame:
    back, first, again, last, own, _ = row.tolist()
    return CallFrame(
        location_of_number(back),
        location_of_number(first),
        again,
        None if last == NO_LOCATION else location_of_number(last),
        owns_scope=bool(own),
        restores=restores,
    )
