"""Programs of a Fanuc control: O numbers and names, several in one file, M98, M99 and M97.

A tape of the ISO code has : for O. The first program of the file runs first; each ends where the next begins or
the file does. A subprogram that the file lacks is a file of its own beside it: O2000, O2000.nc or 2000.nc, and
POCKET or POCKET.nc for <POCKET>. The name O2000 is the number 2000 (manual of the 30i).
"""

import re
import sys
from collections.abc import Iterator
from typing import TypeAlias

from twin.nc.control.control import Control
from twin.nc.dialects.fanuc.memory import memory_of
from twin.nc.text.blocks import Location, Statement, Word
from twin.nc.text.library import Library
from twin.nc.text.lines import Lines
from twin.nc.text.source import Source

Key: TypeAlias = "int | str"
"""What names a program: its number, or its name in upper case."""
NAME, NAMED_HEADING = "<", "O<"
"""Addresses of the words <NAME> and O<NAME>."""
NAMED, NAMED_BEGIN = r"(O?<)[^<>]*>", r"(O<)[^<>]*>"
"""How they are written; the second, where programs have names and are not called by them."""
_HEADING = re.compile(r"[ \t]*(?:[O:][ \t]*([0-9]{1,8})(?![0-9.])|O<([^<>]*)>)", re.IGNORECASE)
_HEADING_SOMEWHERE = re.compile(rb"[Oo](?:[ \t]*[0-9]|<)|:[ \t]*[0-9]")
_CALL = re.compile(
    r"^[^(]*?(?:M0*98|G0*6[56])(?![0-9.])(?:[ \t]*<([^<>]*)>|[^(]*?P[ \t]*([0-9]{1,8})(?![0-9.]))",
    re.IGNORECASE,
)
_CALL_SOMEWHERE = re.compile(rb"(?:M0*98|G0*6[56])(?![0-9.])", re.IGNORECASE)
_NUMBER = re.compile(r"O?0*([0-9]{1,8})")
_NAME = re.compile(r"[-+_.A-Z0-9]{1,32}")
"""Names of programs (manual of the 30i: 32 characters at most)."""
_BLANK = re.compile(r"[ \t]*(?:%.*)?")
_OF_A_PROGRAM = re.compile(r"(?<![A-Z])[GXYZMO][ \t]*[-+]?[.0-9]", re.IGNORECASE)
"""A word of a program, which text before the first % does not hold."""
_LONGEST_TEXT = 200
"""So many lines of text may stand there."""
_REPEATS = 10_000
"""P of M98 holds how often the subprogram runs in the digits above the last four."""


def _key_of(name: str) -> Key:
    """What a name calls: a number where it is one."""
    number = _NUMBER.fullmatch(name.upper())
    return name.upper() if number is None else int(number[1])


def _shown(key: Key) -> str:
    """A program as its heading names it."""
    return f"O{key}" if isinstance(key, int) else f"O<{key}>"


def _heading_of_file(name: str) -> str | None:
    """What names a file's program behind the O of its heading."""
    called = _NUMBER.fullmatch(name) or _NAME.fullmatch(name)
    return None if called is None else _shown(_key_of(name)).removeprefix("O")


def _calls(source: Source) -> Iterator[str]:
    """What programs that a text calls and does not hold have behind their O."""
    if not source.lines.any_holds(_CALL_SOMEWHERE):
        return
    held = {key for _, key in _headings(source.lines)}
    for line in source.lines:
        if (match := _CALL.match(line)) is not None:
            if match[1] is not None:
                called = {_key_of(match[1])}
            else:
                called = {int(match[2]), int(match[2]) % _REPEATS}
            for each in called - held:
                yield _shown(each).removeprefix("O")


def _headings(lines: Lines) -> Iterator[tuple[int, Key]]:
    """Lines of headings, from 0, and the programs that they begin."""
    for line, text in lines.holding(_HEADING_SOMEWHERE):
        if (match := _HEADING.match(text)) is not None:
            yield line, _key_of(match[2]) if match[1] is None else int(match[1])


LIBRARY = Library(_calls, "O", ("", ".nc", ".cnc", ".tap", ".prg", ".txt"), _heading_of_file)


