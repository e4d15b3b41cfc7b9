"""The Q parameters of a cycle's definition, on its own line and on those that follow it."""

import re
from collections.abc import Iterator, Mapping

from twin.nc.control.control import Control
from twin.nc.dialects.heidenhain.memory import RAPID, CycleParameters, memory_of
from twin.nc.text.blocks import Location, Statement

_PARAMETER = re.compile(
    r"Q([0-9]{3})[ \t]*=[ \t]*(F?MAX|F?AUTO|PREDEF|[-+]?[ \t]*(?:[.0-9]+|Q[LR]?[0-9]+))?",
    re.IGNORECASE,
)
_LINE = re.compile(r"[ \t]*Q[0-9]{3}[ \t]*=", re.IGNORECASE)
_COMMA = re.compile(r"(?<=[0-9]),(?=[0-9])")


def continued(control: Control, *, while_: re.Pattern[str] | None) -> Iterator[tuple[int, str]]:
    """The lines that go on with the block, without their comments, numbered from 0; they are passed over.

    A line goes on where the one before ends with ``~``; of a block without any ``~`` where it looks as given.
    """
    counter, number = control.program_counter, control.block.line
    lines = counter.lines
    tilde = lines[number - 1].rstrip().endswith("~")
    while_ = None if tilde else while_
    while number < len(lines):
        raw = lines[number]
        code = _COMMA.sub(".", raw.split(";")[0]).rstrip("~ \t")
        goes_on = tilde or (while_ is not None and while_.match(code) is not None)
        if not goes_on:
            break
        tilde = raw.rstrip().endswith("~")
        number += 1
        counter.go(Location(number, 0))
        yield number - 1, code


def take_parameters(
    control: Control, statement: Statement, name: str, known: Mapping[int, str]
) -> CycleParameters:
    """Take the parameters of a definition and give Q their values."""
    line, values = control.block.line, {}
    begin = statement.text_column
    given = [
        (line - 1, begin, statement.text),
        *((n, 0, t) for n, t in continued(control, while_=_LINE)),
    ]
    for number, column, text in given:
        control.report.line = number + 1
        for match in _PARAMETER.finditer(text):
            parameter, at = int(match[1]), column + match.start()
            if parameter not in known or parameter in values:
                said = "occurs twice" if parameter in values else f"is no parameter of {name}"
                hint = ", ".join(f"Q{each}" for each in sorted(known))
                control.report.fail(
                    "cycle-word", f"Q{parameter} {said}", at, 4, f"{name} has {hint}"
                )
            values[parameter] = _value(control, match, text, column)
            control.variables.write(f"Q{parameter}", values[parameter])
    control.report.line = line
    return CycleParameters(name, values, control.modal.unit, line)


def _value(control: Control, match: re.Match[str], text: str, column: int) -> float:
    written = (match[2] or "").upper()
    at = column + match.start()
    if written in ("FMAX", "MAX"):
        return RAPID
    if written in ("FAUTO", "AUTO"):
        feed = memory_of(control).tool_feed
        if feed is None:
            message = "FAUTO needs the F of TOOL CALL, and it had none"
            control.report.fail("no-feed", message, at, len(match[0]), "TOOL CALL 1 Z S3000 F500")
        return feed
    if written in ("", "PREDEF"):
        message = (
            f"Q{match[1]} has no value"
            if not written
            else "PREDEF needs GLOBAL DEF, which the twin does not follow"
        )
        control.report.fail("cycle-word", message, at, len(match[0]), f"write Q{match[1]}=2")
    value, _ = control.statements.operand(text, match.start(2), column)
    return control.compute(value, column + match.start(2))
