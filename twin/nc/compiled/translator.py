"""Translates lines that are not plain into instructions, when a run comes to them."""

import numpy as np

from twin.nc.bytecode.assembler import BlockWriter, NotTranslatableError
from twin.nc.bytecode.opcodes import GENERAL, LARGEST_PART, Instructions, Step
from twin.nc.compiled.kernels.expression import ONE, THREE, TWO
from twin.nc.compiled.kernels.program import unread_lines
from twin.nc.compiled.kernels.tokenizer import CODE, FUNCTION, NUMBER
from twin.nc.compiled.line_shapes import LineShapes
from twin.nc.compiled.tables import PlainTables
from twin.nc.control.control import Control
from twin.nc.text.blocks import Block
from twin.nc.text.diagnostics import ProgramError

_MEANINGS = (NUMBER, CODE, FUNCTION)
"""Roles of words whose value says what a block is."""
_AHEAD = 1000
"""Lines that are looked at for further ones of known shapes: one call for many of them."""


class Translator:
    """Translates the program of one control.

    Attributes:
        instructions: What was translated.
    """

    def __init__(self, control: Control, tables: PlainTables) -> None:
        self._control = control
        self._lines = tables.lines
        self.instructions = Instructions(len(control.flow.lines))
        letters = [letter for letter, role in tables.roles.items() if role not in _MEANINGS]
        self._shapes = LineShapes({*letters, *tables.cycle_letters})
        self._writer = BlockWriter(
            self.instructions,
            control.variables,
            tables.roles,
            (ONE, TWO, THREE),
            NUMBER,
            control.dialect.live_variables,
        )

    def translate(self, line: int) -> bool:
        """Translate a line, from 0; False where the general way must run all of it."""
        instructions = self.instructions
        if self._control.dialect.translate is None:
            return False
        instructions.make_room()
        lines = self._control.flow.lines
        key, numbers = self._shapes.split(lines[line])
        if self._copy(line, key, numbers):
            page = lines.page_of(line)
            ahead = unread_lines(
                page.data,
                page.starts,
                page.lines.start,
                self._lines,
                instructions.table.first,
                line,
                _AHEAD,
            )
            for each in ahead.tolist():
                self._copy(each, *self._shapes.split(lines[each]))
            return True
        first = instructions.rows
        known = self._translate_line(line)
        if known:
            rows = slice(first, instructions.rows)
            self._shapes.keep(key, numbers, instructions.table, rows, self._writer.columns)
        return known

    def _copy(self, line: int, key: tuple[str, ...], numbers: list[float]) -> bool:
        """Translate a line as one of its shape was; False where there was none."""
        shape = self._shapes.find(key, numbers)
        if shape is None:
            return False
        row = self.instructions.add_rows(
            shape.steps, shape.arguments, shape.numbers, np.array(numbers), shape.places
        )
        self.instructions.begins(line, row)
        return True

    def _translate_line(self, line: int) -> bool:
        instructions = self.instructions
        blocks = self._control.flow.quiet_blocks(line)
        if blocks is None or len(blocks) > LARGEST_PART:
            instructions.begins(line, GENERAL)
            return False
        first, before = instructions.rows, None
        any_known = not blocks
        for block in blocks:
            if before is not None:
                instructions.lead_here(before)
            before = instructions.rows
            known = self._translate(block)
            if not known:
                instructions.take_back(before)
                instructions.add(Step.BLOCK)
                instructions.add(Step.LEAVE)
            any_known = any_known or known
        if not blocks:
            instructions.add(Step.NEXT)
        if not any_known:
            instructions.take_back(first)
        instructions.begins(line, first if any_known else GENERAL)
        return any_known

    def _translate(self, block: Block) -> bool:
        control = self._control
        before = control.block, control.report.line
        control.block = block
        try:
            self._writer.begin(block)
            if not (block.skippable and control.settings.block_skip):
                assert control.dialect.translate is not None
                control.dialect.translate(control, block, self._writer)
        except (NotTranslatableError, ProgramError):
            return False
        finally:
            control.block, control.report.line = before
        self._writer.end()
        return True
