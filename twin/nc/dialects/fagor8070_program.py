"""Parameters, expressions, structured flow and subroutines of the Fagor CNC 8070."""

import math
import re
from collections.abc import Callable
from typing import NoReturn

from twin.nc.blocks import Statement
from twin.nc.control import Control
from twin.nc.dialects.fagor8070_memory import memory_of
from twin.nc.dialects.fagor8070_structure import Construct, structure_of
from twin.nc.expressions import (
    ARITHMETIC,
    COMPARISON,
    Expression,
    ExpressionError,
    ExpressionSyntax,
    FunctionOf,
    Operator,
)
from twin.nc.flow import Place, Return

DEEPEST_CALL = 20
"""Subroutines and repetitions within each other (manual, E1152)."""

LOCAL_PARAMETERS = 26
"""P0 to P25 are local (MINLOCP, MAXLOCP); the letters A to Z of #PCALL set them."""


def _integers(compute: Callable[[int, int], int]) -> Callable[[float, float], float]:
    return lambda a, b: float(compute(int(a), int(b)))


EXPRESSIONS = ExpressionSyntax(
    operators={
        **ARITHMETIC,
        **COMPARISON,
        "**": Operator(7, math.pow),
        "==": Operator(3, lambda a, b: float(a == b)),
        "!=": Operator(3, lambda a, b: float(a != b)),
        "&": Operator(2, _integers(lambda a, b: a & b)),
        "^": Operator(1, _integers(lambda a, b: a ^ b)),
        "|": Operator(0, _integers(lambda a, b: a | b)),
    },
    functions={
        "SIN": FunctionOf(lambda a: math.sin(math.radians(a))),
        "COS": FunctionOf(lambda a: math.cos(math.radians(a))),
        "TAN": FunctionOf(lambda a: math.tan(math.radians(a))),
        "ASIN": FunctionOf(lambda a: math.degrees(math.asin(a))),
        "ACOS": FunctionOf(lambda a: math.degrees(math.acos(a))),
        "ATAN": FunctionOf(lambda a: math.degrees(math.atan(a))),
        "ARG": FunctionOf(lambda x, y: math.degrees(math.atan2(y, x)), 2),
        "ABS": FunctionOf(math.fabs),
        "SQR": FunctionOf(lambda a: a * a),
        "SQRT": FunctionOf(math.sqrt),
        "LOG": FunctionOf(math.log10),
        "LN": FunctionOf(math.log),
        "EXP": FunctionOf(math.exp),
        "DEXP": FunctionOf(lambda a: math.pow(10.0, a)),
        "INT": FunctionOf(lambda a: float(math.trunc(a))),
        "FRACT": FunctionOf(lambda a: a - math.trunc(a)),
        "ROUND": FunctionOf(lambda a: float(math.floor(a + 0.5))),
        "FUP": FunctionOf(lambda a: float(math.ceil(a))),
        "INV": FunctionOf(lambda a: float(~int(a))),
    },
    constants={},
    variable=r"P[0-9]+|V\.[A-Z]\.[A-Z_][\w.]*",
    indexed=("P",),
    brackets="[]",
)
"""Angles are degrees."""

STATEMENT = (
    r"%|\$(?:GOTO|IF|ELSEIF|ELSE|ENDIF|SWITCH|CASE|DEFAULT|ENDSWITCH|FOR|ENDFOR|WHILE|ENDWHILE"
    r"|DO|ENDDO|BREAK|CONTINUE)\b"
    r"|#(?:RPT|TIME|CALL|PCALL|MCALL|MDOFF|RET|COMMENT[ \t]+BEGIN|COMMENT[ \t]+END)\b"
    r"|LL(?=[ \t]+[A-Z_]\w*)|L(?=[ \t]+[A-Z_])"
    r"|P[0-9]+(?=[ \t]*[-+*/]?=(?!=))|P(?=\[)|V\.[A-Z]\.[A-Z_][\w.]*(?=[ \t]*[-+*/]?=)"
)

