"""One translated block: its steps on a stack, all of them or none.

Each step is what ``instructions.Step`` says of it.
"""

import numpy as np

from twin.compilation.kernel import NONE_YET, inlined_kernel
from twin.nc.bytecode import opcodes
from twin.nc.bytecode.frames import (
    AGAIN,
    BACK,
    BLOCKS,
    CALLS,
    DEPTH,
    FIRST,
    FULL,
    FURTHEST,
    LAST,
    LEFT,
    LINE,
    MADE,
    NO_PLACE,
    NOTHING_RESTORED,
    OWN,
    PART,
    RESTORED_BY_CONTROL,
    RESTORED_HERE,
    RESTORES,
    STEPS_LEFT,
    Routine,
)
from twin.nc.bytecode.opcodes import PART_BITS, Table
from twin.nc.bytecode.registers import CYCLE, DOUBTFUL, BlockTables, Constants, Rows, State
from twin.nc.compiled.kernels.block import Bench, copy_force, copy_state, run_times
from twin.nc.compiled.kernels.cycle import NO_ROOM
from twin.nc.compiled.kernels.effects import polar_target, run_deed
from twin.nc.compiled.kernels.expression import of_one, of_three, of_two
from twin.nc.compiled.kernels.leads import begin_compensation, end_compensation
from twin.nc.compiled.kernels.lookahead import hold_events
from twin.nc.compiled.kernels.tokenizer import NUMBER
from twin.nc.compiled.kernels.variables import (
    NO_SLOT,
    innermost,
    load,
    own_value,
    slot_of_number,
    store,
)
from twin.nc.path.contour_registers import OFF, STAGE
from twin.nc.text.expressions import LARGEST_NUMBER

DONE = -1
"""The block was run."""

_PART_MASK = (1 << PART_BITS) - 1


