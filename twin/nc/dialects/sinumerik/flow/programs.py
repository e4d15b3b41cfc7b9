"""The programs of a text: an archive's headings, PROC with its parameters, and files beside the program.

A file may hold several programs, each headed ``%_N_NAME_MPF`` or ``%_N_NAME_SPF``: the first main program runs.
Those that it calls and that are not in it are files of their names beside it.
"""

import re
from collections.abc import Iterator

from twin.nc.control.control import Control
from twin.nc.dialects.sinumerik.memory import Formal, Subprogram, VariableType, memory_of
from twin.nc.dialects.sinumerik.variables.expressions import NAME
from twin.nc.text.blocks import Location, Statement
from twin.nc.text.library import Library
from twin.nc.text.source import Source

MARK = "%_N_"
"""Begins the heading of a program, and the line in front of a file that is called."""

_HEADING = re.compile(
    r"%[ \t]*(?:_N_)?([A-Z0-9_]\w*?)(?:_(MPF|SPF|INI|TOA|GUD|DEF))?[ \t]*(?:;.*|\(.*)?",
    re.IGNORECASE,
)
_PROC = re.compile(
    rf"[ \t]*(?:N[ \t]*\d+[ \t]*)?PROC[ \t]+({NAME}|L\d+)[ \t]*(?:\(([^)]*)\))?([^;]*)",
    re.IGNORECASE,
)
_FORMAL = re.compile(
    rf"[ \t]*(VAR[ \t]+)?(REAL|INT|BOOL|CHAR|AXIS|STRING[ \t]*\[\d+\])[ \t]+({NAME})[ \t]*(\[[^\]]*\])?[ \t]*(?:=[ \t]*([-+.\w]+))?[ \t]*",
    re.IGNORECASE,
)
_PARAMETER = re.compile(r"(?:\[[^\]]*\]|[^,\[])+")
_CALL = re.compile(
    r"^[ \t]*/?[0-9]?[ \t]*(?:N[ \t]*\d+[ \t]*)?"
    rf"(?:(?:MCALL|P?CALL|EXTCALL)\b[ \t]*\(?[ \t]*\"?(?:[^\s\"(]*/)?(?:_N_)?)?(L\d+|{NAME})\b",
    re.IGNORECASE,
)
_CONTOUR = re.compile(r"\bCYCLE72[ \t]*\([ \t]*\"(\w+)\"", re.IGNORECASE)
_CALL_SOMEWHERE = re.compile(rb"L[0-9]|[A-Z_]{2}", re.IGNORECASE)


def name_of_file(name: str) -> str:
    """How a program is called whose file, or whose text in quotes, has this name."""
    return re.sub(r"^.*/|_N_|[._][MS]PF$", "", name)


def _calls(source: Source) -> Iterator[str]:
    if source.lines.any_holds(_CALL_SOMEWHERE):
        for line in source.lines:
            for match in (_CALL.match(line), _CONTOUR.search(line)):
                if match is not None:
                    yield name_of_file(match[1].upper())


SUFFIXES = (".spf", ".mpf", ".arc")
LIBRARY = Library(_calls, MARK, SUFFIXES[:2], name_of_file)


# --- the programs of a text


def begin(control: Control) -> None:
    """Find the programs of the text; the first that is no subprogram runs."""
    memory, lines = memory_of(control), control.program_counter.lines
    heads = [
        (line, match)
        for line, text in lines.holding("%")
        if (match := _HEADING.fullmatch(text.rstrip())) is not None
    ]
    ends = [*(line for line, _ in heads[1:]), len(lines)][: len(heads)]
    programs = [range(line, end) for (line, _), end in zip(heads, ends, strict=True)]
    mains = [
        each
        for each, (_, match) in zip(programs, heads, strict=True)
        if (match[2] or "").upper() != "SPF"
    ]
    memory.main = (mains or programs or [range(len(lines))])[0]
    if heads and _holds_blocks(control, range(heads[0][0])):
        memory.main = range(heads[0][0])
    for each, (line, match) in zip(programs, heads, strict=True):
        if each != memory.main and _holds_blocks(control, range(line + 1, each.stop)):
            found = subprogram_of(control, range(line + 1, each.stop))
            memory.subprograms.setdefault(match[1].upper(), found)
    control.program_counter.go(Location(memory.main.start, 0))


def _holds_blocks(control: Control, lines: range) -> bool:
    text = control.program_counter.lines
    return any(text[line].partition(";")[0].strip() for line in lines)


def subprogram_of(control: Control, lines: range) -> Subprogram:
    """A subprogram with what its PROC says, if it has one."""
    text = control.program_counter.lines
    for line in lines:
        bare = text[line].partition(";")[0].strip()
        if bare:
            proc = _PROC.fullmatch(bare)
            if proc is None:
                return Subprogram(lines, line)
            formals = tuple(
                _formal(control, line, each) for each in _PARAMETER.findall(proc[2] or "")
            )
            return Subprogram(lines, line + 1, formals, "SAVE" in proc[3].upper().split())
    return Subprogram(lines, lines.start)


def _formal(control: Control, line: int, text: str) -> Formal:
    match = _FORMAL.fullmatch(text)
    if match is None:
        control.report.line = line + 1
        column = control.program_counter.lines[line].find(text)
        hint = "PROC NAME(REAL DEPTH, VAR INT COUNT)"
        control.report.fail(
            "definition", "a parameter needs its type and its name", column, len(text), hint
        )
    kind = VariableType(re.split(r"[ \t\[]", match[2].upper())[0])
    default = float(match[5]) if match[5] and re.fullmatch(r"[-+]?[0-9.]+", match[5]) else 0.0
    return Formal(match[3].upper(), kind, bool(match[1]), bool(match[4]), default)


def lines_around(control: Control) -> range:
    """The program or subprogram that is being run; labels are its own."""
    here, memory = control.block.line - 1, memory_of(control)
    for each in memory.subprograms.values():
        if here in each.lines:
            return each.lines
    return memory.main


def heading(control: Control, statement: Statement) -> None:
    """%_N_NAME_MPF: the program's name. Another program behind it ends it."""
    if control.block.line - 1 == memory_of(control).main.start or not statement.text.strip():
        return  # a lone % marks the tape
    if control.program_counter.is_calling:
        message = "the subprogram ends without M17 or RET"
        control.fail("return-outside", message, statement, "write M17 or RET at its end")
    control.program_counter.end()


def procedure(control: Control, statement: Statement) -> None:
    """PROC of a main program: it takes no parameters that somebody could give."""
    here = control.block.line - 1
    own = subprogram_of(control, range(here, here + 1))
    if own.formals:
        message = "the program needs parameters, and nobody calls it"
        control.fail("call-values", message, statement, "run the program that calls it")
