"""A program's blocks: words with the place where they are."""

from typing import NamedTuple

from twin.nc.canonical import NO_BLOCK_NUMBER
from twin.nc.text.expressions.expressions import Expression, NumberedVariable, Variable


class Location(NamedTuple):
    """Where a block is in a program: its line, from 0, and its part of the line, from 0."""

    line: int
    part: int


class Word(NamedTuple):
    """An address with its value.

    Attributes:
        address: Upper case, such as ``X`` or ``FF``.
        value: A number, or an expression where the program computes it; NaN where it has none, as ``FMAX``.
        column: First character in the line, from 0.
        width: Characters from the address to the end of the value.
        incremental: The word alone is incremental (``X20I``).
        without_point: A number without a decimal point.
        mark: What the program writes besides address and value: how the value counts (``IC``), the name of
            a code, a name in angle brackets, or a text in quotes.
    """

    address: str
    value: float | Expression
    column: int
    width: int
    incremental: bool = False
    without_point: bool = False
    mark: str = ""

    @property
    def text(self) -> str:
        """The word as a programmer would write it."""
        if self.mark:
            whole = self.address == "G" or self.address.endswith("<")
            return self.mark if whole else f"{self.address}={self.mark}"
        if self.value != self.value:
            return self.address
        value = f"{self.value:.10g}" if isinstance(self.value, float) else "..."
        return f"{self.address}{'=' * self.address[-1:].isdigit()}{value}"


class Statement(NamedTuple):
    """Something that is not made of words: an assignment, a loop, a call.

    Attributes:
        keyword: Upper case name of the statement, such as ``$IF`` or ``=``.
        text: What follows the keyword, without comments.
        column: Where the keyword begins, from 0.
        text_column: Where ``text`` begins, from 0.
    """

    keyword: str
    text: str
    column: int
    text_column: int


class Assignment(NamedTuple):
    """A variable that a block gives a value.

    Attributes:
        column: Where the variable begins, from 0.
        width: Characters up to the end of the value.
        number: That of the variable, where it is computed.
    """

    target: Variable | NumberedVariable
    value: Expression
    column: int
    width: int
    number: Expression | None = None


def assignment_of(
    target: Variable | NumberedVariable, value: Expression, column: int, width: int
) -> Assignment:
    """An assignment; arguments as its attributes."""
    number = Expression("", target.index) if isinstance(target, NumberedVariable) else None
    return Assignment(target, value, column, width, number)


class Block(NamedTuple):
    """One block of a program.

    Attributes:
        line: Source line, from 1.
        part: Which of the line's blocks it is, from 0.
        number: Its N number or ``NO_BLOCK_NUMBER``.
        words: Its words without N, in the order of the text.
        skippable: It begins with a slash.
        name: Its label in brackets, or empty.
        assignments: Variables that get new values when all words have been read.
        skip_level: Number behind the slash, 1 where there is none.
    """

    line: int
    part: int
    number: int = NO_BLOCK_NUMBER
    words: tuple[Word, ...] = ()
    statement: Statement | None = None
    skippable: bool = False
    name: str = ""
    assignments: tuple[Assignment, ...] = ()
    skip_level: int = 1
