"""Program flow: BEGIN PGM, END PGM, labels, subprograms, repeats, jumps, other programs."""

import re
from collections.abc import Iterator

from twin.nc.control.control import Control
from twin.nc.control.program_counter import FoundInText
from twin.nc.dialects.heidenhain.memory import memory_of
from twin.nc.dialects.heidenhain.syntax import KEYWORDS
from twin.nc.dialects.heidenhain.values import refuse_rest, text_of, value_at
from twin.nc.text.blocks import Location, Statement
from twin.nc.text.library import Library
from twin.nc.text.source import Source

DEEPEST_CALL = 19
"""Subprograms, and programs, that may call each other (manual)."""
MOST_REPEATS = 65_534
"""REP of a part of a program (manual)."""

_NAME = r"(?:\"[^\"]*\"|QS[0-9]+|[0-9]+)"
_LABEL = re.compile(rf"[ \t/]*(?:[0-9]+[ \t]+)?LBL[ \t]*({_NAME})", re.IGNORECASE)
_LABEL_SOMEWHERE = re.compile(rb"\bLBL", re.IGNORECASE)
_CALL = re.compile(
    rf"[ \t]*({_NAME})(?:[ \t]*REP[ \t]*(Q[LR]?[0-9]+|[0-9]+)(?:[ \t]*/[ \t]*[0-9]+)?)?",
    re.IGNORECASE,
)
_HEADING = re.compile(r"[ \t]*(.*?)[ \t]*\b(MM|INCH)[ \t]*", re.IGNORECASE)
_CONDITION = re.compile(
    rf"(?:[ \t]*(?P<word>IF)\b)?[ \t]*(?P<left>[-+]?[ \t]*(?:Q[LR]?[0-9]+|[.0-9]+)|QS[0-9]+)[ \t]+"
    rf"(?:(?P<how>EQU|NE|GT|LT)[ \t]*(?P<right>[-+]?[ \t]*(?:Q[LR]?[0-9]+|[.0-9]+))"
    rf"|IS[ \t]+(?P<defined>DEFINED|UNDEFINED))[ \t]+GOTO[ \t]+LBL[ \t]*(?P<label>{_NAME})[ \t]*",
    re.IGNORECASE,
)
_COMPARED = {
    "EQU": lambda a, b: a == b,
    "NE": lambda a, b: a != b,
    "GT": lambda a, b: a > b,
    "LT": lambda a, b: a < b,
}
_BEGINS = re.compile(r"[ \t]*[0-9]*[ \t]*BEGIN[ \t]+PGM\b", re.IGNORECASE)
_BLOCK = re.compile(rf"[ \t]*/?[ \t]*[0-9]*[ \t]*(?:{KEYWORDS})", re.IGNORECASE)
_LONGEST_TEXT = 200
"""So many lines of text may come before BEGIN PGM."""
FILE = "; CALL PGM "
"""Begins the line before a program that another file holds."""
_CALLED = re.compile(r"\bCALL[ \t]+PGM[ \t]+(\"[^\"]*\"|[^ \t;~]+)", re.IGNORECASE)
_CALLED_SOMEWHERE = re.compile(rb"\bCALL[ \t]+PGM", re.IGNORECASE)


def program_name(written: str) -> str:
    """The name of a program without its folder and its suffix, in upper case."""
    name = re.split(r"[\\/:]", written.strip('"'))[-1].upper()
    return name.removesuffix(".H")


def _calls(source: Source) -> Iterator[str]:
    if source.lines.any_holds(_CALLED_SOMEWHERE):
        for line in source.lines:
            code = line.split(";")[0]
            yield from (program_name(match[1]) for match in _CALLED.finditer(code))


LIBRARY = Library(_calls, FILE, (".h",))


# --- a program and its end


def pass_text_before_program(control: Control) -> None:
    """Begin at BEGIN PGM where lines that are no blocks come before it, such as a set-up sheet."""
    lines = control.program_counter.lines
    head = [lines[at] for at in range(min(len(lines), _LONGEST_TEXT))]
    first = next((at for at, line in enumerate(head) if _BEGINS.match(line)), 0)
    text = [line for line in head[:first] if line.strip() and not line.lstrip().startswith(";")]
    if not text or any(map(_BLOCK.match, text)):
        return
    control.program_counter.go(Location(first, 0))
    control.report.line = 1
    message = (
        f"the program begins by BEGIN PGM in line {first + 1}: what is before it is passed over"
    )
    control.report.warn_once("before-program", message)


def begin_program(control: Control, statement: Statement) -> None:
    """BEGIN PGM name MM: the unit of its lengths."""
    match = _HEADING.fullmatch(statement.text)
    if match is None:
        hint = "write BEGIN PGM PART MM"
        control.fail(
            "unreadable-statement", "BEGIN PGM needs a name and MM or INCH", statement, hint
        )
    unit = 1.0 if match[2].upper() == "MM" else 25.4
    if control.motion.last is not None and unit != control.modal.unit:
        message = "the unit of a program that is called differs from that of the one that calls it"
        control.fail("unreadable-statement", message, statement)
    control.modal.unit = unit


def end_program(control: Control, statement: Statement) -> None:
    """END PGM: back to the program that has called this one, else the end."""
    control.path.flush()
    if control.path.leads is not None:
        control.fail("contour-lead", "the program ends behind APPR, without a contour", statement)
    if _first_line(control, control.block.line) > 1:
        control.go_back(statement)
    elif control.program_counter.is_calling:
        message = "the program ends within a subprogram, which has no LBL 0"
        control.fail("program-end", message, statement, "end it by LBL 0")
    else:
        control.ended = True


