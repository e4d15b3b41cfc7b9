"""One compiled block: its instructions on a stack, all of them or none.

Each does what ``opcodes`` says of it.
"""

import numpy as np

from twin.compilation.compilable import inlined
from twin.nc.bytecode import opcodes
from twin.nc.bytecode.bytecode import PART_BITS, BytecodeTable
from twin.nc.bytecode.frames import (
    AGAIN,
    BACK,
    BLOCKS,
    CALLS,
    DEPTH,
    FIRST,
    FULL,
    FURTHEST,
    INSTRUCTION_BUDGET,
    LAST,
    LINE,
    MADE,
    NO_LOCATION,
    NOTHING_RESTORED,
    OWNS_SCOPE,
    PART,
    RESTORED_BY_CONTROL,
    RESTORED_HERE,
    RESTORES,
    TRAPPED,
    ExecutionState,
)
from twin.nc.bytecode.registers import BAILOUT, CYCLE, BlockTables, Constants, State
from twin.nc.compiled.kernels.block import (
    Scratch,
    copy_active_codes,
    copy_state,
    execute_repeatedly,
)
from twin.nc.compiled.kernels.cycle import NO_ROOM
from twin.nc.compiled.kernels.effects import polar_target, run_effect
from twin.nc.compiled.kernels.expression import evaluate
from twin.nc.compiled.kernels.frame import begin_compensation
from twin.nc.compiled.kernels.tokenizer import NUMBER
from twin.nc.compiled.kernels.variables import (
    NO_SLOT,
    innermost,
    own_value,
    slot_of_number,
    store,
)
from twin.nc.path.compensation import leads
from twin.nc.path.compensation.contour import OFF, STAGE
from twin.nc.path.compensation.lookahead import hold_events
from twin.nc.path.rows import Rows

DONE = -1
"""The block was run."""

_PART_MASK = (1 << PART_BITS) - 1


