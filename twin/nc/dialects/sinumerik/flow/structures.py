"""Conditions, loops and jumps of the SINUMERIK."""

import re
from collections.abc import Callable
from typing import NoReturn

from twin.nc.control.codes import StatementAction
from twin.nc.control.constructs import Structure
from twin.nc.control.control import Control
from twin.nc.dialects.sinumerik.flow.programs import lines_around
from twin.nc.dialects.sinumerik.memory import memory_of
from twin.nc.dialects.sinumerik.variables.expressions import NAME
from twin.nc.dialects.sinumerik.variables.variables import with_texts_compared, write_variable
from twin.nc.iso.structured_flow import StructuredFlow
from twin.nc.text.blocks import Location, Statement
from twin.nc.text.expressions.expressions import (
    Expression,
    ExpressionError,
    NumberedVariable,
    Tree,
    Variable,
)

DEEPEST_CONSTRUCT = 16
"""Constructs within each other (manual)."""
_HEAD = re.compile(
    rf"[ \t]*(?:/[0-9]?)?[ \t]*(?:[N:][ \t]*[0-9]+[ \t]*)?(?:{NAME}[ \t]*:[ \t]*)?"
    r"(IF|ELSE|ENDIF|WHILE|ENDWHILE|FOR|ENDFOR|LOOP|ENDLOOP|REPEAT|UNTIL)\b([^;]*)",
    re.IGNORECASE,
)
_ENDS = {"ENDIF": "IF", "ENDWHILE": "WHILE", "ENDFOR": "FOR", "ENDLOOP": "LOOP", "UNTIL": "REPEAT"}
_BRANCHES = {"ELSE": "IF"}
_JUMP = re.compile(r"\b(GOTO[FBC]?|GOTOS)\b", re.IGNORECASE)
_LABEL = re.compile(r"[ \t]*(?:N[ \t]*([0-9]+)|([A-Z_][A-Z_]\w*))[ \t]*", re.IGNORECASE)
_CASE = re.compile(r"[ \t]*(DEFAULT\b|.+?)[ \t]*\b(GOTO[FBC]?)[ \t]+(\w+)", re.IGNORECASE)


def _structure(control: Control) -> Structure:
    memory = memory_of(control)
    if memory.structure is None:
        memory.structure = structure = Structure(_ENDS, _BRANCHES)
        for line, text in enumerate(control.program_counter.lines):
            match = _HEAD.match(text)
            if match is None:
                if text.startswith("%"):
                    structure.close()
                continue
            keyword, rest = match[1].upper(), match[2].strip()
            jumps = keyword == "IF" and _JUMP.search(rest) is not None
            repeats_blocks = keyword == "REPEAT" and rest
            if not jumps and not repeats_blocks:
                structure.add(keyword, line)
    return memory.structure


def value_of(control: Control, statement: Statement) -> float:
    """The value behind a keyword."""
    return _condition(control, statement.text, statement.text_column)


def _condition(control: Control, text: str, column: int) -> float:
    compared = with_texts_compared(control, text, column)
    return control.compute(control.statements.expression(compared, column), column)


_FLOW = StructuredFlow(
    _structure,
    "every IF needs its ENDIF, every loop its end, each on a line of its own",
    value_of,
    DEEPEST_CONSTRUCT,
)
begin_repeat = _FLOW.mark
"""REPEAT alone on its line begins a loop that UNTIL ends."""


# --- conditions and loops


def _if(control: Control, statement: Statement) -> None:
    """IF: run what follows where the condition holds; with a GOTO on the line jump."""
    jump = _JUMP.search(statement.text)
    head = statement.text if jump is None else statement.text[: jump.start()]
    column = statement.text_column
    holds = _condition(control, head, column) != 0.0
    if jump is not None:
        if holds:
            at = column + jump.start()
            go_to(
                control,
                Statement(jump[1].upper(), statement.text[jump.end() :], at, column + jump.end()),
            )
        return
    construct = _FLOW.construct_of(control, statement)
    if not holds:
        if construct.branches:
            control.jump(Location(construct.branches[0].line + 1, 0))
        else:
            control.jump(construct.behind)


def _for_parts(control: Control, statement: Statement) -> tuple[Tree, Expression, Expression, int]:
    """The variable of FOR, its first and its last value."""
    text, column = statement.text, statement.text_column
    target, at = control.statements.operand(text, 0, column)
    rest = text[at:].lstrip()
    to = re.search(r"\bTO\b", text, re.IGNORECASE)
    if (
        not rest.startswith("=")
        or to is None
        or not isinstance(target.tree, Variable | NumberedVariable)
    ):
        message = "FOR counts a variable from one value to another"
        control.fail("structure", message, statement, "write FOR R1=1 TO 10")
    begin = len(text) - len(rest) + 1
    first = control.statements.expression(text[begin : to.start()], column + begin)
    last = control.statements.expression(text[to.end() :], column + to.end())
    return target.tree, first, last, column


