"""What is wrong with a line that cannot be read."""

import re
import unicodedata
from collections.abc import Sequence
from typing import NoReturn

from twin.nc.text.blocks import Word
from twin.nc.text.diagnostics.reporter import Reporter
from twin.nc.text.diagnostics.slips import near, near_or_listed, slip_at
from twin.nc.text.expressions.expressions import ExpressionError
from twin.nc.text.grammar import Grammar

_STATEMENT = re.compile(r"[#$][A-Z]\w*", re.IGNORECASE)
_GARBLED = re.compile(r"[-+.0-9]{1,20}")
"""What looks like a number and was not read as one."""
_LATE_SKIP = re.compile(r"(N[ \t]*[0-9]+)[ \t]*/", re.IGNORECASE)
_NAME = re.compile(r"[^\W\d_]\w+(?![\w(\[])")
"""Letters and digits without a bracket behind, as neither a value nor a function is written."""
_LETTERS = re.compile(r"[A-Z]{2,}(?![0-9.=\[(<#])|[A-Z]{3,}", re.IGNORECASE)
"""A name, and no letter that has lost its number."""
_TWO_NAMES = re.compile(r"\w+[ \t]+[A-Z]\w*", re.IGNORECASE)
_NAME_AND_VALUE = re.compile(r"([A-Z_]+)[ \t]*([-+.0-9]*)", re.IGNORECASE)
_LOOKALIKES = str.maketrans("АВСЕНІКМОРТХУЗΑΒΕΖΗΙΚΜΝΟΡΤΥΧ", "ABCEHIKMOPTXY3ABEZHIKMNOPTYX")
"""Cyrillic and Greek letters that look like Latin ones: a keyboard left in the wrong layout."""
_LONE_LETTER = re.compile(r"(?<![A-Za-z#\[])[A-Za-z]$")
"""The address of a word without a value."""


