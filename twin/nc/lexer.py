"""From a line of text to blocks of words, by a dialect's syntax."""

import re
from typing import NoReturn

from twin.nc.blocks import Block, Statement, Word
from twin.nc.canonical import NO_BLOCK_NUMBER
from twin.nc.diagnostics import ProgramError
from twin.nc.dialect import Dialect
from twin.nc.expressions import (
    LARGEST_NUMBER,
    NUMBER,
    ExpressionError,
    ExpressionReader,
    operator_pattern,
)
from twin.nc.reporter import Reporter

LONGEST_LINE = 65_536
"""Characters of a line: far beyond any control's block, so that one line cannot eat the memory."""

_LARGEST_LABEL = 4_294_967_295
"""Largest N number (32 bits, as the Fagor manual states)."""

_NEXT_LABEL = re.compile(r"(?<=[ \t])N[ \t]*[0-9]", re.IGNORECASE)
_BLANKS = re.compile(r"[ \t]*")
_LOOKALIKES = str.maketrans("АВСЕНІКМОРТХУЗ", "ABCEHIKMOPTXY3")
"""Cyrillic letters that look like Latin ones: a keyboard left in the wrong layout."""


class Lexer:
    """Reads the lines of programs in one dialect."""

    def __init__(self, dialect: Dialect, report: Reporter) -> None:
        syntax = dialect.syntax
        self._dialect = dialect
        self._syntax = syntax
        self._report = report
        self._reader = ExpressionReader(syntax.expressions) if syntax.expressions else None
        continues = "[0-9.]"
        if syntax.expressions is not None:
            operators = sorted(syntax.expressions.operators, key=len, reverse=True)
            continues += rf"|[ \t]*(?:{'|'.join(map(operator_pattern, operators))})"
        suffix = r"(I(?![ \t]*[-+.0-9=\[P])|)" if syntax.incremental_suffix else "()"
        self._word = re.compile(
            rf"[ \t]*({syntax.address})[ \t]*([+-]?{NUMBER})(?!{continues}){suffix}",
            re.IGNORECASE,
        )
        self._address = re.compile(rf"[ \t]*({syntax.address})[ \t]*", re.IGNORECASE)
        self._suffix = re.compile(suffix, re.IGNORECASE)
        self._statement = (
            re.compile(rf"[ \t]*({syntax.statement})", re.IGNORECASE) if syntax.statement else None
        )

    @property
    def expressions(self) -> ExpressionReader:
        """Reads this dialect's expressions."""
        assert self._reader is not None
        return self._reader

    def blocks(self, line: str, number: int, previous: str = "") -> tuple[Block, ...]:
        """Read a line; a line without words gives no block.

        Args:
            line: Its text.
            number: Its number, from 1.
            previous: Text of the line before.

        Raises:
            ProgramError: It cannot be read.
        """
        if not line or line.isspace():
            return ()
        self._report.line = number
        self._check(line)
        try:
            return _LineReader(self, line, number).blocks()
        except ProgramError:
            excuse = self._syntax.excused(line, previous)
            if excuse is None:
                raise
        self._report.warn(excuse, "this line is no block and is left out", 0, len(line))
        return ()

    def _check(self, line: str) -> None:
        if len(line) > LONGEST_LINE:
            message = f"the line has {len(line)} characters, more than {LONGEST_LINE}"
            self._report.fail("line-too-long", message, LONGEST_LINE)
        if not line.isprintable():
            for column, character in enumerate(line):
                if ord(character) < 32 and character not in "\t\f\v":
                    message = f"the line holds the control character {ord(character)}"
                    self._report.fail("control-character", message, column)