@inlined_kernel
def run_steps(
    row: int,
    table: Table,
    tables: BlockTables,
    constants: Constants,
    state: State,
    rows: Rows,
    routine: Routine,
    bench: Bench,
) -> int:
    """Run the block that begins at a row; ``DONE``, or why it was left as if not begun.

    Args:
        row: Row of its ``BLOCK``.
        table: The instructions.
        tables: What words mean.
        constants: What stays.
        state: What changes with moves.
        rows: Room for the moves, one at least.
        routine: How far the program has come.
        bench: Room to work in.
    """
    progress, calls, memory = routine.progress, routine.calls, routine.memory
    saved, stack = routine.saved, bench.stack
    line, made, depth, called = progress[LINE], progress[MADE], progress[DEPTH], progress[CALLS]
    place = line << PART_BITS | progress[PART]
    steps_left = progress[STEPS_LEFT] - (place <= progress[FURTHEST])
    behind = (line + 1) << PART_BITS if table.argument[row] == 0 else place + 1
    going, range_end, restores = behind, NO_PLACE, NOTHING_RESTORED
    top, words, stores, own, why = NONE_YET, NONE_YET, 0, 0, LEFT
    contour, first_event = routine.contour, state.happened[0]
    kept = compensates = contour.counts[STAGE] != OFF
    if compensates:
        copy_state(state, bench.kept)
    while steps_left >= 0:
        row += 1
        step, argument = table.step[row], table.argument[row]
        if step == opcodes.NUMBER:
            stack[top] = table.number[row]
            top += 1
        elif step == opcodes.LOAD:
            value = load(memory, depth, argument)
            if np.isnan(value):
                break
            stack[top] = value
            top += 1
        elif step == opcodes.TWO:
            top -= 1
            value = of_two(argument, stack[top - 1], stack[top])
            if not abs(value) <= LARGEST_NUMBER:
                break
            stack[top - 1] = value
        elif step == opcodes.ONE:
            value = of_one(argument, stack[top - 1])
            if not abs(value) <= LARGEST_NUMBER:
                break
            stack[top - 1] = value
        elif step == opcodes.THREE:
            top -= 2
            value = of_three(argument, stack[top - 1], stack[top], stack[top + 1])
            if not abs(value) <= LARGEST_NUMBER:
                break
            stack[top - 1] = value
        elif step == opcodes.NEGATE:
            stack[top - 1] = -stack[top - 1]
        elif step == opcodes.LOAD_NUMBERED:
            slot = slot_of_number(table.numbered, stack[top - 1])
            value = np.nan if slot == NO_SLOT else load(memory, depth, slot)
            if np.isnan(value):
                break
            stack[top - 1] = value
        elif step in (opcodes.LOAD_BELOW, opcodes.LOAD_NUMBERED_BELOW):
            slot = argument
            if step == opcodes.LOAD_NUMBERED_BELOW:
                slot = slot_of_number(table.numbered, stack[top - 2])
            value = np.nan if slot == NO_SLOT else load(memory, depth, slot)
            if np.isnan(value):
                break
            stack[top] = stack[top - 1]
            stack[top - 1] = value
            top += 1
        elif step == opcodes.DEFINED:
            stack[top] = 0.0 if np.isnan(load(memory, depth, argument)) else 1.0
            top += 1
        elif step == opcodes.DROP:
            top -= 1
        elif step in (opcodes.STORE, opcodes.STORE_DECLARED, opcodes.STORE_NUMBERED):
            top -= 1
            slot = argument
            if step == opcodes.STORE_NUMBERED:
                slot = slot_of_number(table.numbered, stack[top - 1])
                if slot == NO_SLOT:
                    break
            before = own_value(memory, depth, slot)
            if step == opcodes.STORE_DECLARED and np.isnan(before):
                break
            bench.slots[stores], bench.before[stores] = slot, before
            stores += 1
            store(memory, depth, slot, stack[top])
        elif step in (opcodes.WORD, opcodes.WORD_NUMBER):
            bench.roles[words] = argument
            if step == opcodes.WORD:
                top -= 1
                bench.values[words] = stack[top]
            else:
                bench.values[words] = table.number[row]
            words += 1
        elif step == opcodes.KEEP and not kept:
            copy_state(state, bench.kept)
            kept = True
        elif step == opcodes.COMPENSATE:
            top -= 1
            if not begin_compensation(argument, stack[top], constants, state, contour):
                break
        elif step == opcodes.END_COMPENSATION:
            after = end_compensation(made, state.happened[0], contour, rows)
            if after < 0:
                break
            made = progress[MADE] = after  # not undone: to end it twice is to end it once
        elif step >= opcodes.IN_FORCE:
            top = run_deed(
                step,
                argument,
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
            if top == DOUBTFUL:
                break
        elif step in (opcodes.RUN, opcodes.RUN_OFTEN, opcodes.RUN_CODES, opcodes.RUN_POLAR):
            polar = step == opcodes.RUN_POLAR
            if polar:
                radius = stack[top - 2 if argument == 3 else top - 1]
                angle = stack[top - 1]
                if not polar_target(argument, radius, angle, constants, state):
                    break
            count = 1.0
            if step == opcodes.RUN_OFTEN:
                top -= 1
                count = stack[top]
                if not 1.0 <= count <= table.number[row] or count != np.floor(count):
                    break
                if state.modal[CYCLE] != 0.0 or contour.counts[STAGE] != OFF:
                    break
                if made + count > len(rows.codes):
                    why = FULL
                    break
                copy_state(state, bench.kept)
            after = run_times(
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
                bench,
            )
            if after < 0:
                why = FULL if after == NO_ROOM else LEFT
                if step == opcodes.RUN_OFTEN:
                    copy_state(bench.kept, state)
                break
            first_event = state.happened[0]
            made = after
            if step == opcodes.RUN_CODES:
                words = 1 if words > 0 and bench.roles[0] == NUMBER else 0
        elif step == opcodes.JUMP:
            going = argument
        elif step in (opcodes.JUMP_IF, opcodes.JUMP_UNLESS):
            top -= 1
            if (stack[top] != 0.0) == (step == opcodes.JUMP_IF):
                going = argument
                step = opcodes.NEXT
        elif step == opcodes.JUMP_CASE:
            top -= 1
            if stack[top] == stack[top - 1]:
                going = argument
                step = opcodes.NEXT
        elif step == opcodes.BEGIN_FOR:
            first, last, width = stack[top - 3], stack[top - 2], stack[top - 1]
            if width == 0.0:
                break
            stack[top - 3] = 1.0 if (first - last) * width > 0.0 else 0.0
            stack[top - 2] = first
            top -= 1
        elif step == opcodes.STEP_FOR:
            last, width = stack[top - 3], stack[top - 2]
            if width == 0.0:
                break
            value = stack[top - 1] + width
            stack[top - 4] = 1.0 if (value - last) * width <= 0.0 else 0.0
            stack[top - 3] = value
            top -= 2
        elif step == opcodes.COUNT_DOWN:
            left = own_value(memory, depth, argument)
            if np.isnan(left):
                left = table.number[row]
            store(memory, depth, argument, np.nan if left == 0.0 else left - 1.0)
            stack[top] = 0.0 if left == 0.0 else 1.0
            top += 1
        elif step == opcodes.MAY_CALL:
            if called >= argument or called >= len(calls) or depth + 1 >= len(memory.local):
                break
        elif step == opcodes.OWN_VARIABLES:
            depth += 1
            own = 1
            memory.local[depth, :] = np.nan
        elif step == opcodes.RESTORING:
            restores = RESTORED_HERE
        elif step in (opcodes.CALL, opcodes.REPEAT):
            again = 0.0
            if step == opcodes.REPEAT:
                top -= 1
                again = stack[top] - 1.0
                if not again >= 0.0 or again != np.floor(again):
                    break
            call = calls[called]
            call[BACK], call[FIRST], call[AGAIN] = behind, argument, int(again)
            call[LAST], call[OWN], call[RESTORES] = range_end, own, restores
            if restores == RESTORED_HERE:
                copy_force(state.modal, state.in_force, saved.modal[called], saved.in_force[called])
            called += 1
            going = argument
        elif step == opcodes.RANGE:
            range_end = argument
        elif step == opcodes.MAY_RETURN:
            from_part = innermost(calls, called)
            if from_part == 0 or calls[from_part - 1, RESTORES] == RESTORED_BY_CONTROL:
                break
        elif step == opcodes.RETURN:
            called = innermost(calls, called) - 1
            depth -= calls[called, OWN]
            going = calls[called, BACK]
            if calls[called, RESTORES] == RESTORED_HERE:
                copy_force(saved.modal[called], saved.in_force[called], state.modal, state.in_force)
        elif step == opcodes.LEAVE:
            break
        if step == opcodes.NEXT:
            progress[LINE], progress[PART] = going >> PART_BITS, going & _PART_MASK
            progress[FURTHEST] = max(progress[FURTHEST], place)
            progress[STEPS_LEFT], progress[DEPTH], progress[CALLS] = steps_left, depth, called
            progress[MADE] = made
            if contour.counts[STAGE] != OFF:
                hold_events(contour, rows, first_event, state.happened[0])
            progress[BLOCKS] += 1
            return DONE
    if kept:
        copy_state(bench.kept, state)
    if not compensates:
        contour.counts[STAGE] = OFF
    while stores > 0:
        stores -= 1
        store(memory, progress[DEPTH], bench.slots[stores], bench.before[stores])
    return why