def _write(control: Control, tree: Tree, value: float, column: int) -> None:
    assert isinstance(tree, Variable | NumberedVariable)
    try:
        index = None
        if isinstance(tree, NumberedVariable):
            index = control.compute(Expression("", tree.index), column)
        write_variable(control, tree.name, index, value)
    except ExpressionError as error:
        control.report.fail(error.code, str(error), column, len(tree.name), error.hint)


def _for(control: Control, statement: Statement) -> None:
    """FOR R1=1 TO 5: the body runs for each, counting up by 1."""
    construct = _FLOW.construct_of(control, statement)
    tree, first, last, column = _for_parts(control, statement)
    value = control.compute(first, column)
    _write(control, tree, value, column)
    if value > control.compute(last, column):
        control.jump(construct.behind)


def _end_for(control: Control, statement: Statement) -> None:
    construct = _FLOW.construct_of(control, statement)
    begin = control.statements.of_line(construct.begin)
    tree, _, last, column = _for_parts(control, begin)
    value = control.compute(Expression("", tree), column) + 1.0
    _write(control, tree, value, column)
    again = value <= control.compute(last, column)
    control.report.line = control.block.line
    if again:
        control.jump(Location(construct.begin + 1, 0))


# --- jumps


def go_to(control: Control, statement: Statement) -> None:
    """GOTOF, GOTOB, GOTO, GOTOC: to a label ahead, behind, either, or on where there is none."""
    keyword = statement.keyword
    if keyword == "GOTOS":
        control.jump(Location(memory_of(control).main.start, 0))
        return
    label = _LABEL.fullmatch(statement.text)
    if label is None:
        message = f"{keyword} needs a label or a block number"
        hint = f"write {keyword} LABEL, whose name begins with two letters, or {keyword} N100"
        control.fail("jump-target", message, statement, hint)
    place = find_label(control, statement, int(label[1]) if label[1] else label[2].upper())
    if place is None:
        return
    _FLOW.refuse_jump_inside(control, statement, place)
    control.jump(place)


def find_label(control: Control, statement: Statement, label: int | str) -> Location | None:
    """Where a jump leads: the nearest block with the label in its direction; None: GOTOC finds none."""
    lines, here, keyword = lines_around(control), control.block.line - 1, statement.keyword
    places = [
        each for each in control.program_counter.labels().get(label, []) if each.line in lines
    ]
    behind = [each for each in places if each.line <= here]
    ahead = [each for each in places if each.line > here]
    nearest: dict[str, Callable[[], list[Location]]] = {
        "GOTOF": lambda: ahead[:1],
        "GOTOB": lambda: behind[-1:],
    }
    found = nearest.get(keyword, lambda: ahead[:1] or behind[-1:])()
    if not found and keyword != "GOTOC":
        _refuse_label(control, statement, label, elsewhere=bool(places))
    return found[0] if found else None


def _refuse_label(
    control: Control, statement: Statement, label: int | str, *, elsewhere: bool
) -> NoReturn:
    keyword, shown = statement.keyword, f"N{label}" if isinstance(label, int) else label
    hint = "a label ends with a colon: LABEL:"
    if elsewhere:
        where = "behind this block" if keyword == "GOTOF" else "before this block"
        other = "GOTOB" if keyword == "GOTOF" else "GOTOF"
        hint = f"it is not {where}; {other} or GOTO leads there"
    control.fail(
        "unknown-label", f"{keyword} names {shown}, and no block has it there", statement, hint
    )


def _case(control: Control, statement: Statement) -> None:
    """CASE(expression) OF 1 GOTOF A 2 GOTOF B DEFAULT GOTOF C."""
    parts = re.split(r"\bOF\b", statement.text, maxsplit=1, flags=re.IGNORECASE)
    if len(parts) != 2:
        hint = "CASE R1 OF 1 GOTOF A 2 GOTOF B DEFAULT GOTOF C"
        control.fail("structure", "CASE needs its OF", statement, hint)
    column = statement.text_column
    value = control.compute(control.statements.expression(parts[0], column), column)
    at, text = 0, parts[1]
    begin = column + len(parts[0]) + 2
    while text[at:].strip():
        case = _CASE.match(text, at)
        if case is None:
            control.report.fail("structure", "a value and its GOTOF must stand here", begin + at)
        is_default = case[1].upper() == "DEFAULT"
        where = begin + case.start(1)
        if (
            is_default
            or control.compute(control.statements.expression(case[1], where), where) == value
        ):
            jump = Statement(case[2].upper(), case[3], begin + case.start(2), begin + case.start(3))
            go_to(control, jump)
            return
        at = case.end()


STATEMENTS: dict[str, StatementAction] = {
    "IF": _if,
    "ELSE": _FLOW.leave,
    "ENDIF": _FLOW.mark,
    "WHILE": _FLOW.run_while,
    "ENDWHILE": _FLOW.go_back,
    "FOR": _for,
    "ENDFOR": _end_for,
    "LOOP": _FLOW.mark,
    "ENDLOOP": _FLOW.go_back,
    "UNTIL": _FLOW.repeat_until,
    "CASE": _case,
    **dict.fromkeys(("GOTO", "GOTOF", "GOTOB", "GOTOC", "GOTOS"), go_to),
}
