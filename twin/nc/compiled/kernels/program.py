"""The compiled run through a program: lines of text, compiled blocks, parts that are called.

It stops before a block that it does not know or that something is wrong with, with everything as it
was before that block.
"""

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from twin.compilation.compilable import compilable
from twin.nc.bytecode import opcodes
from twin.nc.bytecode.bytecode import (
    INTERPRETED,
    NOT_COMPILED,
    NOTHING,
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
    STORES,
    TRAPPED,
    UNCOMPILED_LINE,
    WORDS,
    ExecutionState,
    Scratch,
    end_parts,
)
from twin.nc.bytecode.registers import MOST_EVENTS, MOST_WORDS, Machine
from twin.nc.bytecode.token_kinds import UNSUPPORTED, ByteArray, LineTables
from twin.nc.canonical import IntArray
from twin.nc.compiled.kernels.dispatch import DONE, dispatch_loop
from twin.nc.compiled.kernels.tokenizer import read_words
from twin.nc.path.compensation.contour import MOST_LET_GO, OFF, STAGE


class PageColumns(NamedTuple):
    """A page of the program as UTF-8.

    Attributes:
        data: Its bytes.
        starts: Where each line of it begins, shape (lines,).
        ends: Where each ends, shape (lines,).
        first_line: Its first line, from 0.
    """

    data: ByteArray
    starts: IntArray
    ends: IntArray
    first_line: int


@compilable
def run_program(
    page: PageColumns,
    line_tables: LineTables,
    table: BytecodeTable,
    machine: Machine,
    execution: ExecutionState,
    scratch: Scratch,
    most: int,
) -> int:
    """Run blocks until one is for the interpreter tier or for the line compiler, or the rows are full.

    Args:
        page: The lines to read.
        line_tables: How lines are read.
        table: What compiled lines do.
        machine: What blocks run on.
        execution: How far the program has come.
        scratch: Room to work in.
        most: Lines and blocks after which it pauses.

    Returns:
        Why it ended.
    """
    rows, data = machine.rows, page.data
    progress, calls = execution.progress, execution.calls
    lines = len(table.first) - 1
    contour, events = execution.contour, machine.state.event_count
    for _ in range(most):
        end_parts(progress, calls)
        line = int(progress[LINE])
        if line >= lines:
            return ENDED
        room = 1
        if contour.counts[STAGE] != OFF:
            room = len(contour.waiting.codes) + MOST_LET_GO
        if progress[MADE] + room > len(rows.codes) or events[0] + MOST_EVENTS > len(rows.events):
            return FULL
        row, words = int(np.int64(table.first[line])), 0
        if row == INTERPRETED:
            return TRAPPED
        is_text = row == NOT_COMPILED
        if is_text:
            at = line - page.first_line
            if at < 0 or at >= len(page.starts):
                return OFF_PAGE
            begin, end = int(page.starts[at]), int(page.ends[at])
            if progress[PART] > 0 or end - begin > line_tables.longest:
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
        scratch.counts[WORDS], scratch.counts[STORES] = words, 0
        result = dispatch_loop(row, table, machine, execution, scratch)
        if result != DONE:
            return UNCOMPILED_LINE if is_text and result == TRAPPED else result
    return PAUSED


@compilable
def unread_lines(
    page: PageColumns,
    line_tables: LineTables,
    first: npt.NDArray[np.int32],
    line: int,
    most: int,
) -> IntArray:
    """Those of the next lines on the page that a run would not read by itself.

    Args:
        page: The lines to read.
        line_tables: How lines are read.
        first: First row of each compiled line.
        line: The line before them, from 0.
        most: How many lines are looked at.
    """
    data, first_line = page.data, page.first_line
    token_kinds, values = np.zeros(MOST_WORDS, np.int64), np.zeros(MOST_WORDS)
    last = min(line + 1 + most, first_line + len(page.starts))
    found, count = np.zeros(most, np.int64), 0
    for each in range(line + 1, last):
        begin, end = page.starts[each - first_line], page.ends[each - first_line]
        if first[each] != NOT_COMPILED or end - begin > line_tables.longest:
            continue
        if read_words(data, begin, end, line_tables, token_kinds, values) == UNSUPPORTED:
            found[count] = each
            count += 1
    return found[:count]
