"""Subprograms of CODESYS SoftMotion, and statements that begin with a name."""

import re

from twin.nc.blocks import Statement
from twin.nc.control import Control
from twin.nc.dialects.codesys.program import Subprogram, assign, variables
from twin.nc.flow import Place, Return

DEEPEST_CALL = 14
"""Subprograms within subprograms (manual, before 4.18)."""

_FORMAL = re.compile(
    r"[ \t]*([A-Z_]\w*)[ \t]*[{(]([^})]*)[})][ \t]*(RESTORE)?[ \t]*", re.IGNORECASE
)
_SUBPROGRAM = re.compile(r"[ \t]*(?:N[ \t]*\d+[ \t]+)?(END_)?SUBPROGRAM\b(.*)", re.IGNORECASE)


def _subprograms(control: Control) -> dict[str, Subprogram]:
    known = variables(control)
    if known.subprograms is None:
        known.subprograms = {}
        for line, text in enumerate(control.flow.lines):
            match = _SUBPROGRAM.match(text)
            heading = _FORMAL.match(match[2]) if match and not match[1] else None
            if heading is not None:
                formals = tuple(
                    each.split(":")[0].strip().upper()
                    for each in heading[2].split(",")
                    if each.strip()
                )
                known.subprograms[heading[1].upper()] = Subprogram(
                    Place(line + 1, 0), formals, heading[3] is not None
                )
    return known.subprograms


def define(control: Control, statement: Statement) -> None:
    """SUBPROGRAM: its blocks run when it is called; here they are passed over."""
    if _FORMAL.fullmatch(statement.text) is None:
        hint = "SUBPROGRAM Name{#a : LREAL} RESTORE"
        control.report.fail("declaration", "the heading cannot be read", statement.column, 10, hint)
    found = control.flow.seek(
        lambda block: block.statement is not None and block.statement.keyword == "END_SUBPROGRAM"
    )
    if not found:
        control.report.fail("open-subprogram", "END_SUBPROGRAM is missing", statement.column, 10)
    control.flow.next()


def call(control: Control, statement: Statement) -> None:
    """``Name{values}``: run a subprogram with its own variables."""
    name = statement.keyword.strip()
    subprogram = _subprograms(control).get(name)
    if subprogram is None:
        known = ", ".join(sorted(_subprograms(control))) or "none"
        control.report.fail(
            "unknown-subprogram",
            f"there is no subprogram {name}",
            statement.column,
            len(name),
            hint=f"subprograms here: {known}",
        )
    text = statement.text.strip()
    if text[-1:] not in ("}", ")"):
        control.report.fail("expression", "the bracket is not closed", statement.text_column)
    column = statement.text_column + statement.text.index(text[0]) + 1
    values = [control.compute(each, column) for each in control.expressions(text[1:-1], column)]
    if len(values) != len(subprogram.formals):
        control.report.fail(
            "call-values",
            f"{name} takes {len(subprogram.formals)} values, not {len(values)}",
            statement.column,
            len(name),
        )
    known = variables(control)
    before = control.saved_modal() if subprogram.restores else None

    def leave() -> None:
        known.local.pop()
        if before is not None:
            control.restore_modal(before)

    back = Return(control.flow.place, subprogram.place, leave)
    control.flow.call(back, DEEPEST_CALL, statement.column, len(name))
    known.local.append(dict(zip(subprogram.formals, values, strict=True)))


def assign_or_call(control: Control, statement: Statement) -> None:
    """A statement that begins with a name."""
    if statement.keyword.startswith("#"):
        assign(control, statement)
    else:
        call(control, statement)


def leave_subprogram(control: Control, statement: Statement) -> None:
    """RETURN or END_SUBPROGRAM."""
    if not control.flow.calls:
        message = f"{statement.keyword} stands outside a subprogram"
        control.report.fail("return-outside", message, statement.column, len(statement.keyword))
    control.flow.end_part()
