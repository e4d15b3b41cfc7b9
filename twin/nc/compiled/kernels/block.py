"""One block's words, run once or several times, and compensated."""

from copy import deepcopy
from typing import NamedTuple

import numpy as np

from twin.compilation.compilable import compilable, inlined
from twin.nc.bytecode.bytecode import MOST_STORES, MOST_VALUES
from twin.nc.bytecode.registers import MOST_WORDS, BlockTables, Constants, State
from twin.nc.canonical import FloatArray, IntArray
from twin.nc.compiled.kernels.words import execute_block
from twin.nc.path.compensation.contour import OFF, STAGE, Contour
from twin.nc.path.compensation.follow import follow
from twin.nc.path.rows import Rows, copy, copy_rows


class Scratch(NamedTuple):
    """Room to work in.

    Attributes:
        token_kinds: Of words, shape (``MOST_WORDS``,).
        values: Of words, shape (``MOST_WORDS``,).
        modal: Modal state of the block.
        snapshot: State before a block that runs often.
        stack: Shape (``MOST_VALUES``,).
        slots: Variables that the block has set, shape (``MOST_STORES``,).
        before: What they held before, shape (``MOST_STORES``,).
    """

    token_kinds: IntArray
    values: FloatArray
    modal: FloatArray
    snapshot: State
    stack: FloatArray
    slots: IntArray
    before: FloatArray


def new_scratch(state: State) -> Scratch:
    """Room to work in, for a state of this size."""
    return Scratch(
        np.zeros(MOST_WORDS, np.int64),
        np.zeros(MOST_WORDS),
        np.zeros_like(state.modal),
        deepcopy(state),
        np.zeros(MOST_VALUES),
        np.zeros(MOST_STORES, np.int64),
        np.zeros(MOST_STORES),
    )


@compilable
def copy_active_codes(
    modal: FloatArray, active_codes: IntArray, to_modal: FloatArray, to_force: IntArray
) -> None:
    """Copy what is in force."""
    copy(modal, to_modal)
    copy(active_codes, to_force)


@compilable
def copy_state(source: State, target: State) -> None:
    """Copy every column of a state."""
    copy_active_codes(source.modal, source.active_codes, target.modal, target.active_codes)
    copy(source.programmed, target.programmed)
    copy(source.part, target.part)
    copy(source.registers, target.registers)
    copy(source.total, target.total)
    copy_rows(source.shifts, target.shifts)
    target.event_count[0] = source.event_count[0]


@inlined
def execute_repeatedly(
    times: int,
    line: int,
    words: int,
    polar: bool,
    made: int,
    first_event: int,
    tables: BlockTables,
    constants: Constants,
    state: State,
    rows: Rows,
    contour: Contour,
    scratch: Scratch,
) -> int:
    """Run the words on the scratch.

    Args:
        times: How often; more than once only while nothing is compensated.
        line: The block's line, from 1.
        words: How many there are.
        polar: As for ``execute_block``.
        made: The next row.
        first_event: The block's first event that has not been seen to.
        tables: What words mean.
        constants: What stays.
        state: What changes.
        rows: Room for the moves.
        contour: Radius compensation.
        scratch: The words.

    Returns:
        The row after the block's moves, ``UNSUPPORTED``, ``BAILOUT`` or ``NO_ROOM``.
    """
    after = made
    for _ in range(times):
        after = execute_block(
            line,
            scratch.token_kinds[:words],
            scratch.values[:words],
            tables,
            constants,
            state,
            scratch.modal,
            rows,
            after,
            polar,
        )
        if after < 0:
            return after
    if contour.counts[STAGE] != OFF:
        return follow(made, after, first_event, state.event_count[0], contour, rows)
    return after
