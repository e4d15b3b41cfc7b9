"""Structured flow of the Fagor CNC 8070: conditions, loops, jumps."""

import re
from collections.abc import Sequence

from twin.nc.control.codes import StatementAction
from twin.nc.control.constructs import Construct, Structure
from twin.nc.control.control import Control
from twin.nc.dialects.fagor8070.memory import memory_of
from twin.nc.dialects.fagor8070.subroutines import lines_around
from twin.nc.iso.structured_flow import StructuredFlow
from twin.nc.text.blocks import Location, Statement
from twin.nc.text.expressions.expressions import Expression, Variable

_KEYWORD = re.compile(
    r"[ \t]*/?[ \t]*(?:N[ \t]*[0-9]+[ \t]*|\[\w+\][ \t]*)?(\$[A-Z]+)(.*)", re.IGNORECASE
)
_ENDS = {
    "$ENDIF": "$IF",
    "$ENDWHILE": "$WHILE",
    "$ENDDO": "$DO",
    "$ENDFOR": "$FOR",
    "$ENDSWITCH": "$SWITCH",
}
_BRANCHES = {"$ELSEIF": "$IF", "$ELSE": "$IF", "$CASE": "$SWITCH", "$DEFAULT": "$SWITCH"}


def structure_of(lines: Sequence[str]) -> Structure:
    """Pair the keywords of a program; those that have no counterpart stay open."""
    structure = Structure(_ENDS, _BRANCHES)
    for line, text in enumerate(lines):
        if "$" in text and (match := _KEYWORD.match(text)) is not None:
            keyword = match[1].upper()
            if not (keyword == "$IF" and "$" in match[2]):
                structure.add(keyword, line)
    return structure


_PLACE = re.compile(r"[ \t]*(?:N[ \t]*([0-9]+)|\[[ \t]*([A-Z_]\w*)[ \t]*\])[ \t]*", re.IGNORECASE)


def _structure(control: Control) -> Structure:
    memory = memory_of(control)
    if memory.structure is None:
        memory.structure = structure_of(control.program_counter.lines)
    return memory.structure


def value_of(control: Control, statement: Statement) -> float:
    """The value behind a keyword."""
    column = statement.text_column
    return control.compute(control.statements.expression(statement.text, column), column)


_FLOW = StructuredFlow(_structure, "every $IF needs its $ENDIF, every loop its end", value_of)


def _jump_behind_condition(
    control: Control, statement: Statement, head: str, target: str
) -> Statement:
    """The jump of ``$IF condition $GOTO``, given the texts before and behind its dollar."""
    if target[:4].upper() != "GOTO":
        control.fail("structure", "only $GOTO can follow a condition", statement)
    column = statement.text_column + len(head) + 5
    return Statement(statement.keyword, target[4:], statement.column, column)


def _enclosing(control: Control, statement: Statement, without: tuple[str, ...]) -> Construct:
    """The innermost construct around the block that is of no kind left out."""
    around = [
        construct
        for construct in _structure(control).around(control.block.line - 1)
        if construct.keyword not in without
    ]
    if not around:
        control.fail("structure", f"{statement.keyword} is outside a loop", statement)
    return around[-1]


def destination(control: Control, statement: Statement) -> Location:
    """Where a jump leads."""
    match = _PLACE.fullmatch(statement.text)
    if match is None:
        hint = "write $GOTO N50 or $GOTO [END]"
        control.fail("jump-target", "$GOTO needs N10 or [NAME]", statement, hint)
    label = int(match[1]) if match[1] else match[2].upper()
    span = statement.text_column, len(statement.text)
    place = control.program_counter.find_label(label, span, "$GOTO", lines_around(control))
    _FLOW.refuse_jump_inside(control, statement, place)
    return place


# --- what the statements do


