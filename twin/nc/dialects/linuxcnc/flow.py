"""O-words of LinuxCNC: conditions, loops, subroutines; M98 and M99."""

from typing import NoReturn

from twin.nc.control.constructs import Construct
from twin.nc.control.control import Control
from twin.nc.control.program_counter import CallFrame
from twin.nc.control.state import integer_of
from twin.nc.dialects.linuxcnc.memory import memory_of
from twin.nc.dialects.linuxcnc.parameters import LOCAL_PARAMETERS
from twin.nc.dialects.linuxcnc.saved_state import restore_at_return
from twin.nc.dialects.linuxcnc.structure import (
    FILE,
    KEYWORDS,
    LOOPS,
    OWord,
    name_of_label,
    o_word,
    scope,
    structure,
)
from twin.nc.text.blocks import Location, Statement
from twin.nc.text.expressions import Expression, ExpressionError

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
    """The values behind a keyword, with their columns; each stands in square brackets."""
    reader, found, at = control.program_counter.lexer.expressions, [], 0
    text = word.text.rstrip()
    while at < len(text):
        if text[at] in " \t":
            at += 1
            continue
        if text[at] != "[":
            refuse(control, statement, "o-word", "values stand in square brackets here")
        try:
            value, end = reader.read_operand(text, at)
        except ExpressionError as error:
            column = word.column + (at if error.column is None else error.column)
            control.report.fail(error.code, str(error), column, 1, error.hint)
        found.append((value, word.column + at))
        at = end
    return found


def condition_of(control: Control, word: OWord, statement: Statement) -> tuple[Expression, int]:
    """The one value behind IF, ELSEIF, WHILE or REPEAT.

    Raises:
        ProgramError: There is none, or more than one.
    """
    found = values_of(control, word, statement)
    if len(found) != 1:
        hint = f"write o{word.label} {word.keyword.lower()} [#1 LT 5]"
        message = f"{word.keyword.lower()} needs one value in square brackets"
        refuse(control, statement, "expression", message, hint)
    return found[0]


def _computed(control: Control, word: OWord, statement: Statement) -> float:
    return control.compute(*condition_of(control, word, statement))


def construct_of(control: Control, statement: Statement, word: OWord) -> Construct:
    """The construct that a line belongs to.

    Raises:
        ProgramError: It has no counterpart.
    """
    construct = structure(control).by_line.get(control.block.line - 1)
    if construct is None or construct.end is None:
        message = f"o{word.label} {word.keyword.lower()} has no counterpart"
        hint = "every if needs its endif, every loop and every sub its end, with the same label"
        refuse(control, statement, "open-structure", message, hint)
    return construct


def behind(construct: Construct) -> Location:
    """The place behind a construct."""
    assert construct.end is not None
    return Location(construct.end + 1, 0)


def line_of(control: Control, line: int) -> tuple[Statement, OWord]:
    """The O-word of another line, from 0; errors are that line's from now on."""
    control.report.line = line + 1
    (block,) = control.program_counter.lexer.blocks(control.program_counter.lines[line], line + 1)
    assert block.statement is not None
    word = o_word(block.statement)
    assert word is not None
    return block.statement, word


def _declare(control: Control, statement: Statement, word: OWord) -> None:
    """A label is given once in its subroutine.

    Raises:
        ProgramError: Another line has it.
    """
    line = control.block.line - 1
    key = f"{scope(control, line)}{word.label}"
    before = memory_of(control).labels.setdefault(key, line)
    if before != line:
        _, other = control.program_counter.lines[before], before + 1
        message = f"o{word.label} is the label of line {other} already"
        refuse(control, statement, "ambiguous-label", message, "give each its own label")


def _if(control: Control, statement: Statement, word: OWord) -> None:
    _declare(control, statement, word)
    construct = construct_of(control, statement, word)
    if _computed(control, word, statement):
        return
    for branch in construct.branches:
        at = line_of(control, branch.line)
        if branch.keyword == "ELSE" or _computed(control, at[1], at[0]):
            control.program_counter.go(Location(branch.line + 1, 0))
            return
    control.program_counter.go(behind(construct))


def _leave(control: Control, statement: Statement, word: OWord) -> None:
    control.program_counter.go(behind(construct_of(control, statement, word)))


