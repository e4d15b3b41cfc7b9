"""Jumps of CODESYS SoftMotion."""

from twin.nc.control.control import Control
from twin.nc.dialects.codesys.program import COUNTER, read_variable
from twin.nc.dialects.codesys.subprograms import own_lines
from twin.nc.text.blocks import Location, Word


def destination(control: Control, target: Word) -> Location:
    """The block with the number of a word L, among those that may be jumped to."""
    span = (target.column, target.width)
    return control.program_counter.find_label(
        int(control.number(target)), span, "L", own_lines(control)
    )


def conditional_jump(control: Control) -> None:
    """G20: go on at block L when K (or the internal variable) is not 0.

    A label L?4 is looked for forwards as L!4; where it is missing, the blocks behind the jump are
    not run (manual).
    """
    number, label, condition = control.take("L"), control.take("L?"), control.take("K")
    target = number or label
    if target is None:
        control.fail("jump-target", "G20 needs L: the block to jump to", hint="write G20 L10 K1")
    value = control.number(target)
    if value != int(value) or value < 0.0:
        control.fail("jump-target", f"{target.text} is no block number", target)
    if number is None:
        _seek_label(control, target, condition)
    elif _holds(control, condition):
        control.jump(destination(control, number))


def _holds(control: Control, condition: Word | None) -> bool:
    """Whether K, or without it the internal variable, is not 0."""
    if condition is None:
        return read_variable(control, COUNTER, None) != 0.0
    return control.number(condition) != 0.0


def _seek_label(control: Control, target: Word, condition: Word | None) -> None:
    """Go on at the next block with this label, or behind the program, if a condition holds."""
    value, here = control.number(target), own_lines(control)
    if not _holds(control, condition):
        return
    if not control.program_counter.seek(
        lambda block: (
            block.line - 1 in here
            and any(word.address == "L!" and word.value == value for word in block.words)
        )
    ):
        control.warn("label-not-found", f"no L!{value:g} follows: the program ends here", target)
        control.program_counter.end()
