"""O-words of LinuxCNC: conditions, loops, subroutines; M98 and M99."""

from collections.abc import Callable
from typing import NoReturn

from twin.nc.control.constructs import Construct
from twin.nc.control.control import Control, integer_of
from twin.nc.dialects.linuxcnc.memory import memory_of
from twin.nc.dialects.linuxcnc.parameters import LOCAL_PARAMETERS
from twin.nc.dialects.linuxcnc.saved_state import restore_at_return
from twin.nc.dialects.linuxcnc.structure import (
    FILE,
    KEYWORDS,
    LOOPS,
    OWord,
    lines_to_read,
    name_of_label,
    o_word,
    scope,
    structure,
)
from twin.nc.text.blocks import Location, Statement
from twin.nc.text.expressions.arithmetic import nearest_whole_away
from twin.nc.text.expressions.expressions import Computed, Expression, Variable

WITH_VALUES = ("CALL", "RETURN", "ENDSUB", "IF", "ELSEIF", "WHILE", "REPEAT")
"""Keywords that values may follow."""
DEEPEST_CALL = 9
"""Subroutines that may call each other (``rs274``)."""


def refuse(
    control: Control, statement: Statement, code: str, message: str, hint: str | None = None
) -> NoReturn:
    """Refuse a line with an O-word."""
    width = len(statement.keyword) + len(statement.text.rstrip())
    control.report.fail(code, message, statement.column, width, hint)


def values_of(control: Control, word: OWord, statement: Statement) -> list[tuple[Expression, int]]:
    """The values behind a keyword, with their columns; each is in square brackets."""
    return control.program_counter.parsed(word, lambda: _read_values(control, word, statement))


def _read_values(
    control: Control, word: OWord, statement: Statement
) -> list[tuple[Expression, int]]:
    found, at, text = list[tuple[Expression, int]](), 0, word.text.rstrip()
    while at < len(text):
        if text[at] in " \t":
            at += 1
            continue
        if text[at] != "[":
            rest = text[at:].strip()
            hint = "leave then out" if rest.lower() == "then" else f"write {word.shown} [{rest}]"
            refuse(control, statement, "o-word", "values stand in square brackets here", hint)
        value, end = control.statements.operand(text, at, word.column)
        found.append((value, word.column + at))
        at = end
    return found


def _condition_of(control: Control, statement: Statement, word: OWord) -> tuple[Expression, int]:
    """The one value behind a keyword, and its column."""
    found = values_of(control, word, statement)
    if len(found) != 1:
        hint = f"write {word.shown} [#1 LT 5]"
        message = f"{word.keyword.lower()} needs one value in square brackets"
        refuse(control, statement, "expression", message, hint)
    return found[0]


def _construct_of(control: Control, statement: Statement, word: OWord) -> Construct:
    """The construct that a line belongs to."""
    construct = structure(control).by_line.get(control.block.line - 1)
    if construct is None or construct.end is None:
        message = f"{word.shown} has no counterpart"
        hint = "every if needs its endif, every loop and every sub its end, with the same label"
        refuse(control, statement, "open-structure", message, hint)
    for line in memory_of(control).garbled:
        if construct.begin < line < construct.end:
            control.report.line = line + 1
            control.program_counter.lexer.blocks(control.program_counter.lines[line], line + 1)
            message, width = "no O-word of the control", len(control.program_counter.lines[line])
            control.report.fail("o-word", message, 0, width, ", ".join(KEYWORDS).lower())
    if construct.keyword == "DO":  # read even where break leads past it
        _read_line(control, construct.end)
    return construct


def _read_line(control: Control, line: int) -> None:
    """Read the values of another line's O-word, from 0, as the control does where it looks for its label."""
    statement, word = _line_of(control, line)
    values_of(control, word, statement)
    control.report.line = control.block.line


def _line_of(control: Control, line: int) -> tuple[Statement, OWord]:
    """The O-word of another line, from 0; errors are that line's from now on."""
    statement = control.statements.of_line(line)
    word = o_word(statement)
    assert word is not None
    return statement, word


def _declare(control: Control, statement: Statement, word: OWord) -> None:
    """A label is given once in its subroutine, as far as the program comes to it."""
    line = control.block.line - 1
    own = scope(control, line)
    same = [
        each
        for each in structure(control).constructs
        if each.name == word.label and scope(control, each.begin) == own
    ]
    if len(same) == 1:
        return
    before = memory_of(control).labels.setdefault(f"{own}{word.label}", line)
    if before != line:
        message = f"{word.name} is the label of line {before + 1} already"
        refuse(control, statement, "ambiguous-label", message, "give each its own label")


def _if(control: Control, statement: Statement, word: OWord) -> None:
    _declare(control, statement, word)
    construct = _construct_of(control, statement, word)
    if control.compute(*_condition_of(control, statement, word)):
        control.jump(Location(control.block.line, 0))
        return
    for branch in construct.branches:
        is_else = branch.keyword == "ELSE"
        if is_else or control.compute(*_condition_of(control, *_line_of(control, branch.line))):
            control.jump(Location(branch.line + 1, 0))
            return
    control.jump(construct.behind)