_NAME = re.compile(r"[ \t]*([A-Z_]\w*)[ \t]*", re.IGNORECASE)
_SET = re.compile(r"[ \t]*([-+*/]?)=")
_SEPARATOR = re.compile(r"[ \t,]*")
_PLACE = re.compile(r"[ \t]*(?:N[ \t]*([0-9]+)|\[[ \t]*([A-Z_]\w*)[ \t]*\])[ \t]*", re.IGNORECASE)
_RANGE = re.compile(
    r"[ \t]*\[[ \t]*(N?[A-Z_0-9]+)[ \t]*,[ \t]*(N?[A-Z_0-9]+)[ \t]*(?:,(.*))?\][ \t]*",
    re.IGNORECASE,
)
_ARGUMENT = re.compile(r"[ \t]*([A-Z])[ \t]*=?", re.IGNORECASE)
_SUBROUTINE = re.compile(r"[ \t]*%[ \t]*L[ \t]+([A-Z_0-9]\w*)", re.IGNORECASE)


def _refuse(
    control: Control, statement: Statement, code: str, message: str, hint: str | None = None
) -> NoReturn:
    control.report.fail(code, message, statement.column, len(statement.keyword), hint)


# --- parameters and variables


def read_variable(control: Control, name: str, index: float | None) -> float:
    """Value of ``P5``, ``P[...]``, ``V.P.name``, ``V.S.name`` or a known ``V.G`` variable."""
    memory = memory_of(control)
    if name == "P" and index is not None:
        name = f"P{index:g}"
    if name == "V.G.PORGF":
        return memory.origin[0]
    if name == "V.G.PORGS":
        return memory.origin[1]
    table = _table(control, name)
    if name in table:
        return table[name]
    if name in control.settings.variables:
        return control.settings.variables[name]
    raise ExpressionError(
        "unknown-variable",
        f"{name} has no value",
        None,
        f"set it before, or in the job: [variables] {name} = 0.0",
    )


def _table(control: Control, name: str) -> dict[str, float]:
    memory = memory_of(control)
    local = name.startswith("P") and name[1:].isdigit() and int(name[1:]) < LOCAL_PARAMETERS
    return memory.local[-1] if local else memory.common


def assign(control: Control, statement: Statement) -> None:
    """``P1 = 5``, ``P[P2] += 1``, ``V.P.depth = 3``; several on a line."""
    name, text, at = statement.keyword.strip(), statement.text, 0
    while True:
        if name == "P":
            index, at = _index(control, statement, at)
            name = f"P{index}"
        match = _SET.match(text, at)
        if match is None:
            _refuse(control, statement, "assignment", "'=' is missing behind the name")
        try:
            expression, end = control.flow.lexer.expressions.read(text, match.end())
        except ExpressionError as error:
            column = statement.text_column + (error.column or 0)
            control.report.fail(error.code, str(error), column, 1, error.hint)
        value = control.compute(expression, statement.text_column + match.end())
        if match[1]:
            old = _old_value(control, statement, name)
            value = control.compute(
                _combined(old, match[1], value), statement.text_column + match.end()
            )
        _table(control, name)[name] = value
        separator = _SEPARATOR.match(text, end)
        assert separator is not None
        at = separator.end()
        if at == len(text):
            return
        following = control.flow.lexer.expressions.variable_at(text, at)
        if following is None and text[at : at + 1].upper() == "P":
            name, at = "P", at + 1
            continue
        if following is None:
            control.report.fail(
                "assignment", "only further assignments can follow", statement.text_column + at
            )
        name, at = following[0].upper(), following.end()


def _combined(old: float, operator: str, value: float) -> Expression:
    compute = EXPRESSIONS.operators[operator].compute

    def evaluate(_scope: object) -> float:
        try:
            return compute(old, value)
        except ArithmeticError as error:
            raise ExpressionError("undefined-value", f"the value is undefined: {error}") from error

    return Expression(f"{old:g}{operator}{value:g}", evaluate)