class Unreadable:
    """Refuses one line."""

    def __init__(self, grammar: Grammar, report: Reporter, line: str, number: int) -> None:
        self._grammar = grammar
        self._report = report
        self._line = line
        self._number = number

    def fail(
        self, code: str, message: str, column: int, *, width: int = 1, hint: str | None = None
    ) -> NoReturn:
        """Refuse the line; arguments as for ``Reporter.fail``."""
        self._report.line = self._number
        self._report.fail(code, message, column, width, hint)

    def refuse_value(self, begin: int, error: ExpressionError) -> NoReturn:
        """The value of a word or an assignment that begins at a column cannot be read."""
        name = _NAME.match(self._line, begin)
        if name is not None and error.code == "unknown-function":
            self._refuse_name(name)
        column = begin if error.column is None else min(error.column, len(self._line) - 1)
        lone = _LONE_LETTER.search(self._line[: error.column].rstrip(" \t="))
        if error.column is not None and lone is not None:
            hint = self._slip_at(lone.start()) or "write a number after it"
            self.fail("missing-value", f"'{lone[0]}' has no value", lone.start(), hint=hint)
        slip = None
        if error.code in ("expression", "unknown-function"):
            slip = self._slip_at(column) or self._slip_at(begin)
        self.fail(error.code, str(error), column, hint=slip or error.hint)

    def refuse_late_skip(self, address: re.Match[str]) -> None:
        """``N20 /X1``: the mark of block skip is behind the number."""
        late = _LATE_SKIP.match(self._line, address.start(1))
        if late is not None:
            message = f"the / of a block that can be skipped must begin its line, before {late[1]}"
            self.fail("label", message, late.end() - 1, hint=f"write /{late[1]}")

    def refuse_code(self, words: Sequence[Word]) -> None:
        """Words without values may belong to a code that the dialect refuses anyway."""
        for word in words:
            if word.address == "G" and isinstance(word.value, float):
                refusal = self._grammar.language.refusal(word.value)
                if refusal is not None:
                    message = f"{word.text} {refusal}"
                    self.fail("unsupported-g", message, word.column, width=word.width)

    def refuse(self, at: int, words: Sequence[Word]) -> NoReturn:
        """Nothing that the dialect knows begins at a column, behind these words."""
        character = self._line[at]
        latin = character.upper().translate(_LOOKALIKES)
        address = self._grammar.address.match(self._line, at)
        if "\u0370" <= character <= "\u04ff":
            alphabet = "Cyrillic" if character >= "\u0400" else "Greek"
            message = f"'{character}' is a {alphabet} letter"
            hint = f"write the Latin {latin}" if latin != character.upper() else self._comments()
            self.fail("foreign-letter", message, at, hint=hint)
        statement = _STATEMENT.match(self._line, at)
        if statement is not None and self._grammar.statement is not None:
            language = self._grammar.language
            message = f"'{statement[0]}' is no statement of {language.name}"
            listed = near_or_listed(statement[0], language.keywords, language.name)
            hint = self._slip_at(at) or listed
            self.fail("unknown-statement", message, at, width=len(statement[0]), hint=hint)
        if address is not None:
            self.refuse_code(words)
        name = _LETTERS.match(self._line, at if address is None else address.start(1))
        if name is not None:
            self._refuse_name(name)
        if address is not None:
            self._refuse_missing_value(address)
        if not character.isascii():
            name = unicodedata.name(character, "no character").lower()
            message = f"U+{ord(character):04X} ({name}) begins no word"
            hint = "write a blank" if character.isspace() else None
            self.fail("unreadable", message, at, hint=hint)
        message = f"'{character}' begins no word of {self._grammar.language.name}"
        self.fail("unreadable", message, at, hint=self._hint_for(at))

    def _refuse_missing_value(self, address: re.Match[str]) -> NoReturn:
        name, end = address[1], address.end()
        garbled = _GARBLED.match(self._line, end)
        if garbled is not None:
            message = f"'{garbled[0]}' is no number"
            hint = self._slip_at(end)
            self.fail("missing-value", message, end, width=len(garbled[0]), hint=hint)
        hint = self._slip_at(address.start(1)) or "write a number after it"
        self.fail("missing-value", f"'{name}' has no value", address.start(1), hint=hint)

    def _refuse_name(self, name: re.Match[str]) -> NoReturn:
        """A name that is no word and no statement."""
        language = self._grammar.language
        both = _TWO_NAMES.match(self._line, name.start())
        alike = [each for text in (name, both) if text for each in near(text[0], language.keywords)]
        hint = self._slip_at(name.start()) or (f"near it: {', '.join(alike)}" if alike else None)
        message = f"'{name[0]}' is no word of {language.name}"
        usual = self._comments()
        if self._grammar.reader is not None:
            usual = f"a value is a number, a variable or a function; {usual}"
        self.fail("unknown-word", message, name.start(), width=len(name[0]), hint=hint or usual)

    def refuse_without_sign(self, address: re.Match[str], sign: str) -> NoReturn:
        """A word whose value must follow a sign lacks it."""
        written = _NAME_AND_VALUE.match(self._line, address.start(1))
        assert written is not None
        message = f"'{written[0].rstrip()}' cannot be read"
        usual = f"write {written[1].upper()}{sign}{written[2] or '...'}"
        hint = self._slip_at(address.end()) or usual
        begin, width = address.start(1), len(written[0].rstrip())
        self.fail("expression", message, begin, width=width, hint=hint)

    def _hint_for(self, at: int) -> str | None:
        character = self._line[at]
        if character == ",":
            return "decimals begin with a point"
        slip = self._slip_at(at)
        if slip is not None:
            return slip
        if character.isdigit():
            return "a number follows the letter or name that it is for"
        return self._comments() if character in ";$\"('/" else None

    def _comments(self) -> str:
        comments = [each for each in self._grammar.syntax.comments if not each.whole_line]
        shown = " or ".join(f"{each.opening} {each.closing or '...'}" for each in comments)
        return f"comments are written {shown}"

    def _slip_at(self, column: int) -> str | None:
        return slip_at(self._line, column, self._grammar.language.name)