def begin(control: Control) -> None:
    """Find the programs of the file."""
    memory, lines = memory_of(control), control.program_counter.lines
    before: int | None = None
    start = _pass_text_before_tape(control)
    for line, key in _headings(lines):
        if line < start:
            continue
        memory.headings.append(line)
        if memory.main is None:
            memory.main = line
        if key not in memory.programs or _follows(control, before, line, key):
            memory.programs[key] = line + 1
        before = line
    _warn_of_tape_end(control, start)


def _pass_text_before_tape(control: Control) -> int:
    """Begin behind the first % where text that is no program comes before it, as the control does; the line, from 0."""
    lines = control.program_counter.lines
    first = next((at for at, _ in lines.holding("%") if lines[at].lstrip().startswith("%")), 0)
    text = [lines[at] for at in range(min(first, _LONGEST_TEXT + 1))]
    blank = all(_BLANK.fullmatch(each) for each in text)
    if blank or len(text) > _LONGEST_TEXT or any(map(_OF_A_PROGRAM.search, text)):
        return 0
    control.program_counter.go(Location(first + 1, 0))
    control.report.line = 1
    message = f"the control reads a file from its first % on, in line {first + 1}: what is before it is passed over"
    control.report.warn_once("before-tape-start", message)
    return first + 1


def _warn_of_tape_end(control: Control, start: int) -> None:
    """Warn of blocks behind a % within a program: a control reads no further, and the twin does."""
    lines, begun = control.program_counter.lines, False
    for line, _ in lines.holding("%"):
        if not lines[line].lstrip().startswith("%"):
            continue
        begun = begun or any(not _BLANK.fullmatch(lines[each]) for each in range(start, line))
        behind = next(
            (each for each in range(line + 1, len(lines)) if not _BLANK.fullmatch(lines[each])),
            None,
        )
        if begun and behind is not None and not _HEADING.match(lines[behind]):
            control.report.line = line + 1
            message = (
                "a control reads a file up to this %, and blocks of the program stand behind it"
            )
            control.report.warn_once(
                "behind-tape-end", message, hint="leave it out, or begin a program by O behind it"
            )
            return


def _follows(control: Control, before: int | None, line: int, key: Key) -> bool:
    """A file's own heading is right behind the one that its name has given it."""
    lines = control.program_counter.lines
    if before is None or memory_of(control).programs.get(key) != before + 1:
        return False
    return all(_BLANK.fullmatch(lines[each]) for each in range(before + 1, line))


def heading(control: Control, word: Word) -> None:
    """O: the heading of the program that runs first."""
    if word.mark:
        named(control, word)
    memory, line = memory_of(control), control.block.line - 1
    if line != memory.main:
        message = f"{word.text} begins here, and the program before it has not ended"
        hint = "a program ends by M30 or M2, a subprogram by M99"
        control.fail("program-end", message, word, hint=hint)
    if control.program_counter.is_calling or len(control.block.words) > 1:
        control.fail("program-end", f"{word.text} must stand alone before its program", word)


def lines_around(control: Control, line: int | None = None) -> range:
    """The program that a line, from 0, is in, else the one that is being run; labels are its own."""
    headings, count = memory_of(control).headings, len(control.program_counter.lines)
    here = control.block.line - 1 if line is None else line
    first = max((each for each in headings if each <= here), default=0)
    return range(first, min((each for each in headings if each > here), default=count))


def whole(control: Control, word: Word, code: str, meaning: str) -> int:
    """The value of a word that must be a whole number from 0."""
    value = control.number(word)
    if value < 0.0 or value != int(value):
        control.fail(code, f"{word.text} is no {meaning}", word)
    return int(value)


def called(control: Control, number: int, repeats: int | None) -> tuple[int, int]:
    """Number of the program that P names, and how often it runs; ``repeats`` is L, where it is written."""
    memory = memory_of(control)
    if repeats is not None or number in memory.programs or not memory.variant.repeats_in_p:
        return number, 1 if repeats is None else repeats
    count, short = divmod(number, _REPEATS)
    return (short, count) if count else (number, 1)


