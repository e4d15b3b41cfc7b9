"""The compiled run through a program: lines of text, compiled blocks, parts that are called.

It stops before a block that it does not know or that something is wrong with, with everything as it
was before that block.
"""

import numpy as np
import numpy.typing as npt

from twin.compilation.compilable import compilable
from twin.nc.bytecode import opcodes
from twin.nc.bytecode.bytecode import (
    INTERPRETED,
    NOT_COMPILED,
    NOTHING,
    PART_BITS,
    WORDS_ALONE,
    BytecodeTable,
)
from twin.nc.bytecode.frames import (
    ENDED,
    FULL,
    LINE,
    MADE,
    OFF_PAGE,
    PART,
    PAUSED,
    TRAPPED,
    UNCOMPILED_LINE,
    ExecutionState,
)
from twin.nc.bytecode.registers import MOST_EVENTS, MOST_WORDS, BlockTables, Constants, State
from twin.nc.canonical import IntArray
from twin.nc.compiled.kernels.block import Scratch
from twin.nc.compiled.kernels.dispatch import DONE, dispatch_loop
from twin.nc.compiled.kernels.tokenizer import (
    UNSUPPORTED,
    ByteArray,
    LineTables,
    line_end,
    read_words,
)
from twin.nc.compiled.kernels.variables import end_parts
from twin.nc.path.compensation.contour import MOST_LET_GO, OFF, STAGE
from twin.nc.path.rows import Rows
from twin.nc.text.lexer import LONGEST_LINE

_PART_MASK = (1 << PART_BITS) - 1


@compilable
def run_program(
    data: ByteArray,
    starts: IntArray,
    first_line: int,
    line_tables: LineTables,
    tables: BlockTables,
    constants: Constants,
    state: State,
    rows: Rows,
    table: BytecodeTable,
    routine: ExecutionState,
    scratch: Scratch,
    most: int,
) -> int:
    """Run blocks until one is for the interpreter tier or for the line compiler, or the rows are full.

    Args:
        data: A page of the program as UTF-8.
        starts: Where each line of it begins, and where the last one ends, shape (lines + 1,).
        first_line: Its first line, from 0.
        line_tables: How lines are read.
        tables: What blocks mean.
        constants: What stays.
        state: What changes with moves.
        rows: Room for the moves.
        table: What compiled lines do.
        routine: How far the program has come.
        scratch: Room to work in.
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
        room = 1
        if contour.counts[STAGE] != OFF:
            room = len(contour.waiting.codes) + MOST_LET_GO
        if progress[MADE] + room > len(rows.codes) or state.event_count[0] + MOST_EVENTS > len(
            rows.events
        ):
            return FULL
        row, words = int(np.int64(table.first[line])), 0
        if row == INTERPRETED:
            return TRAPPED
        is_text = row == NOT_COMPILED
        if is_text:
            at = line - first_line
            if at < 0 or at >= len(starts) - 1:
                return OFF_PAGE
            begin = int(starts[at])
            end = line_end(data, begin, int(starts[at + 1]))
            if progress[PART] > 0 or end - begin > LONGEST_LINE:
                return UNCOMPILED_LINE
            words = read_words(data, begin, end, line_tables, scratch.token_kinds, scratch.values)
            if words == UNSUPPORTED:
                return UNCOMPILED_LINE
            row = WORDS_ALONE if words > 0 else NOTHING
        for _part in range(progress[PART]):
            row = (
                int(np.int64(table.operand[row])) if table.opcode[row] == opcodes.BLOCK else NOTHING
            )
        if table.opcode[row] != opcodes.BLOCK:
            progress[LINE], progress[PART] = line + 1, 0
            continue
        result = dispatch_loop(row, words, table, tables, constants, state, rows, routine, scratch)
        if result != DONE:
            return UNCOMPILED_LINE if is_text and result == TRAPPED else result
    return PAUSED


@compilable
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
        starts: As for ``run_program``.
        first_line: As for ``run_program``.
        line_tables: As for ``run_program``.
        first: First row of each compiled line.
        line: The line before them, from 0.
        most: How many lines are looked at.
    """
    token_kinds, values = np.zeros(MOST_WORDS, np.int64), np.zeros(MOST_WORDS)
    last = min(line + 1 + most, first_line + len(starts) - 1)
    found, count = np.zeros(most, np.int64), 0
    for each in range(line + 1, last):
        begin = starts[each - first_line]
        end = line_end(data, begin, starts[each - first_line + 1])
        if first[each] != NOT_COMPILED or end - begin > LONGEST_LINE:
            continue
        if read_words(data, begin, end, line_tables, token_kinds, values) == UNSUPPORTED:
            found[count] = each
            count += 1
    return found[:count]
