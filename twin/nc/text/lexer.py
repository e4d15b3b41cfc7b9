"""From a line of text to blocks of words, by a dialect's syntax."""

import re
from collections.abc import Callable, Collection

from twin.nc.text.blocks import Block, Statement
from twin.nc.text.comments import is_control
from twin.nc.text.diagnostics.diagnostics import ProgramError
from twin.nc.text.diagnostics.reporter import Reporter
from twin.nc.text.expressions.expression_reader import ExpressionReader
from twin.nc.text.grammar import Grammar
from twin.nc.text.keyword_line import KeywordLine
from twin.nc.text.line_reader import LineReader
from twin.nc.text.syntax import Language

_SPLIT = re.compile(r"[0-9.][ \t]+[0-9.]")
_COMMA = re.compile(r"(?<=[0-9]),(?=[0-9])")
_BEGINS_BLOCK = re.compile(r"/?[A-Z][ \t]*[-+]?[.0-9#\[]", re.IGNORECASE)
_NUMBER_WITH_BLANKS = re.compile(r"[0-9.](?:[ \t]*[0-9.])+")


class Lexer:
    """Reads the lines of programs in one dialect."""

    def __init__(self, language: Language, report: Reporter) -> None:
        self._grammar = grammar = Grammar(language)
        self._block_end = grammar.syntax.block_end
        self._closes_up = grammar.syntax.blanks_in_numbers
        self._continued = grammar.syntax.continued
        self._has_commas = grammar.syntax.decimal_comma
        self._reader = KeywordLine if grammar.syntax.worded else LineReader
        self._longest = grammar.syntax.longest_line
        self._report = report

    @property
    def keywords(self) -> Collection[str]:
        """What this dialect's statements begin with."""
        return self._grammar.language.keywords

    @property
    def expressions(self) -> ExpressionReader:
        """Reads this dialect's expressions."""
        assert self._grammar.reader is not None
        return self._grammar.reader

    def blocks(
        self, line: str, number: int, previous: Callable[[int], str] = lambda _number: ""
    ) -> tuple[Block, ...]:
        """Read a line by its number, from 1; one without words gives no block. ``previous``: the text before it."""
        if not line or line.isspace():
            return ()
        self._report.line = number
        if len(line) > self._longest or not line.isprintable():
            self._check(line)
        if self._continued and previous(number).rstrip().endswith(self._continued):
            return (Block(number, 0, statement=Statement(self._continued, line, 0, 0)),)
        if self._block_end and self._block_end in line:
            line = self._before_end(line)
        if self._closes_up and _SPLIT.search(line):
            line = self._grammar.outside_comments(_NUMBER_WITH_BLANKS, _closed_up, line)
        if self._has_commas and "," in line:
            line = self._grammar.outside_comments(_COMMA, lambda _comma: ".", line)
        try:
            return self._reader(self._grammar, self._report, line, number).blocks()
        except ProgramError:
            excuse = self._grammar.syntax.excused(line, previous(number))
            if excuse is None:
                raise
        self._report.warn(excuse, "this line is no block and is left out", 0, len(line))
        return ()

    def _before_end(self, line: str) -> str:
        """A line without the end of its block and the remark behind it; all of it where a further block follows."""
        bare = self._grammar.bare(line)
        end = bare.find(self._block_end)
        if end < 0 or not line[:end].strip():
            return line
        behind = bare[end:].strip(f"{self._block_end} \t")
        return line if _BEGINS_BLOCK.match(behind) else line[:end].rstrip()

    def _check(self, line: str) -> None:
        if len(line) > self._longest:
            message = f"the line has {len(line)} characters, more than {self._longest}"
            self._report.fail("line-too-long", message, self._longest)
        for column, character in enumerate(line):
            if is_control(ord(character)):
                message = f"the line holds the control character {ord(character)}"
                hint = None if ord(character) else "if the file is UTF-16, save it as UTF-8"
                self._report.fail("control-character", message, column, hint=hint)


def _closed_up(number: re.Match[str]) -> str:
    """A number without its blanks, which follow it, so that the next word stays where it is."""
    return re.sub(r"[ \t]", "", number[0]).ljust(len(number[0]))
