"""What a Fanuc control makes of a block's words before any of them acts."""

from twin.nc.control.control import Control
from twin.nc.dialects.fanuc import decimal_point
from twin.nc.dialects.fanuc.memory import letter_patterns, memory_of
from twin.nc.text.blocks import Block

OVERRULED_CYCLE = letter_patterns(
    "G", rb"0*(?:7[346]|8[1-9])(?![0-9.])[^\r\n]*[Gg][ \t]*0*[0-3](?![0-9.])"
)
"""A motion code behind that of a cycle."""
_STRAIGHT, _ARCS = (0.0, 1.0), (2.0, 3.0)
_WORDS_OF_CYCLES = "RPQKL"


def as_read(control: Control, block: Block) -> Block:
    """A block with what its words count."""
    return decimal_point.count(control, _without_overruled_cycle(control, block))


def _without_overruled_cycle(control: Control, block: Block) -> Block:
    """Of a cycle and a straight motion in a block the last counts; a motion leaves R P Q K L out (manual).

    Raises:
        ProgramError: An arc stands behind a cycle, whose R would be ambiguous; or a motion on a control of
            which it is not known what counts.
    """
    codes = [word for word in block.words if word.address == "G"]
    cycle = next((word for word in codes if word.value in decimal_point.CYCLES), None)
    behind = [] if cycle is None else codes[codes.index(cycle) + 1 :]
    motion = next((word for word in behind if word.value in (*_STRAIGHT, *_ARCS)), None)
    if cycle is None or motion is None:
        return block
    control.report.line = block.line
    if motion.value in _ARCS or not memory_of(control).variant.last_code_counts:
        message = f"{cycle.text} and {motion.text} exclude each other in this order"
        control.fail("conflicting-codes", message, motion, "write them in two blocks")
    message = f"{motion.text} behind {cycle.text} moves, and nothing is drilled"
    control.report.warn("cycle-overruled", message, motion.column, motion.width)
    words = tuple(
        word for word in block.words if word is not cycle and word.address not in _WORDS_OF_CYCLES
    )
    return block._replace(words=words)