def _nothing(control: Control, statement: Statement, word: OWord) -> None:
    construct_of(control, statement, word)


def _while(control: Control, statement: Statement, word: OWord) -> None:
    construct = construct_of(control, statement, word)
    value = _computed(control, word, statement)
    if construct.keyword == "DO":
        if value:
            control.program_counter.go(Location(construct.begin + 1, 0))
        return
    _declare(control, statement, word)
    if not value:
        control.program_counter.go(behind(construct))


def _do(control: Control, statement: Statement, word: OWord) -> None:
    _declare(control, statement, word)
    construct_of(control, statement, word)


def _again(control: Control, statement: Statement, word: OWord) -> None:
    control.program_counter.go(Location(construct_of(control, statement, word).begin, 0))


def counter_of(construct: Construct) -> str:
    """The variable that counts the rounds of a REPEAT; no program can name it."""
    return f"#repeat {construct.begin}"


def _repeat(control: Control, statement: Statement, word: OWord) -> None:
    _declare(control, statement, word)
    construct = construct_of(control, statement, word)
    count = float(round(_computed(control, word, statement)))
    control.variables.write(counter_of(construct), count)
    if count <= 0.0:
        control.program_counter.go(behind(construct))


def _end_repeat(control: Control, statement: Statement, word: OWord) -> None:
    construct = construct_of(control, statement, word)
    left = (control.variables.read(counter_of(construct)) or 0.0) - 1.0
    control.variables.write(counter_of(construct), left)
    if left > 0.0:
        control.program_counter.go(Location(construct.begin + 1, 0))


def enclosing(control: Control, statement: Statement, word: OWord) -> Construct:
    """The loop with the label that BREAK or CONTINUE names.

    Raises:
        ProgramError: The line lies in none.
    """
    for each in reversed(structure(control).around(control.block.line - 1)):
        if each.keyword in LOOPS and each.name == word.label:
            if each.keyword == "REPEAT":
                hint = "count by a while loop that is left"
                message = f"the control leaves while and do loops by {word.keyword.lower()}, no repeat"
                refuse(control, statement, "open-structure", message, hint)
            return each
    message = f"no loop o{word.label} lies around this line"
    refuse(control, statement, "open-structure", message)


def _break(control: Control, statement: Statement, word: OWord) -> None:
    control.program_counter.go(behind(enclosing(control, statement, word)))


def _continue(control: Control, statement: Statement, word: OWord) -> None:
    construct = enclosing(control, statement, word)
    assert construct.end is not None
    control.program_counter.go(Location(construct.end, 0))


# --- subroutines


def subroutine_line(control: Control, name: str, *, here: int) -> int | None:
    """The line, from 0, of a subroutine's definition; None where there is none.

    Args:
        control: The control.
        name: Its label.
        here: The line, from 0, of the call: what stands before it comes before a file.
    """
    structure(control)
    lines = memory_of(control).subroutines.get(name, [])
    behind_program = first_file(control)
    before = [line for line in lines if line < min(here, behind_program)]
    files = [line for line in lines if line >= behind_program]
    later = [line for line in lines if here <= line < behind_program]
    return next(iter((*before[-1:], *files[:1], *later[:1])), None)


def first_file(control: Control) -> int:
    """The line, from 0, before the first file behind the program."""
    parts = control.report.parts
    return parts[0][0] - 2 if parts else len(control.program_counter.lines)


def called_line(control: Control, statement: Statement, word: OWord) -> int:
    """First line, from 0, of the subroutine that CALL names.

    Raises:
        ProgramError: There is none, or it is one for M98.
    """
    name = word.label
    if name[0] in "#[":
        column = statement.text_column + len(statement.text) - len(statement.text.lstrip())
        value = control.compute(control.expression(name, column), column)
        name = str(integer_of(value))
    line = subroutine_line(control, name, here=control.block.line - 1)
    if line is None:
        known = ", ".join(f"o{each}" for each in memory_of(control).subroutines) or "none"
        message = f"there is no subroutine {name}"
        hint = (
            f"it stands in the program as o<{name}> sub, or beside it in {name}.ngc; here: {known}"
        )
        refuse(control, statement, "unknown-subprogram", message, hint)
    if line not in structure(control).by_line:
        message = f"O{name} is a program for M98, and no subroutine"
        refuse(control, statement, "unknown-subprogram", message, f"write M98 P{name}")
    return line


