"""Structured flow of the Fagor CNC 8070: conditions, loops, jumps."""

import re

from twin.nc.blocks import Statement
from twin.nc.control import Control
from twin.nc.dialects.fagor8070.memory import memory_of
from twin.nc.dialects.fagor8070.structure import Construct, Structure, structure_of
from twin.nc.dialects.fagor8070.subroutines import lines_around
from twin.nc.dialects.fagor8070.variables import read_variable, refuse
from twin.nc.flow import Place

_PLACE = re.compile(r"[ \t]*(?:N[ \t]*([0-9]+)|\[[ \t]*([A-Z_]\w*)[ \t]*\])[ \t]*", re.IGNORECASE)


def _structure(control: Control) -> Structure:
    memory = memory_of(control)
    if memory.structure is None:
        memory.structure = structure_of(control.flow.lines)
    return memory.structure


def _construct(control: Control, statement: Statement) -> Construct:
    construct = _structure(control).by_line.get(control.block.line - 1)
    if construct is None or construct.end is None:
        refuse(
            control,
            statement,
            "open-structure",
            f"{statement.keyword} has no counterpart",
            hint="every $IF needs its $ENDIF, every loop its end",
        )
    return construct


def _condition(control: Control, line: int) -> float:
    """The value behind the keyword of another line of a construct."""
    control.report.line = line + 1
    (block,) = control.flow.lexer.blocks(control.flow.lines[line], line + 1)
    assert block.statement is not None
    text, column = block.statement.text, block.statement.text_column
    return control.compute(control.expression(text, column), column)


def if_(control: Control, statement: Statement) -> None:
    """$IF: run the first branch whose condition holds; or jump, with $GOTO on the same line."""
    head, goto, target = statement.text.partition("$")
    value = control.compute(control.expression(head, statement.text_column), statement.text_column)
    if goto:
        word = target[:4].upper()
        if word != "GOTO":
            refuse(control, statement, "structure", "only $GOTO can follow a condition")
        if value:
            column = statement.text_column + len(head) + 5
            _go_to(control, target[4:], column, statement)
        return
    construct = _construct(control, statement)
    if value:
        return
    for branch in construct.branches:
        if branch.keyword == "$ELSE" or _condition(control, branch.line):
            control.flow.go(Place(branch.line + 1, 0))
            return
    control.flow.go(_behind(construct))


def _behind(construct: Construct) -> Place:
    assert construct.end is not None
    return Place(construct.end + 1, 0)


def else_(control: Control, statement: Statement) -> None:
    """$ELSEIF, $ELSE reached from the branch before: go on behind $ENDIF."""
    control.flow.go(_behind(_construct(control, statement)))


def while_(control: Control, statement: Statement) -> None:
    """$WHILE: run the body as long as the condition holds."""
    construct = _construct(control, statement)
    column = statement.text_column
    if not control.compute(control.expression(statement.text, column), column):
        control.flow.go(_behind(construct))


def again(control: Control, statement: Statement) -> None:
    """$ENDWHILE: look at the condition again."""
    control.flow.go(Place(_construct(control, statement).begin, 0))


def nothing(control: Control, statement: Statement) -> None:
    """$DO, $ENDIF, $ENDSWITCH: only mark a place, which must have its counterpart."""
    _construct(control, statement)


def end_do(control: Control, statement: Statement) -> None:
    """$ENDDO condition: run the body again as long as it holds."""
    construct, column = _construct(control, statement), statement.text_column
    if control.compute(control.expression(statement.text, column), column):
        control.flow.go(Place(construct.begin + 1, 0))


def for_(control: Control, statement: Statement) -> None:
    """$FOR P1 = first, last, step."""
    construct = _construct(control, statement)
    name, first, last, step = _for_values(control, statement)
    control.variables.write(name, first)
    if (first - last) * step > 0.0:
        control.flow.go(_behind(construct))


def end_for(control: Control, statement: Statement) -> None:
    """$ENDFOR: step on, and run the body again until the last value is passed."""
    construct = _construct(control, statement)
    line = control.block.line
    control.report.line = construct.begin + 1
    (block,) = control.flow.lexer.blocks(control.flow.lines[construct.begin], construct.begin + 1)
    assert block.statement is not None
    name, _, last, step = _for_values(control, block.statement)
    value = read_variable(control, name, None) + step
    control.variables.write(name, value)
    control.report.line = line
    if (value - last) * step <= 0.0:
        control.flow.go(Place(construct.begin + 1, 0))


def _for_values(control: Control, statement: Statement) -> tuple[str, float, float, float]:
    variable = control.flow.lexer.expressions.variable_at(statement.text.lstrip(), 0)
    name, equals, values = statement.text.partition("=")
    if variable is None or not equals:
        refuse(control, statement, "structure", "$FOR needs its parameter", "$FOR P1=0,10,1")
    column = statement.text_column + len(name) + 1
    first, last, step = (
        control.compute(each, column) for each in control.expressions(values, column, 3)
    )
    if step == 0.0:
        refuse(control, statement, "structure", "a step of 0 never ends")
    return variable[0].upper(), first, last, step


def switch(control: Control, statement: Statement) -> None:
    """$SWITCH: go to the $CASE with the same value, else to $DEFAULT."""
    construct, column = _construct(control, statement), statement.text_column
    value = control.compute(control.expression(statement.text, column), column)
    for branch in construct.branches:
        if branch.keyword == "$DEFAULT" or _condition(control, branch.line) == value:
            control.flow.go(Place(branch.line + 1, 0))
            return
    control.flow.go(_behind(construct))


def case(control: Control, statement: Statement) -> None:
    """$CASE or $DEFAULT reached from the case before, which is not documented.

    Raises:
        ProgramError: Always.
    """
    refuse(control, statement, "missing-break", "the case before has no $BREAK")


def leave_construct(control: Control, statement: Statement) -> None:
    """$BREAK: go on behind the innermost loop or $SWITCH."""
    control.flow.go(_behind(_enclosing(control, statement, ("$IF",))))


def next_round(control: Control, statement: Statement) -> None:
    """$CONTINUE: go to the end of the innermost loop."""
    construct = _enclosing(control, statement, ("$IF", "$SWITCH"))
    assert construct.end is not None
    control.flow.go(Place(construct.end, 0))


def _enclosing(control: Control, statement: Statement, without: tuple[str, ...]) -> Construct:
    around = [
        construct
        for construct in _structure(control).around(control.block.line - 1)
        if construct.keyword not in without
    ]
    if not around:
        refuse(control, statement, "structure", f"{statement.keyword} stands outside a loop")
    return around[-1]


def go_to(control: Control, statement: Statement) -> None:
    """$GOTO N10 or $GOTO [NAME]."""
    _go_to(control, statement.text, statement.text_column, statement)


def _go_to(control: Control, text: str, column: int, statement: Statement) -> None:
    match = _PLACE.fullmatch(text)
    if match is None:
        refuse(control, statement, "jump-target", "$GOTO needs N10 or [NAME]")
    place = control.flow.find_label(
        label_of(match), (column, len(text)), "$GOTO", lines_around(control)
    )
    structure = _structure(control)
    here = structure.around(control.block.line - 1)
    if any(construct not in here for construct in structure.around(place.line)):
        refuse(control, statement, "jump-into-structure", "a jump must not lead into a structure")
    control.flow.go(place)


def label_of(match: re.Match[str]) -> int | str:
    """The N number or the name that was read."""
    return int(match[1]) if match[1] else match[2].upper()
