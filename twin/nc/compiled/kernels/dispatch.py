"""One compiled block: its instructions on a stack, all of them or none.

Each does what ``opcodes`` says of it; opcodes of one kind have a function.
"""

from twin.compilation.compilable import compilable, inlined
from twin.nc.bytecode import compensation, opcodes
from twin.nc.bytecode.bytecode import PART_BITS, BytecodeTable, Instruction
from twin.nc.bytecode.effects import Affected, BlockPlace
from twin.nc.bytecode.flow import Transfer, arrive, keep_codes, straight_on
from twin.nc.bytecode.frames import (
    CODES_RESTORED,
    DEPTH,
    FULL,
    FURTHEST,
    INSTRUCTION_BUDGET,
    LINE,
    MADE,
    PART,
    RESTORES,
    TRAPPED,
    ExecutionState,
    Scratch,
    innermost,
)
from twin.nc.bytecode.instructions import Surroundings, run_instruction
from twin.nc.bytecode.registers import (
    ACTIVE,
    CORRECT_CENTER,
    CYCLE,
    DRILLING,
    INTERPOLATION,
    PLANE,
    BlockTables,
    Machine,
    State,
    copy_state,
)
from twin.nc.bytecode.variables import undo_stores
from twin.nc.canonical import FloatArray
from twin.nc.compiled.kernels.block import BlockBegin, run_words
from twin.nc.compiled.kernels.cycle import NO_ROOM
from twin.nc.compiled.kernels.variables import use_variable
from twin.nc.path.compensation import leads
from twin.nc.path.compensation.contour import OFF, STAGE, Contour
from twin.nc.path.compensation.lookahead import hold_events
from twin.nc.path.drilling_cycle import Cycle

_PECKING = Cycle._fields.index("pecking")
DONE = -1
"""The block was run."""


@inlined
def dispatch_loop(
    row: int, table: BytecodeTable, machine: Machine, execution: ExecutionState, scratch: Scratch
) -> int:
    """Run the block that begins at a row; ``DONE``, or why it was left as if not begun.

    Args:
        row: Row of its ``BLOCK``.
        table: The instructions.
        machine: What it runs on; its rows have room for one move at least.
        execution: How far the program has come.
        scratch: Room to work in, with the words that have been read already.
    """
    state, contour, progress = machine.state, execution.contour, execution.progress
    stack, memory = scratch.stack, execution.memory
    line, here = progress[LINE] + 1, progress[LINE] << PART_BITS | progress[PART]
    budget = progress[INSTRUCTION_BUDGET] - (here <= progress[FURTHEST])
    ends_line = table.operand[row] == 0
    to = straight_on(progress, (progress[LINE] + 1) << PART_BITS if ends_line else here + 1)
    top, why = 0, TRAPPED
    made, first_event = progress[MADE], state.event_count[0]
    has_snapshot = compensates = contour.counts[STAGE] != OFF
    if compensates:
        copy_state(state, scratch.snapshot)
    while budget >= 0 and top >= 0:
        row += 1
        instruction = Instruction(table.opcode[row], table.operand[row], table.immediate[row])
        opcode = instruction.opcode
        if opcode >= opcodes.CONSTANT:
            around = Surroundings(
                memory,
                execution.calls,
                BlockPlace(line, made, contour.counts[STAGE] != OFF),
                Affected(machine.constants, state, machine.rows),
            )
            top, to = run_instruction(instruction, stack, top, to, around)
            if top < 0 or (
                opcode == opcodes.CHECK_RETURN and not _may_return(to, machine.tables, execution)
            ):
                break
            if opcodes.CALL <= opcode <= opcodes.RETURN:
                keep_codes(opcode, to, state.modal, execution.saved)
            if to.ends:
                opcode = opcodes.NEXT
        elif opcodes.LOAD <= opcode <= opcodes.WORD_CONSTANT:
            top = use_variable(instruction, top, to.depth, table.numbered, memory, scratch)
        elif opcodes.RUN <= opcode <= opcodes.RUN_POLAR:
            begun = BlockBegin(line, made, first_event)
            after = run_words(instruction, top, begun, machine, contour, scratch)
            if after < 0:
                why = FULL if after == NO_ROOM else TRAPPED
                break
            made, first_event = after, state.event_count[0]
        elif opcode == opcodes.SNAPSHOT:
            if not has_snapshot:
                copy_state(state, scratch.snapshot)
            has_snapshot = True
        elif opcode == opcodes.COMPENSATE:
            top -= 1
            if not _compensate(instruction.operand, stack[top], machine, contour):
                break
        elif opcode == opcodes.END_COMPENSATION:
            hold_events(contour, machine.rows, first_event, state.event_count[0])
            first_event = state.event_count[0]
            after = leads.end(made, state.event_count[0], contour, machine.rows)
            if after < 0:
                break
            made = progress[MADE] = after  # not undone: to end it twice is to end it once
        elif opcode == opcodes.ACTIVATE:
            group = machine.tables.group[instruction.operand]
            state.modal[ACTIVE + group] = instruction.operand
        elif opcode == opcodes.TRAP or (opcode == opcodes.NO_PECKS and _pecks(machine)):
            break
        if opcode == opcodes.NEXT:
            progress[INSTRUCTION_BUDGET], progress[MADE] = budget, made
            arrive(to, here, progress)
            hold_events(contour, machine.rows, first_event, state.event_count[0])
            return DONE
    _undo(has_snapshot, compensates, state, execution, scratch)
    return why


@inlined
def _compensate(side: int, radius: float, machine: Machine, contour: Contour) -> bool:
    """Begin compensation with a radius [mm]; whether nothing is wrong with that."""
    answer = compensation.may_begin(radius, contour)
    if answer == compensation.BEGINS:
        compensation.begin(side, radius, machine.constants, machine.state, contour)
    return answer >= 0


@inlined
def _undo(
    has_snapshot: bool,
    compensates: bool,
    state: State,
    execution: ExecutionState,
    scratch: Scratch,
) -> None:
    """Take back what a block has done, which found compensation in force or not."""
    if has_snapshot:
        copy_state(scratch.snapshot, state)
    if not compensates:
        execution.contour.counts[STAGE] = OFF
    undo_stores(execution.progress[DEPTH], execution.memory, scratch)


@inlined
def _pecks(machine: Machine) -> bool:
    """Whether a drilling cycle with pecks is in force."""
    return machine.tables.cycles[int(machine.state.modal[CYCLE]), _PECKING] != 0.0


@inlined
def _may_return(to: Transfer, tables: BlockTables, execution: ExecutionState) -> bool:
    """Whether what the end of the part puts back into force is known here."""
    called = innermost(execution.calls, to.called) - 1
    restores = execution.calls[called, RESTORES]
    return restores != CODES_RESTORED or knows(execution.saved[called], tables)


@compilable
def knows(modal: FloatArray, tables: BlockTables) -> bool:
    """Whether the compiled tier can run blocks with all that is in force, shape (m,)."""
    interpolation, cycle = int(modal[INTERPOLATION]), int(modal[CYCLE])
    if interpolation >= len(tables.kind) or cycle >= len(tables.kind):
        return False
    drills = cycle == 0 or tables.kind[cycle] == DRILLING
    plain = modal[PLANE] < 3.0 and modal[CORRECT_CENTER] != 0.0
    return drills and plain
