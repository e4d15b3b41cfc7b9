"""Blocks of the Fagor CNC 8070 as instructions for the fast way: the same as ``statements`` do."""

from collections.abc import Callable

from twin.nc.bytecode.assembler import BlockWriter, NotTranslatableError
from twin.nc.bytecode.block_compiler import sorted_words, write_words
from twin.nc.bytecode.opcodes import Step
from twin.nc.control.control import Control
from twin.nc.control.flow import Place
from twin.nc.dialects.fagor8070 import flow, polar, subroutines
from twin.nc.dialects.fagor8070.subroutines import DEEPEST_CALL
from twin.nc.dialects.fagor8070.variables import EXPRESSIONS, assignments
from twin.nc.text.blocks import Block, Statement
from twin.nc.text.expressions import Expression

_RETURNS = (17.0, 29.0)


def translate(control: Control, block: Block, writer: BlockWriter) -> None:
    """Write a block.

    Raises:
        NotTranslatableError: It is left to the general way.
    """
    if block.statement is None:
        _words(control, block, writer)
        return
    keyword = " ".join(block.statement.keyword.split())
    if keyword.startswith(("$", "#", "%", "L")):
        translation = _STATEMENTS.get(keyword)
        if translation is None:
            raise NotTranslatableError
        translation(control, block.statement, writer)
    else:
        _assign(control, block.statement, writer)


def _words(control: Control, block: Block, writer: BlockWriter) -> None:
    often = [word for word in block.words if word.address == "NR"]
    returns = [word for word in block.words if word.address == "M" and word.value in _RETURNS]
    rest = [word for word in block.words if word not in (*often[:1], *returns[:1])]
    if often and any(word.address == "M" for word in block.words):
        raise NotTranslatableError
    if often:
        count = often[0].value
        if isinstance(count, Expression):
            writer.value(count)
        else:
            writer.number(count)
        if any(word.address in control.dialect.word_translations for word in rest):
            raise NotTranslatableError
        if any(code.begins_cycle for _, code in sorted_words(control, rest).codes):
            raise NotTranslatableError
        writer.words(rest, often=control.settings.step_limit)
    elif returns:
        writer.may_return()
        write_words(control, rest, writer)
        writer.go_back()
    elif polar.is_polar(control, rest):
        polar.write_polar(control, rest, writer)
    else:
        write_words(control, rest, writer)


def _assign(control: Control, statement: Statement, writer: BlockWriter) -> None:
    for each in assignments(control, statement):
        compute = EXPRESSIONS.operators[each.operator].compute if each.operator else None
        if each.index is not None:
            writer.value(each.index)
            writer.value(each.value)
            writer.assign_numbered("P", compute)
        else:
            writer.value(each.value)
            if compute is None:
                writer.assign(each.name)
            else:
                writer.change(each.name, compute)


def _if(control: Control, statement: Statement, writer: BlockWriter) -> None:
    head, goto, target = statement.text.partition("$")
    writer.value(control.expression(head, statement.text_column))
    if goto:
        jump = flow.jump_behind_condition(control, statement, head, target)
        writer.jump_if(flow.destination(control, jump))
        return
    construct = flow.construct_of(control, statement)
    writer.jump_if(Place(control.block.line, 0))
    for branch in construct.branches:
        if branch.keyword == "$ELSE":
            writer.jump(Place(branch.line + 1, 0))
            return
        writer.value(flow.value_of(control, flow.statement_at(control, branch.line)))
        writer.jump_if(Place(branch.line + 1, 0))
    writer.jump(flow.behind(construct))


def _leave(control: Control, statement: Statement, writer: BlockWriter) -> None:
    writer.jump(flow.behind(flow.construct_of(control, statement)))


def _nothing(control: Control, statement: Statement, _writer: BlockWriter) -> None:
    flow.construct_of(control, statement)


def _while(control: Control, statement: Statement, writer: BlockWriter) -> None:
    construct = flow.construct_of(control, statement)
    writer.value(flow.value_of(control, statement))
    writer.jump_unless(flow.behind(construct))


def _again(control: Control, statement: Statement, writer: BlockWriter) -> None:
    writer.jump(Place(flow.construct_of(control, statement).begin, 0))


def _end_do(control: Control, statement: Statement, writer: BlockWriter) -> None:
    construct = flow.construct_of(control, statement)
    writer.value(flow.value_of(control, statement))
    writer.jump_if(Place(construct.begin + 1, 0))


def _for(control: Control, statement: Statement, writer: BlockWriter) -> None:
    construct = flow.construct_of(control, statement)
    name, values, _ = flow.for_values(control, statement)
    for each in values:
        writer.value(each)
    writer.begin_for(name, flow.behind(construct))


def _end_for(control: Control, statement: Statement, writer: BlockWriter) -> None:
    construct = flow.construct_of(control, statement)
    name, values, _ = flow.for_values(control, flow.statement_at(control, construct.begin))
    for each in values:
        writer.value(each)
    writer.step_for(name, Place(construct.begin + 1, 0))


def _switch(control: Control, statement: Statement, writer: BlockWriter) -> None:
    construct = flow.construct_of(control, statement)
    writer.value(flow.value_of(control, statement))
    for branch in construct.branches:
        if branch.keyword == "$DEFAULT":
            writer.jump(Place(branch.line + 1, 0))
            return
        writer.value(flow.value_of(control, flow.statement_at(control, branch.line)))
        writer.jump_case(Place(branch.line + 1, 0))
    writer.jump(flow.behind(construct))


def _break(control: Control, statement: Statement, writer: BlockWriter) -> None:
    writer.jump(flow.behind(flow.enclosing(control, statement, ("$IF",))))


def _continue(control: Control, statement: Statement, writer: BlockWriter) -> None:
    construct = flow.enclosing(control, statement, ("$IF", "$SWITCH"))
    assert construct.end is not None
    writer.jump(Place(construct.end, 0))


def _go_to(control: Control, statement: Statement, writer: BlockWriter) -> None:
    writer.jump(flow.destination(control, statement))


def _repeat(control: Control, statement: Statement, writer: BlockWriter) -> None:
    asked = subroutines.range_of(control, statement)
    writer.value(asked.count)
    writer.repeat(asked.first, asked.last, DEEPEST_CALL)


def _call(control: Control, statement: Statement, writer: BlockWriter) -> None:
    writer.call(Place(subroutines.called_line(control, statement), 0), DEEPEST_CALL)


def _call_with_parameters(control: Control, statement: Statement, writer: BlockWriter) -> None:
    parameters: list[str] = []
    for parameter, value, _ in subroutines.arguments(control, statement):
        writer.value(value)
        parameters.append(parameter)
    line = subroutines.pcalled_line(control, statement)
    writer.call(Place(line, 0), DEEPEST_CALL, parameters)


def _return(_control: Control, _statement: Statement, writer: BlockWriter) -> None:
    writer.may_return()
    writer.go_back()


def _dwell(control: Control, statement: Statement, writer: BlockWriter) -> None:
    writer.value(control.expression(statement.text, statement.text_column))
    writer.step(Step.DWELL)


_STATEMENTS: dict[str, Callable[[Control, Statement, BlockWriter], None]] = {
    "$IF": _if,
    "$ELSEIF": _leave,
    "$ELSE": _leave,
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
    "#RPT": _repeat,
    "#CALL": _call,
    "LL": _call,
    "L": _call,
    "#PCALL": _call_with_parameters,
    "#RET": _return,
    "#TIME": _dwell,
}
"""The others, which end in diagnostics, events or nothing that is run twice, have no counterpart."""
