"""Structured flow of the Fagor CNC 8070: conditions, loops, jumps."""

import re

from twin.nc.bytecode.assembler import Assembler
from twin.nc.control.codes import StatementAction, StatementEffect
from twin.nc.control.constructs import Construct, Structure
from twin.nc.control.control import Control
from twin.nc.dialects.fagor8070.memory import memory_of
from twin.nc.dialects.fagor8070.structure import structure_of
from twin.nc.dialects.fagor8070.subroutines import lines_around
from twin.nc.text.blocks import Location, Statement

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
        message = f"{statement.keyword} has no counterpart"
        hint = "every $IF needs its $ENDIF, every loop its end"
        control.refuse(statement, "open-structure", message, hint)
    return construct


def _jump_behind_condition(
    control: Control, statement: Statement, head: str, target: str
) -> Statement:
    """The jump of ``$IF condition $GOTO``, given the texts before and behind its dollar."""
    if target[:4].upper() != "GOTO":
        control.refuse(statement, "structure", "only $GOTO can follow a condition")
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
        control.refuse(statement, "structure", f"{statement.keyword} stands outside a loop")
    return around[-1]


def destination(control: Control, statement: Statement) -> Location:
    """Where a jump leads.

    Raises:
        ProgramError: Nowhere, or into a construct.
    """
    match = _PLACE.fullmatch(statement.text)
    if match is None:
        control.refuse(statement, "jump-target", "$GOTO needs N10 or [NAME]")
    label = int(match[1]) if match[1] else match[2].upper()
    span = statement.text_column, len(statement.text)
    place = control.program_counter.find_label(label, span, "$GOTO", lines_around(control))
    structure = _structure(control)
    here = structure.around(control.block.line - 1)
    if any(construct not in here for construct in structure.around(place.line)):
        control.refuse(statement, "jump-into-structure", "a jump must not lead into a structure")
    return place


# --- what the statements do


def _if(control: Control, statement: Statement, assembler: Assembler) -> None:
    """$IF: run the first branch whose condition holds; or jump, with $GOTO on the same line."""
    head, goto, target = statement.text.partition("$")
    column = statement.text_column
    assembler.value(control.expression(head, column), column)
    if goto:
        jump = _jump_behind_condition(control, statement, head, target)
        assembler.jump_if(lambda: destination(control, jump))
        return
    construct = construct_of(control, statement)
    assembler.jump_if(Location(control.block.line, 0))
    for branch in construct.branches:
        if branch.keyword == "$ELSE":
            assembler.jump(Location(branch.line + 1, 0))
            return
        put_value(control, control.statement_of(branch.line), assembler)
        assembler.jump_if(Location(branch.line + 1, 0))
    assembler.jump(construct.behind)


def _else(control: Control, statement: Statement, assembler: Assembler) -> None:
    """$ELSEIF, $ELSE reached from the branch before: go on behind $ENDIF."""
    assembler.jump(construct_of(control, statement).behind)


def _nothing(control: Control, statement: Statement, _assembler: Assembler) -> None:
    """$DO, $ENDIF, $ENDSWITCH: only mark a place, which must have its counterpart."""
    construct_of(control, statement)


def _while(control: Control, statement: Statement, assembler: Assembler) -> None:
    """$WHILE: run the body as long as the condition holds."""
    construct = construct_of(control, statement)
    put_value(control, statement, assembler)
    assembler.jump_unless(construct.behind)


def _again(control: Control, statement: Statement, assembler: Assembler) -> None:
    """$ENDWHILE: look at the condition again."""
    assembler.jump(Location(construct_of(control, statement).begin, 0))


def _end_do(control: Control, statement: Statement, assembler: Assembler) -> None:
    """$ENDDO condition: run the body again as long as it holds."""
    construct = construct_of(control, statement)
    put_value(control, statement, assembler)
    assembler.jump_if(Location(construct.begin + 1, 0))


def _for(control: Control, statement: Statement, assembler: Assembler) -> None:
    """$FOR P1 = first, last, step."""
    construct = construct_of(control, statement)
    name = _for_values(control, statement, assembler)
    assembler.begin_for(name, construct.behind)


def _end_for(control: Control, statement: Statement, assembler: Assembler) -> None:
    """$ENDFOR: step on, and run the body again until the last value is passed."""
    construct = construct_of(control, statement)
    name = _for_values(control, control.statement_of(construct.begin), assembler)
    assembler.step_for(name, Location(construct.begin + 1, 0))


def _for_values(control: Control, statement: Statement, assembler: Assembler) -> str:
    """Put first, last and step on the stack; the parameter."""
    variable = control.program_counter.lexer.expressions.variable.match(statement.text.lstrip(), 0)
    name, equals, values = statement.text.partition("=")
    if variable is None or not equals:
        control.refuse(statement, "structure", "$FOR needs its parameter", "$FOR P1=0,10,1")
    column = statement.text_column + len(name) + 1
    for each in control.expressions(values, column, 3):
        assembler.value(each, column)
    return variable[0].upper()


def _switch(control: Control, statement: Statement, assembler: Assembler) -> None:
    """$SWITCH: go to the $CASE with the same value, else to $DEFAULT."""
    construct = construct_of(control, statement)
    put_value(control, statement, assembler)
    for branch in construct.branches:
        if branch.keyword == "$DEFAULT":
            assembler.jump(Location(branch.line + 1, 0))
            return
        put_value(control, control.statement_of(branch.line), assembler)
        assembler.jump_case(Location(branch.line + 1, 0))
    assembler.jump(construct.behind)


def _case(control: Control, statement: Statement) -> None:
    """$CASE or $DEFAULT reached from the case before, which is not documented."""
    control.refuse(statement, "missing-break", "the case before has no $BREAK")


def _break(control: Control, statement: Statement, assembler: Assembler) -> None:
    """$BREAK: go on behind the innermost loop or $SWITCH."""
    assembler.jump(_enclosing(control, statement, ("$IF",)).behind)


def _continue(control: Control, statement: Statement, assembler: Assembler) -> None:
    """$CONTINUE: go to the end of the innermost loop."""
    construct = _enclosing(control, statement, ("$IF", "$SWITCH"))
    assert construct.end is not None
    assembler.jump(Location(construct.end, 0))


def _go_to(control: Control, statement: Statement, assembler: Assembler) -> None:
    """$GOTO N10 or $GOTO [NAME]."""
    assembler.jump(destination(control, statement))


def put_value(control: Control, statement: Statement, assembler: Assembler) -> None:
    """Put the value behind a keyword on the stack."""
    column = statement.text_column
    assembler.value(control.expression(statement.text, column), column)


STATEMENTS: dict[str, StatementAction] = {
    **{
        keyword: StatementEffect(write)
        for keyword, write in {
            "$IF": _if,
            "$ELSEIF": _else,
            "$ELSE": _else,
            "$ENDIF": _nothing,
            "$WHILE": _while,
            "$ENDWHILE": _again,
            "$DO": _nothing,
            "$ENDDO": _end_do,
            "$FOR": _for,
            "$ENDFOR": _end_for,
            "$SWITCH": _switch,
            "$ENDSWITCH": _nothing,
            "$BREAK": _break,
            "$CONTINUE": _continue,
            "$GOTO": _go_to,
        }.items()
    },
    "$CASE": _case,
    "$DEFAULT": _case,
}
