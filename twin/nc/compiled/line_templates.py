"""Lines that differ in their numbers alone are compiled alike: once, for all of them.

A post-processor's program may hold a hundred thousand lines such as ``X[P1+2.5]``; reading each as
an expression would cost more than running it.
"""

import dataclasses
import re
from collections.abc import Set

import numpy as np

from twin.nc.bytecode import opcodes
from twin.nc.bytecode.bytecode import BytecodeTable
from twin.nc.bytecode.token_kinds import CODE, FUNCTION
from twin.nc.canonical import FloatArray, IntArray
from twin.nc.text.arithmetic import is_whole
from twin.nc.text.expressions import LARGEST_NUMBER
from twin.nc.text.line_reader import LARGEST_LABEL
from twin.nc.text.plain_word import (
    BLANKS,
    BLANKS_BETWEEN,
    NUMBER,
    SIGNED_NUMBER,
    SIGNED_POINTED_NUMBER,
)

_SHARED = (*range(opcodes.CONSTANT, opcodes.JUMP), opcodes.SNAPSHOT, opcodes.SET_REGISTER)
"""Opcodes of lines that may share a template, besides those of variables, words and moves."""
_MOST_TEMPLATES = 1000
"""Templates that are kept: a program that has more gains nothing by them."""


@dataclasses.dataclass(frozen=True, slots=True)
class Template:
    """What the lines of one shape do.

    Attributes:
        instructions: Opcodes, operands and immediates of the line that was compiled, shape (n,) each.
        places: Rows whose number is the line's own, in the order of its text, shape (m,).
    """

    instructions: tuple[IntArray, IntArray, FloatArray]
    places: IntArray


class LineTemplates:
    """The templates of one program's lines."""

    def __init__(self, letters: Set[str], pointed: Set[str] = frozenset()) -> None:
        """Know no template yet.

        Args:
            letters: Those of words whose value does not change what the block is.
            pointed: Those of words whose number does so where it has no decimal point.
        """
        # The block's number, a word with its number, or a number that belongs to no name.
        label = rf"\A{BLANKS}N{BLANKS_BETWEEN}{NUMBER}"
        plain, others = "".join(letters - pointed), "".join(letters & pointed)
        word = [rf"[{plain}]{BLANKS_BETWEEN}{SIGNED_NUMBER}"] if plain else []
        if others:
            word.append(rf"[{others}]{BLANKS_BETWEEN}{SIGNED_POINTED_NUMBER}")
        self._number = re.compile(
            rf"({label}|(?<![\w.$#])(?:{'|'.join([*word, NUMBER])}))", re.IGNORECASE
        )
        self._templates: dict[tuple[str, ...], Template] = {}

    def split(self, text: str) -> tuple[tuple[str, ...], list[float]]:
        """A line without its numbers, and these."""
        pieces, numbers = self._number.split(text), []
        for at, word in enumerate(pieces[1::2]):
            written = word.strip()
            letter = written[0] if written[0].isalpha() else ""
            numbers.append(float(written[len(letter) :]))
            pieces[2 * at + 1] = letter
        return tuple(pieces), numbers

    def find(self, key: tuple[str, ...], numbers: list[float]) -> Template | None:
        """The template for a line that was split, or None."""
        template = self._templates.get(key)
        if template is None or any(not abs(number) <= LARGEST_NUMBER for number in numbers):
            return None
        labelled = key[1:2] == ("N",)
        return None if labelled and not is_whole(numbers[0], LARGEST_LABEL) else template

    def keep(
        self,
        key: tuple[str, ...],
        numbers: list[float],
        table: BytecodeTable,
        rows: slice,
        columns: list[int],
    ) -> None:
        """Remember what a line does, where its numbers are all that it does not share.

        Args:
            key: The line without its numbers.
            numbers: Its numbers.
            table: The instructions.
            rows: Those of the line.
            columns: Where the word stands that each of the rows of a line of one block belongs to.
        """
        codes, operands = table.opcode[rows].copy(), table.operand[rows].copy()
        own = np.flatnonzero(
            (codes == opcodes.CONSTANT)
            | ((codes == opcodes.WORD_CONSTANT) & ~np.isin(operands, (CODE, FUNCTION)))
        )
        shared = len(columns) == len(codes) and (
            ((codes <= opcodes.RUN) | np.isin(codes, _SHARED)).all()
            and (codes[1:] != opcodes.BLOCK).all()
            and len(self._templates) < _MOST_TEMPLATES
        )
        if not shared:
            return
        own = own[np.argsort(np.array(columns)[own], kind="stable")]
        if table.immediate[rows][own].tolist() == numbers:
            instructions = codes, operands, table.immediate[rows].copy()
            self._templates[key] = Template(instructions, own)