@inlined
def dispatch_loop(
    row: int,
    words: int,
    table: BytecodeTable,
    tables: BlockTables,
    constants: Constants,
    state: State,
    rows: Rows,
    routine: ExecutionState,
    scratch: Scratch,
) -> int:
    """Run the block that begins at a row; ``DONE``, or why it was left as if not begun.

    Args:
        row: Row of its ``BLOCK``.
        words: How many words have been read already.
        table: The instructions.
        tables: What words mean.
        constants: What stays.
        state: What changes with moves.
        rows: Room for the moves, one at least.
        routine: How far the program has come.
        scratch: Room to work in.
    """
    progress, calls, memory = routine.progress, routine.calls, routine.memory
    saved, stack = routine.saved, scratch.stack
    line, made, depth, called = progress[LINE], progress[MADE], progress[DEPTH], progress[CALLS]
    place = line << PART_BITS | progress[PART]
    budget = progress[INSTRUCTION_BUDGET] - (place <= progress[FURTHEST])
    behind = (line + 1) << PART_BITS if table.operand[row] == 0 else place + 1
    going, range_end, restores = behind, NO_LOCATION, NOTHING_RESTORED
    top, stores, own, why = 0, 0, 0, TRAPPED
    contour, first_event = routine.contour, state.event_count[0]
    has_snapshot = compensates = contour.counts[STAGE] != OFF
    if compensates:
        copy_state(state, scratch.snapshot)
    while budget >= 0:
        row += 1
        opcode, operand = table.opcode[row], table.operand[row]
        if opcodes.CONSTANT <= opcode <= opcodes.DROP:
            top = evaluate(opcode, operand, row, stack, top, depth, table, memory)
            if top < 0:
                break
        elif opcode in (opcodes.STORE, opcodes.STORE_DECLARED, opcodes.STORE_NUMBERED):
            top -= 1
            slot = operand
            if opcode == opcodes.STORE_NUMBERED:
                slot = slot_of_number(table.numbered, stack[top - 1])
                if slot == NO_SLOT:
                    break
            before = own_value(memory, depth, slot)
            if opcode == opcodes.STORE_DECLARED and np.isnan(before):
                break
            scratch.slots[stores], scratch.before[stores] = slot, before
            stores += 1
            store(memory, depth, slot, stack[top])
        elif opcode in (opcodes.WORD, opcodes.WORD_CONSTANT):
            scratch.token_kinds[words] = operand
            if opcode == opcodes.WORD:
                top -= 1
                scratch.values[words] = stack[top]
            else:
                scratch.values[words] = table.immediate[row]
            words += 1
        elif opcode == opcodes.SNAPSHOT and not has_snapshot:
            copy_state(state, scratch.snapshot)
            has_snapshot = True
        elif opcode == opcodes.COMPENSATE:
            top -= 1
            if not begin_compensation(operand, stack[top], constants, state, contour):
                break
        elif opcode == opcodes.END_COMPENSATION:
            after = leads.end(made, state.event_count[0], contour, rows)
            if after < 0:
                break
            made = progress[MADE] = after  # not undone: to end it twice is to end it once
        elif opcode >= opcodes.ACTIVATE:
            top = run_effect(
                opcode,
                operand,
                stack,
                top,
                line + 1,
                made,
                tables,
                constants,
                state,
                rows,
                contour.counts[STAGE] != OFF,
            )
            if top == BAILOUT:
                break
        elif opcode in (opcodes.RUN, opcodes.RUN_REPEATEDLY, opcodes.RUN_CODES, opcodes.RUN_POLAR):
            polar = opcode == opcodes.RUN_POLAR
            if polar:
                radius = stack[top - 2 if operand == 3 else top - 1]
                angle = stack[top - 1]
                if not polar_target(operand, radius, angle, constants, state):
                    break
            count = 1.0
            if opcode == opcodes.RUN_REPEATEDLY:
                top -= 1
                count = stack[top]
                if not 1.0 <= count <= table.immediate[row] or count != np.floor(count):
                    break
                if state.modal[CYCLE] != 0.0 or contour.counts[STAGE] != OFF:
                    break
                if made + count > len(rows.codes):
                    why = FULL
                    break
                copy_state(state, scratch.snapshot)
            after = execute_repeatedly(
                int(count),
                line + 1,
                words,
                polar,
                made,
                first_event,
                tables,
                constants,
                state,
                rows,
                contour,
                scratch,
            )
            if after < 0:
                why = FULL if after == NO_ROOM else TRAPPED
                if opcode == opcodes.RUN_REPEATEDLY:
                    copy_state(scratch.snapshot, state)
                break
            first_event = state.event_count[0]
            made = after
            if opcode == opcodes.RUN_CODES:
                words = 1 if words > 0 and scratch.token_kinds[0] == NUMBER else 0
        elif opcode == opcodes.JUMP:
            going = operand
        elif opcode in (opcodes.JUMP_IF, opcodes.JUMP_UNLESS):
            top -= 1
            if (stack[top] != 0.0) == (opcode == opcodes.JUMP_IF):
                going = operand
                opcode = opcodes.NEXT
        elif opcode == opcodes.JUMP_CASE:
            top -= 1
            if stack[top] == stack[top - 1]:
                going = operand
                opcode = opcodes.NEXT
        elif opcode == opcodes.BEGIN_FOR:
            first, last, width = stack[top - 3], stack[top - 2], stack[top - 1]
            if width == 0.0:
                break
            stack[top - 3] = 1.0 if (first - last) * width > 0.0 else 0.0
            stack[top - 2] = first
            top -= 1
        elif opcode == opcodes.STEP_FOR:
            last, width = stack[top - 3], stack[top - 2]
            if width == 0.0:
                break
            value = stack[top - 1] + width
            stack[top - 4] = 1.0 if (value - last) * width <= 0.0 else 0.0
            stack[top - 3] = value
            top -= 2
        elif opcode == opcodes.COUNT_DOWN:
            left = own_value(memory, depth, operand)
            if np.isnan(left):
                left = table.immediate[row]
            store(memory, depth, operand, np.nan if left == 0.0 else left - 1.0)
            stack[top] = 0.0 if left == 0.0 else 1.0
            top += 1
        elif opcode == opcodes.CHECK_CALL:
            if called >= operand or called >= len(calls) or depth + 1 >= len(memory.local):
                break
        elif opcode == opcodes.OWN_VARIABLES:
            depth += 1
            own = 1
            memory.local[depth, :] = np.nan
        elif opcode == opcodes.RESTORE_CODES:
            restores = RESTORED_HERE
        elif opcode in (opcodes.CALL, opcodes.REPEAT):
            again = 0.0
            if opcode == opcodes.REPEAT:
                top -= 1
                again = stack[top] - 1.0
                if not again >= 0.0 or again != np.floor(again):
                    break
            call = calls[called]
            call[BACK], call[FIRST], call[AGAIN] = behind, operand, int(again)
            call[LAST], call[OWNS_SCOPE], call[RESTORES] = range_end, own, restores
            if restores == RESTORED_HERE:
                copy_active_codes(
                    state.modal, state.active_codes, saved.modal[called], saved.active_codes[called]
                )
            called += 1
            going = operand
        elif opcode == opcodes.RANGE:
            range_end = operand
        elif opcode == opcodes.CHECK_RETURN:
            from_part = innermost(calls, called)
            if from_part == 0 or calls[from_part - 1, RESTORES] == RESTORED_BY_CONTROL:
                break
        elif opcode == opcodes.RETURN:
            called = innermost(calls, called) - 1
            depth -= calls[called, OWNS_SCOPE]
            going = calls[called, BACK]
            if calls[called, RESTORES] == RESTORED_HERE:
                copy_active_codes(
                    saved.modal[called], saved.active_codes[called], state.modal, state.active_codes
                )
        elif opcode == opcodes.TRAP:
            break
        if opcode == opcodes.NEXT:
            progress[LINE], progress[PART] = going >> PART_BITS, going & _PART_MASK
            progress[FURTHEST] = max(progress[FURTHEST], place)
            progress[INSTRUCTION_BUDGET], progress[DEPTH], progress[CALLS] = budget, depth, called
            progress[MADE] = made
            if contour.counts[STAGE] != OFF:
                hold_events(contour, rows, first_event, state.event_count[0])
            progress[BLOCKS] += 1
            return DONE
    if has_snapshot:
        copy_state(scratch.snapshot, state)
    if not compensates:
        contour.counts[STAGE] = OFF
    while stores > 0:
        stores -= 1
        store(memory, progress[DEPTH], scratch.slots[stores], scratch.before[stores])
    return why
