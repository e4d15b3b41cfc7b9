"""Subroutines and repeated ranges of the Fagor CNC 8070."""

import re
from collections.abc import Iterator, Mapping

from twin.nc.control.codes import StatementAction
from twin.nc.control.control import Control
from twin.nc.dialects.fagor8070.memory import memory_of
from twin.nc.text.blocks import Location, Statement
from twin.nc.text.expressions.expressions import Expression, ExpressionError
from twin.nc.text.library import Library
from twin.nc.text.source import Source

MARK = "%GLOBAL "
"""Begins the line in front of a global subroutine; a program's own heading has no blank in it."""

_CALL = re.compile(
    r"^[ \t]*/?[ \t]*(?:N[ \t]*[0-9]+[ \t]*|\[\w+\][ \t]*)?(?:L|#P?CALL|#MCALL)[ \t]+([A-Z_]\w*)",
    re.IGNORECASE,
)

_CALL_SOMEWHERE = re.compile(rb"(?:L|CALL)[ \t]+[A-Z_]", re.IGNORECASE)


def _calls(source: Source) -> Iterator[str]:
    if source.lines.any_holds(_CALL_SOMEWHERE):
        for line in source.lines:
            if (match := _CALL.match(line)) is not None:
                yield match[1].upper()


LIBRARY = Library(_calls, MARK, ("", ".nc"))


DEEPEST_CALL = 20
"""Subroutines and repetitions within each other (manual, E1152)."""


_NAME = re.compile(r"[ \t]*([A-Z_]\w*)[ \t]*", re.IGNORECASE)
_TITLE = re.compile(r"[ \t]*[^,;(]*(?:\([^)]*\)[ \t]*)?")
_LABEL = r"[ \t]*(\[?[ \t]*[A-Z_0-9]+[ \t]*\]?)[ \t]*"
_RANGE = re.compile(rf"[ \t]*\[{_LABEL},{_LABEL}(?:,(.*))?\][ \t]*", re.IGNORECASE)
_ARGUMENT = re.compile(r"[ \t]*([A-Z])[ \t]*=?", re.IGNORECASE)
_NUMBERED = re.compile(r"L([0-9]+)")
"""Decision: ``#CALL L100`` calls ``%L 100`` where no subroutine is called L100, as post-processors write."""
_NO_RANGE = "the range or the number of runs is none"
_SUBROUTINE = re.compile(r"[ \t]*%[ \t]*L[ \t]+([A-Z_0-9]\w*)", re.IGNORECASE)


def _repeat(control: Control, statement: Statement) -> None:
    """#RPT[N10,N20,3]: run the blocks from one label to another, 3 times."""
    match, counter = _RANGE.fullmatch(statement.text), control.program_counter
    if match is None:
        control.fail("repeat-range", "the labels are missing", statement, "#RPT[N10,N20,3]")
    first, last = (
        counter.find_label(
            _range_label(match[group]), _span(statement), "#RPT", lines_around(control)
        )
        for group in (1, 2)
    )
    blocks = counter.lexer.blocks(counter.lines[last.line], last.line + 1)
    if len(blocks) != 1 or blocks[0].words or blocks[0].statement is not None:
        message = "the last label must stand alone in its block"
        control.fail("repeat-range", message, statement, "give it a block of its own behind")
    if last < first:
        control.fail("repeat-range", _NO_RANGE, statement)
    if first <= Location(control.block.line - 1, 0) <= last:
        control.fail("repeat-range", "the range must not hold its own #RPT", statement)
    times = 1.0
    if match[3] is not None:
        column = statement.text_column + match.start(3)
        times = control.compute(control.statements.expression(match[3], column), column)
    control.call(first, DEEPEST_CALL, statement, times=times, last=last)


def _range_label(text: str) -> int | str:
    name = text.strip("[] \t").upper()
    return int(name[1:]) if name[:1] == "N" and name[1:].isdigit() else name


def _span(statement: Statement) -> tuple[int, int]:
    return statement.column, len(statement.keyword)


def begin(control: Control) -> None:
    """The main program is the first heading that is no subroutine's."""
    memory, lines = memory_of(control), control.program_counter.lines
    main = None
    for line, text in lines.holding("%"):
        if not text.lstrip().startswith("%"):
            continue
        memory.headings.append(line)
        match = _SUBROUTINE.match(text)
        if text.startswith(MARK):
            first = line + 1
            while first < len(lines) and lines[first].strip()[:1] in ("", "%", ";", "("):
                first += 1
            memory.library[text[len(MARK) :]] = first
        elif match is not None:
            memory.subroutines[match[1].upper()] = line + 1
        elif main is None and not memory.library:
            main = line
    if memory.subroutines and main is not None:
        control.program_counter.go(Location(main, 0))
    memory.main = main


def lines_around(control: Control) -> range:
    """The program or subroutine that is being run; labels are its own."""
    headings, here = memory_of(control).headings, control.block.line - 1
    count = len(control.program_counter.lines)
    begin = max((line for line in headings if line <= here), default=0)
    return range(begin, min((line for line in headings if line > here), default=count))


