"""G40, G41 and G42 for the compiled tier: what the actions of ``offsets`` do, as steps."""

from twin.nc.bytecode.assembler import Assembler, UnsupportedError
from twin.nc.bytecode.opcodes import Opcode
from twin.nc.control.block_words import BlockWords
from twin.nc.control.codes import Compiler
from twin.nc.text.expressions import Expression


def compile_compensation(side: float) -> Compiler:
    """Compensation by the corrector D, else by the tool in the spindle."""

    def write(block: BlockWords, assembler: Assembler) -> None:
        word, table = block.take("D"), block.control.tools.table
        if word is None:
            assembler.emit(Opcode.TOOL_RADIUS)
        elif isinstance(word.value, Expression) or word.value not in table:
            raise UnsupportedError
        else:
            assembler.constant(table[int(word.value)].radius)
        assembler.emit(Opcode.COMPENSATE, int(side))

    return write


def compile_compensation_by_tool(side: float) -> Compiler:
    """Compensation by the tool in the spindle, where it has its offset."""

    def write(block: BlockWords, assembler: Assembler) -> None:
        del block
        assembler.emit(Opcode.TOOL_RADIUS, 1)
        assembler.emit(Opcode.COMPENSATE, int(side))

    return write


def compile_compensation_by_radius(side: float) -> Compiler:
    """Compensation by the radius D, else by the one that was given last."""

    def write(block: BlockWords, assembler: Assembler) -> None:
        word = block.take("D")
        if word is not None:
            assembler.word_value(word)
        assembler.emit(Opcode.PROGRAMMED_RADIUS, int(word is not None))
        assembler.emit(Opcode.COMPENSATE, int(side))

    return write


def compile_end_of_compensation(block: BlockWords, assembler: Assembler) -> None:
    """The next line leads out."""
    del block
    assembler.emit(Opcode.END_COMPENSATION)
