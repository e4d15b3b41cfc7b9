"""How a control takes the words of a block and computes their values."""

import abc
from collections.abc import Callable
from typing import NoReturn, TypeVar

from twin.nc.control.state import ControlState, number_of
from twin.nc.text.blocks import Block, Statement, Word
from twin.nc.text.expressions import Expression, ExpressionError

Found = TypeVar("Found")
Read = Callable[[str, int], tuple[Found, int]]


class ControlWords(ControlState, abc.ABC):
    """The words of the block that is being run."""

    def take(self, address: str) -> Word | None:
        """Take a word from the block; None where it has none."""
        return self.words.pop(address, None)

    def take_number(self, address: str) -> float:
        """Take the value of a word from the block; 0 where it has none."""
        word = self.words.pop(address, None)
        return 0.0 if word is None else number_of(word)

    def take_computed(self, address: str) -> float:
        """Take the value of a word that may be a reference to a variable."""
        word = self.words.pop(address)
        if isinstance(word.value, Expression):
            return self.evaluate(word.value, word)
        return word.value

    def number(self, word: Word) -> float:
        """The value of a word that has been computed."""
        return number_of(word)

    def value(self, word: Word) -> float:
        """The value of a word, which may have to be computed."""
        if isinstance(word.value, Expression):
            return self.evaluate(word.value, word)
        return word.value

    def length(self, word: Word | None) -> float:
        """The value of a word that counts a length [mm]; 0 where there is none."""
        return 0.0 if word is None else number_of(word) * self.modal.unit

    def take_axis_words(self) -> list[tuple[int, Word]]:
        """Take the words that name axes; pairs of column and word.

        Raises:
            ProgramError: The machine lacks an axis.
        """
        words, columns = self.words, self._axis_columns
        if not self._axes_that_lack.isdisjoint(words):
            for name in [each for each in words if each in self._axes_that_lack]:
                self._leave_out(words.pop(name))
        return [(columns[each], words.pop(each)) for each in list(words) if each in columns]

    def _leave_out(self, word: Word) -> None:
        """Pass over the word of an axis that the machine lacks, where the job says so and it stays at 0.

        Raises:
            ProgramError: It does not, or nobody has said so.
        """
        if word.address not in self.settings.axis_words or number_of(word) != 0.0:
            self.refuse_axis(word)

    def refuse_axis(self, word: Word) -> NoReturn:
        """The machine lacks the axis that the word names."""
        names = ", ".join(self.settings.axes.names)
        message = f"this machine has no axis {word.address}"
        rotary = next(
            (n for n, line in zip(names.split(", "), self.linear, strict=True) if not line), ""
        )
        stands = f'; {word.address} = "{rotary}" where it stands for {rotary}' if rotary else ""
        hint = f'axes: {names}; in the job: [axes] {word.address} = "ignored at 0"{stands}'
        self.fail("no-such-axis", message, word, hint)

    def axis_value(self, index: int, word: Word) -> float:
        """Value of an axis word [mm or deg]."""
        return number_of(word) * self.unit_of(index)

    def unit_of(self, index: int) -> float:
        """What 1 of an axis is in the program's unit [mm or deg]."""
        return self.modal.unit if self.linear[index] else 1.0

    def evaluate(self, expression: Expression, word: Word) -> float:
        """Compute an expression; errors point at the word."""
        try:
            return expression.compute(self)
        except ExpressionError as error:
            self.fail(error.code, str(error), word, hint=error.hint)

    def expression(self, text: str, column: int) -> Expression:
        """Read a text that must be one expression."""
        (only,) = self.expressions(text, column, 1)
        return only

    def expressions(self, text: str, column: int, count: int | None = None) -> list[Expression]:
        """Read a text that must be expressions separated by commas."""
        if not text.strip() and not count:
            return []
        found, end = self._read(self.program_counter.lexer.expressions.read_list, text, 0, column)
        if text[end:].strip() or (count is not None and len(found) != count):
            wanted = "values" if count is None else f"{count} value" + "s" * (count > 1)
            hint = "equal is written ==" if text[end:].lstrip().startswith("=") else None
            message = f"{wanted} must stand here and no more"
            self.report.fail("expression", message, column + end, 1, hint)
        return found

    def read_operand(self, text: str, at: int, column: int) -> tuple[Expression, int]:
        """Read the operand at a place of a text that begins at a column; return it with its end."""
        return self._read(self.program_counter.lexer.expressions.read_operand, text, at, column)

    def read_expression(self, text: str, at: int, column: int) -> tuple[Expression, int]:
        """As ``read_operand``, but read the longest expression."""
        return self._read(self.program_counter.lexer.expressions.read, text, at, column)

    def _read(self, read: Read[Found], text: str, at: int, column: int) -> tuple[Found, int]:
        try:
            return read(text, at)
        except ExpressionError as error:
            self.report.fail(error.code, str(error), column + (error.column or 0), 1, error.hint)

    def blocks_within(self, text: str, column: int) -> tuple[Block, ...]:
        """The blocks of a text that stands at a column of the block's line."""
        return self.program_counter.lexer.blocks(" " * column + text, self.block.line)

    def statement_of(self, line: int) -> Statement:
        """The statement of another line, from 0; errors are that line's from now on."""
        self.report.line = line + 1
        (block,) = self.program_counter.lexer.blocks(self.program_counter.lines[line], line + 1)
        assert block.statement is not None
        return block.statement

    def refuse(
        self, statement: Statement, code: str, message: str, hint: str | None = None
    ) -> NoReturn:
        """Refuse a statement; the caret stands under its keyword."""
        self.report.fail(code, message, statement.column, len(statement.keyword), hint)

    def compute(self, expression: Expression, column: int) -> float:
        """Compute an expression of a statement; errors point at its column."""
        try:
            return expression.compute(self)
        except ExpressionError as error:
            self.report.fail(error.code, str(error), column, len(expression.text), error.hint)

    @abc.abstractmethod
    def read_variable(self, name: str, index: float | None) -> float:
        """Value of a variable of the program, for expressions."""
