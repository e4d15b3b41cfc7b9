"""A program's bytecode: a table of instructions that grows, and the first row of each of its lines."""

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from twin.nc.bytecode import opcodes
from twin.nc.canonical import FloatArray, IntArray
from twin.nc.text.blocks import Location

MOST_INSTRUCTIONS = 1 << 19
"""Rows that are kept; a program that needs more is compiled anew from there on."""
MOST_STORES = 64
"""Variables that a block may set."""
MOST_ROWS = 200
"""Rows of a block."""
MOST_VALUES = MOST_ROWS
"""Values that wait on the stack: no row adds more than one."""
PART_BITS = 20
"""A location as one number: the line, and in these bits the part."""
LARGEST_PART = (1 << PART_BITS) - 1
NOT_COMPILED, INTERPRETED = 0, -1
"""Instead of a line's first row: not compiled yet; always run by the interpreter tier."""


NOTHING, WORDS_ALONE = 0, 1
"""Rows that are always there: of a line without a block, and of one that is words alone, which have
been read."""


class Instruction(NamedTuple):
    """One row of the table; what the operands mean, ``opcodes`` says."""

    opcode: int
    operand: int
    immediate: float


class BytecodeTable(NamedTuple):
    """The rows, as the kernel reads them.

    Attributes:
        first: First row of each line, ``NOT_COMPILED`` or ``INTERPRETED``, shape (lines + 1,).
        opcode: Shape (n,).
        operand: Shape (n,).
        immediate: Shape (n,).
        numbered: Slots of the variables that have a number, shape (m,).
    """

    first: npt.NDArray[np.int32]
    opcode: IntArray
    operand: IntArray
    immediate: FloatArray
    numbered: IntArray


_ALWAYS = (opcodes.NEXT, opcodes.BLOCK, opcodes.RUN, opcodes.NEXT)


class Bytecode:
    """A table that grows."""

    def __init__(self, lines: int) -> None:
        self._first = np.zeros(lines + 1, np.int32)
        self._compiled: list[int] = []
        self._opcode = np.zeros(256, np.int64)
        self._operand = np.zeros(256, np.int64)
        self._immediate = np.zeros(256)
        self._opcode[: len(_ALWAYS)] = _ALWAYS
        self._rows = len(_ALWAYS)
        self.numbered = np.zeros(0, np.int64)

    @property
    def rows(self) -> int:
        """Where the next row goes."""
        return self._rows

    @property
    def table(self) -> BytecodeTable:
        """The rows as columns."""
        return BytecodeTable(
            self._first, self._opcode, self._operand, self._immediate, self.numbered
        )

    def add(self, opcode: int, operand: int = 0, immediate: float = 0.0) -> None:
        """Append a row."""
        row = self._rows
        self._grow(1)
        self._opcode[row], self._operand[row], self._immediate[row] = opcode, operand, immediate
        self._rows = row + 1

    def add_lines(
        self,
        lines: list[int],
        instructions: tuple[IntArray, IntArray, FloatArray],
        places: IntArray,
        own: FloatArray,
    ) -> None:
        """Append the rows of lines that differ in numbers alone.

        Args:
            lines: Counted from 0.
            instructions: Opcodes, operands and immediates of one of them, shape (n,) each.
            places: Rows whose number is the line's own, shape (m,).
            own: These numbers of each line, shape (lines, m).
        """
        first, size = self._rows, len(instructions[0])
        count = size * len(lines)
        self._grow(count)
        rows, columns = slice(first, first + count), (self._opcode, self._operand, self._immediate)
        for column, shared in zip(columns, instructions, strict=True):
            column[rows].reshape(-1, size)[:] = shared
        self._immediate[rows].reshape(-1, size)[:, places] = own
        self._first[lines] = np.arange(first, first + count, size)
        self._compiled += lines
        self._rows = first + count

    def _grow(self, rows: int) -> None:
        """Make room for so many rows."""
        while self._rows + rows > len(self._opcode):
            self._opcode = np.concatenate([self._opcode, np.zeros_like(self._opcode)])
            self._operand = np.concatenate([self._operand, np.zeros_like(self._operand)])
            self._immediate = np.concatenate([self._immediate, np.zeros_like(self._immediate)])

    def lead_here(self, row: int) -> None:
        """The next row is the operand of an earlier one."""
        self._operand[row] = self._rows

    def take_back(self, row: int) -> None:
        """Forget this row and those behind it."""
        self._rows = row

    def number_variables(self, slots: list[int]) -> None:
        """From now on these are the slots of the variables 0, 1, 2, ..."""
        self.numbered = np.array(slots, np.int64)

    def begins(self, line: int, row: int) -> None:
        """The rows of a line, counted from 0, begin here; or ``INTERPRETED``."""
        self._first[line] = row
        self._compiled.append(line)

    def make_room(self) -> None:
        """Forget everything where the table has become too long."""
        if self._rows > MOST_INSTRUCTIONS or len(self._compiled) > MOST_INSTRUCTIONS:
            self._first[self._compiled] = NOT_COMPILED
            self._compiled = []
            self._rows = len(_ALWAYS)


def number_of_location(location: Location) -> int:
    """A location as one number, in the order of the program."""
    return location.line << PART_BITS | location.part
