"""One line being read: its words, labels, comments and statements, from left to right."""

import re
import string
from typing import NoReturn

from twin.nc.canonical import NO_BLOCK_NUMBER
from twin.nc.text.blocks import Assignment, Block, Statement, Word, assignment_of
from twin.nc.text.comments import NO_COMMENT, OPEN_COMMENT
from twin.nc.text.diagnostics.reporter import Reporter
from twin.nc.text.diagnostics.slips import slip_at
from twin.nc.text.diagnostics.unreadable import Unreadable
from twin.nc.text.expressions.arithmetic import is_whole
from twin.nc.text.expressions.expressions import (
    LARGEST_NUMBER,
    ExpressionError,
    NumberedVariable,
    Variable,
)
from twin.nc.text.grammar import Grammar
from twin.nc.text.plain_word import BLANKS

LARGEST_LABEL = 4_294_967_295
"""Largest N number (32 bits, as the Fagor manual states)."""

_SKIP_LEVEL = re.compile(r"[0-9](?=[ \t]*[A-Z#/:])", re.IGNORECASE)
_NEXT_LABEL = re.compile(r"(?<=[ \t])N[ \t]*[0-9]", re.IGNORECASE)
_BLANKS = re.compile(BLANKS)
_EQUALS = re.compile(rf"{BLANKS}=")
_QUOTED = re.compile(rf"{BLANKS}(\"[^\"]*\")")
_PROSE = re.compile(r"[^\W\d_]{2,}(?:[ \t,;:'-]+[^\W\d_]+)+[ \t]*[.!?:]?[ \t]*(?=$|N[ \t]*[0-9])")
"""At least two words of letters alone, up to the end of the line or the next block."""
_NO_NUMBER = re.compile(r"\b[A-Z](?:nan|inf|infinity|null|none|undefined)\b", re.IGNORECASE)
"""Words of a post-processor that had no number to write: no prose."""

_tuple = tuple.__new__
_LETTERS = frozenset(string.ascii_uppercase) - {"N"}
"""Addresses of words as they are."""
_SHORT = len(f"{LARGEST_NUMBER:.0f}")
"""Characters of words whose number is below the largest one."""


