"""Lines that differ in their numbers alone are translated alike: once, for all of them.

A post-processor's program may hold a hundred thousand lines such as ``X[P1+2.5]``; reading each as
an expression would cost more than running it.
"""

import dataclasses
import re
from collections.abc import Iterable

import numpy as np

from twin.nc.bytecode.opcodes import Step, Table
from twin.nc.canonical import FloatArray, IntArray
from twin.nc.compiled.kernels.tokenizer import CODE, FUNCTION
from twin.nc.text.expressions import LARGEST_NUMBER, NUMBER

_LABEL = re.compile(r"[ \t]*N[ \t]*([0-9]{1,9})(?=[ \t])", re.IGNORECASE)
_SHARED = (Step.KEEP, Step.CYCLE_WORD)
"""Steps of lines that may share a shape, besides those that compute and move."""
_MOST_SHAPES = 1000
"""Shapes that are kept: a program that has more gains nothing by them."""


@dataclasses.dataclass(frozen=True, slots=True)
class Shape:
    """What the lines of one shape do.

    Attributes:
        steps: Shape (n,).
        arguments: Shape (n,).
        numbers: Of the line that was translated, shape (n,).
        places: Rows whose number is the line's own, in the order of its text, shape (m,).
    """

    steps: IntArray
    arguments: IntArray
    numbers: FloatArray
    places: IntArray


class LineShapes:
    """The shapes of one program's lines."""

    def __init__(self, letters: Iterable[str]) -> None:
        """Know no shape yet.

        Args:
            letters: Those of words whose value does not change what the block is.
        """
        # A word with its number, or a number that belongs to no name.
        self._number = re.compile(
            rf"((?<![\w.$#])[{''.join(letters)}][ \t]*[-+]?{NUMBER}|(?<![\w.$#]){NUMBER})",
            re.IGNORECASE,
        )
        self._shapes: dict[tuple[str, ...], Shape] = {}

    def split(self, text: str) -> tuple[tuple[str, ...], list[float]]:
        """A line without its numbers, and these."""
        label = _LABEL.match(text)
        pieces = self._number.split(text if label is None else text[label.end() :])
        words = pieces[1::2]
        numbers = [0.0 if label is None else float(label[1])]
        for at, word in enumerate(words):
            letter = word[0] if word[0].isalpha() else ""
            numbers.append(float(word[1:] if letter else word))
            pieces[2 * at + 1] = letter
        if label is not None:
            return ("N", *pieces), numbers
        return tuple(pieces), numbers[1:]

    def find(self, key: tuple[str, ...], numbers: list[float]) -> Shape | None:
        """The shape of a line that was split, or None."""
        shape = self._shapes.get(key)
        if shape is None or any(not abs(number) <= LARGEST_NUMBER for number in numbers):
            return None
        return shape

    def keep(
        self,
        key: tuple[str, ...],
        numbers: list[float],
        table: Table,
        rows: slice,
        columns: list[int],
    ) -> None:
        """Remember what a line does, where its numbers are all that it does not share.

        Args:
            key: The line without its numbers.
            numbers: They.
            table: The instructions.
            rows: Those of the line.
            columns: Where the word stands that each of the rows of a line of one block belongs to.
        """
        steps, arguments = table.step[rows].copy(), table.argument[rows].copy()
        own = np.flatnonzero(
            (steps == Step.NUMBER)
            | ((steps == Step.WORD_NUMBER) & ~np.isin(arguments, (CODE, FUNCTION)))
        )
        shared = len(columns) == len(steps) and (
            ((steps <= Step.RUN) | np.isin(steps, _SHARED)).all()
            and (steps[1:] != Step.BLOCK).all()
            and len(self._shapes) < _MOST_SHAPES
        )
        if not shared:
            return
        own = own[np.argsort(np.array(columns)[own], kind="stable")]
        if table.number[rows][own].tolist() == numbers:
            self._shapes[key] = Shape(steps, arguments, table.number[rows].copy(), own)
