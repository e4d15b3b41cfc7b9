"""Blocks of CODESYS SoftMotion as instructions for the fast way: the same as its actions do."""

from twin.nc.bytecode.assembler import BlockWriter, NotTranslatableError
from twin.nc.bytecode.block_compiler import write_words
from twin.nc.control.control import Control
from twin.nc.control.flow import Place
from twin.nc.dialects.codesys import jumps, program, subprograms
from twin.nc.text import arithmetic
from twin.nc.text.blocks import Block, Statement, Word
from twin.nc.text.expressions import Expression, Variable

_JUMP, _WRITE, _ADD = 20.0, 36.0, 37.0


def translate(control: Control, block: Block, writer: BlockWriter) -> None:
    """Write a block.

    Raises:
        NotTranslatableError: It is left to the general way.
    """
    if block.statement is not None:
        _statement(control, block.statement, writer)
        return
    codes = [word.value for word in block.words if word.address == "G"]
    if _JUMP in codes:
        _jump(control, _words_beside(block, "LK"), writer)
    elif _WRITE in codes or _ADD in codes:
        _change(control, _words_beside(block, "OD"), writer, add=_ADD in codes)
    else:
        write_words(control, block.words, writer)


def _words_beside(block: Block, letters: str) -> dict[str, Word]:
    """The words of a block that has one code and at most one of each of these letters."""
    words = {word.address: word for word in block.words}
    if len(words) < len(block.words) or words.keys() - {"G", *letters}:
        raise NotTranslatableError
    return words


def _jump(control: Control, words: dict[str, Word], writer: BlockWriter) -> None:
    target, condition = words.get("L"), words.get("K")
    if target is None or isinstance(target.value, Expression):
        raise NotTranslatableError
    if target.value < 0.0 or target.value != int(target.value):
        raise NotTranslatableError
    if condition is None:
        writer.value(Variable(program.COUNTER))
    else:
        _value(condition, writer)
    writer.jump_if(jumps.destination(control, target))


def _change(control: Control, words: dict[str, Word], writer: BlockWriter, *, add: bool) -> None:
    name, value = program.reference(control, words.get("O")), words.get("D")
    if value is None:
        raise NotTranslatableError
    _value(value, writer)
    if add:
        writer.change(name, arithmetic.add)
    else:
        writer.assign(name, declared=name.startswith("#"))


def _value(word: Word, writer: BlockWriter) -> None:
    if isinstance(word.value, Expression):
        writer.value(word.value)
    else:
        writer.number(word.value)


def _statement(control: Control, statement: Statement, writer: BlockWriter) -> None:
    keyword = statement.keyword.strip()
    if keyword == "LET":
        name, value, _ = program.declaration(control, statement)
        if value is None:
            writer.number(0.0)
        else:
            writer.value(value)
        writer.assign(name)
    elif keyword.startswith("#"):
        name, value, _ = program.assigned(control, statement)
        writer.value(value)
        writer.assign(name, declared=True)
    elif keyword in ("RETURN", "END_SUBPROGRAM"):
        writer.may_return()
        writer.go_back()
    elif keyword == "SUBPROGRAM":
        raise NotTranslatableError
    else:
        _call(control, statement, writer)


def _call(control: Control, statement: Statement, writer: BlockWriter) -> None:
    subprogram, values, _ = subprograms.called(control, statement)
    for each in values:
        writer.value(each)
    begin = Place(subprogram.lines.start, 0)
    deepest, formals = subprograms.DEEPEST_CALL, subprogram.formals
    writer.call(begin, deepest, formals, restores=subprogram.restores)