def arguments(control: Control, statement: Statement, word: OWord) -> list[tuple[Expression, int]]:
    """The values that CALL gives to #1, #2 and so on."""
    found = values_of(control, word, statement)
    if len(found) > LOCAL_PARAMETERS:
        message = f"a call gives {LOCAL_PARAMETERS} values at most"
        refuse(control, statement, "call-values", message)
    return found


def _call(control: Control, statement: Statement, word: OWord) -> None:
    line = called_line(control, statement, word)
    values = {
        f"#{number}": control.compute(value, column)
        for number, (value, column) in enumerate(arguments(control, statement, word), 1)
    }
    memory_of(control).called.add(structure(control).by_line[line].name)
    span = statement.column, len(statement.text) + 1
    frame = CallFrame(Location(line + 1, 0), owns_scope=True)
    control.program_counter.call(frame, DEEPEST_CALL, *span)
    control.variables.enter(values)


def _sub(control: Control, statement: Statement, word: OWord) -> None:
    construct = construct_of(control, statement, word)
    if control.program_counter.is_calling:
        message = "a subroutine cannot be defined within another"
        refuse(control, statement, "open-structure", message, "end the one before by its endsub")
    if word.label in memory_of(control).called:
        message = f"o{word.label} was called before this line, where the program defines it again"
        refuse(control, statement, "ambiguous-label", message, "end the program by M2 before it")
    _declare(control, statement, word)
    control.program_counter.go(behind(construct))


def _return(control: Control, statement: Statement, word: OWord) -> None:
    memory, found = memory_of(control), values_of(control, word, statement)
    value = control.compute(*found[0]) if found else 0.0
    if not control.program_counter.is_calling:
        refuse(control, statement, "return-outside", "no subroutine is being run here")
    memory.returned = (value, bool(found))
    restore_at_return(control)
    control.program_counter.leave()


def program_for_m98(control: Control, statement: Statement, _word: OWord) -> None:
    """O100 alone: a program that M98 calls, and that the flow may run into."""
    del control, statement


ACTIONS = {
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
    "": program_for_m98,
}


def run_o_word(control: Control, statement: Statement) -> None:
    """A line that begins with an O-word."""
    word = o_word(statement)
    if word is None:
        refuse(control, statement, "o-word", "O needs a label", "write o100 or o<name>")
    action = ACTIONS.get(word.keyword)
    if action is None:
        known = ", ".join(KEYWORDS).lower()
        refuse(control, statement, "o-word", f"'{word.keyword.lower()}' follows no O", known)
    if word.label[0] in "#[" and word.keyword != "CALL":
        refuse(control, statement, "o-word", "only call can compute its label")
    check_rest(control, statement, word)
    action(control, statement, word)


def check_rest(control: Control, statement: Statement, word: OWord) -> None:
    """Most keywords end their line.

    Raises:
        ProgramError: Something follows.
    """
    if word.keyword not in WITH_VALUES and word.text.strip():
        message = f"nothing may follow o{word.label} {word.keyword.lower()}"
        refuse(control, statement, "o-word", message, "write it on a line of its own")


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
    number, times = control.take("P"), control.take("L")
    if number is None:
        control.fail("jump-target", "M98 needs P, the number of the program", hint="write M98 P100")
    count = 1 if times is None else integer_of(control.number(times))
    if count < 0:
        control.fail("repeat-count", "L must count the calls of M98", times)
    if count == 0:
        return
    name = name_of_label(str(integer_of(control.number(number))))
    line = subroutine_line(control, name, here=control.block.line - 1)
    if line is None or line in structure(control).by_line:
        message = f"there is no program O{name}"
        hint = f"it begins with O{name} alone, here or in {name}.ngc beside the program"
        control.fail("unknown-subprogram", message, number, hint)
    frame = CallFrame(Location(line + 1, 0), again=count - 1)
    control.program_counter.call(frame, DEEPEST_CALL, number.column, number.width)


def return_from_program(control: Control) -> None:
    """M99: back behind M98; in the main program from its beginning again."""
    if not control.program_counter.leave():
        control.program_counter.go(Location(0, 0))
        memory_of(control).percent = False
