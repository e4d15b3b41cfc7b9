"""REPEAT, REPEATB and CALL BLOCK: blocks that run again, named by their labels."""

import re

from twin.nc.control.control import Control
from twin.nc.dialects.sinumerik.flow.programs import lines_around
from twin.nc.dialects.sinumerik.memory import DEEPEST_CALL
from twin.nc.dialects.sinumerik.variables.expressions import NAME
from twin.nc.text.blocks import Location, Statement

_NAMED = rf"N[ \t]*\d+|{NAME}"
_RANGE = re.compile(
    rf"[ \t]*({_NAMED})(?:[ \t]+(?!P[ \t]*=)({_NAMED}))?[ \t]*(?:P[ \t]*=?[ \t]*(.+))?",
    re.IGNORECASE,
)


def repeat_blocks(control: Control, statement: Statement) -> None:
    """REPEAT FIRST LAST P=3, REPEATB LABEL P=3: run blocks again."""
    match = _RANGE.fullmatch(statement.text.rstrip())
    if match is None:
        message = f"{statement.keyword} needs the label of what it repeats, and at most P="
        control.fail("repeat-range", message, statement, f"write {statement.keyword} LABEL P=3")
    times = 1.0
    if match[3]:
        at = statement.text_column + match.start(3)
        times = control.compute(control.statements.expression(match[3], at), at)
    lines, here = lines_around(control), Location(control.block.line - 1, 0)
    first = _place(control, statement, match[1], lines)
    if match[2]:
        last = _place(control, statement, match[2], lines)
    else:
        last = first if statement.keyword == "REPEATB" else _end_label(control, first, here)
    if last < first or first <= here <= last:
        message = "the range or the number of runs is none, or holds its own repetition"
        control.fail("repeat-range", message, statement)
    control.call(first, DEEPEST_CALL, statement, times=times, last=last)


def call_part(
    control: Control, statement: Statement, first: str, last: str, lines: range | None = None
) -> None:
    """Call the blocks between two labels, of the program that runs or of other lines."""
    lines = lines_around(control) if lines is None else lines
    begin = _place(control, statement, first, lines)
    end = _place(control, statement, last, lines)
    if end < begin:
        message = f"{statement.keyword} names {last}, which is before {first}"
        control.fail("repeat-range", message, statement)
    control.call(begin, DEEPEST_CALL, statement, last=end)


def _end_label(control: Control, first: Location, here: Location) -> Location:
    """REPEAT LABEL: up to ENDLABEL:, or up to the block before the repetition."""
    ends = control.program_counter.labels().get("ENDLABEL", [])
    lines = lines_around(control)
    found = [each for each in ends if each.line in lines and each > first]
    if found:
        return found[0]
    text = control.program_counter.lines
    last = next(
        (each for each in range(here.line - 1, -1, -1) if text[each].partition(";")[0].strip()), 0
    )
    return Location(last, 0)


def _place(control: Control, statement: Statement, text: str, lines: range) -> Location:
    bare = re.sub(r"[ \t]", "", text.upper())
    label = int(bare[1:]) if bare[0] == "N" and bare[1:].isdigit() else bare
    places = control.program_counter.labels().get(label, [])
    places = [each for each in places if each.line in lines]
    before = [each for each in places if each.line < control.block.line - 1]
    if not places:
        message = f"{statement.keyword} names {bare}, and no block has it"
        control.fail("unknown-label", message, statement, "a label ends with a colon: LABEL:")
    return before[-1] if before else places[0]
