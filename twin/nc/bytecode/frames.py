"""How far a program has come: its location, the parts that it calls, and how they end.

Both tiers keep it in the same columns.
"""

from copy import deepcopy
from typing import NamedTuple

import numpy as np

from twin.compilation.compilable import compilable
from twin.nc.bytecode.bytecode import LARGEST_PART, MOST_STORES, MOST_VALUES, PART_BITS
from twin.nc.bytecode.registers import MOST_WORDS, OF_PLAIN_BLOCKS, State
from twin.nc.canonical import FloatArray, IntArray
from twin.nc.path.compensation.contour import Contour

LINE, PART, FURTHEST, INSTRUCTION_BUDGET, DEPTH, CALLS, BLOCKS, MADE = range(8)
"""Places in the progress: line and part that come next, from 0; the furthest place that was run;
blocks that may still be run again; row of the local variables; parts that are being run for a
caller; blocks run; moves made."""
PROGRESS = 8

BACK, FIRST, AGAIN, LAST, OWNS_SCOPE, RESTORES = range(6)
"""Columns of the calls: where to go on; where the part begins; how often it still runs anew before
that; its last block where it ends by its location, ``NO_LOCATION`` where a word ends it; whether it has
local variables of its own, which its end forgets; and what its end puts back into force, one of the
following."""
NOTHING_RESTORED, CODES_RESTORED = range(2)
"""What its end puts back into force: nothing, or what was in force when it was called."""
CALL_COLUMNS = 6
NO_LOCATION = -1
MOST_CALLS = 64
"""Parts within each other: more than any dialect allows."""

ENDED, FULL, PAUSED, UNCOMPILED_LINE, TRAPPED, OFF_PAGE = range(6)
"""Why a run ends: behind the last line; no room for a move; the caller has not been heard for
long; at a line that is to be compiled; at a block for the interpreter tier; at a line of
another page."""


@compilable
def go_to(location: int, progress: IntArray) -> None:
    """Let a location come next."""
    progress[LINE], progress[PART] = location >> PART_BITS, location & LARGEST_PART


@compilable
def end_part(progress: IntArray, calls: IntArray) -> None:
    """The innermost called part has ended: run it again, or go back to its caller."""
    call = calls[progress[CALLS] - 1]
    if call[AGAIN] > 0:
        call[AGAIN] -= 1
        go_to(call[FIRST], progress)
    else:
        progress[CALLS] -= 1
        progress[DEPTH] -= call[OWNS_SCOPE]
        go_to(call[BACK], progress)


@compilable
def end_parts(progress: IntArray, calls: IntArray) -> None:
    """Parts that end by their location and have been passed end."""
    while progress[CALLS] > 0:
        last = calls[progress[CALLS] - 1, LAST]
        if last == NO_LOCATION or (progress[LINE] << PART_BITS | progress[PART]) <= last:
            return
        end_part(progress, calls)


@compilable
def innermost(calls: IntArray, called: int) -> int:
    """How many parts are being run up to the innermost that a word ends; 0: there is none."""
    while called > 0 and calls[called - 1, LAST] != NO_LOCATION:
        called -= 1
    return called


class VariableStore(NamedTuple):
    """The columns of ``Variables``.

    Attributes:
        common: Shape (n,).
        given_common: Shape (n,).
        local: Shape (calls, m).
        given_local: Shape (m,).
    """

    common: FloatArray
    given_common: FloatArray
    local: FloatArray
    given_local: FloatArray


class ExecutionState(NamedTuple):
    """How far a program has come.

    Attributes:
        progress: Shape (``PROGRESS``,).
        calls: The innermost last, shape (``MOST_CALLS``, ``CALL_COLUMNS``).
        memory: Its variables.
        saved: What was in force when each was called, as in ``State.modal``, shape (``MOST_CALLS``, m).
        contour: Radius compensation, in force or not.
    """

    progress: IntArray
    calls: IntArray
    memory: VariableStore
    saved: FloatArray
    contour: Contour


WORDS, STORES = range(2)
"""Places in the counts of ``Scratch``."""


class Scratch(NamedTuple):
    """Room to work in.

    Attributes:
        counts: How many ``WORDS`` and ``STORES`` there are, shape (2,).
        token_kinds: Of words, shape (``MOST_WORDS``,).
        values: Of words, shape (``MOST_WORDS``,).
        modal: What is in force in the block, shape (``OF_PLAIN_BLOCKS``,).
        snapshot: State before a block that runs often.
        stack: Shape (``MOST_VALUES``,).
        slots: Variables that the block has set, shape (``MOST_STORES``,).
        before: What they held before, shape (``MOST_STORES``,).
    """

    counts: IntArray
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
        np.zeros(2, np.int64),
        np.zeros(MOST_WORDS, np.int64),
        np.zeros(MOST_WORDS),
        np.zeros(OF_PLAIN_BLOCKS),
        deepcopy(state),
        np.zeros(MOST_VALUES),
        np.zeros(MOST_STORES, np.int64),
        np.zeros(MOST_STORES),
    )
