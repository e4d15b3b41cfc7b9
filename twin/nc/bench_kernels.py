"""Room in which the compiled run works on one block."""

from copy import deepcopy
from typing import NamedTuple

import numpy as np

from twin.nc.canonical import FloatArray, IntArray
from twin.nc.column_kernels import copy, copy_rows
from twin.nc.compile_kernels import kernel
from twin.nc.instructions import MOST_STORES, MOST_VALUES
from twin.nc.plain_state import MOST_WORDS, State


class Bench(NamedTuple):
    """Room to work in.

    Attributes:
        roles: Of words, shape (``MOST_WORDS``,).
        values: Of words, shape (``MOST_WORDS``,).
        modal: Modal state of the block.
        kept: State before a block that runs often.
        stack: Shape (``MOST_VALUES``,).
        slots: Variables that the block has set, shape (``MOST_STORES``,).
        before: What they held before, shape (``MOST_STORES``,).
    """

    roles: IntArray
    values: FloatArray
    modal: FloatArray
    kept: State
    stack: FloatArray
    slots: IntArray
    before: FloatArray


def new_bench(state: State) -> Bench:
    """Room to work in, for a state of this size."""
    return Bench(
        np.zeros(MOST_WORDS, np.int64),
        np.zeros(MOST_WORDS),
        np.zeros_like(state.modal),
        deepcopy(state),
        np.zeros(MOST_VALUES),
        np.zeros(MOST_STORES, np.int64),
        np.zeros(MOST_STORES),
    )


@kernel
def copy_force(
    modal: FloatArray, in_force: IntArray, to_modal: FloatArray, to_force: IntArray
) -> None:
    """Copy what is in force."""
    copy(modal, to_modal)
    copy(in_force, to_force)


@kernel
def copy_state(source: State, target: State) -> None:
    """Copy every column of a state."""
    copy_force(source.modal, source.in_force, target.modal, target.in_force)
    copy(source.programmed, target.programmed)
    copy(source.part, target.part)
    copy(source.registers, target.registers)
    copy(source.total, target.total)
    copy_rows(source.shifts, target.shifts)
    target.happened[0] = source.happened[0]
