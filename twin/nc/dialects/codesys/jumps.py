"""Jumps of CODESYS SoftMotion."""

from twin.nc.control.control import Control
from twin.nc.dialects.codesys.program import COUNTER, read_variable
from twin.nc.dialects.codesys.subprograms import own_lines
from twin.nc.text.blocks import Location, Word


def destination(control: Control, target: Word) -> Location:
    """The block with the number of a word L, among those that may be jumped to.

    Raises:
        ProgramError: There is none.
    """
    span = (target.column, target.width)
    return control.program_counter.find_label(
        int(control.number(target)), span, "L", own_lines(control)
    )


def conditional_jump(control: Control) -> None:
    """G20: go on at block L when K (or the internal variable) is not 0.

    A label L?4 is looked for forwards as L!4; where it is missing, the blocks behind the jump are
    not run (manual).
    """
    number, label = control.take("L"), control.take("L?")
    condition = control.take_number("K", read_variable(control, COUNTER, None))
    target = number or label
    if target is None:
        control.fail("jump-target", "G20 needs L: the block to jump to", hint="write G20 L10 K1")
    value = control.number(target)
    if value != int(value) or value < 0.0:
        control.fail("jump-target", f"{target.text} is no block number", target)
    if condition == 0.0:
        return
    if number is not None:
        control.program_counter.go(destination(control, target))
        return
    here = own_lines(control)
    if not control.program_counter.seek(
        lambda block: (
            block.line - 1 in here
            and any(word.address == "L!" and word.value == value for word in block.words)
        )
    ):
        control.warn("label-not-found", f"no L!{value:g} follows: the program ends here", target)
        control.program_counter.end()
