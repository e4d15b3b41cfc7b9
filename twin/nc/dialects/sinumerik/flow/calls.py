"""Calls of subprograms: L.., by name, with parameters, CALL, PCALL, EXTCALL, MCALL, and the return."""

import re
from collections.abc import Sequence

from twin.nc.control.codes import Action, StatementAction
from twin.nc.control.control import Control
from twin.nc.dialects.sinumerik.flow.programs import heading, name_of_file, procedure
from twin.nc.dialects.sinumerik.flow.repeats import call_part, repeat_blocks
from twin.nc.dialects.sinumerik.frames import put_programmable
from twin.nc.dialects.sinumerik.memory import (
    DEEPEST_CALL,
    TEXTS,
    CallFrame,
    Formal,
    Subprogram,
    VariableType,
    memory_of,
)
from twin.nc.dialects.sinumerik.variables.expressions import NAME, bracketed, split_values
from twin.nc.dialects.sinumerik.variables.variables import axis_of_value, text_named, write_variable
from twin.nc.text.blocks import Block, Location, Statement
from twin.nc.text.diagnostics.slips import near, slip_at
from twin.nc.text.expressions.expressions import ExpressionError, Variable

_TIMES = re.compile(r"[ \t]*P[ \t]*=?[ \t]*(.+)", re.IGNORECASE)
_PATH = re.compile(
    r"[ \t]*(?P<open>\([ \t]*)?(?:\"(?P<text>[^\"]*)\"|(?P<path>/[^\s(]+)|(?!BLOCK\b)(?P<name>\w+))?"
    r"(?(open)[ \t]*\))",
    re.IGNORECASE,
)
"""What CALL, PCALL and EXTCALL name: a text, a path, or a variable that holds a text."""
_PART = re.compile(rf"[ \t]*BLOCK[ \t]+({NAME})[ \t]+TO[ \t]+({NAME})[ \t]*", re.IGNORECASE)


def call_named(control: Control, statement: Statement, name: str, text: str, column: int) -> None:
    """Call a subprogram; the text behind its name holds values in brackets and P, how often."""
    subprogram = _subprogram(control, statement, name)
    inner, begin, end = bracketed(control, text, column)
    rest, times = text[end:].rstrip(), 1.0
    if rest:
        match = _TIMES.fullmatch(rest)
        if match is None:
            message = f"only P and how often can follow the call of {name}"
            control.report.fail("call-values", message, column + end, len(rest))
        at = column + end + match.start(1)
        times = control.compute(control.statements.expression(match[1], at), at)
    values = [(each, begin + at) for each, at in split_values(inner)] if inner.strip() else []
    _enter(control, statement, subprogram, values, times)


def _subprogram(control: Control, statement: Statement, name: str) -> Subprogram:
    memory = memory_of(control)
    found = memory.subprograms.get(name)
    if found is None and name[0] == "L" and name[1:].isdigit():
        found = memory.subprograms.get(f"L{int(name[1:])}")
    if found is None:
        own = ", ".join(sorted(memory.subprograms))
        message = f"there is no subprogram {name}"
        alike = near(name, (*control.program_counter.lexer.keywords, *memory.subprograms))
        hints = [
            slip_at(control.report.text_of(control.block.line), statement.column, "sinumerik"),
            f"near it: {', '.join(alike)}" if alike else None,
            f"a subprogram is a file {name}.SPF beside the program, or follows it behind %_N_{name}_SPF",
            f"here: {own}" if own else None,
        ]
        hint = "; ".join(filter(None, hints))
        control.fail("unknown-subprogram", message, statement, hint)
    return found


def call_subprogram(control: Control, statement: Statement, name: str) -> None:
    """Call a subprogram without values."""
    _enter(control, statement, _subprogram(control, statement, name), [], 1.0)


def _enter(
    control: Control,
    statement: Statement,
    subprogram: Subprogram,
    values: Sequence[tuple[str, int]],
    times: float,
) -> None:
    """Call a subprogram with the texts of its values, and where they are."""
    formals, memory = subprogram.formals, memory_of(control)
    if len(values) > len(formals):
        message = f"the subprogram takes {len(formals)} values, not {len(values)}"
        control.fail("call-values", message, statement, "PROC declares them: PROC NAME(REAL DEPTH)")
    frame, given = CallFrame(depth=control.program_counter.depth + 1), list[tuple[str, float]]()
    for number, formal in enumerate(formals):
        text, at = values[number] if number < len(values) else ("", statement.column)
        frame.types[formal.name] = formal.type
        if formal.type in TEXTS:
            is_axis = formal.type is VariableType.AXIS
            read = axis_of_value if is_axis else text_named
            frame.texts[formal.name] = read(control, text, at) if text.strip() else ""
        elif formal.is_table:
            given += _table(control, frame, formal, text.strip().upper(), at)
        else:
            given.append((formal.name, _number(control, frame, formal, text, at)))
    if subprogram.restores:
        frame.programmable = (memory.matrix, memory.translation)
    first = Location(subprogram.first, 0)
    control.call(first, DEEPEST_CALL, statement, given, restores=subprogram.restores, times=times)
    memory.calls.append(frame)


