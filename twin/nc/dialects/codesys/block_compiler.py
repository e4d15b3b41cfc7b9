"""Blocks of CODESYS SoftMotion as instructions for the compiled tier: the same as its actions do."""

from twin.nc.bytecode.assembler import Assembler, UnsupportedError
from twin.nc.control.block_compiler import BlockCompiler
from twin.nc.control.control import Control
from twin.nc.dialects.codesys import jumps, program, subprograms
from twin.nc.text import arithmetic
from twin.nc.text.blocks import Block, Location, Statement, Word
from twin.nc.text.expressions import Expression, Variable

_JUMP, _WRITE, _ADD = 20.0, 36.0, 37.0


def compile_block(compiler: BlockCompiler, block: Block) -> None:
    """Write a block.

    Raises:
        UnsupportedError: It is left to the interpreter tier.
    """
    control, assembler = compiler.control, compiler.assembler
    if block.statement is not None:
        _statement(control, block.statement, assembler)
        return
    codes = [word.value for word in block.words if word.address == "G"]
    if _JUMP in codes:
        _jump(control, _words_beside(block, "LK"), assembler)
    elif _WRITE in codes or _ADD in codes:
        _change(control, _words_beside(block, "OD"), assembler, add=_ADD in codes)
    else:
        compiler.words(block.words)


def _words_beside(block: Block, letters: str) -> dict[str, Word]:
    """The words of a block that has one code and at most one of each of these letters."""
    words = {word.address: word for word in block.words}
    if len(words) < len(block.words) or words.keys() - {"G", *letters}:
        raise UnsupportedError
    return words


def _jump(control: Control, words: dict[str, Word], assembler: Assembler) -> None:
    target, condition = words.get("L"), words.get("K")
    if target is None or isinstance(target.value, Expression):
        raise UnsupportedError
    if target.value < 0.0 or target.value != int(target.value):
        raise UnsupportedError
    if condition is None:
        assembler.value(Variable(program.COUNTER))
    else:
        _value(condition, assembler)
    assembler.jump_if(jumps.destination(control, target))


def _change(control: Control, words: dict[str, Word], assembler: Assembler, *, add: bool) -> None:
    name, value = program.reference(control, words.get("O")), words.get("D")
    if value is None:
        raise UnsupportedError
    _value(value, assembler)
    if add:
        assembler.change(name, arithmetic.add)
    else:
        assembler.assign(name, declared=name.startswith("#"))


def _value(word: Word, assembler: Assembler) -> None:
    if isinstance(word.value, Expression):
        assembler.value(word.value)
    else:
        assembler.constant(word.value)


def _statement(control: Control, statement: Statement, assembler: Assembler) -> None:
    keyword = statement.keyword.strip()
    if keyword == "LET":
        name, value, _ = program.declaration(control, statement)
        if value is None:
            assembler.constant(0.0)
        else:
            assembler.value(value)
        assembler.assign(name)
    elif keyword.startswith("#"):
        name, value, _ = program.assigned(control, statement)
        assembler.value(value)
        assembler.assign(name, declared=True)
    elif keyword in ("RETURN", "END_SUBPROGRAM"):
        assembler.check_return()
        assembler.end_call()
    elif keyword == "SUBPROGRAM":
        raise UnsupportedError
    else:
        _call(control, statement, assembler)


def _call(control: Control, statement: Statement, assembler: Assembler) -> None:
    subprogram, values, _ = subprograms.called(control, statement)
    for each in values:
        assembler.value(each)
    begin = Location(subprogram.lines.start, 0)
    deepest, formals = subprograms.DEEPEST_CALL, subprogram.formals
    assembler.call(begin, deepest, formals, restores=subprogram.restores)
