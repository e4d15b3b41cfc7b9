"""Translates lines that are not plain into instructions, when a run comes to them."""

from twin.nc.block_writer import BlockWriter, NotTranslatableError
from twin.nc.blocks import Block
from twin.nc.control import Control
from twin.nc.diagnostics import ProgramError
from twin.nc.expression_kernels import ONE, THREE, TWO
from twin.nc.instructions import GENERAL, LARGEST_PART, Instructions, Step
from twin.nc.plain_tables import PlainTables
from twin.nc.plain_words_kernels import NUMBER


class Translator:
    """Translates the program of one control.

    Attributes:
        instructions: What was translated.
    """

    def __init__(self, control: Control, tables: PlainTables) -> None:
        self._control = control
        self.instructions = Instructions(len(control.flow.lines))
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
        blocks = None
        if self._control.dialect.translate is not None:
            blocks = self._control.flow.quiet_blocks(line)
        if blocks is None or len(blocks) > LARGEST_PART:
            instructions.begins(line, GENERAL)
            return False
        instructions.make_room()
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
            self._writer.begin()
            if not (block.skippable and control.settings.block_skip):
                assert control.dialect.translate is not None
                control.dialect.translate(control, block, self._writer)
        except (NotTranslatableError, ProgramError):
            return False
        finally:
            control.block, control.report.line = before
        self.instructions.add(Step.NEXT)
        return True