class _LineReader:
    """One line being read: its text and the place reached."""

    def __init__(self, lexer: Lexer, line: str, number: int) -> None:
        self._lexer = lexer
        self._report = lexer._report  # noqa: SLF001 (one class in two: the reader and its line)
        self._syntax = lexer._syntax  # noqa: SLF001
        self._word = lexer._word  # noqa: SLF001
        self._line = line
        self._line_number = number
        self._at = 0
        self._done: list[Block] = []
        self._words: list[Word] = []
        self._number = NO_BLOCK_NUMBER
        self._skippable = False
        self._fresh = True

    def blocks(self) -> tuple[Block, ...]:
        line = self._line
        match_word = self._word.match
        words = self._words
        while True:
            match = match_word(line, self._at)
            if match is None:
                if not self._something_else():
                    break
                words = self._words
                continue
            address, number, suffix = match.groups()
            begin = match.start(1)
            self._at = match.end()
            if address in ("N", "n"):
                self._label(number, begin)
                words = self._words
                continue
            value = float(number)
            if not abs(value) <= LARGEST_NUMBER:
                self._fail("number-range", f"the value is not within ±{LARGEST_NUMBER:g}", begin)
            name = address.upper()
            name = self._syntax.aliases.get(name, name)
            words.append(Word(name, value, begin, self._at - begin, bool(suffix)))
        self._close()
        return tuple(self._done)

    def _something_else(self) -> bool:
        """Read what is no plain word; False at the end of the line."""
        blanks = _BLANKS.match(self._line, self._at)
        assert blanks is not None
        at = self._at = blanks.end()
        if at == len(self._line):
            return False
        for comment in self._syntax.comments:
            if self._line.startswith(comment.opening, at):
                if not comment.closing:
                    return False
                end = self._line.find(comment.closing, at + len(comment.opening))
                if end < 0:
                    message = f"the comment is not closed by '{comment.closing}'"
                    self._fail("open-comment", message, at)
                self._at = end + len(comment.closing)
                return True
        if self._line[at] == "/" and self._fresh and not self._words:
            self._skippable = True
            self._at += 1
            return True
        if not self._statement() and not self._computed_word():
            self._refuse(at)
        return True

    def _statement(self) -> bool:
        pattern = self._lexer._statement  # noqa: SLF001
        match = pattern.match(self._line, self._at) if pattern and not self._words else None
        if match is None:
            return False
        text = self._statement_text(match.end())
        keyword = match[1].upper()
        begin = match.start(1)
        statement = Statement(keyword, text, begin, match.end())
        self._done.append(
            Block(
                self._line_number,
                len(self._done),
                self._number,
                statement=statement,
                skippable=self._skippable,
            )
        )
        self._start_block(NO_BLOCK_NUMBER)
        self._at = match.end() + len(text)
        return True

    def _statement_text(self, start: int) -> str:
        """What belongs to a statement: up to a comment that ends the line, or the next block."""
        end = len(self._line)
        for comment in self._syntax.comments:
            if not comment.closing and (found := self._line.find(comment.opening, start)) >= 0:
                end = min(end, found)
        if self._syntax.several_blocks and (label := _NEXT_LABEL.search(self._line, start, end)):
            end = label.start()
        return self._line[start:end]

    def _computed_word(self) -> bool:
        if self._lexer._reader is None:  # noqa: SLF001
            return False
        line = self._line
        match = self._lexer._address.match(line, self._at)  # noqa: SLF001
        if match is None:
            return False
        begin = match.start(1)
        try:
            expression, end = self._lexer._reader.read(line, match.end())  # noqa: SLF001
        except ExpressionError as error:
            column = begin if error.column is None else min(error.column, len(line) - 1)
            self._fail(error.code, str(error), column, hint=error.hint)
        name = match[1].upper()
        if name == "N":
            self._fail("label", "a block number must be a plain number", begin)
        suffix = self._lexer._suffix.match(line, end)  # noqa: SLF001
        assert suffix is not None
        self._at = suffix.end()
        name = self._syntax.aliases.get(name, name)
        self._words.append(Word(name, expression, begin, self._at - begin, bool(suffix[1])))
        return True

    def _label(self, number: str, begin: int) -> None:
        value = float(number)
        if not (value == int(min(value, LARGEST_NUMBER)) and 0 <= value <= _LARGEST_LABEL):
            self._fail("label", f"N{number} is no block number", begin)
        if self._words or self._number != NO_BLOCK_NUMBER:
            if not self._syntax.several_blocks:
                message = "N must begin its block"
                self._fail("label", message, begin, hint="write the blocks on lines of their own")
            self._close()
        self._start_block(int(value))

    def _start_block(self, number: int) -> None:
        self._number = number
        self._words = []
        self._fresh = False
        if number == NO_BLOCK_NUMBER:
            self._skippable = False

    def _close(self) -> None:
        if self._words or self._number != NO_BLOCK_NUMBER:
            self._done.append(
                Block(
                    self._line_number,
                    len(self._done),
                    self._number,
                    tuple(self._words),
                    skippable=self._skippable,
                )
            )

    def _refuse(self, at: int) -> NoReturn:
        character = self._line[at]
        latin = character.upper().translate(_LOOKALIKES)
        address = self._lexer._address.match(self._line, at)  # noqa: SLF001
        if latin != character.upper():
            message = f"'{character}' is a Cyrillic letter"
            self._fail("foreign-letter", message, at, hint=f"write the Latin {latin}")
        if address is not None:
            message = f"'{address[1]}' has no value"
            self._fail("missing-value", message, address.start(1), hint="write a number after it")
        self._fail("unreadable", f"'{character}' begins no word of {self._lexer._dialect.name}", at)  # noqa: SLF001

    def _fail(self, code: str, message: str, column: int, *, hint: str | None = None) -> NoReturn:
        self._report.line = self._line_number
        self._report.fail(code, message, column, 1, hint)
