"""Blocks of the Fagor CNC 8070 as instructions for the compiled tier: the same as ``statements`` do."""

from collections.abc import Callable

from twin.nc.bytecode import opcodes
from twin.nc.bytecode.assembler import Assembler, UnsupportedError
from twin.nc.control.block_compiler import BlockCompiler
from twin.nc.control.control import Control
from twin.nc.dialects.fagor8070 import flow, polar, subroutines
from twin.nc.dialects.fagor8070.control_variables import is_live
from twin.nc.dialects.fagor8070.subroutines import DEEPEST_CALL
from twin.nc.dialects.fagor8070.variables import EXPRESSIONS, assignments
from twin.nc.text.blocks import Block, Location, Statement
from twin.nc.text.expressions import Expression

_RETURNS = (17.0, 29.0)


def compile_block(compiler: BlockCompiler, block: Block) -> None:
    """Write a block.

    Raises:
        UnsupportedError: It is left to the interpreter tier.
    """
    if block.statement is None:
        _words(compiler, block)
        return
    keyword = " ".join(block.statement.keyword.split())
    if keyword.startswith(("$", "#", "%", "L")):
        compile_statement = _STATEMENTS.get(keyword)
        if compile_statement is None:
            raise UnsupportedError
        compile_statement(compiler.control, block.statement, compiler.assembler)
    else:
        _assign(compiler.control, block.statement, compiler.assembler)


def _words(compiler: BlockCompiler, block: Block) -> None:
    assembler = compiler.assembler
    often = [word for word in block.words if word.address == "NR"]
    returns = [word for word in block.words if word.address == "M" and word.value in _RETURNS]
    rest = [word for word in block.words if word not in (*often[:1], *returns[:1])]
    if often and any(word.address == "M" for word in block.words):
        raise UnsupportedError
    if often:
        count = often[0].value
        if isinstance(count, Expression):
            assembler.value(count)
        else:
            assembler.constant(count)
        if any(word.address in compiler.vocabulary.word_compilers for word in rest):
            raise UnsupportedError
        if any(code.begins_cycle for _, code in compiler.sorted(rest).codes):
            raise UnsupportedError
        assembler.words(rest, often=compiler.control.settings.step_limit)
    elif returns:
        assembler.check_return()
        compiler.words(rest)
        assembler.end_call()
    elif polar.is_polar(compiler, rest):
        polar.compile_polar(compiler, rest)
    else:
        compiler.words(rest)


def _assign(control: Control, statement: Statement, assembler: Assembler) -> None:
    every, rest = assignments(control, statement)
    if rest is not None or any(is_live(each.name) for each in every):
        raise UnsupportedError
    for each in every:
        compute = EXPRESSIONS.operators[each.operator].compute if each.operator else None
        if each.index is not None:
            assembler.value(each.index)
            assembler.value(each.value)
            assembler.assign_numbered("P", compute)
        else:
            assembler.value(each.value)
            if compute is None:
                assembler.assign(each.name)
            else:
                assembler.change(each.name, compute)


def _if(control: Control, statement: Statement, assembler: Assembler) -> None:
    head, goto, target = statement.text.partition("$")
    assembler.value(control.expression(head, statement.text_column))
    if goto:
        jump = flow.jump_behind_condition(control, statement, head, target)
        assembler.jump_if(flow.destination(control, jump))
        return
    construct = flow.construct_of(control, statement)
    assembler.jump_if(Location(control.block.line, 0))
    for branch in construct.branches:
        if branch.keyword == "$ELSE":
            assembler.jump(Location(branch.line + 1, 0))
            return
        assembler.value(flow.value_of(control, flow.statement_at(control, branch.line)))
        assembler.jump_if(Location(branch.line + 1, 0))
    assembler.jump(flow.behind(construct))


def _leave(control: Control, statement: Statement, assembler: Assembler) -> None:
    assembler.jump(flow.behind(flow.construct_of(control, statement)))


def _nothing(control: Control, statement: Statement, _assembler: Assembler) -> None:
    flow.construct_of(control, statement)


def _while(control: Control, statement: Statement, assembler: Assembler) -> None:
    construct = flow.construct_of(control, statement)
    assembler.value(flow.value_of(control, statement))
    assembler.jump_unless(flow.behind(construct))


def _again(control: Control, statement: Statement, assembler: Assembler) -> None:
    assembler.jump(Location(flow.construct_of(control, statement).begin, 0))


def _end_do(control: Control, statement: Statement, assembler: Assembler) -> None:
    construct = flow.construct_of(control, statement)
    assembler.value(flow.value_of(control, statement))
    assembler.jump_if(Location(construct.begin + 1, 0))


def _for(control: Control, statement: Statement, assembler: Assembler) -> None:
    construct = flow.construct_of(control, statement)
    name, values, _ = flow.for_values(control, statement)
    for each in values:
        assembler.value(each)
    assembler.begin_for(name, flow.behind(construct))


def _end_for(control: Control, statement: Statement, assembler: Assembler) -> None:
    construct = flow.construct_of(control, statement)
    name, values, _ = flow.for_values(control, flow.statement_at(control, construct.begin))
    for each in values:
        assembler.value(each)
    assembler.step_for(name, Location(construct.begin + 1, 0))


def _switch(control: Control, statement: Statement, assembler: Assembler) -> None:
    construct = flow.construct_of(control, statement)
    assembler.value(flow.value_of(control, statement))
    for branch in construct.branches:
        if branch.keyword == "$DEFAULT":
            assembler.jump(Location(branch.line + 1, 0))
            return
        assembler.value(flow.value_of(control, flow.statement_at(control, branch.line)))
        assembler.jump_case(Location(branch.line + 1, 0))
    assembler.jump(flow.behind(construct))


def _break(control: Control, statement: Statement, assembler: Assembler) -> None:
    assembler.jump(flow.behind(flow.enclosing(control, statement, ("$IF",))))


def _continue(control: Control, statement: Statement, assembler: Assembler) -> None:
    construct = flow.enclosing(control, statement, ("$IF", "$SWITCH"))
    assert construct.end is not None
    assembler.jump(Location(construct.end, 0))


def _go_to(control: Control, statement: Statement, assembler: Assembler) -> None:
    assembler.jump(flow.destination(control, statement))


def _repeat(control: Control, statement: Statement, assembler: Assembler) -> None:
    asked = subroutines.range_of(control, statement)
    assembler.value(asked.count)
    assembler.repeat(asked.first, asked.last, DEEPEST_CALL)


def _call(control: Control, statement: Statement, assembler: Assembler) -> None:
    assembler.call(Location(subroutines.called_line(control, statement), 0), DEEPEST_CALL)


def _call_with_parameters(control: Control, statement: Statement, assembler: Assembler) -> None:
    parameters: list[str] = []
    for parameter, value, _ in subroutines.arguments(control, statement):
        assembler.value(value)
        parameters.append(parameter)
    line = subroutines.pcalled_line(control, statement)
    assembler.call(Location(line, 0), DEEPEST_CALL, parameters)


def _return(_control: Control, _statement: Statement, assembler: Assembler) -> None:
    assembler.check_return()
    assembler.end_call()


def _dwell(control: Control, statement: Statement, assembler: Assembler) -> None:
    assembler.value(control.expression(statement.text, statement.text_column))
    assembler.emit(opcodes.DWELL)


_STATEMENTS: dict[str, Callable[[Control, Statement, Assembler], None]] = {
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
