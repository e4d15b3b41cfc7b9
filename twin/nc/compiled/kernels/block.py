"""One block's words, run once or several times, and compensated."""

from typing import NamedTuple

import numpy as np

from twin.compilation.compilable import inlined
from twin.nc.bytecode import opcodes
from twin.nc.bytecode.bytecode import Instruction
from twin.nc.bytecode.effects import polar_target
from twin.nc.bytecode.frames import WORDS, Scratch
from twin.nc.bytecode.registers import BAILOUT, CYCLE, Machine, copy_state
from twin.nc.bytecode.token_kinds import NUMBER, UNSUPPORTED
from twin.nc.compiled.kernels.cycle import NO_ROOM
from twin.nc.compiled.kernels.words import execute_block
from twin.nc.path.compensation.contour import OFF, STAGE, Contour
from twin.nc.path.compensation.follow import follow


class BlockBegin(NamedTuple):
    """Where a block's words begin.

    Attributes:
        line: The block's line, from 1.
        made: The next row.
        first_event: The block's first event that has not been seen to.
    """

    line: int
    made: int
    first_event: int


@inlined
def run_words(
    instruction: Instruction,
    top: int,
    begun: BlockBegin,
    machine: Machine,
    contour: Contour,
    scratch: Scratch,
) -> int:
    """Run one of the instructions that execute the words on the scratch.

    Args:
        instruction: One from ``RUN`` to ``RUN_POLAR``.
        top: How many values there are.
        begun: Where they begin.
        machine: What they run on.
        contour: Radius compensation.
        scratch: Words and values.

    Returns:
        The row after the block's moves, ``UNSUPPORTED``, ``BAILOUT`` or ``NO_ROOM``.
    """
    words = scratch.counts[WORDS]
    opcode, operand, stack = instruction.opcode, instruction.operand, scratch.stack
    state, polar, times = machine.state, opcode == opcodes.RUN_POLAR, 1
    if polar:
        radius = stack[top - 2 if operand == 3 else top - 1]
        if not polar_target(operand, radius, stack[top - 1], machine.constants, state):
            return BAILOUT
    if opcode == opcodes.RUN_REPEATEDLY:
        count = stack[top - 1]
        if not 1.0 <= count <= instruction.immediate or count != np.floor(count):
            return BAILOUT
        if state.modal[CYCLE] != 0.0 or contour.counts[STAGE] != OFF:
            return BAILOUT
        if begun.made + count > len(machine.rows.codes):
            return NO_ROOM
        times = int(count)
        copy_state(state, scratch.snapshot)
    after = begun.made
    for _ in range(times):
        after = execute_block(
            begun.line,
            scratch.token_kinds[:words],
            scratch.values[:words],
            machine,
            scratch.modal,
            after,
            polar,
        )
        if after < 0:
            break
    if after < 0:
        if opcode == opcodes.RUN_REPEATEDLY:
            copy_state(scratch.snapshot, state)
        return after
    if opcode == opcodes.RUN_CODES:
        scratch.counts[WORDS] = 1 if words > 0 and scratch.token_kinds[0] == NUMBER else 0
    if contour.counts[STAGE] != OFF:
        if state.modal[CYCLE] != 0.0:
            return UNSUPPORTED
        events = state.event_count[0]
        return follow(begun.made, after, begun.first_event, events, contour, machine.rows)
    return after
