"""Values within statements: words behind a keyword's own part, single values, texts."""

from typing import NoReturn

from twin.nc.control.control import Control
from twin.nc.dialects.heidenhain.memory import memory_of
from twin.nc.text.blocks import Statement, Word
from twin.nc.text.expressions.expressions import Expression


def computed_words(control: Control, statement: Statement, at: int) -> dict[str, Word]:
    """The words of a statement's text from a place on, computed, by address."""
    found: dict[str, Word] = {}
    column = statement.text_column + at
    for block in control.statements.blocks(statement.text[at:], column, control.block.line):
        for word in block.words:
            if word.address in found:
                control.fail("duplicate-word", f"'{word.address}' occurs twice here", word)
            found[word.address] = _computed(control, word)
        if block.statement is not None:
            refuse_rest(control, block.statement.column, block.statement.keyword)
    return found


def _computed(control: Control, word: Word) -> Word:
    value = word.value
    if isinstance(value, Expression):
        return word._replace(value=control.compute(value, word))
    return word


def refuse_rest(control: Control, column: int, text: str) -> NoReturn:
    """Something is where a statement has ended."""
    control.report.fail("unreadable-statement", f"'{text}' cannot stand here", column, len(text))


def value_at(control: Control, statement: Statement, at: int = 0) -> tuple[float, int]:
    """The number or Q parameter at a place of a statement's text, computed, and the place behind it."""
    value, end = control.statements.operand(statement.text, at, statement.text_column)
    return control.compute(value, statement.text_column + at), end


def word_of(control: Control, statement: Statement, span: tuple[int, int]) -> Word:
    """The value at a place of a statement's text, as a word of its keyword."""
    value, _ = value_at(control, statement, span[0])
    return named_word(statement, value, span)


def named_word(statement: Statement, value: float, span: tuple[int, int]) -> Word:
    """A value as a word of a statement's keyword."""
    column = statement.text_column + span[0]
    return Word(f"{statement.keyword} ", value, column, span[1] - span[0])


def text_of(control: Control, written: str) -> str:
    """A text in quotes, or that of a QS parameter."""
    if written.startswith('"'):
        return written.strip('"')
    return memory_of(control).texts.get(written.upper(), "")