def named(control: Control, word: Word) -> Key:
    """The program that a word <NAME> or O<NAME> names."""
    name = word.mark[word.mark.index("<") + 1 : -1]
    if _NAME.fullmatch(name.upper()) is None:
        message = f"{word.text} names no program"
        hint = "a name has 1 to 32 letters, digits and - + _ ."
        control.fail("call-values", message, word, hint)
    return _key_of(name)


def program_word(
    control: Control,
    caller: str,
    words: tuple[Word | None, Word | None],
    error_at: Statement | None,
) -> Word:
    """The one of P and a name that says which program a code calls."""
    number, name = words
    word = name or number
    if word is None:
        message = f"{caller} needs P, the number of the program"
        hint = f"{caller} P1000; a Fanuc control also takes a name, {caller} <POCKET>"
        control.fail("call-values", message, error_at, hint)
    if name is not None and number is not None:
        message = f"{caller} calls one program, by its number or its name"
        control.fail("call-values", message, name, "leave one out")
    return word


def line_of(control: Control, key: Key, word: Word | None) -> int:
    """The line behind the heading of a program, from 0."""
    programs = memory_of(control).programs
    line = programs.get(key)
    if line is None:
        known = ", ".join(map(_shown, sorted(programs, key=_order))) or "none"
        file = f"O{key}.nc" if isinstance(key, int) else f"{key}.nc"
        message = f"there is no program {_shown(key)}"
        hint = f"programs of this file: {known}; or a file {file} beside it"
        control.fail("unknown-subprogram", message, word, hint=hint)
    return line


def _order(key: Key) -> tuple[int, str]:
    """Numbers come first."""
    return (key, "") if isinstance(key, int) else (sys.maxsize, key)


def call(control: Control) -> None:
    """M98 P L, M98 <NAME> L: run a subprogram, L times."""
    word = program_word(control, "M98", (control.take("P"), control.take(NAME)), None)
    often = control.take("L")
    repeats = None if often is None else whole(control, often, "repeat-count", "count")
    if word.mark:
        key, count = named(control, word), 1 if repeats is None else repeats
    else:
        key, count = called(control, whole(control, word, "call-values", "program number"), repeats)
    run_part(control, Location(line_of(control, key, word), 0), count, word)


def call_block(control: Control) -> None:
    """M97 P L: run the blocks from N on as a subprogram, L times."""
    word, often = control.take("P"), control.take("L")
    if word is None:
        control.fail("call-values", "M97 needs P, the number of a block", None, "M97 P1000")
    count = 1 if often is None else whole(control, often, "repeat-count", "count")
    number = whole(control, word, "jump-target", "block number")
    label = control.program_counter.find_label(
        number, (word.column, word.width), "M97", lines_around(control)
    )
    run_part(control, label, count, word)


def run_part(control: Control, first: Location, count: int, word: Word) -> None:
    """Run what begins at a location up to its M99, so often.

    Raises:
        ProgramError: The count is 0, or too many programs call each other.
    """
    if count < 1:
        control.fail("repeat-count", "a subprogram runs once at least", word)

    control.call(first, memory_of(control).variant.deepest_call, word, times=float(count))


def return_(control: Control) -> None:
    """M99: back behind the call; with P at the block of that number.

    In the main program M99 P jumps, and M99 alone, by which a control begins again for ever, ends.
    """
    target, counter = control.take("P"), control.program_counter
    if counter.is_calling:
        if target is not None:
            counter.calls[-1].again = 0
        control.go_back()
        around = lines_around(control, counter.location.line)
    elif target is None:
        message = "M99 in the main program starts it again, for ever: here it ends"
        control.report.warn_once("endless-main", message, hint="end the main program by M30")
        control.ended = True
        return
    else:
        around = lines_around(control)
    if target is not None:
        number = whole(control, target, "jump-target", "block number")
        span = (target.column, target.width)
        counter.go(counter.find_label(number, span, "M99", around))


def finish(control: Control) -> None:
    """The last line has been passed without an end."""
    if control.program_counter.is_calling:
        message = "the file ends within a subprogram, which has no M99"
        control.report.fail("program-end", message, hint="end it by M99")
    control.report.warn("no-end", "the program has no M30, M2 or M99 at its end")
