"""The compiled run through a program: lines of text, translated blocks, parts that are called.

It stops before a block that it does not know or that something is wrong with, with everything as it
was before that block.
"""

import numpy as np
import numpy.typing as npt

from twin.compilation.kernel import NO, ONCE, array_kernel, kernel
from twin.nc.bytecode.frames import (
    BLOCKS,
    ENDED,
    FULL,
    FURTHEST,
    LEFT,
    LINE,
    MADE,
    OFF_PAGE,
    PART,
    PAUSED,
    STEPS_LEFT,
    UNREAD,
    Routine,
)
from twin.nc.bytecode.opcodes import GENERAL, PART_BITS, UNKNOWN, Step, Table
from twin.nc.bytecode.registers import MOST_EVENTS, MOST_WORDS, BlockTables, Constants, Rows, State
from twin.nc.canonical import IntArray
from twin.nc.compiled.kernels.block import Bench, copy_state, run_times
from twin.nc.compiled.kernels.cycle import NO_ROOM
from twin.nc.compiled.kernels.opcodes import DONE, run_steps
from twin.nc.compiled.kernels.tokenizer import (
    NOT_PLAIN,
    ByteArray,
    LineTables,
    line_end,
    read_words,
)
from twin.nc.compiled.kernels.variables import end_parts
from twin.nc.path.contour_registers import OFF, ROOM, STAGE
from twin.nc.text.lexer import LONGEST_LINE

_BLOCK = int(Step.BLOCK)
_PART_MASK = (1 << PART_BITS) - 1


@kernel
def run_program(
    data: ByteArray,
    starts: IntArray,
    first_line: int,
    line_tables: LineTables,
    tables: BlockTables,
    constants: Constants,
    state: State,
    rows: Rows,
    table: Table,
    routine: Routine,
    bench: Bench,
    most: int,
) -> int:
    """Run blocks until one is for the general way or for the translator, or the rows are full.

    Args:
        data: A page of the program as UTF-8.
        starts: Where each line of it begins, and where the last one ends, shape (lines + 1,).
        first_line: Its first line, from 0.
        line_tables: How lines are read.
        tables: What blocks mean.
        constants: What stays.
        state: What changes with moves.
        rows: Room for the moves.
        table: What translated lines do.
        routine: How far the program has come.
        bench: Room to work in.
        most: Lines and blocks after which it pauses.

    Returns:
        Why it ended.
    """
    progress, calls = routine.progress, routine.calls
    lines = len(table.first) - 1
    contour = routine.contour
    for _ in range(most):
        end_parts(progress, calls)
        line = int(progress[LINE])
        if line >= lines:
            return ENDED
        compensates = contour.counts[STAGE] != OFF
        room = ROOM if compensates else 1
        if progress[MADE] + room > len(rows.codes) or state.happened[0] + MOST_EVENTS > len(
            rows.events
        ):
            return FULL
        row = int(np.int64(table.first[line]))
        if row == GENERAL:
            return LEFT
        if row == UNKNOWN:
            at = line - first_line
            if at < 0 or at >= len(starts) - 1:
                return OFF_PAGE
            begin = int(starts[at])
            end = line_end(data, begin, int(starts[at + 1]))
            if progress[PART] > 0 or end - begin > LONGEST_LINE:
                return UNREAD
            words = read_words(data, begin, end, line_tables, bench.roles, bench.values)
            if words == NOT_PLAIN:
                return UNREAD
            if words == 0:
                progress[LINE] = line + 1
                continue
            place = line << PART_BITS
            steps_left = progress[STEPS_LEFT] - (place <= progress[FURTHEST])
            if steps_left < 0:
                return LEFT
            if compensates:
                copy_state(state, bench.kept)
            made = run_times(
                ONCE,
                line + 1,
                words,
                NO,
                progress[MADE],
                state.happened[0],
                tables,
                constants,
                state,
                rows,
                contour,
                bench,
            )
            if made < 0:
                if compensates:
                    copy_state(bench.kept, state)
                return FULL if made == NO_ROOM else UNREAD if made == NOT_PLAIN else LEFT
            progress[FURTHEST] = max(progress[FURTHEST], place)
            progress[STEPS_LEFT], progress[MADE] = steps_left, made
            progress[BLOCKS] += 1
            progress[LINE] = line + 1
            continue
        for _part in range(progress[PART]):
            row = int(np.int64(table.argument[row])) if table.step[row] == _BLOCK else 0
        if table.step[row] != _BLOCK:
            progress[LINE], progress[PART] = line + 1, 0
            continue
        result = run_steps(row, table, tables, constants, state, rows, routine, bench)
        if result != DONE:
            return result
    return PAUSED


@array_kernel
def unread_lines(
    data: ByteArray,
    starts: IntArray,
    first_line: int,
    line_tables: LineTables,
    first: npt.NDArray[np.int32],
    line: int,
    most: int,
) -> IntArray:
    """Those of the next lines on the page that a run would not read by itself.

    Args:
        data: As for ``run_program``.
        starts: The same.
        first_line: The same.
        line_tables: The same.
        first: First row of each translated line.
        line: The line before them, from 0.
        most: How many lines are looked at.
    """
    roles, values = np.zeros(MOST_WORDS, np.int64), np.zeros(MOST_WORDS)
    last = min(line + 1 + most, first_line + len(starts) - 1)
    found, count = np.zeros(most, np.int64), 0
    for each in range(line + 1, last):
        begin = starts[each - first_line]
        end = line_end(data, begin, starts[each - first_line + 1])
        if first[each] != UNKNOWN or end - begin > LONGEST_LINE:
            continue
        if read_words(data, begin, end, line_tables, roles, values) == NOT_PLAIN:
            found[count] = each
            count += 1
    return found[:count]
