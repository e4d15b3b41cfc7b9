"""Assignments of LinuxCNC as instructions for the compiled tier; O-words say their own."""

from twin.nc.bytecode.assembler import Assembler, UnsupportedError
from twin.nc.control.block_compiler import BlockCompiler
from twin.nc.dialects.linuxcnc.parameters import LiveParameters
from twin.nc.text.blocks import Block
from twin.nc.text.expressions import NumberedVariable

_LIVE = LiveParameters()


def compile_block(compiler: BlockCompiler, block: Block) -> None:
    """Write a block.

    Raises:
        UnsupportedError: It is left to the interpreter tier.
    """
    if block.assignments:
        _assign(block, compiler.assembler)
    else:
        compiler.block(block)


def _assign(block: Block, assembler: Assembler) -> None:
    """One assignment that stands alone; several are computed before the first is given."""
    if block.words or len(block.assignments) > 1:
        raise UnsupportedError
    only = block.assignments[0]
    if isinstance(only.target, NumberedVariable):
        assembler.value(only.target.index)
        assembler.value(only.value)
        assembler.assign_numbered("#")
    elif only.target.name in _LIVE or only.target.name == "#0":
        raise UnsupportedError
    else:
        assembler.value(only.value)
        assembler.assign(only.target.name)