def _old_value(control: Control, statement: Statement, name: str) -> float:
    try:
        return read_variable(control, name, None)
    except ExpressionError as error:
        _refuse(control, statement, error.code, str(error), error.hint)


def _index(control: Control, statement: Statement, at: int) -> tuple[int, int]:
    try:
        expression, end = control.flow.lexer.expressions.read(statement.text, at)
    except ExpressionError as error:
        column = statement.text_column + (error.column or 0)
        control.report.fail(error.code, str(error), column, 1, error.hint)
    value = control.compute(expression, statement.text_column + at)
    if value < 0.0 or value != int(value):
        _refuse(control, statement, "parameter-number", f"there is no parameter P[{value:g}]")
    return int(value), end


# --- structured flow


def _construct(control: Control, statement: Statement) -> Construct:
    memory = memory_of(control)
    if memory.structure is None:
        memory.structure = structure_of(control.flow.lines)
    construct = memory.structure.by_line.get(control.block.line - 1)
    if construct is None or construct.end is None:
        _refuse(
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
            _refuse(control, statement, "structure", "only $GOTO can follow a condition")
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
    _table(control, name)[name] = first
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
    _table(control, name)[name] = value
    control.report.line = line
    if (value - last) * step <= 0.0:
        control.flow.go(Place(construct.begin + 1, 0))


def _for_values(control: Control, statement: Statement) -> tuple[str, float, float, float]:
    variable = control.flow.lexer.expressions.variable_at(statement.text.lstrip(), 0)
    name, equals, values = statement.text.partition("=")
    if variable is None or not equals:
        _refuse(control, statement, "structure", "$FOR needs its parameter", "$FOR P1=0,10,1")
    column = statement.text_column + len(name) + 1
    first, last, step = (
        control.compute(each, column) for each in control.expressions(values, column, 3)
    )
    if step == 0.0:
        _refuse(control, statement, "structure", "a step of 0 never ends")
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
    _refuse(control, statement, "missing-break", "the case before has no $BREAK")


def leave_construct(control: Control, statement: Statement) -> None:
    """$BREAK: go on behind the innermost loop or $SWITCH."""
    control.flow.go(_behind(_enclosing(control, statement, ("$IF",))))


def next_round(control: Control, statement: Statement) -> None:
    """$CONTINUE: go to the end of the innermost loop."""
    construct = _enclosing(control, statement, ("$IF", "$SWITCH"))
    assert construct.end is not None
    control.flow.go(Place(construct.end, 0))


def _enclosing(control: Control, statement: Statement, without: tuple[str, ...]) -> Construct:
    memory = memory_of(control)
    if memory.structure is None:
        memory.structure = structure_of(control.flow.lines)
    for construct in reversed(memory.structure.around(control.block.line - 1)):
        if construct.keyword not in without and construct.end is not None:
            return construct
    _refuse(control, statement, "structure", f"{statement.keyword} stands outside a loop")


def go_to(control: Control, statement: Statement) -> None:
    """$GOTO N10 or $GOTO [NAME]."""
    _go_to(control, statement.text, statement.text_column, statement)


def _go_to(control: Control, text: str, column: int, statement: Statement) -> None:
    match = _PLACE.fullmatch(text)
    if match is None:
        _refuse(control, statement, "jump-target", "$GOTO needs N10 or [NAME]")
    place = control.flow.find_label(_label(match), (column, len(text)), "$GOTO")
    memory = memory_of(control)
    if memory.structure is None:
        memory.structure = structure_of(control.flow.lines)
    here = memory.structure.around(control.block.line - 1)
    if any(construct not in here for construct in memory.structure.around(place.line)):
        _refuse(control, statement, "jump-into-structure", "a jump must not lead into a structure")
    control.flow.go(place)


def _label(match: re.Match[str]) -> int | str:
    return int(match[1]) if match[1] else match[2].upper()


def repeat_range(control: Control, statement: Statement) -> None:
    """#RPT[N10,N20,3]: run the blocks from one label to another, 3 times."""
    match = _RANGE.fullmatch(statement.text)
    if match is None:
        _refuse(control, statement, "repeat-range", "the labels are missing", "#RPT[N10,N20,3]")
    first, last = (
        control.flow.find_label(_range_label(match[group]), _span(statement), "#RPT")
        for group in (1, 2)
    )
    column = statement.text_column
    count = (
        1.0
        if match[3] is None
        else control.compute(
            control.expression(match[3], column + match.start(3)), column + match.start(3)
        )
    )
    if last < first or count < 1.0 or count != int(count):
        _refuse(control, statement, "repeat-range", "the range or the number of runs is none")
    if first <= Place(control.block.line - 1, 0) <= last:
        _refuse(control, statement, "repeat-range", "the range must not hold its own #RPT")
    part = Return(control.flow.place, first, None, int(count) - 1, last)
    control.flow.call(part, DEEPEST_CALL, *_span(statement))


def _range_label(text: str) -> int | str:
    name = text.upper()
    return int(name[1:]) if name[:1] == "N" and name[1:].isdigit() else name


def _span(statement: Statement) -> tuple[int, int]:
    return statement.column, len(statement.keyword)


# --- subroutines


def begin(control: Control) -> None:
    """The main program is the first heading that is no local subroutine's."""
    memory = memory_of(control)
    main = None
    for line, text in enumerate(control.flow.lines):
        if not text.lstrip().startswith("%"):
            continue
        match = _SUBROUTINE.match(text)
        if match is not None:
            memory.subroutines[match[1].upper()] = line + 1
        elif main is None:
            main = line
    if memory.subroutines and main is not None:
        control.flow.place = Place(main, 0)
    memory.main = main


def heading(control: Control, statement: Statement) -> None:
    """%: the program's name; nowhere else."""
    if control.block.line - 1 != memory_of(control).main:
        message = "a heading can stand only before the program or a local subroutine"
        _refuse(control, statement, "heading", message, hint="end a subroutine by M17")


def call_local(control: Control, statement: Statement) -> None:
    """LL, #CALL: run a local subroutine with the caller's parameters."""
    match = _NAME.fullmatch(statement.text)
    if match is None:
        _refuse(control, statement, "call-values", "the call needs a name and no more")
    _call(control, statement, match[1].upper(), None)


def call_global(control: Control, statement: Statement) -> None:
    """L: global subroutines lie in files of their own, which the twin does not have.

    Raises:
        ProgramError: Always.
    """
    _refuse(
        control,
        statement,
        "global-subroutine",
        "global subroutines are not part of the program",
        hint="write it as a local one (%L NAME ... M17) and call it by LL",
    )


def call_with_parameters(control: Control, statement: Statement) -> None:
    """#PCALL NAME A1 B2: run a local subroutine with parameters of its own."""
    name, values = _arguments(control, statement)
    _call(control, statement, name, values)


def call_modally(control: Control, statement: Statement) -> None:
    """#MCALL NAME A1: run the subroutine after every block that moves, until #MDOFF."""
    memory = memory_of(control)
    memory.modal_call = (*_arguments(control, statement), statement)


def end_modal_call(control: Control, _statement: Statement) -> None:
    """#MDOFF."""
    memory_of(control).modal_call = None


def call_after_motion(control: Control) -> None:
    """The modal subroutine, when a block has moved."""
    memory = memory_of(control)
    if memory.modal_call is not None and not control.flow.calls:
        name, values, statement = memory.modal_call
        _call(control, statement, name, dict(values))


def _arguments(control: Control, statement: Statement) -> tuple[str, dict[str, float]]:
    match = _NAME.match(statement.text)
    if match is None:
        _refuse(control, statement, "call-values", "the call needs a name")
    values: dict[str, float] = {}
    at = match.end()
    while at < len(statement.text.rstrip()):
        letter = _ARGUMENT.match(statement.text, at)
        column = statement.text_column + at
        if letter is None:
            control.report.fail("call-values", "a letter and its value must stand here", column)
        try:
            expression, at = control.flow.lexer.expressions.read(statement.text, letter.end())
        except ExpressionError as error:
            control.report.fail(error.code, str(error), column, 1, error.hint)
        values[f"P{ord(letter[1].upper()) - ord('A')}"] = control.compute(expression, column)
    return match[1].upper(), values


def _call(
    control: Control, statement: Statement, name: str, values: dict[str, float] | None
) -> None:
    memory = memory_of(control)
    line = memory.subroutines.get(name)
    if line is None:
        known = ", ".join(sorted(memory.subroutines)) or "none"
        message = f"there is no local subroutine {name}"
        _refuse(control, statement, "unknown-subprogram", message, f"subroutines here: {known}")
    leave = None
    if values is not None:
        leave = memory.forget_local
    back = Return(control.flow.place, Place(line, 0), leave)
    control.flow.call(back, DEEPEST_CALL, *_span(statement))
    if values is not None:
        memory.local.append(values)


def return_(control: Control) -> None:
    """M17, M29, #RET: back to the caller."""
    calls = control.flow.calls
    if not any(call.last is None for call in calls):
        control.fail("return-outside", "there is no subroutine to return from")
    while calls[-1].last is not None:
        calls.pop()
    control.flow.end_part()


def return_statement(control: Control, _statement: Statement) -> None:
    """#RET."""
    return_(control)


# --- others


def dwell(control: Control, statement: Statement) -> None:
    """#TIME [s]."""
    column = statement.text_column
    seconds = control.compute(control.expression(statement.text, column), column)
    if seconds < 0.0:
        _refuse(control, statement, "dwell", "a dwell cannot be negative")
    control.dwell(seconds)


def skip_comment(control: Control, statement: Statement) -> None:
    """#COMMENT BEGIN: everything up to #COMMENT END is comment."""
    lines = control.flow.lines
    for line in range(control.block.line, len(lines)):
        if re.match(r"[ \t]*#COMMENT[ \t]+END\b", lines[line], re.IGNORECASE):
            control.flow.go(Place(line + 1, 0))
            return
    _refuse(control, statement, "open-comment", "#COMMENT END is missing")


def stray_comment_end(control: Control, statement: Statement) -> None:
    """#COMMENT END without its beginning.

    Raises:
        ProgramError: Always.
    """
    _refuse(control, statement, "open-comment", "#COMMENT BEGIN is missing")


def warn_of_missing_end(control: Control) -> None:
    """The program's last line is reached without M30 or M02 (decision: a warning)."""
    if control.flow.calls:
        control.fail("return-outside", "the subroutine has no M17, M29 or #RET")
    control.report.warn("no-end", "the program ends without M30", hint="write M30 at its end")


STATEMENTS: dict[str, Callable[[Control, Statement], None]] = {
    "%": heading,
    "$IF": if_,
    "$ELSEIF": else_,
    "$ELSE": else_,
    "$ENDIF": nothing,
    "$WHILE": while_,
    "$ENDWHILE": again,
    "$DO": nothing,
    "$ENDDO": end_do,
    "$FOR": for_,
    "$ENDFOR": end_for,
    "$SWITCH": switch,
    "$CASE": case,
    "$DEFAULT": case,
    "$ENDSWITCH": nothing,
    "$BREAK": leave_construct,
    "$CONTINUE": next_round,
    "$GOTO": go_to,
    "#RPT": repeat_range,
    "#TIME": dwell,
    "#CALL": call_local,
    "LL": call_local,
    "L": call_global,
    "#PCALL": call_with_parameters,
    "#MCALL": call_modally,
    "#MDOFF": end_modal_call,
    "#RET": return_statement,
    "#COMMENT BEGIN": skip_comment,
    "#COMMENT END": stray_comment_end,
}


def other_statement(control: Control, statement: Statement) -> None:
    """An assignment, or a comment's mark written with other blanks."""
    words = " ".join(statement.keyword.split())
    STATEMENTS.get(words, assign)(control, statement)
