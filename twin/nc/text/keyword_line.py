"""One line of a language whose blocks begin with keywords: a bare number, a keyword, words with and without values."""

import math
import re

from twin.nc.canonical import NO_BLOCK_NUMBER
from twin.nc.text.blocks import Block, Statement, Word
from twin.nc.text.line_reader import LineReader

_NUMBER = re.compile(r"[ \t]*([0-9]{1,12})(?=[ \t]|$|[^-+.,0-9=])")
_SKIP = re.compile(r"[ \t]*/")
_BLANKS = re.compile(r"[ \t]+")


class KeywordLine(LineReader):
    """Reads one such line."""

    _keyword: Statement | None = None

    def blocks(self) -> tuple[Block, ...]:
        """The line's blocks, behind a number without an address; the slash may be on both sides of it."""
        for _ in range(2):
            if (slash := _SKIP.match(self._line, self._at)) is not None and not self._skippable:
                self._skippable, self._at = True, slash.end()
            if (number := _NUMBER.match(self._line, self._at)) is not None and not self._done:
                self._at = number.end()
                self._label(number[1], number.start(1))
        return super().blocks()

    def _statement(self) -> bool:
        pattern = self._grammar.statement
        match = pattern.match(self._line, self._at) if pattern is not None else None
        if match is None or self._keyword is not None:
            return False
        keyword = _BLANKS.sub(" ", match[1].strip().upper())
        self._at = match.end()
        text = "" if keyword in self._syntax.worded else self._statement_text(match.end())
        statement = Statement(keyword, text, match.start(1), match.end())
        if keyword in self._syntax.worded:
            self._keyword = statement
        else:
            self._at += len(text)
            self._finish_block(statement)
            self._start_block(NO_BLOCK_NUMBER)
        return True

    def _something_else(self) -> bool:
        flag = self._grammar.flag.match(self._line, self._at) if self._grammar.flag else None
        if flag is None:
            return super()._something_else()
        begin, self._at = flag.start(1), flag.end()
        name = _BLANKS.sub("", flag[1].upper())
        if len(name) == 1:  # its value was left out: what was in force stays
            return True
        self._words.append(Word(name, math.nan, begin, self._at - begin))
        return True

    def _close(self) -> None:
        if self._keyword is None:
            super()._close()
        else:
            self._finish_block(self._keyword)
