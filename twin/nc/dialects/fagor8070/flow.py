"""Structured flow of the Fagor CNC 8070: conditions, loops, jumps."""

import re

from twin.nc.control.constructs import Construct, Structure
from twin.nc.control.control import Control
from twin.nc.dialects.fagor8070.memory import memory_of
from twin.nc.dialects.fagor8070.structure import structure_of
from twin.nc.dialects.fagor8070.subroutines import lines_around
from twin.nc.dialects.fagor8070.variables import read_variable, refuse
from twin.nc.text.blocks import Location, Statement
from twin.nc.text.expressions import Expression

_PLACE = re.compile(r"[ \t]*(?:N[ \t]*([0-9]+)|\[[ \t]*([A-Z_]\w*)[ \t]*\])[ \t]*", re.IGNORECASE)


def _structure(control: Control) -> Structure:
    memory = memory_of(control)
    if memory.structure is None:
        memory.structure = structure_of(control.program_counter.lines)
    return memory.structure


def construct_of(control: Control, statement: Statement) -> Construct:
    """The construct that a statement of the block belongs to.

    Raises:
        ProgramError: It has no counterpart.
    """
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


def statement_at(control: Control, line: int) -> Statement:
    """The statement of another line of a construct, from 0; errors are that line's from now on."""
    control.report.line = line + 1
    (block,) = control.program_counter.lexer.blocks(control.program_counter.lines[line], line + 1)
    assert block.statement is not None
    return block.statement


def value_of(control: Control, statement: Statement) -> Expression:
    """The value behind a keyword."""
    return control.expression(statement.text, statement.text_column)


def _compute(control: Control, statement: Statement) -> float:
    return control.compute(value_of(control, statement), statement.text_column)


def if_(control: Control, statement: Statement) -> None:
    """$IF: run the first branch whose condition holds; or jump, with $GOTO on the same line."""
    head, goto, target = statement.text.partition("$")
    value = control.compute(control.expression(head, statement.text_column), statement.text_column)
    if goto:
        jump = jump_behind_condition(control, statement, head, target)
        if value:
            control.program_counter.go(destination(control, jump))
        return
    construct = construct_of(control, statement)
    if value:
        return
    for branch in construct.branches:
        if branch.keyword == "$ELSE" or _compute(control, statement_at(control, branch.line)):
            control.program_counter.go(Location(branch.line + 1, 0))
            return
    control.program_counter.go(behind(construct))


def jump_behind_condition(
    control: Control, statement: Statement, head: str, target: str
) -> Statement:
    """The jump of ``$IF condition $GOTO``, given the texts before and behind its dollar."""
    if target[:4].upper() != "GOTO":
        refuse(control, statement, "structure", "only $GOTO can follow a condition")
    column = statement.text_column + len(head) + 5
    return Statement(statement.keyword, target[4:], statement.column, column)


def behind(construct: Construct) -> Location:
    """The place behind a construct that has an end."""
    assert construct.end is not None
    return Location(construct.end + 1, 0)


def else_(control: Control, statement: Statement) -> None:
    """$ELSEIF, $ELSE reached from the branch before: go on behind $ENDIF."""
    control.program_counter.go(behind(construct_of(control, statement)))


def while_(control: Control, statement: Statement) -> None:
    """$WHILE: run the body as long as the condition holds."""
    construct = construct_of(control, statement)
    if not _compute(control, statement):
        control.program_counter.go(behind(construct))


def again(control: Control, statement: Statement) -> None:
    """$ENDWHILE: look at the condition again."""
    control.program_counter.go(Location(construct_of(control, statement).begin, 0))


def nothing(control: Control, statement: Statement) -> None:
    """$DO, $ENDIF, $ENDSWITCH: only mark a place, which must have its counterpart."""
    construct_of(control, statement)


def end_do(control: Control, statement: Statement) -> None:
    """$ENDDO condition: run the body again as long as it holds."""
    construct = construct_of(control, statement)
    if _compute(control, statement):
        control.program_counter.go(Location(construct.begin + 1, 0))


