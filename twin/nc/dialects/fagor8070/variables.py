"""Parameters, variables and expressions of the Fagor CNC 8070."""

import math
import re
from collections.abc import Callable
from typing import NoReturn

from twin.nc.blocks import Statement
from twin.nc.control import Control
from twin.nc.dialects.fagor8070.memory import memory_of
from twin.nc.expression_reader import computed
from twin.nc.expressions import (
    ARITHMETIC,
    COMPARISON,
    Expression,
    ExpressionError,
    ExpressionSyntax,
    FunctionOf,
    Operator,
)

LOCAL_PARAMETERS = 26
"""P0 to P25 are local (MINLOCP, MAXLOCP); the letters A to Z of #PCALL set them."""
_LOCAL = frozenset(f"P{number}" for number in range(LOCAL_PARAMETERS))


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
    existence=("EXIST",),
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

_SET = re.compile(r"[ \t]*([-+*/]?)=")
_SEPARATOR = re.compile(r"[ \t,]*")


def refuse(
    control: Control, statement: Statement, code: str, message: str, hint: str | None = None
) -> NoReturn:
    """Refuse a statement; the caret stands under its keyword."""
    control.report.fail(code, message, statement.column, len(statement.keyword), hint)


def read_variable(control: Control, name: str, index: float | None) -> float:
    """Value of ``P5``, ``P[...]``, ``V.P.name``, ``V.S.name`` or a known ``V.G`` variable."""
    memory = memory_of(control)
    if name == "P" and index is not None:
        name = f"P{index:g}"
    if name == "V.G.PORGF":
        return memory.origin[0]
    if name == "V.G.PORGS":
        return memory.origin[1]
    table = variable_table(control, name)
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


def variable_table(control: Control, name: str) -> dict[str, float]:
    """Where a variable is kept: with the call, or for the whole program."""
    memory = memory_of(control)
    local = name in _LOCAL or (name.startswith("P0") and int(name[1:]) < LOCAL_PARAMETERS)
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
            refuse(control, statement, "assignment", "'=' is missing behind the name")
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
        variable_table(control, name)[name] = value
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

    return Expression(
        f"{old:g}{operator}{value:g}", lambda _scope: computed(operator, compute, old, value)
    )


def _old_value(control: Control, statement: Statement, name: str) -> float:
    try:
        return read_variable(control, name, None)
    except ExpressionError as error:
        refuse(control, statement, error.code, str(error), error.hint)


def _index(control: Control, statement: Statement, at: int) -> tuple[int, int]:
    try:
        expression, end = control.flow.lexer.expressions.read(statement.text, at)
    except ExpressionError as error:
        column = statement.text_column + (error.column or 0)
        control.report.fail(error.code, str(error), column, 1, error.hint)
    value = control.compute(expression, statement.text_column + at)
    if value < 0.0 or value != int(value):
        refuse(control, statement, "parameter-number", f"there is no parameter P[{value:g}]")
    return int(value), end