def warn_of_missing_end(control: Control) -> None:
    """The last line has been passed."""
    if control.program_counter.is_calling:
        message = "the file ends within a subprogram, which has no LBL 0"
        control.report.fail("program-end", message, hint="end it by LBL 0")
    control.report.warn("no-end", "the program has no END PGM, M2 or M30 at its end")


def refuse_end_of_called(control: Control) -> None:
    """M2 or M30."""
    if _first_line(control, control.block.line) > 1:
        message = "a program that another one calls holds neither M2 nor M30"
        control.fail("program-end", message, hint="END PGM ends it")


def stop(control: Control, statement: Statement) -> None:
    """STOP: the operator starts the program again."""
    rest = statement.text.strip()
    for block in control.statements.blocks(
        statement.text, statement.text_column, control.block.line
    ):
        control.run(block)
        rest = ""
    if rest:
        refuse_rest(control, statement.text_column, rest)
    control.function("M0", {})


def _first_line(control: Control, line: int) -> int:
    """First line of the file that a line is in, both from 1."""
    firsts = (first for first, _ in control.report.parts if first <= line)
    return max(firsts, default=1)


# --- labels


def label(control: Control, statement: Statement) -> None:
    """LBL 0 ends a subprogram; others are places."""
    text = statement.text.strip()
    if re.fullmatch(_NAME, text, re.IGNORECASE) is None:
        control.fail("label", "LBL needs a number or a name", statement, 'LBL 1 or LBL "EDGE"')
    if text == "0" and control.program_counter.is_calling:
        control.go_back(statement)


def _line_of(control: Control, name: str, column: int) -> int:
    """Line of a label, from 0, in the file that runs."""
    memory, lines = memory_of(control), control.program_counter.lines
    if memory.labels is None:
        memory.labels = found = FoundInText[tuple[int, str], int]()
        numbered = enumerate(lines) if lines.any_holds(_LABEL_SOMEWHERE) else ()
        for line, text in numbered:
            if (match := _LABEL.match(text)) is not None and match[1] != "0":
                key = _first_line(control, line + 1), match[1].strip('"').upper()
                found[key] = -1 if key in found else line
    first = _first_line(control, control.block.line)
    wanted = str(int(name)) if name.isdigit() else text_of(control, name).upper()
    line = memory.labels.get((first, wanted))
    if line is None:
        known = ", ".join(each for file, each in memory.labels if file == first)
        message = f"there is no LBL {name}"
        hint = f"labels here: {known or 'none'}"
        control.report.fail("unknown-label", message, column, len(name), hint)
    if line < 0:
        control.report.fail("ambiguous-label", f"LBL {name} occurs twice", column, len(name))
    return line


def call_label(control: Control, statement: Statement) -> None:
    """CALL LBL 1: a subprogram; with REP the part from the label to here runs so often again."""
    match = _CALL.match(statement.text)
    if match is None or statement.text[match.end() :].strip():
        control.fail("label", "CALL LBL needs a label", statement, "CALL LBL 1 REP 3")
    column = statement.text_column + match.start(1)
    if match[1] == "0":
        message = "LBL 0 ends subprograms and cannot be called"
        control.report.fail("label", message, column, 1)
    line, here = _line_of(control, match[1], column), control.block.line
    if match[2] is None:
        control.call(Location(line + 1, 0), DEEPEST_CALL, statement)
        return
    repeats = memory_of(control).repeats
    if here not in repeats:
        times, _ = value_at(control, statement, match.start(2))
        if times != int(times) or not 0 <= times <= MOST_REPEATS:
            message = f"REP counts repeats, 0 to {MOST_REPEATS}, not {times:g}"
            control.fail("repeat-count", message, statement)
        repeats[here] = int(times)
    if repeats[here] > 0:
        repeats[here] -= 1
        control.jump(Location(line, 0))
    else:
        del repeats[here]


def call_program(control: Control, statement: Statement) -> None:
    """CALL PGM: the program of another file."""
    written = statement.text.strip()
    name = program_name(written)
    if not name:
        message = "CALL PGM needs the name of a program"
        control.fail("unknown-subprogram", message, statement, "CALL PGM PART2")
    for first, _ in control.report.parts:
        if control.program_counter.lines[first - 2] == f"{FILE}{name}":
            control.call(Location(first - 1, 0), DEEPEST_CALL, statement, ())
            return
    message = f"there is no program {name or written}"
    hint = f"put {name.lower()}.h into the folder of this program"
    control.fail("unknown-subprogram", message, statement, hint)


# --- jumps


def jump_if(control: Control, statement: Statement) -> None:
    """FN 9 to FN 12, and IF: go on at a label where a condition holds."""
    match = _CONDITION.fullmatch(statement.text)
    if match is None or (match["word"] is None) is (statement.keyword != "IF"):
        hint = "FN 9: IF +Q1 EQU +Q2 GOTO LBL 1"
        control.fail(
            "unreadable-statement", "the condition of the jump cannot be read", statement, hint
        )
    how = statement.keyword
    if how != "IF" and match["how"] is not None:
        wanted = ("EQU", "NE", "GT", "LT")[int(re.sub("[^0-9]", "", how)) - 9]
        if match["how"].upper() != wanted:
            control.fail("unreadable-statement", f"{how} compares by {wanted}", statement)
    if _holds(control, statement, match):
        column = statement.text_column + match.start("label")
        control.jump(Location(_line_of(control, match["label"], column), 0))


def _holds(control: Control, statement: Statement, match: re.Match[str]) -> bool:
    if match["defined"] is not None:
        name = match["left"].strip().lstrip("+").upper()
        known = name in memory_of(control).texts or control.variables.read(name) is not None
        return known is (match["defined"].upper() == "DEFINED")
    left, _ = value_at(control, statement, match.start("left"))
    right, _ = value_at(control, statement, match.start("right"))
    return _COMPARED[match["how"].upper()](left, right)
