"""Blocks of a Fanuc control as instructions for the compiled tier."""

from twin.nc.bytecode.assembler import UnsupportedError
from twin.nc.control.block_compiler import BlockCompiler
from twin.nc.dialects.fanuc import decimal_point, programs, variables
from twin.nc.text.blocks import Block, Location, Word
from twin.nc.text.expressions import Expression

_CALL, _RETURN = 98.0, 99.0


def compile_block(compiler: BlockCompiler, block: Block) -> None:
    """Write a block.

    Raises:
        UnsupportedError: It is left to the interpreter tier.
    """
    functions = [word for word in block.words if word.address == "M"]
    if any(word.value == _CALL for word in functions):
        _call(compiler, block)
    elif any(word.value == _RETURN for word in functions):
        _return(compiler, block)
    elif block.assignments:
        (*others, assignment) = block.assignments
        if others or block.words:
            raise UnsupportedError
        variables.compile_assignment(compiler.assembler, assignment)
    else:
        _refuse_counted(compiler, block.words)
        compiler.block(block)


def _refuse_counted(compiler: BlockCompiler, words: tuple[Word, ...]) -> None:
    """Numbers without a point count what the state at run time says."""
    looked_at = decimal_point.pointless(compiler.control.settings)
    for word in words:
        if word.address in looked_at and (word.address == "P" or word.pointless) and word.value:
            raise UnsupportedError
        if isinstance(word.value, Expression) and variables.rounds(word.value.tree):
            raise UnsupportedError


def _call(compiler: BlockCompiler, block: Block) -> None:
    values = {word.address: word.value for word in block.words}
    if not {"M", "P"} <= values.keys() <= {"M", "P", "L"} or len(values) != len(block.words):
        raise UnsupportedError
    number, often = values["P"], values.get("L")
    if isinstance(number, Expression) or isinstance(often, Expression):
        raise UnsupportedError
    repeats = None if often is None else int(often)
    if number != int(number) or often != repeats:
        raise UnsupportedError
    control = compiler.control
    program, count = programs.called(control, int(number), repeats)
    if count < 1:
        raise UnsupportedError
    line = programs.line_of(control, program, None)
    programs.compile_call(control, Location(line, 0), count, compiler.assembler)


def _return(compiler: BlockCompiler, block: Block) -> None:
    rest = tuple(word for word in block.words if word.address != "M" or word.value != _RETURN)
    if len(rest) != len(block.words) - 1 or any(word.address == "P" for word in rest):
        raise UnsupportedError
    _refuse_counted(compiler, rest)
    compiler.assembler.check_return()
    compiler.words(rest)
    compiler.assembler.end_call()