def _number(control: Control, frame: CallFrame, formal: Formal, text: str, at: int) -> float:
    """The value of a parameter; where it is VAR, the variable that the end of the call writes is noted."""
    expression = control.statements.expression(text, at) if text.strip() else None
    if formal.is_reference:
        if expression is None or not isinstance(expression.tree, Variable):
            message = f"{formal.name} is VAR: the call must give it a variable"
            control.report.fail("call-values", message, at, 1)
        frame.references[formal.name] = expression.tree.name
    value = formal.default if expression is None else control.compute(expression, at)
    return formal.type.converted(value)


def _table(
    control: Control, frame: CallFrame, formal: Formal, name: str, at: int
) -> list[tuple[str, float]]:
    """The elements of a table that a call gives, by their names in the subprogram."""
    size = memory_of(control).calls[-1].sizes.get(name)
    if size is None:
        message = f"{formal.name} is a table: the call must give it one"
        control.report.fail("call-values", message, at, max(len(name), 1), "DEF REAL TABLE[10]")
    frame.sizes[formal.name] = size
    places = [f"[{row},{column}]" for row in range(size[0]) for column in range(size[1])]
    if formal.is_reference:
        frame.references |= {f"{formal.name}{place}": f"{name}{place}" for place in places}
    read = control.variables.read
    return [(f"{formal.name}{place}", read(f"{name}{place}") or 0.0) for place in places]


def go_back(control: Control, error_at: Statement | None = None) -> None:
    """M17, RET, or the last line of a subprogram: back behind its call, or to its beginning again."""
    control.require_caller(error_at)
    memory = memory_of(control)
    frame = memory.calls[-1]
    results = [(to, control.variables.read(name)) for name, to in frame.references.items()]
    control.go_back(error_at)
    if control.program_counter.depth >= frame.depth:  # it runs again
        return
    memory.calls.pop()
    for name, value in results:
        if value is not None:
            _give_back(control, name, value, error_at)
    if frame.programmable is not None and frame.programmable != (memory.matrix, memory.translation):
        put_programmable(control, *frame.programmable)


def _give_back(control: Control, name: str, value: float, error_at: Statement | None) -> None:
    """Write a variable of the caller's, or an element of a table, that a VAR has changed."""
    if name.endswith("]"):
        control.variables.write(name, value)
        return
    try:
        write_variable(control, name, None, value)
    except ExpressionError as error:
        control.fail(error.code, str(error), error_at, error.hint)


def end_of_program(number: int) -> Action:
    """M2, M17, M30: the end of a subprogram, else of the program."""

    def action(control: Control) -> None:
        if any(call.last is None for call in control.program_counter.calls):
            go_back(control)
        else:
            control.function(f"M{number}", {})
            control.ended = True

    return action


def numbered(control: Control, statement: Statement) -> None:
    """L10 P3: call the subprogram L10, three times."""
    call_named(control, statement, statement.keyword, statement.text, statement.text_column)


def call(control: Control, statement: Statement) -> None:
    """CALL "NAME", CALL NAME BLOCK FIRST TO LAST, CALL BLOCK FIRST TO LAST, PCALL /PATH(..), EXTCALL("NAME")."""
    match = _PATH.match(statement.text)
    written = "" if match is None else match["text"] or match["path"] or ""
    if match is not None and match["name"]:
        written = memory_of(control).calls[-1].texts.get(match["name"].upper(), "")
    end = 0 if match is None else match.end()
    part, name = _PART.fullmatch(statement.text, end), name_of_file(written.upper())
    if part is not None:
        lines = _subprogram(control, statement, name).lines if name else None
        call_part(control, statement, part[1], part[2], lines)
        return
    if not name:
        message = f"{statement.keyword} needs the name of a program, in quotes or in a STRING"
        control.fail("call-values", message, statement, f'write {statement.keyword} "NAME"')
    call_named(control, statement, name, statement.text[end:], statement.text_column + end)


# --- MCALL


def call_after_motion(control: Control) -> None:
    """The modal call, when a block has moved that is no part of what it calls."""
    memory, depth = memory_of(control), control.program_counter.depth
    if memory.modal_depth is not None and depth <= memory.modal_depth:
        memory.modal_depth = None
    if memory.modal_call is not None and memory.modal_depth is None:
        memory.modal_depth = depth
        kept = control.words, control.codes, control.block
        control.run(Block(control.block.line, control.block.part, statement=memory.modal_call))
        control.words, control.codes, control.block = kept
        if control.program_counter.depth == depth:  # a cycle, which is done
            memory.modal_depth = None


def call_modally(control: Control, statement: Statement) -> None:
    """MCALL NAME(...): call it behind every block that moves; MCALL alone ends that."""
    memory, text = memory_of(control), statement.text
    match = re.fullmatch(rf"([ \t]*)(L\d+|{NAME})\b(.*)", text.rstrip(), re.IGNORECASE)
    if not text.strip():
        memory.modal_call = None
        return
    if match is None:
        control.fail(
            "call-values", "MCALL needs a name", statement, "write MCALL CYCLE81(...) or MCALL"
        )
    column = statement.text_column + match.start(2)
    called = Statement(match[2].upper(), match[3], column, column + len(match[2]))
    if called.keyword not in control.program_counter.lexer.keywords:
        _subprogram(control, called, called.keyword)
    memory.modal_call = called


STATEMENTS: dict[str, StatementAction] = {
    "%": heading,
    "PROC": procedure,
    "RET": go_back,
    "CALL": call,
    "EXTCALL": call,
    "PCALL": call,
    "REPEATB": repeat_blocks,
    "MCALL": call_modally,
    "EXTERN": lambda _control, _statement: None,
}