class LineReader:
    """Reads one line."""

    _at = 0
    _number = NO_BLOCK_NUMBER
    _name = ""
    _skippable = False
    _skip_level = 1
    _done: tuple[Block, ...] = ()
    _assignments: tuple[Assignment, ...] = ()

    def __init__(self, grammar: Grammar, report: Reporter, line: str, number: int) -> None:
        self._grammar = grammar
        self._syntax = grammar.syntax
        self._report = report
        self._line = line
        self._line_number = number
        self._words: list[Word] = []

    def blocks(self) -> tuple[Block, ...]:
        """The line's blocks."""
        has_statements = self._grammar.statement is not None
        end = len(self._line)
        while self._at < end:
            if has_statements and not self._words and self._statement():
                continue
            if self._plain_words():
                continue
            if self._at == end or not self._something_else():
                break
        self._close()
        return self._done

    def _plain_words(self) -> bool:
        """Read words with plain numbers; True behind an N where a statement may follow."""
        grammar, at, add = self._grammar, self._at, self._words.append
        relative = self._syntax.relative
        for blanks, written, address, number, suffix in grammar.words.findall(self._line, at):
            if not written:
                break
            begin, width = at + len(blanks), len(written)
            at = begin + width
            if address not in _LETTERS:
                address = grammar.name(address)
                if address == "N":
                    self._at = at
                    self._label(number, begin)
                    if grammar.statement is not None and grammar.statement.match(self._line, at):
                        return True
                    add = self._words.append
                    continue
                if address in relative:
                    address, suffix = relative[address], address
            value = float(number)
            if width > _SHORT and not -LARGEST_NUMBER <= value <= LARGEST_NUMBER:
                self._fail("number-range", f"the value is not within ±{LARGEST_NUMBER:g}", begin)
            # As Word(...), in a third of the time.
            add(_tuple(Word, (address, value, begin, width, suffix != "", "." not in number, "")))
        self._at = at
        return False

    def _something_else(self) -> bool:
        """Read what is no plain word and no statement; False at the end of the line."""
        comment = self._grammar.comment.match(self._line, self._at)
        if comment is not None:
            self._at = comment.end()
            return True
        blanks = _BLANKS.match(self._line, self._at)
        assert blanks is not None
        self._at = blanks.end()
        if self._at == len(self._line):
            return False
        if self._line[self._at] in self._grammar.comment_openings and self._comment():
            return True
        if self._block_skip() or self._named_label() or self._label_colon() or self._assignment():
            return True
        if self._named_code() or self._name_word() or self._quoted_word():
            return True
        if not self._computed_word():
            self._unreadable.refuse(self._at, self._words)
        return True

    def _prose(self) -> bool:
        """Leave out prose behind the words of a block, with a warning."""
        match = _PROSE.match(self._line, self._at) if self._words else None
        if match is None or not self._syntax.trailing_prose or _NO_NUMBER.search(match[0]):
            return False
        self._report.line = self._line_number
        message = "this is no part of the block and is left out"
        self._report.warn(
            "trailing-prose", message, self._at, len(match[0]), "write it in brackets: ( ... )"
        )
        self._at = match.end()
        return True

    def _comment(self) -> bool:
        """Pass over a comment; False where none begins."""
        end = self._grammar.comment_end(self._line, self._at)
        if end == OPEN_COMMENT:
            self._refuse_open_comment(self._line[self._at :], self._at)
        if end == NO_COMMENT:
            return False
        self._at = end
        return True

    def _refuse_open_comment(self, text: str, at: int) -> NoReturn:
        """A comment that begins a text, at a column, is not closed, or holds another one."""
        begun = next(each for each in self._syntax.comments if text.startswith(each.opening))
        again = text.find(begun.opening, len(begun.opening))
        if not begun.holds_opening and 0 <= again < text.find(begun.closing):
            message = f"a comment that '{begun.opening}' began holds no further '{begun.opening}'"
            hint = slip_at(self._line, at + again, self._grammar.language.name)
            self._fail("open-comment", message, at + again, hint=hint)
        message = f"the comment is not closed by '{begun.closing}'"
        self._fail("open-comment", message, at, hint="close it on its own line")

    def _block_skip(self) -> bool:
        numbered = self._number != NO_BLOCK_NUMBER and not self._syntax.skip_levels
        if self._line[self._at] != "/" or self._words or numbered:
            return False
        self._skippable = True
        self._at += 1
        levels = self._syntax.skip_levels
        level = _SKIP_LEVEL.match(self._line, self._at)
        if level is not None and int(level[0]) in levels:
            self._skip_level, self._at = int(level[0]), level.end()
        elif levels:
            self._skip_level = levels[0]
        return True

    def _label_colon(self) -> bool:
        """``N20:``, which some write where the number is the target of a jump."""
        number = self._number != NO_BLOCK_NUMBER and not self._words
        if self._grammar.label is None or not number or self._line[self._at] != ":":
            return False
        self._at += 1
        return True

    def _named_label(self) -> bool:
        pattern = self._grammar.label
        if pattern is None or self._words or self._name:
            return False
        match = pattern.match(self._line, self._at)
        if match is None:
            return False
        self._name = match[1].upper()
        self._at = match.end()
        return True

    def _named_code(self) -> bool:
        """A code that has a name in place of a number."""
        pattern = self._grammar.code
        match = pattern.match(self._line, self._at) if pattern is not None else None
        if match is None:
            return False
        name = match[1].upper()
        word = Word("G", self._syntax.codes[name], self._at, len(name), mark=name)
        self._words.append(word)
        self._at = match.end()
        return True

    def _name_word(self) -> bool:
        """A word that is a name in angle brackets."""
        pattern = self._grammar.named
        match = pattern.match(self._line, self._at) if pattern is not None else None
        if match is None:
            return False
        begin, self._at = self._at, match.end()
        address = match[1].upper()
        self._words.append(Word(address, 0.0, begin, self._at - begin, mark=match[0]))
        return True

    def _quoted_word(self) -> bool:
        """A word whose value is a text in quotes."""
        match = self._grammar.address.match(self._line, self._at) if self._syntax.texts else None
        text = _QUOTED.match(self._line, match.end()) if match is not None else None
        if match is None or text is None or self._grammar.name(match[1]) not in self._syntax.texts:
            return False
        begin, self._at = match.start(1), text.end()
        name = self._grammar.name(match[1])
        self._words.append(Word(name, 0.0, begin, self._at - begin, mark=text[1]))
        return True

    def _statement(self) -> bool:
        pattern = self._grammar.statement
        match = pattern.match(self._line, self._at) if pattern is not None else None
        if match is None:
            return False
        text = self._statement_text(match.end())
        statement = Statement(match[1].upper(), text, match.start(1), match.end())
        self._finish_block(statement)
        self._start_block(NO_BLOCK_NUMBER)
        self._at = match.end() + len(text)
        return True

    def _statement_text(self, start: int) -> str:
        """What belongs to a statement: up to a comment that ends the line, or the next block."""
        end = self._grammar.end_comment(self._line, start)
        if self._syntax.several_blocks and (label := _NEXT_LABEL.search(self._line, start, end)):
            end = label.start()
        text = self._line[start:end]
        if self._syntax.inner_comments:
            text, wrong = self._grammar.without_comments(text)
            if wrong != NO_COMMENT:
                self._refuse_open_comment(text[wrong:], start + wrong)
            return text
        for comment in self._syntax.comments:
            if comment.closing and text.rstrip().endswith(comment.closing):
                opening = text.rfind(comment.opening)
                if (
                    opening > 0
                    and text[opening - 1] in " \t"
                    and not self._wants_value(text[:opening], comment.opening)
                ):
                    return text[:opening] + " " * (len(text) - opening)
        return text

    def _wants_value(self, text: str, opening: str) -> bool:
        """Whether a bracket behind a text is a value, not a comment, where both look alike."""
        expressions, unfinished = self._syntax.expressions, self._grammar.unfinished
        if expressions is None or unfinished is None or expressions.brackets[0] != opening:
            return False
        return unfinished.search(text) is not None

    def _computed_word(self) -> bool:
        reader = self._grammar.reader
        match = self._grammar.address.match(self._line, self._at)
        if reader is None or match is None:
            return False
        begin, at = match.start(1), match.end()
        self._unreadable.refuse_late_skip(match)
        form = self._grammar.form.match(self._line, at) if self._grammar.form is not None else None
        mark = "" if form is None else form[1].upper()
        read = reader.read_value if form is None else reader.read_operand
        try:
            expression, end = read(self._line, at if form is None else form.end())
        except ExpressionError as error:
            if self._prose():
                return True
            self._unreadable.refuse_code(self._words)
            self._unreadable.refuse_value(begin, error)
        name = self._grammar.name(match[1])
        if name == "N":
            self._fail("label", "a block number must be a plain number", begin)
        if not match[1].endswith(sign := self._syntax.computed_behind):
            self._unreadable.refuse_without_sign(match, sign)
        suffix = self._grammar.suffix.match(self._line, end)
        assert suffix is not None
        self._at = suffix.end()
        relative, form_relative = (
            self._syntax.relative,
            form is not None and self._syntax.forms[mark],
        )
        incremental = bool(suffix[1]) or name in relative or form_relative
        name, width = relative.get(name, name), self._at - begin
        self._words.append(Word(name, expression, begin, width, incremental, mark=mark))
        return True

    def _assignment(self) -> bool:
        """Read ``#1=5`` where the dialect has assignments among words."""
        begin, reader = self._at, self._grammar.reader
        if reader is None or self._line[begin] != (self._syntax.assigned or None):
            return False
        try:
            target, at = reader.read_operand(self._line, begin)
            sign = _EQUALS.match(self._line, at)
            if sign is None:
                message = f"'{target.text}' is no word: it is assigned by =, or follows a letter"
                self._fail("assignment", message, begin, width=at - begin)
            read = reader.read if self._syntax.open_assignments else reader.read_value
            value, end = read(self._line, sign.end())
        except ExpressionError as error:
            self._unreadable.refuse_value(begin, error)
        tree = target.tree
        assert isinstance(tree, (Variable, NumberedVariable))
        self._assignments += (assignment_of(tree, value, begin, end - begin),)
        self._at = end
        return True

    def _label(self, number: str, begin: int) -> None:
        value = float(number)
        if self._syntax.fractional_labels:
            value = float(int(value))
        if not is_whole(value, LARGEST_LABEL):
            self._fail("label", f"N{number} is no block number", begin)
        if self._words or self._number != NO_BLOCK_NUMBER:
            if not self._syntax.several_blocks:
                message = "N must begin its block"
                self._fail("label", message, begin, hint="write the blocks on lines of their own")
            self._finish_block()
        self._start_block(int(value))

    def _start_block(self, number: int) -> None:
        self._number = number
        self._name = ""
        self._words, self._assignments = [], ()

    def _finish_block(self, statement: Statement | None = None) -> None:
        given = (
            self._line_number,
            len(self._done),
            self._number,
            tuple(self._words),
            statement,
            self._skippable,
            self._name,
            self._assignments,
            self._skip_level,
        )
        self._done += (_tuple(Block, given),)

    def _close(self) -> None:
        if self._words or self._assignments or self._number != NO_BLOCK_NUMBER or self._name:
            self._finish_block()

    @property
    def _unreadable(self) -> Unreadable:
        """Says what is wrong with the line."""
        return Unreadable(self._grammar, self._report, self._line, self._line_number)

    def _fail(
        self, code: str, message: str, column: int, *, width: int = 1, hint: str | None = None
    ) -> NoReturn:
        self._unreadable.fail(code, message, column, width=width, hint=hint)