def _leave(control: Control, statement: Statement, word: OWord) -> None:
    """A condition has held; those of the branches behind are computed on the way to the end, as ``rs274`` does."""
    construct = _construct_of(control, statement, word)
    for branch in construct.branches:
        if branch.line >= control.block.line - 1 and branch.keyword == "ELSEIF":
            control.compute(*_condition_of(control, *_line_of(control, branch.line)))
    control.jump(construct.behind)


def _nothing(control: Control, statement: Statement, word: OWord) -> None:
    _construct_of(control, statement, word)


def _while(control: Control, statement: Statement, word: OWord) -> None:
    construct = _construct_of(control, statement, word)
    if construct.keyword == "DO":
        if control.compute(*_condition_of(control, statement, word)):
            control.jump(Location(construct.begin + 1, 0))
        return
    _declare(control, statement, word)
    if not control.compute(*_condition_of(control, statement, word)):
        control.jump(construct.behind)


def _do(control: Control, statement: Statement, word: OWord) -> None:
    _declare(control, statement, word)
    _construct_of(control, statement, word)


def _again(control: Control, statement: Statement, word: OWord) -> None:
    control.jump(Location(_construct_of(control, statement, word).begin, 0))


def _counter_of(construct: Construct) -> str:
    """The variable that counts the rounds of a REPEAT; no program can name it."""
    return f"#repeat {construct.begin}"


def _repeat(control: Control, statement: Statement, word: OWord) -> None:
    _declare(control, statement, word)
    construct = _construct_of(control, statement, word)
    value, column = _condition_of(control, statement, word)
    rounds = control.compute(
        Expression("", Computed("ROUND", nearest_whole_away, (value.tree,))), column
    )
    control.variables.write(_counter_of(construct), rounds)
    if not rounds > 0.0:
        control.jump(construct.behind)


def _end_repeat(control: Control, statement: Statement, word: OWord) -> None:
    construct = _construct_of(control, statement, word)
    counter = _counter_of(construct)
    left = control.compute(Expression("", Variable(counter)), 0) - 1.0
    control.variables.write(counter, left)
    if left > 0.0:
        control.jump(Location(construct.begin + 1, 0))


def _enclosing(control: Control, statement: Statement, word: OWord) -> Construct:
    """The loop with the label that BREAK or CONTINUE names."""
    for each in reversed(structure(control).around(control.block.line - 1)):
        if each.keyword in LOOPS and each.name == word.label:
            if each.keyword == "REPEAT":
                hint = "count by a while loop that is left"
                leave = word.keyword.lower()
                message = f"the control leaves while and do loops by {leave}, no repeat"
                refuse(control, statement, "open-structure", message, hint)
            return each
    message = f"no loop {word.name} lies around this line"
    refuse(control, statement, "open-structure", message)


def _break(control: Control, statement: Statement, word: OWord) -> None:
    control.jump(_enclosing(control, statement, word).behind)


def _continue(control: Control, statement: Statement, word: OWord) -> None:
    construct = _enclosing(control, statement, word)
    assert construct.end is not None
    control.jump(Location(construct.end, 0))


# --- subroutines


def _subroutine_line(control: Control, name: str, *, here: int) -> int | None:
    """The line, from 0, of a subroutine's definition; None where there is none.

    What is before the line of the call, ``here``, comes before a file.
    """
    structure(control)
    lines = memory_of(control).subroutines.get(name, [])
    files_from = _first_file(control)
    before = [line for line in lines if line < min(here, files_from)]
    files = [line for line in lines if line >= files_from]
    later = [line for line in lines if here <= line < files_from]
    return next(iter((*before[-1:], *files[:1], *later[:1])), None)


def _first_file(control: Control) -> int:
    """The line, from 0, before the first file behind the program."""
    parts = control.report.parts
    return parts[0][0] - 2 if parts else len(control.program_counter.lines)


def _called_line(control: Control, statement: Statement, word: OWord) -> int:
    """First line, from 0, of the subroutine that CALL names."""
    name, here = word.label, control.block.line - 1
    if name[0] in "#[":
        column = statement.text_column + len(statement.text) - len(statement.text.lstrip())
        name = str(integer_of(control.compute(control.statements.expression(name, column), column)))
    line = _subroutine_line(control, name, here=here)
    if line is None:
        known = ", ".join(f"o{each}" for each in memory_of(control).subroutines) or "none"
        message = f"there is no subroutine {name}"
        hint = f"it is in the program as o<{name}> sub, or next to it in {name}.ngc; here: {known}"
        refuse(control, statement, "unknown-subprogram", message, hint)
    if line not in structure(control).by_line:
        message = f"O{name} is a program for M98, and no subroutine"
        refuse(control, statement, "unknown-subprogram", message, f"write M98 P{name}")
    if here <= line < _first_file(control):
        memory_of(control).called.add(name)
    return line


