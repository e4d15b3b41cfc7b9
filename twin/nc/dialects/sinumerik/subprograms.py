"""Subprograms of the SINUMERIK: L.., by name, with parameters; MCALL, CALL, REPEAT; programs of an archive.

A file may hold several programs, each headed ``%_N_NAME_MPF`` or ``%_N_NAME_SPF``: the first main program runs.
Those that it calls and that are not in it are files of their names beside it.
"""

import re
from collections.abc import Iterator

from twin.nc.control.codes import Action, StatementAction
from twin.nc.control.control import Control
from twin.nc.dialects.sinumerik.frames import put_programmable
from twin.nc.dialects.sinumerik.memory import CallFrame, Formal, Subprogram, memory_of
from twin.nc.dialects.sinumerik.types import VariableType
from twin.nc.dialects.sinumerik.variables import NAME, axis_of_value, write_variable
from twin.nc.text.blocks import Block, Location, Statement
from twin.nc.text.expressions import Expression, ExpressionError, Variable
from twin.nc.text.library import Library
from twin.nc.text.source import Source

DEEPEST_CALL = 16
"""Subprograms that may call each other (manual)."""
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
    rf"[ \t]*(VAR[ \t]+)?(REAL|INT|BOOL|CHAR|AXIS|STRING[ \t]*\[\d+\])[ \t]+({NAME})[ \t]*(?:=[ \t]*([-+.\w]+))?[ \t]*",
    re.IGNORECASE,
)
_TIMES = re.compile(r"(?:^|[ \t])P[ \t]*=?[ \t]*(.+)$", re.IGNORECASE)
_CALL = re.compile(
    rf"^[ \t]*/?[0-9]?[ \t]*(?:N[ \t]*\d+[ \t]*)?(?:MCALL[ \t]+|CALL[ \t]+\"?|EXTCALL[ \t]*\(?[ \t]*\"?)?(L\d+|{NAME})\b",
    re.IGNORECASE,
)
_CONTOUR = re.compile(r"\bCYCLE72[ \t]*\([ \t]*\"(\w+)\"", re.IGNORECASE)
_CALL_SOMEWHERE = re.compile(rb"L[0-9]|[A-Z_]{2}", re.IGNORECASE)
_QUOTED_NAME = re.compile(
    r"[ \t]*\(?[ \t]*\"(?:.*/)?(?:_N_)?(\w+?)(?:_[MS]PF|\.[MS]PF)?\"[ \t]*\)?[ \t]*(.*)",
    re.IGNORECASE,
)
_RANGE = re.compile(
    rf"[ \t]*(N[ \t]*\d+|{NAME})(?:[ \t]+(?!P[ \t]*=)(N[ \t]*\d+|{NAME}))?[ \t]*(.*)", re.IGNORECASE
)


def name_of_file(name: str) -> str:
    """How a program is called whose file has this name."""
    return re.sub(r"^_N_|_[MS]PF$", "", name)


def _calls(source: Source) -> Iterator[str]:
    if source.lines.any_holds(_CALL_SOMEWHERE):
        for line in source.lines:
            for match in (_CALL.match(line), _CONTOUR.search(line)):
                if match is not None:
                    yield match[1].upper()


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
                _formal(control, line, each) for each in (proc[2] or "").split(",") if each.strip()
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
    default = float(match[4]) if match[4] and re.fullmatch(r"[-+]?[0-9.]+", match[4]) else 0.0
    return Formal(match[3].upper(), kind, bool(match[1]), default)


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


# --- calls


def call_named(control: Control, statement: Statement, name: str, text: str, column: int) -> None:
    """Call a subprogram; the text behind its name holds values in brackets and P, how often.

    Raises:
        ProgramError: There is none of that name, or the values do not fit.
    """
    subprogram = _subprogram(control, statement, name)
    values, rest, at = _values(control, text, column, subprogram.formals)
    times = 1.0
    if rest.strip():
        match = _TIMES.fullmatch(rest.rstrip()) or _TIMES.match(f" {rest.strip()}")
        if match is None:
            message = f"only P and how often can follow the call of {name}"
            control.report.fail("call-values", message, at, len(rest))
        times = control.compute(control.statements.expression(match[1], at), at)
    _enter(control, statement, subprogram, values, times)


def _subprogram(control: Control, statement: Statement, name: str) -> Subprogram:
    memory = memory_of(control)
    found = memory.subprograms.get(name)
    if found is None and name[0] == "L" and name[1:].isdigit():
        found = memory.subprograms.get(f"L{int(name[1:])}")
    if found is None:
        known = ", ".join(sorted(memory.subprograms)) or "none"
        message = f"there is no subprogram {name}"
        hint = f"it is a file {name}.SPF beside the program, or follows it behind %_N_{name}_SPF; here: {known}"
        control.fail("unknown-subprogram", message, statement, hint)
    return found


def call_subprogram(control: Control, statement: Statement, name: str) -> None:
    """Call a subprogram without values.

    Raises:
        ProgramError: There is none of that name, or it needs values.
    """
    _enter(control, statement, _subprogram(control, statement, name), [], 1.0)