def for_(control: Control, statement: Statement) -> None:
    """$FOR P1 = first, last, step."""
    construct = construct_of(control, statement)
    name, first, last, step = _for_values(control, statement)
    control.variables.write(name, first)
    if (first - last) * step > 0.0:
        control.program_counter.go(behind(construct))


def end_for(control: Control, statement: Statement) -> None:
    """$ENDFOR: step on, and run the body again until the last value is passed."""
    construct = construct_of(control, statement)
    line = control.block.line
    name, _, last, step = _for_values(control, statement_at(control, construct.begin))
    value = read_variable(control, name, None) + step
    control.variables.write(name, value)
    control.report.line = line
    if (value - last) * step <= 0.0:
        control.program_counter.go(Location(construct.begin + 1, 0))


def for_values(control: Control, statement: Statement) -> tuple[str, list[Expression], int]:
    """Parameter of a $FOR, its three values, and where these begin."""
    variable = control.program_counter.lexer.expressions.variable_at(statement.text.lstrip(), 0)
    name, equals, values = statement.text.partition("=")
    if variable is None or not equals:
        refuse(control, statement, "structure", "$FOR needs its parameter", "$FOR P1=0,10,1")
    column = statement.text_column + len(name) + 1
    return variable[0].upper(), control.expressions(values, column, 3), column


def _for_values(control: Control, statement: Statement) -> tuple[str, float, float, float]:
    name, values, column = for_values(control, statement)
    first, last, step = (control.compute(each, column) for each in values)
    if step == 0.0:
        refuse(control, statement, "structure", "a step of 0 never ends")
    return name, first, last, step


def switch(control: Control, statement: Statement) -> None:
    """$SWITCH: go to the $CASE with the same value, else to $DEFAULT."""
    construct, value = construct_of(control, statement), _compute(control, statement)
    for branch in construct.branches:
        if branch.keyword == "$DEFAULT" or value == _compute(
            control, statement_at(control, branch.line)
        ):
            control.program_counter.go(Location(branch.line + 1, 0))
            return
    control.program_counter.go(behind(construct))


def case(control: Control, statement: Statement) -> None:
    """$CASE or $DEFAULT reached from the case before, which is not documented.

    Raises:
        ProgramError: Always.
    """
    refuse(control, statement, "missing-break", "the case before has no $BREAK")


def leave_construct(control: Control, statement: Statement) -> None:
    """$BREAK: go on behind the innermost loop or $SWITCH."""
    control.program_counter.go(behind(enclosing(control, statement, ("$IF",))))


def next_round(control: Control, statement: Statement) -> None:
    """$CONTINUE: go to the end of the innermost loop."""
    construct = enclosing(control, statement, ("$IF", "$SWITCH"))
    assert construct.end is not None
    control.program_counter.go(Location(construct.end, 0))


def enclosing(control: Control, statement: Statement, without: tuple[str, ...]) -> Construct:
    """The innermost construct around the block that is of no kind left out."""
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
    control.program_counter.go(destination(control, statement))


def destination(control: Control, statement: Statement) -> Location:
    """Where a jump leads.

    Raises:
        ProgramError: Nowhere, or into a construct.
    """
    match = _PLACE.fullmatch(statement.text)
    if match is None:
        refuse(control, statement, "jump-target", "$GOTO needs N10 or [NAME]")
    place = control.program_counter.find_label(
        label_of(match),
        (statement.text_column, len(statement.text)),
        "$GOTO",
        lines_around(control),
    )
    structure = _structure(control)
    here = structure.around(control.block.line - 1)
    if any(construct not in here for construct in structure.around(place.line)):
        refuse(control, statement, "jump-into-structure", "a jump must not lead into a structure")
    return place


def label_of(match: re.Match[str]) -> int | str:
    """The N number or the name that was read."""
    return int(match[1]) if match[1] else match[2].upper()
