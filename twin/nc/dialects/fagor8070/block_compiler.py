"""Blocks of words of the Fagor CNC 8070 as instructions for the compiled tier."""

from twin.nc.bytecode.assembler import UnsupportedError
from twin.nc.control.block_compiler import BlockCompiler
from twin.nc.dialects.fagor8070 import polar
from twin.nc.text.blocks import Block
from twin.nc.text.expressions import Expression

_RETURNS = (17.0, 29.0)


def compile_block(compiler: BlockCompiler, block: Block) -> None:
    """Write a block.

    Raises:
        UnsupportedError: It is left to the interpreter tier.
    """
    if block.statement is None:
        _words(compiler, block)
    else:
        compiler.block(block)


def _words(compiler: BlockCompiler, block: Block) -> None:
    assembler = compiler.assembler
    often = [word for word in block.words if word.address == "NR"]
    returns = [word for word in block.words if word.address == "M" and word.value in _RETURNS]
    rest = [word for word in block.words if word not in (*often[:1], *returns[:1])]
    if often and any(word.address == "M" for word in block.words):
        raise UnsupportedError
    if often:
        count = often[0].value
        if isinstance(count, Expression):
            assembler.value(count)
        else:
            assembler.constant(count)
        if any(word.address in compiler.acting for word in rest):
            raise UnsupportedError
        if any(code.begins_cycle for _, code in compiler.sorted(rest).codes):
            raise UnsupportedError
        assembler.words(rest, often=compiler.control.settings.step_limit)
    elif returns:
        assembler.check_return()
        compiler.words(rest)
        assembler.end_call()
    elif polar.is_polar(compiler, rest):
        polar.compile_polar(compiler, rest)
    else:
        compiler.words(rest)
