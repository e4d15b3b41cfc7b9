"""A dialect's syntax as compiled patterns."""

import re
from collections.abc import Callable

from twin.nc.text.comments import (
    OPEN_COMMENT,
    closed_comment,
    comment_end,
    comment_marks,
    comments_of,
    without_comments,
)
from twin.nc.text.expressions.expression_reader import ExpressionReader, operator_pattern
from twin.nc.text.expressions.expressions import ExpressionSyntax
from twin.nc.text.plain_word import BLANKS, BLANKS_BETWEEN, SIGNED_NUMBER
from twin.nc.text.syntax import Language

_QUOTED = re.compile(r'"[^"]*"')


class Grammar:
    """What reading a line needs, made once per dialect and program.

    Attributes:
        comment: A comment that is closed, unless it can only begin its line.
        comment_openings: The characters that comments may begin with.
        words: Blanks, and an address with a plain number and, where the dialect has it, the incremental
            suffix: blanks, all of the word, address, number and suffix; behind the last, with none of
            these, what is left of the line.
        form: A name before a bracket that says how a value counts, or None.
        named: A word that is a name in angle brackets, or None where the dialect has none.
        statement: The keyword of a statement, or None where the dialect has none.
        reader: Reads computed values, or None.
        unfinished: The end of a text that a bracket must follow as a value, or None.
    """

    def __init__(self, language: Language) -> None:
        syntax = language.syntax
        self.language = language
        self.syntax = syntax
        self.reader = ExpressionReader(syntax.expressions) if syntax.expressions else None
        continues = "[0-9.]"
        if syntax.expressions is not None and not syntax.expressions.bracketed:
            operators = sorted(syntax.expressions.operators, key=len, reverse=True)
            continues += rf"|{BLANKS}(?:=|{'|'.join(map(operator_pattern, operators))})"
        self.unfinished = _unfinished(syntax.expressions) if syntax.expressions else None
        suffix = r"(I(?![ \t]*[-+.0-9=\[P])|)" if syntax.incremental_suffix else "()"
        word = rf"({syntax.address}){BLANKS_BETWEEN}({SIGNED_NUMBER})(?!{continues}){suffix}"
        self.words = _compiled(rf"({BLANKS})({word})|(?s:.+)")
        self._comments = comment_marks(syntax.comments)
        self._endless = tuple(each.opening for each in syntax.comments if not each.closing)
        self.comment = re.compile(BLANKS + closed_comment(self._comments))
        self.comment_openings = {comment.opening[0] for comment in syntax.comments}
        self.address = _compiled(rf"{BLANKS}({syntax.address}){BLANKS_BETWEEN}")
        self.suffix = _compiled(suffix)
        self._has_texts = bool(syntax.texts)
        self.flag = _compiled(rf"{BLANKS}({syntax.flag})") if syntax.flag is not None else None
        self.statement = (
            _compiled(rf"{BLANKS}({syntax.statement})") if syntax.statement is not None else None
        )
        self.label = _compiled(syntax.label) if syntax.label else None
        self.form = (
            _compiled(rf"{BLANKS}({'|'.join(syntax.forms)}){BLANKS}(?=\()")
            if syntax.forms
            else None
        )
        self.named = _compiled(syntax.names) if syntax.names is not None else None
        self.code = _compiled(rf"({'|'.join(syntax.codes)})\b") if syntax.codes else None

    def comment_end(self, line: str, at: int) -> int:
        """The place behind a line's comment that begins at a place, or as ``comments.comment_end``."""
        return comment_end(line.encode("ascii", "replace"), 0, at, len(line), self._comments)

    def end_comment(self, line: str, start: int) -> int:
        """Where behind a place the comment begins that the end of the line closes, or that end; none does in a text."""
        if self._has_texts:
            line = _QUOTED.sub(lambda text: " " * len(text[0]), line)
        begins = (begin for begin, _ in comments_of(line, self._comments) if begin >= start)
        return next((at for at in begins if line.startswith(self._endless, at)), len(line))

    def without_comments(self, line: str) -> tuple[str, int]:
        """A line with blanks in place of its comments, as ``comments.without_comments``."""
        return without_comments(line, self._comments)

    def bare(self, line: str) -> str:
        """A line with blanks in place of its comments."""
        return without_comments(line, self._comments)[0]

    def outside_comments(
        self, pattern: re.Pattern[str], new: Callable[[re.Match[str]], str], line: str
    ) -> str:
        """A line with what matches a pattern outside its comments replaced."""
        pieces: list[str] = []
        at = 0
        for begin, end in comments_of(line, self._comments):
            if end != OPEN_COMMENT:
                pieces += [pattern.sub(new, line[at:begin]), line[begin:end]]
                at = end
        return "".join([*pieces, pattern.sub(new, line[at:])])

    def name(self, address: str) -> str:
        """An address in upper case, without the = of ``X1=``, as the dialect calls it."""
        name = address.upper()
        if len(name) > 1:
            name = name.rstrip("= \t")
        return self.syntax.aliases.get(name, name)


def _unfinished(expressions: ExpressionSyntax) -> re.Pattern[str]:
    """Operators, names of functions and prefixes, and what is before a value."""
    names = "|".join([*expressions.functions, *expressions.prefixes])
    operators = "|".join(map(operator_pattern, expressions.operators))
    return _compiled(rf"(?:[=,]|{operators}|\b(?:{names})){BLANKS}\Z")


def _compiled(pattern: str) -> re.Pattern[str]:
    return re.compile(pattern, re.IGNORECASE)
