"""Subprograms of CODESYS SoftMotion, and statements that begin with a name."""

import re
from collections.abc import Container, Iterator

from twin.nc.control.control import Control
from twin.nc.dialects.codesys.program import (
    COUNTER,
    SubprogramHeading,
    assign,
    memory_of,
    read_variable,
)
from twin.nc.text.blocks import Location, Statement, Word
from twin.nc.text.library import Library
from twin.nc.text.source import Source

DEEPEST_CALL = 14
"""Subprograms within subprograms (manual, before 4.18)."""

_FORMAL = re.compile(
    r"[ \t]*([A-Z_]\w*)[ \t]*[{(]([^})]*)[})][ \t]*(RESTORE)?[ \t]*", re.IGNORECASE
)
_SUBPROGRAM = re.compile(r"[ \t]*(?:N[ \t]*\d+[ \t]+)?(END_)?SUBPROGRAM\b(.*)", re.IGNORECASE)

_CALL = re.compile(r"(?:^|[ \t])([A-Z_]\w{2,})[ \t]*[{(]", re.IGNORECASE)
_CALL_SOMEWHERE = re.compile(rb"[A-Z_][A-Z_0-9]{2,}[ \t]*[{(]", re.IGNORECASE)


def _calls(source: Source) -> Iterator[str]:
    if source.lines.any_holds(_CALL_SOMEWHERE):
        for line in source.lines:
            if _SUBPROGRAM.match(line) is None:
                yield from (match[1].upper() for match in _CALL.finditer(line))


LIBRARY = Library(_calls, "// ", (".cnc",))
"""Subprograms are called from files of their names with ``.cnc`` (manual)."""


class _Outside:
    """The lines that belong to no subprogram."""

    def __init__(self, control: Control) -> None:
        self._bodies = [each.lines for each in _subprograms(control).values()]

    def __contains__(self, line: object) -> bool:
        return not any(line in lines for lines in self._bodies)


def own_lines(control: Control) -> Container[int]:
    """The lines, from 0, of the subprogram that is being run, or those outside all of them."""
    here = control.block.line - 1
    bodies = (each.lines for each in _subprograms(control).values())
    return next((lines for lines in bodies if here in lines), _Outside(control))


def _subprograms(control: Control) -> dict[str, SubprogramHeading]:
    known = memory_of(control)
    if known.subprograms is None:
        known.subprograms = {}
        lines = control.program_counter.lines
        found = ((line, _SUBPROGRAM.match(text)) for line, text in enumerate(lines))
        matches = [(line, match) for line, match in found if match is not None]
        for line, match in matches:
            heading = None if match[1] else _FORMAL.match(match[2])
            if heading is not None:
                formals = tuple(
                    each.split(":")[0].strip().upper()
                    for each in heading[2].split(",")
                    if each.strip()
                )
                ends = (end for end, each in matches if each[1] and end > line)
                known.subprograms[heading[1].upper()] = SubprogramHeading(
                    range(line + 1, next(ends, len(lines))), formals, heading[3] is not None
                )
    return known.subprograms


def define(control: Control, statement: Statement) -> None:
    """SUBPROGRAM: its blocks run when it is called; here they are passed over."""
    if _FORMAL.fullmatch(statement.text) is None:
        hint = "SUBPROGRAM Name{#a : LREAL} RESTORE"
        control.report.fail("declaration", "the heading cannot be read", statement.column, 10, hint)
    found = control.program_counter.seek(
        lambda block: block.statement is not None and block.statement.keyword == "END_SUBPROGRAM"
    )
    if not found:
        control.report.fail("open-subprogram", "END_SUBPROGRAM is missing", statement.column, 10)
    control.program_counter.next()


def _call(control: Control, statement: Statement) -> None:
    """``Name{values}``: run a subprogram with its own variables."""
    name = statement.keyword.strip()
    subprogram = _subprograms(control).get(name)
    if subprogram is None:
        known = ", ".join(sorted(_subprograms(control))) or "none"
        message = f"there is no subprogram {name}"
        hint = f"one of its own file is {name.lower()}.cnc; subprograms here: {known}"
        control.report.fail("unknown-subprogram", message, statement.column, len(name), hint=hint)
    text = statement.text.strip()
    if text[-1:] not in ("}", ")"):
        control.report.fail("expression", "the bracket is not closed", statement.text_column)
    column = statement.text_column + statement.text.index(text[0]) + 1
    values = control.statements.expressions(text[1:-1], column)
    if len(values) != len(subprogram.formals):
        message = f"{name} takes {len(subprogram.formals)} values, not {len(values)}"
        control.report.fail("call-values", message, statement.column, len(name))
    computed = [control.compute(each, column) for each in values]
    control.call(
        Location(subprogram.lines.start, 0),
        DEEPEST_CALL,
        statement,
        zip(subprogram.formals, computed, strict=True),
        restores=subprogram.restores,
    )


def assign_or_call(control: Control, statement: Statement) -> None:
    """A statement that begins with a name."""
    if statement.keyword.startswith("#"):
        assign(control, statement)
    else:
        _call(control, statement)


def destination(control: Control, target: Word) -> Location:
    """The block with the number of a word L, among those that may be jumped to."""
    span = (target.column, target.width)
    return control.program_counter.find_label(
        int(control.number(target)), span, "L", own_lines(control)
    )


def conditional_jump(control: Control) -> None:
    """G20: go on at block L when K (or the internal variable) is not 0.

    A label L?4 is looked for forwards as L!4; where it is missing, the blocks behind the jump are
    not run (manual).
    """
    number, label, condition = control.take("L"), control.take("L?"), control.take("K")
    target = number or label
    if target is None:
        control.fail("jump-target", "G20 needs L: the block to jump to", hint="write G20 L10 K1")
    value = control.number(target)
    if value != int(value) or value < 0.0:
        control.fail("jump-target", f"{target.text} is no block number", target)
    if number is None:
        _seek_label(control, target, condition)
    elif _holds(control, condition):
        control.jump(destination(control, number))


def _holds(control: Control, condition: Word | None) -> bool:
    """Whether K, or without it the internal variable, is not 0."""
    if condition is None:
        return read_variable(control, COUNTER, None) != 0.0
    return control.number(condition) != 0.0


def _seek_label(control: Control, target: Word, condition: Word | None) -> None:
    """Go on at the next block with this label, or behind the program, if a condition holds."""
    value, here = control.number(target), own_lines(control)
    if not _holds(control, condition):
        return
    if not control.program_counter.seek(
        lambda block: (
            block.line - 1 in here
            and any(word.address == "L!" and word.value == value for word in block.words)
        )
    ):
        control.warn("label-not-found", f"no L!{value:g} follows: the program ends here", target)
        control.program_counter.end()