def call_part(control: Control, statement: Statement, first: str, last: str) -> None:
    """Call the blocks between two labels.

    Raises:
        ProgramError: There are none.
    """
    begin, end = _place(control, statement, first), _place(control, statement, last)
    if end < begin:
        message = f"{statement.keyword} names {last}, which stands before {first}"
        control.fail("repeat-range", message, statement)
    control.call(begin, DEEPEST_CALL, statement, last=end)


Value = tuple[Expression | str | None, int]
"""What a call gives for a parameter, an axis as text, None where it leaves it out, and where that stands."""


def split_values(text: str) -> list[tuple[str, int]]:
    """The texts between the commas outside brackets and quotes, with their places."""
    found, depth, begin, quoted = list[tuple[str, int]](), 0, 0, False
    for at, character in enumerate(text):
        if character == '"':
            quoted = not quoted
        elif quoted:
            continue
        elif character in "([":
            depth += 1
        elif character in ")]":
            depth -= 1
        elif character == "," and depth == 0:
            found.append((text[begin:at], begin))
            begin = at + 1
    return [*found, (text[begin:], begin)]


def bracketed(control: Control, text: str, column: int) -> tuple[str, int, int]:
    """The text within the brackets that begin a text, its column, and the place behind them.

    Raises:
        ProgramError: They are not closed.
    """
    at = len(text) - len(text.lstrip())
    if text[at : at + 1] != "(":
        return "", column + at, at
    depth, quoted, end = 0, False, at
    while depth > 0 or end == at:
        if end == len(text):
            control.report.fail("expression", "')' is missing here", column + len(text.rstrip()))
        character = text[end]
        quoted ^= character == '"'
        depth += 0 if quoted else (character == "(") - (character == ")")
        end += 1
    return text[at + 1 : end - 1], column + at + 1, end


def _values(
    control: Control, text: str, column: int, formals: tuple[Formal, ...]
) -> tuple[list[Value], str, int]:
    inner, at, end = bracketed(control, text, column)
    values = list[Value]()
    for number, (each, begin) in enumerate(split_values(inner) if inner.strip() else ()):
        value: Expression | str | None = None
        if number < len(formals) and formals[number].type is VariableType.AXIS:
            value = axis_of_value(control, each, at + begin)
        elif each.strip():
            value = control.statements.expression(each, at + begin)
        values.append((value, at + begin))
    return values, text[end:], column + end


def _enter(
    control: Control,
    statement: Statement,
    subprogram: Subprogram,
    values: list[Value],
    times: float,
) -> None:
    formals, memory = subprogram.formals, memory_of(control)
    if len(values) > len(formals):
        message = f"the subprogram takes {len(formals)} values, not {len(values)}"
        control.fail("call-values", message, statement, "PROC declares them: PROC NAME(REAL DEPTH)")
    frame, references = CallFrame(depth=control.program_counter.depth + 1), dict[str, str]()
    given = list[tuple[str, float]]()
    for number, formal in enumerate(formals):
        expression, at = values[number] if number < len(values) else (None, statement.column)
        frame.types[formal.name] = formal.type
        if formal.type is VariableType.AXIS:
            frame.texts[formal.name] = expression if isinstance(expression, str) else ""
            continue
        assert not isinstance(expression, str)
        if formal.is_reference:
            if expression is None or not isinstance(expression.tree, Variable):
                message = f"{formal.name} is VAR: the call must give it a variable"
                control.report.fail("call-values", message, at, 1)
            references[formal.name] = expression.tree.name
        value = formal.default if expression is None else control.compute(expression, at)
        given.append((formal.name, formal.type.converted(value)))
    frame.references = references
    if subprogram.restores:
        frame.programmable = (memory.matrix, memory.translation)
    first = Location(subprogram.first, 0)
    control.call(first, DEEPEST_CALL, statement, given, restores=subprogram.restores, times=times)
    memory.calls.append(frame)


def go_back(control: Control, error_at: Statement | None = None) -> None:
    """M17, RET, or the last line of a subprogram: back behind its call, or to its beginning again."""
    control.require_caller(error_at)
    memory = memory_of(control)
    frame = memory.calls[-1]
    results = [(to, control.variables.read(name)) for name, to in frame.references.items()]
    control.go_back(error_at)
    if control.program_counter.depth >= frame.depth:  # it runs again
        return
    memory.calls.pop()
    for name, value in results:
        if value is not None:
            try:
                write_variable(control, name, None, value)
            except ExpressionError as error:
                control.fail(error.code, str(error), error_at, error.hint)
    if frame.programmable is not None and frame.programmable != (memory.matrix, memory.translation):
        put_programmable(control, *frame.programmable)


def end_of_program(number: int) -> Action:
    """M2, M17, M30: the end of a subprogram, else of the program."""

    def action(control: Control) -> None:
        if any(call.last is None for call in control.program_counter.calls):
            go_back(control)
        else:
            control.function(f"M{number}", {})
            control.ended = True

    return action