def _if(control: Control, statement: Statement) -> None:
    """$IF: run the first branch whose condition holds; or jump, with $GOTO on the same line."""
    head, goto, target = statement.text.partition("$")
    column = statement.text_column
    holds = control.compute(control.statements.expression(head, column), column) != 0.0
    if goto:
        jump = _jump_behind_condition(control, statement, head, target)
        if holds:
            control.jump(destination(control, jump))
        return
    construct = _FLOW.construct_of(control, statement)
    if holds:
        control.jump(Location(control.block.line, 0))
        return
    for branch in construct.branches:
        if branch.keyword == "$ELSE" or value_of(control, control.statements.of_line(branch.line)):
            control.jump(Location(branch.line + 1, 0))
            return
    control.jump(construct.behind)


def _for(control: Control, statement: Statement) -> None:
    """$FOR P1 = first, last, step."""
    construct = _FLOW.construct_of(control, statement)
    name, first, last, step = _for_values(control, statement, statement)
    control.variables.write(name, first)
    if (first - last) * step > 0.0:
        control.jump(construct.behind)


def _end_for(control: Control, statement: Statement) -> None:
    """$ENDFOR: step on, and run the body again until the last value is passed."""
    construct = _FLOW.construct_of(control, statement)
    values = _for_values(control, control.statements.of_line(construct.begin), statement)
    name, _, last, step = values
    value = control.compute(Expression("", Variable(name)), 0) + step
    control.variables.write(name, value)
    if (value - last) * step <= 0.0:
        control.jump(Location(construct.begin + 1, 0))


def _for_values(
    control: Control, statement: Statement, error_at: Statement
) -> tuple[str, float, float, float]:
    """The parameter, first and last value and step of $FOR.

    Raises:
        ProgramError: They cannot be read, or the step is 0.
    """
    variable = control.program_counter.lexer.expressions.variable.match(statement.text.lstrip(), 0)
    name, equals, values = statement.text.partition("=")
    if variable is None or not equals:
        control.fail("structure", "$FOR needs its parameter", statement, "$FOR P1=0,10,1")
    column = statement.text_column + len(name) + 1
    first, last, step = (
        control.compute(each, column)
        for each in control.statements.expressions(values, column, 3, "$FOR P1=0,10,1")
    )
    if step == 0.0:
        control.fail("structure", "a step of 0 never ends", error_at)
    return variable[0].upper(), first, last, step


def _switch(control: Control, statement: Statement) -> None:
    """$SWITCH: go to the $CASE with the same value, else to $DEFAULT."""
    construct = _FLOW.construct_of(control, statement)
    value = value_of(control, statement)
    for branch in construct.branches:
        is_default = branch.keyword == "$DEFAULT"
        if is_default or value_of(control, control.statements.of_line(branch.line)) == value:
            control.jump(Location(branch.line + 1, 0))
            return
    control.jump(construct.behind)


def _case(control: Control, statement: Statement) -> None:
    """$CASE or $DEFAULT reached from the case before, which is not documented."""
    control.fail("missing-break", "the case before has no $BREAK", statement)


def _break(control: Control, statement: Statement) -> None:
    """$BREAK: go on behind the innermost loop or $SWITCH."""
    control.jump(_enclosing(control, statement, ("$IF",)).behind)


def _continue(control: Control, statement: Statement) -> None:
    """$CONTINUE: go to the end of the innermost loop."""
    construct = _enclosing(control, statement, ("$IF", "$SWITCH"))
    assert construct.end is not None
    control.jump(Location(construct.end, 0))


def _go_to(control: Control, statement: Statement) -> None:
    """$GOTO N10 or $GOTO [NAME]."""
    control.jump(destination(control, statement))


STATEMENTS: dict[str, StatementAction] = {
    "$IF": _if,
    "$ELSEIF": _FLOW.leave,
    "$ELSE": _FLOW.leave,
    "$ENDIF": _FLOW.mark,
    "$WHILE": _FLOW.run_while,
    "$ENDWHILE": _FLOW.go_back,
    "$DO": _FLOW.mark,
    "$ENDDO": _FLOW.repeat_while,
    "$FOR": _for,
    "$ENDFOR": _end_for,
    "$SWITCH": _switch,
    "$ENDSWITCH": _FLOW.mark,
    "$BREAK": _break,
    "$CONTINUE": _continue,
    "$GOTO": _go_to,
    "$CASE": _case,
    "$DEFAULT": _case,
}