def heading(control: Control, statement: Statement) -> None:
    """%: the program's name; nowhere else. A global subroutine behind it ends the program."""
    memory, here = memory_of(control), control.block.line - 1
    if here in memory.headings and statement.text.startswith(MARK[1:]):
        control.program_counter.end()
        return
    if here != memory.main:
        message = "a heading can stand only before the program or a local subroutine"
        hint = "end the program by M30 and a subroutine by M17 before the next begins"
        control.fail("heading", message, statement, hint)
    if _TITLE.fullmatch(statement.text) is None:
        message = "nothing but a comment may follow the program's name"
        hint = "the 8070's heading is %NAME; what follows a comma is the CNC 8055's"
        control.fail("heading", message, statement, hint)


def _call(control: Control, statement: Statement) -> None:
    """LL, L, #CALL: run a local or a global subroutine, or either, with the caller's parameters."""
    control.call(Location(_called_line(control, statement), 0), DEEPEST_CALL, statement)


def _called_line(control: Control, statement: Statement) -> int:
    """First line, from 0, of the subroutine that LL, L or #CALL names."""
    name, memory = _name_of(control, statement, alone=True), memory_of(control)
    tables = {"LL": memory.subroutines, "L": memory.library}
    return _line_of(control, statement, name, tables.get(statement.keyword))


def _call_with_parameters(control: Control, statement: Statement) -> None:
    """#PCALL NAME A1 B2: run a local subroutine with parameters of its own."""
    name = _name_of(control, statement)
    values = [
        (parameter, control.compute(value, column))
        for parameter, value, column in _arguments(control, statement)
    ]
    line = _line_of(control, statement, name)
    control.call(Location(line, 0), DEEPEST_CALL, statement, values)


def call_modally(control: Control, statement: Statement) -> None:
    """#MCALL NAME A1: run the subroutine after every block that moves, until #MDOFF."""
    name, values = _name_of(control, statement), dict[str, float]()
    for parameter, expression, column in _arguments(control, statement):
        values[parameter] = control.compute(expression, column)
    memory_of(control).modal_call = (name, values, statement)


def end_modal_call(control: Control, _statement: Statement) -> None:
    """#MDOFF."""
    memory_of(control).modal_call = None


def call_after_motion(control: Control) -> None:
    """The modal subroutine, when a block has moved."""
    memory = memory_of(control)
    if memory.modal_call is None or control.program_counter.is_calling:
        return
    name, values, statement = memory.modal_call
    line = _line_of(control, statement, name)
    control.call(Location(line, 0), DEEPEST_CALL, statement, values.items())


def _name_of(control: Control, statement: Statement, *, alone: bool = False) -> str:
    """The name behind a call; ``alone``: nothing may follow it."""
    match = (_NAME.fullmatch if alone else _NAME.match)(statement.text)
    if match is None:
        message = "the call needs a name" + (" and no more" if alone else "")
        control.fail("call-values", message, statement)
    return match[1].upper()


def _arguments(control: Control, statement: Statement) -> Iterator[tuple[str, Expression, int]]:
    """Parameters that #PCALL or #MCALL sets, their values, and where these are."""
    match = _NAME.match(statement.text)
    at = 0 if match is None else match.end()
    while at < len(statement.text.rstrip()):
        letter = _ARGUMENT.match(statement.text, at)
        column = statement.text_column + at
        if letter is None:
            control.report.fail("call-values", "a letter and its value must stand here", column)
        try:
            expression, at = control.program_counter.lexer.expressions.read(
                statement.text, letter.end()
            )
        except ExpressionError as error:
            control.report.fail(error.code, str(error), column, 1, error.hint)
        yield f"P{ord(letter[1].upper()) - ord('A')}", expression, column


def _line_of(
    control: Control, statement: Statement, name: str, table: Mapping[str, int] | None = None
) -> int:
    memory = memory_of(control)
    if table is None:
        table = {**memory.library, **memory.subroutines}
    line = table.get(name)
    if line is None and (numbered := _NUMBERED.fullmatch(name)) is not None:
        line = table.get(numbered[1])
    if line is None:
        known = f"subroutines here: {', '.join(sorted(table)) or 'none'}"
        if table is memory.subroutines:
            message = f"there is no local subroutine {name}"
            control.fail("unknown-subprogram", message, statement, known)
        message = f"there is no subroutine {name}"
        hint = f"a global one is a file {name} or {name}.nc beside the program; {known}"
        control.fail("unknown-subprogram", message, statement, hint)
    return line


STATEMENTS: dict[str, StatementAction] = {
    "%": heading,
    "#RPT": _repeat,
    "#CALL": _call,
    "LL": _call,
    "L": _call,
    "#PCALL": _call_with_parameters,
    "#MCALL": call_modally,
    "#MDOFF": end_modal_call,
    "#RET": Control.go_back,
}
