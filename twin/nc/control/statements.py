"""What statements hold: expressions, and blocks behind their keywords."""

from collections.abc import Callable
from typing import TypeVar

from twin.nc.text.blocks import Block, Statement
from twin.nc.text.diagnostics.reporter import Reporter
from twin.nc.text.expressions.expressions import Expression, ExpressionError
from twin.nc.text.lexer import Lexer
from twin.nc.text.lines import Lines

Found = TypeVar("Found")
Read = Callable[[str, int], tuple[Found, int]]


class StatementReader:
    """Reads the texts of statements."""

    def __init__(self, lines: Lines, lexer: Lexer, report: Reporter) -> None:
        self._lines = lines
        self._lexer = lexer
        self._report = report

    def expression(self, text: str, column: int) -> Expression:
        """Read a text that must be one expression."""
        (only,) = self.expressions(text, column, 1)
        return only

    def expressions(
        self, text: str, column: int, count: int | None = None, hint: str | None = None
    ) -> list[Expression]:
        """Read a text that must be expressions separated by commas; a hint says how they are written."""
        if not text.strip() and not count:
            return []
        found, end = self._read(self._lexer.expressions.read_list, text, 0, column)
        rest = text[end:].strip()
        if count is not None and len(found) != count:
            message = f"{count} value{'s' * (count > 1)} must stand here, not {len(found)}"
            self._report.fail("expression", message, column + end, 1, hint)
        if rest:
            begin, message = text.index(rest, end), f"'{rest.split()[0]}' does not belong here"
            hint = self._lexer.expressions.comparison_at(rest, 0) or hint or "leave it out"
            self._report.fail("expression", message, column + begin, len(rest.split()[0]), hint)
        return found

    def operand(self, text: str, at: int, column: int) -> tuple[Expression, int]:
        """Read the operand at a place of a text that begins at a column; return it with its end."""
        return self._read(self._lexer.expressions.read_operand, text, at, column)

    def longest(self, text: str, at: int, column: int) -> tuple[Expression, int]:
        """As ``operand``, but read the longest expression."""
        return self._read(self._lexer.expressions.read, text, at, column)

    def _read(self, read: Read[Found], text: str, at: int, column: int) -> tuple[Found, int]:
        try:
            return read(text, at)
        except ExpressionError as error:
            self._report.fail(error.code, str(error), column + (error.column or 0), 1, error.hint)

    def blocks(self, text: str, column: int, line: int) -> tuple[Block, ...]:
        """The blocks of a text that begins at a column of a line, from 1."""
        return self._lexer.blocks(" " * column + text, line)

    def of_line(self, line: int) -> Statement:
        """The statement of another line, from 0; errors are that line's from now on."""
        self._report.line = line + 1
        (block,) = self._lexer.blocks(self._lines[line], line + 1)
        assert block.statement is not None
        return block.statement