def _call(control: Control, statement: Statement, word: OWord) -> None:
    line = _called_line(control, statement, word)
    values = values_of(control, word, statement)
    if len(values) > LOCAL_PARAMETERS:
        message = f"a call gives {LOCAL_PARAMETERS} values at most"
        refuse(control, statement, "call-values", message)
    given = [(f"#{number}", control.compute(*each)) for number, each in enumerate(values, 1)]
    control.call(Location(line + 1, 0), DEEPEST_CALL, statement, given)


def _sub(control: Control, statement: Statement, word: OWord) -> None:
    """A definition that the program comes to: its own lines are read, and it goes on behind it."""
    _declare(control, statement, word)
    construct = _construct_of(control, statement, word)
    for line in lines_to_read(control, construct):
        _read_line(control, line)
    if control.program_counter.is_calling:
        message = "a subroutine cannot be defined within another"
        hint = "end the one before by its endsub"
        refuse(control, statement, "open-structure", message, hint)
    if word.label in memory_of(control).called:
        message = f"{word.name} was called before this line, which defines it again"
        hint = "end the program by M2 before it"
        refuse(control, statement, "ambiguous-label", message, hint)
    control.jump(construct.behind)


def _return(control: Control, statement: Statement, word: OWord) -> None:
    values = values_of(control, word, statement)
    if len(values) > 1:
        refuse(control, statement, "o-word", "a subroutine gives one value back")
    control.require_caller(statement)
    value = control.compute(*values[0]) if values else 0.0
    memory_of(control).returned = (value, bool(values))
    restore_at_return(control)
    control.go_back(statement)


_WORDS: dict[str, Callable[[Control, Statement, OWord], None]] = {
    "SUB": _sub,
    "ENDSUB": _return,
    "CALL": _call,
    "RETURN": _return,
    "IF": _if,
    "ELSEIF": _leave,
    "ELSE": _leave,
    "ENDIF": _nothing,
    "WHILE": _while,
    "ENDWHILE": _again,
    "DO": _do,
    "REPEAT": _repeat,
    "ENDREPEAT": _end_repeat,
    "BREAK": _break,
    "CONTINUE": _continue,
    "": lambda _control, _statement, _word: None,  # a program for M98: it is run into
}


def run_o_word(control: Control, statement: Statement) -> None:
    """A line that begins with an O-word."""
    word = control.program_counter.parsed(statement, lambda: o_word(statement))
    if word is None or not word.label:
        refuse(control, statement, "o-word", "O needs a label", "write o100 or o<name>")
    run = _WORDS.get(word.keyword)
    if run is None:
        known = ", ".join(KEYWORDS).lower()
        refuse(control, statement, "o-word", f"'{word.keyword.lower()}' follows no O", known)
    if word.label[0] in "#[" and word.keyword != "CALL":
        refuse(control, statement, "o-word", "only call can compute its label")
    if word.keyword not in WITH_VALUES and word.text.strip():
        message = f"nothing may follow {word.shown}"
        hint = "write it on a line of its own"
        if not word.keyword and word.text.startswith("["):
            hint = f"a subroutine is called by {word.shown} call {word.text.rstrip()}"
        refuse(control, statement, "o-word", message, hint)
    run(control, statement, word)


def percent(control: Control, statement: Statement) -> None:
    """%: the first one begins the program, the second ends it."""
    memory = memory_of(control)
    if f"%{statement.text}".startswith(FILE) or memory.percent:
        memory.percent_ended = not f"%{statement.text}".startswith(FILE)
        control.program_counter.end()
        return
    memory.percent = True


# --- M98, M99


def call_program(control: Control) -> None:
    """M98 P L: run the program O and its number, L times, with the caller's parameters."""
    _refuse_companions(control, "NPL", "M98 P100 L2")
    number, times = control.take("P"), control.take("L")
    if number is None:
        control.fail("jump-target", "M98 needs P, the number of the program", hint="write M98 P100")
    count = 1 if times is None else integer_of(control.number(times))
    if count < 0:
        control.fail("repeat-count", "L must count the calls of M98", times)
    if count == 0:
        return
    name = name_of_label(str(integer_of(control.number(number))))
    line = _subroutine_line(control, name, here=control.block.line - 1)
    if line is None or line in structure(control).by_line:
        message = f"there is no program O{name}"
        hint = f"it begins with O{name} alone, here or in {name}.ngc beside the program"
        control.fail("unknown-subprogram", message, number, hint)
    first = Location(line + 1, 0)
    control.call(first, DEEPEST_CALL, number, times=float(count))


def return_from_program(control: Control) -> None:
    """M99: back behind M98; in the main program from its beginning again."""
    _refuse_companions(control, "N", "M99")
    if control.program_counter.is_calling:
        control.go_back()
    else:
        control.program_counter.go(Location(0, 0))
        memory_of(control).percent = False


def _refuse_companions(control: Control, letters: str, alone: str) -> None:
    """A block has only P and L with M98, and nothing with M99: the control passes over other words, or refuses them."""
    words = control.block.words
    call = next(word for word in words if word.address == "M" and word.value in (98.0, 99.0))
    others = (word for word in words if word is not call and word.address not in letters)
    other = next(others, None)
    if other is not None:
        message = f"{other.text} cannot be in a block with {call.text}"
        control.fail("code-words", message, other, f"write {alone} in a line of its own")
