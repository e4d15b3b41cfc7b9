"""G40, G41 and G42 for the fast way: what the actions of ``offsets`` do, as steps."""

from twin.nc.bytecode.assembler import BlockWriter, NotTranslatableError
from twin.nc.bytecode.block_compiler import BlockWords
from twin.nc.bytecode.opcodes import Step
from twin.nc.control.dialect import Translation
from twin.nc.text.expressions import Expression


def write_compensation(side: float) -> Translation:
    """Compensation by the corrector D, else by the tool in the spindle."""

    def write(block: BlockWords, writer: BlockWriter) -> None:
        word, table = block.take("D"), block.control.tools.table
        if word is None:
            writer.step(Step.TOOL_RADIUS)
        elif isinstance(word.value, Expression) or word.value not in table:
            raise NotTranslatableError
        else:
            writer.number(table[int(word.value)].radius)
        writer.step(Step.COMPENSATE, int(side))

    return write


def write_compensation_by_tool(side: float) -> Translation:
    """Compensation by the tool in the spindle, where it has its offset."""

    def write(block: BlockWords, writer: BlockWriter) -> None:
        del block
        writer.step(Step.TOOL_RADIUS, 1)
        writer.step(Step.COMPENSATE, int(side))

    return write


def write_compensation_by_radius(side: float) -> Translation:
    """Compensation by the radius D, else by the one that was given last."""

    def write(block: BlockWords, writer: BlockWriter) -> None:
        word = block.take("D")
        if word is not None:
            writer.word_value(word)
        writer.step(Step.PROGRAMMED_RADIUS, int(word is not None))
        writer.step(Step.COMPENSATE, int(side))

    return write


def write_end_of_compensation(block: BlockWords, writer: BlockWriter) -> None:
    """The next line leads out."""
    del block
    writer.step(Step.END_COMPENSATION)
