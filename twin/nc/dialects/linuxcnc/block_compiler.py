"""Assignments of LinuxCNC as instructions for the compiled tier; O-words say their own."""

from twin.nc.bytecode.assembler import Assembler, UnsupportedError
from twin.nc.control.block_compiler import BlockCompiler
from twin.nc.dialects.linuxcnc.parameters import LiveParameters
from twin.nc.text.blocks import Assignment, Block
from twin.nc.text.expressions import NumberedVariable

_LIVE = LiveParameters()


def compile_block(compiler: BlockCompiler, block: Block) -> None:
    """Write a block.

    Raises:
        UnsupportedError: It is left to the interpreter tier.
    """
    if not block.assignments:
        compiler.block(block)
        return
    if block.words or len(block.assignments) > 1:
        raise UnsupportedError
    for only in block.assignments:
        _assign(only, compiler.assembler)


def _assign(only: Assignment, assembler: Assembler) -> None:
    """An assignment that stands alone; several are computed before the first is given."""
    if isinstance(only.target, NumberedVariable):
        assembler.value(only.target.index)
        assembler.value(only.value)
        assembler.assign_numbered("#")
    elif only.target.name in _LIVE or only.target.name == "#0":
        raise UnsupportedError
    else:
        assembler.value(only.value)
        assembler.assign(only.target.name)