def numbered(control: Control, statement: Statement) -> None:
    """L10 P3: call the subprogram L10, three times."""
    call_named(control, statement, statement.keyword, statement.text, statement.text_column)


def call(control: Control, statement: Statement) -> None:
    """CALL "NAME", EXTCALL("NAME"), CALL BLOCK FIRST TO LAST."""
    text = statement.text
    if re.match(r"[ \t]*BLOCK\b", text, re.IGNORECASE):
        repeat_blocks(
            control, statement, re.sub(r"(?i)^([ \t]*)BLOCK\b(.*?)\bTO\b", r"\1     \2  ", text)
        )
        return
    match = _QUOTED_NAME.fullmatch(text)
    if match is None:
        message = f"{statement.keyword} needs a name in quotes"
        control.fail("call-values", message, statement, f'write {statement.keyword} "NAME"')
    column = statement.text_column + match.start(2)
    call_named(control, statement, match[1].upper(), match[2], column)


# --- REPEAT, MCALL


def repeat_blocks(control: Control, statement: Statement, text: str | None = None) -> None:
    """REPEAT FIRST LAST P=3, REPEATB LABEL P=3: run blocks again."""
    text = statement.text if text is None else text
    match = _RANGE.fullmatch(text.rstrip())
    if match is None:
        message = f"{statement.keyword} needs the label of what it repeats"
        control.fail("repeat-range", message, statement, f"write {statement.keyword} LABEL P=3")
    times = 1.0
    if match[3]:
        count = _TIMES.match(f" {match[3]}")
        at = statement.text_column + match.start(3)
        if count is None:
            control.report.fail("repeat-range", "only P= and how often can follow", at)
        times = control.compute(control.statements.expression(count[1], at), at)
    first = _place(control, statement, match[1])
    last = _place(control, statement, match[2]) if match[2] else None
    here = Location(control.block.line - 1, 0)
    if last is None:
        last = first if statement.keyword == "REPEATB" else _end_label(control, first, here)
    if last < first or first <= here <= last:
        message = "the range or the number of runs is none, or holds its own repetition"
        control.fail("repeat-range", message, statement)
    control.call(first, DEEPEST_CALL, statement, times=times, last=last)


def _end_label(control: Control, first: Location, here: Location) -> Location:
    """REPEAT LABEL: up to ENDLABEL:, or up to the block before the repetition."""
    ends = control.program_counter.labels().get("ENDLABEL", [])
    lines = lines_around(control)
    found = [each for each in ends if each.line in lines and each > first]
    if found:
        return found[0]
    text = control.program_counter.lines
    last = next(
        (each for each in range(here.line - 1, -1, -1) if text[each].partition(";")[0].strip()), 0
    )
    return Location(last, 0)


def _place(control: Control, statement: Statement, text: str) -> Location:
    bare = re.sub(r"[ \t]", "", text.upper())
    label = int(bare[1:]) if bare[0] == "N" and bare[1:].isdigit() else bare
    places, lines = control.program_counter.labels().get(label, []), lines_around(control)
    places = [each for each in places if each.line in lines]
    before = [each for each in places if each.line < control.block.line - 1]
    if not places:
        message = f"{statement.keyword} names {bare}, and no block has it"
        control.fail("unknown-label", message, statement, "a label ends with a colon: LABEL:")
    return before[-1] if before else places[0]


def call_after_motion(control: Control) -> None:
    """The modal call, when a block has moved that is no part of what it calls."""
    memory, depth = memory_of(control), control.program_counter.depth
    if memory.modal_depth is not None and depth <= memory.modal_depth:
        memory.modal_depth = None
    if memory.modal_call is not None and memory.modal_depth is None:
        memory.modal_depth = depth
        kept = control.words, control.codes, control.block
        control.run(Block(control.block.line, control.block.part, statement=memory.modal_call))
        control.words, control.codes, control.block = kept
        if control.program_counter.depth == depth:  # a cycle, which is done
            memory.modal_depth = None


def call_modally(control: Control, statement: Statement) -> None:
    """MCALL NAME(...): call it behind every block that moves; MCALL alone ends that."""
    memory, text = memory_of(control), statement.text
    match = re.fullmatch(rf"([ \t]*)(L\d+|{NAME})\b(.*)", text.rstrip(), re.IGNORECASE)
    if not text.strip():
        memory.modal_call = None
        return
    if match is None:
        control.fail(
            "call-values", "MCALL needs a name", statement, "write MCALL CYCLE81(...) or MCALL"
        )
    column = statement.text_column + match.start(2)
    memory.modal_call = Statement(match[2].upper(), match[3], column, column + len(match[2]))


STATEMENTS: dict[str, StatementAction] = {
    "%": heading,
    "PROC": procedure,
    "RET": go_back,
    "CALL": call,
    "EXTCALL": call,
    "PCALL": call,
    "REPEATB": repeat_blocks,
    "MCALL": call_modally,
    "EXTERN": lambda _control, _statement: None,
}
