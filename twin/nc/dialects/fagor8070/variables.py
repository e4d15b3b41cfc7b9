"""Parameters, variables and expressions of the Fagor CNC 8070."""

import dataclasses
import math
import operator
import re

from twin.nc.control.control import Control
from twin.nc.dialects.fagor8070.control_variables import is_live, read_live, write_live
from twin.nc.text.blocks import Block, Statement
from twin.nc.text.expressions import arithmetic
from twin.nc.text.expressions.expressions import (
    ARITHMETIC,
    COMPARISON,
    IN_DEGREES,
    Computed,
    Expression,
    ExpressionError,
    ExpressionSyntax,
    FunctionOf,
    NumberedVariable,
    Operator,
    Tree,
    Variable,
)

LOCAL_PARAMETERS = 26
"""P0 to P25 are local (MINLOCP, MAXLOCP); the letters A to Z of #PCALL set them."""
_LOCAL = frozenset(f"P{number}" for number in range(LOCAL_PARAMETERS))


_NAME = r"V\.[A-Z]+\.[A-Z_]\w*(?:\[[ \t]*P?[0-9]+[ \t]*\])?(?:\.[A-Z]\w*)*"
"""A variable of the control; tables have their row in brackets."""

EXPRESSIONS = ExpressionSyntax(
    operators={
        **ARITHMETIC,
        **COMPARISON,
        "**": Operator(7, math.pow),
        "==": Operator(3, operator.eq),
        "!=": Operator(3, operator.ne),
        "&": Operator(2, arithmetic.bits_of_both),
        "^": Operator(1, arithmetic.bits_of_one_alone),
        "|": Operator(0, arithmetic.bits_of_either),
    },
    functions={
        **IN_DEGREES,
        "ARG": FunctionOf(lambda x, y: math.degrees(math.atan2(y, x)), 2),
        "SQR": FunctionOf(lambda a: a * a),
        "LOG": FunctionOf(math.log10),
        "DEXP": FunctionOf(lambda a: math.pow(10.0, a)),
        "INT": FunctionOf(int),
        "FRACT": FunctionOf(arithmetic.fraction),
        "ROUND": FunctionOf(lambda a: math.floor(a + 0.5)),
        "FUP": FunctionOf(math.ceil),
        "INV": FunctionOf(lambda a: ~int(a)),
    },
    constants={},
    variable=rf"P[0-9]+|{_NAME}",
    indexed=("P",),
    existence=("EXIST",),
    brackets="[]",
)
"""Angles are degrees."""

VARIABLE_STATEMENT = rf"P[0-9]+(?=[ \t]*[-+*/]?=(?!=))|P(?=\[)|{_NAME}(?=[ \t]*[-+*/]?=)"
"""What begins an assignment."""

_SET = re.compile(r"[ \t]*([-+*/]?)=")
_SEPARATOR = re.compile(r"[ \t,]*")


def read_variable(control: Control, name: str, index: float | None) -> float:
    """Value of ``P5``, ``P[...]``, ``V.P.name``, ``V.S.name`` or a variable of the control."""
    if name == "P" and index is not None:
        name = f"P{index:g}"
    value = read_live(control, name) if is_live(name) else None
    if value is None:
        value = control.variables.read(name)
    if value is not None:
        return value
    message = f"{name} has no value"
    hint = f"set it before, or in the job: [variables] {name} = 0.0"
    raise ExpressionError("unknown-variable", message, None, hint)


def is_local(name: str) -> bool:
    """Whether a variable belongs to the call, not to the whole program."""
    return name in _LOCAL or (name.startswith("P0") and int(name[1:]) < LOCAL_PARAMETERS)


@dataclasses.dataclass(frozen=True, slots=True)
class StatementAssignment:
    """One assignment of a statement.

    Attributes:
        name: The variable, or ``P`` where its number is computed.
        index: That number, or None.
    """

    name: str
    index: Expression | None
    index_column: int
    value: Expression
    column: int


def assignments(
    control: Control, statement: Statement
) -> tuple[list[StatementAssignment], Block | None]:
    """Read ``P1 = 5``, ``P[P2] += 1``, ``V.P.depth = 3``; several on a line.

    Returns:
        The assignments, and the words of a block that follow them on the line, if any.
    """
    found: list[StatementAssignment] = []
    name, text, at = statement.keyword.strip(), statement.text, 0
    begin = statement.text_column
    while True:
        index, index_at = None, at
        if name == "P":
            index, at = control.statements.operand(text, at, begin)
        match = _SET.match(text, at)
        if match is None:
            control.fail("assignment", "'=' is missing behind the name", statement)
        value, end = control.statements.longest(text, match.end(), begin)
        name = name.replace(" ", "").replace("\t", "").upper()
        value = _joined(name, index, match[1], value)
        found.append(StatementAssignment(name, index, begin + index_at, value, begin + match.end()))
        separator = _SEPARATOR.match(text, end)
        assert separator is not None
        at = separator.end()
        if at == len(text):
            return found, None
        following = control.program_counter.lexer.expressions.variable.match(text, at)
        if following is not None:
            name, at = following[0], following.end()
        elif text[at : at + 1].upper() == "P":
            name, at = "P", at + 1
        elif text[at : at + 1].upper() == "G":
            return found, _rest(control, begin + at, text[at:])
        else:
            message = "only further assignments can follow"
            control.report.fail("assignment", message, begin + at)


def _rest(control: Control, column: int, text: str) -> Block:
    """The block whose words are behind assignments."""
    (block,) = control.statements.blocks(text, column, control.block.line)
    return block._replace(number=control.block.number)


def assign(control: Control, statement: Statement) -> None:
    """Give variables their values, one after the other."""
    every, rest = control.program_counter.parsed(statement, lambda: assignments(control, statement))
    for each in every:
        if is_live(each.name):
            _write_live(control, statement, each)
            continue
        name = each.name
        index = 0.0
        if each.index is not None:
            index = control.compute(each.index, each.index_column)
        value = control.compute(each.value, each.column)
        if each.index is not None:
            if index < 0.0 or index != int(index):
                message = f"there is no parameter {name}[{index:g}]"
                control.fail("parameter-number", message, statement)
            name = f"{name}{int(index)}"
        control.variables.write(name, value)
    if rest is not None:
        control.run(rest)


def _joined(name: str, index: Expression | None, operator: str, value: Expression) -> Expression:
    """What a variable becomes, its old value joined to the new one; without an operator the new one."""
    if not operator:
        return value
    old: Tree = Variable(name) if index is None else NumberedVariable(name, index.tree)
    compute = EXPRESSIONS.operators[operator].compute
    return Expression(value.text, Computed(operator, compute, (old, value.tree)))


def _write_live(control: Control, statement: Statement, assignment: StatementAssignment) -> None:
    """Write a variable of the control."""
    name, value = assignment.name, control.compute(assignment.value, assignment.column)
    try:
        written = write_live(control, name, value)
    except ExpressionError as error:
        control.fail(error.code, str(error), statement, error.hint)
    if not written:
        message = f"{name} belongs to the control, and the twin does not simulate it"
        hint = "programs write V.P and V.S variables and the offsets V.A.ORGT[1].X"
        control.fail("control-variable", message, statement, hint)
