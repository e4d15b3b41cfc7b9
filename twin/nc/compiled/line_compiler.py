"""Compiles lines that are not plain into bytecode, when a run comes to them."""

import numpy as np

from twin.nc.bytecode import opcodes
from twin.nc.bytecode.assembler import UnsupportedError
from twin.nc.bytecode.bytecode import INTERPRETED, LARGEST_PART, Bytecode
from twin.nc.bytecode.bytecode_assembler import BytecodeAssembler
from twin.nc.bytecode.token_kinds import CODE, FUNCTION, NUMBER
from twin.nc.compiled.decode_tables import DecodeTables
from twin.nc.compiled.entries import Kernels, page_columns
from twin.nc.compiled.line_templates import LineTemplates, Template
from twin.nc.control.block_compiler import BlockCompiler
from twin.nc.control.executor import Executor
from twin.nc.text.blocks import Block
from twin.nc.text.diagnostics import ProgramError

_MEANINGS = (NUMBER, CODE, FUNCTION)
"""Roles of words whose value says what a block is."""
_AHEAD = 1000
"""Lines that are looked at for further ones of known shapes: one call for many of them."""


class LineCompiler:
    """Compiles the program of one control.

    Attributes:
        bytecode: What was compiled.
    """

    def __init__(self, control: Executor, tables: DecodeTables, kernels: Kernels) -> None:
        self._control = control
        self._kernels = kernels
        self._lines = tables.lines
        self.bytecode = Bytecode(len(control.program_counter.lines))
        letters = [
            letter
            for letter, token_kind in tables.token_kinds.items()
            if token_kind not in _MEANINGS
        ]
        self._templates = LineTemplates({*letters, *tables.cycle_letters}, tables.pointed)
        self._assembler = BytecodeAssembler(
            self.bytecode,
            control.variables,
            tables.token_kinds,
            NUMBER,
            control.dialect.live_variables,
        )
        self._compiler = BlockCompiler(
            control, control.dialect, self._assembler, control.sort_words
        )

    def compile(self, line: int) -> bool:
        """Compile a line, from 0; False where the interpreter tier must run all of it."""
        bytecode = self.bytecode
        bytecode.make_room()
        lines = self._control.program_counter.lines
        key, numbers = self._templates.split(lines[line])
        if self._templates.find(key, numbers) is not None:
            page = lines.page_of(line)
            ahead = self._kernels.unread_lines(
                page_columns(page), self._lines, bytecode.table.first, line, _AHEAD
            )
            self._copy([line, *ahead.tolist()])
            return True
        first = bytecode.rows
        known = self._compile_line(line)
        if known:
            rows = slice(first, bytecode.rows)
            self._templates.keep(key, numbers, bytecode.table, rows, self._assembler.columns)
        return known

    def _copy(self, lines: list[int]) -> None:
        """Compile those of these lines whose shape has a template; lines of one shape at once."""
        alike: dict[tuple[str, ...], tuple[Template, list[int], list[list[float]]]] = {}
        text = self._control.program_counter.lines
        for line in lines:
            key, numbers = self._templates.split(text[line])
            template = self._templates.find(key, numbers)
            if template is not None:
                _, those, own = alike.setdefault(key, (template, [], []))
                those.append(line)
                own.append(numbers)
        for template, those, own in alike.values():
            self.bytecode.add_lines(those, template.instructions, template.places, np.array(own))

    def _compile_line(self, line: int) -> bool:
        bytecode = self.bytecode
        blocks = self._control.program_counter.quiet_blocks(line)
        if blocks is None or len(blocks) > LARGEST_PART:
            bytecode.begins(line, INTERPRETED)
            return False
        first, before = bytecode.rows, None
        any_known = not blocks
        for block in blocks:
            if before is not None:
                bytecode.lead_here(before)
            before = bytecode.rows
            known = self._compile_block(block)
            if not known:
                bytecode.take_back(before)
                bytecode.add(opcodes.BLOCK)
                bytecode.add(opcodes.TRAP)
            any_known = any_known or known
        if not blocks:
            bytecode.add(opcodes.NEXT)
        if not any_known:
            bytecode.take_back(first)
        bytecode.begins(line, first if any_known else INTERPRETED)
        return any_known

    def _compile_block(self, block: Block) -> bool:
        control = self._control
        before, control.block = control.block, block
        with control.report.quietly() as has_said:
            try:
                self._assembler.begin(block)
                if not control.settings.skips(block):
                    control.dialect.compile_block(self._compiler, block)
            except (UnsupportedError, ProgramError):
                return False
            finally:
                control.block = before
            if has_said():
                return False
        self._assembler.end()
        return True
