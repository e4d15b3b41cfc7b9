"""Which block comes next: straight on, jumps, calls, and a limit for programs without an end."""

import dataclasses
import re
from collections.abc import Callable, Container, Hashable, Iterator
from typing import NoReturn, TypeVar, cast

from twin.nc.canonical import NO_BLOCK_NUMBER
from twin.nc.control.modal import Modal
from twin.nc.text.blocks import Block, Location
from twin.nc.text.diagnostics.diagnostics import ProgramError
from twin.nc.text.diagnostics.reporter import Reporter
from twin.nc.text.lexer import Lexer
from twin.nc.text.source import Source

_LABEL = re.compile(r"N[ \t]*[0-9]|[\[:]", re.IGNORECASE)
Key = TypeVar("Key")
Found = TypeVar("Found")
Parsed = TypeVar("Parsed")

_CACHED_LINES = 10_000
"""Lines whose blocks are remembered once a program has jumped."""


class FoundInText(dict[Key, Found]):
    """What was found in a program's text, which does not change."""


@dataclasses.dataclass(slots=True)
class Call:
    """A part of the program that is being run for a caller.

    Attributes:
        again: How often it still runs again before that.
        last: Its last block, where it ends by its location; None: a word ends it.
        owns_variables: It has variables of its own, which its end forgets.
        restores: What its end puts back into force; None: nothing.
        then: Done when it has ended, before the block behind it; None: nothing.
    """

    back: Location
    first: Location
    again: int = 0
    last: Location | None = None
    owns_variables: bool = False
    restores: Modal | None = None
    then: Callable[[], None] | None = None


class ProgramCounter:
    """The program counter.

    Attributes:
        calls: The parts that are being run for a caller, the innermost last.
    """

    def __init__(self, source: Source, lexer: Lexer, step_limit: int, report: Reporter) -> None:
        """Stand before the program, of which so many blocks may be run again."""
        self.lines = source.lines
        self._line_count = len(source.lines)
        self.lexer = lexer
        self._report = report
        self._step_limit = step_limit
        self._line = self._part = 0
        self._furthest = (-1, 0)
        self._budget = step_limit
        self.calls: list[Call] = []
        self._ended: Call | None = None
        self._labels: FoundInText[int | str, list[Location]] | None = None
        self._cache = FoundInText[int, tuple[Block, ...]]()
        self._parsed = FoundInText[Hashable, object]()
        self._end_asked = False
        self._here: tuple[Block, ...] = ()
        self._here_line = -1

    @property
    def begun(self) -> bool:
        """A block was run."""
        return self._furthest[0] >= 0

    @property
    def location(self) -> Location:
        """The block that comes next."""
        return Location(self._line, self._part)

    @property
    def is_calling(self) -> bool:
        """A part of the program is being run for a caller."""
        return bool(self.calls)

    @property
    def depth(self) -> int:
        """How many parts of the program are being run for callers."""
        return len(self.calls)

    def next(self) -> Block | None:
        """The next block, or None at the end of the program.

        Raises:
            ProgramError: Its line cannot be read, or the program runs without end.
        """
        if self.calls:
            self._end_passed()
        if self._ended is not None and self._ended.then is not None:
            then, self._ended = self._ended.then, None
            then()
        line, part = self._line, self._part
        if line == self._here_line and part >= len(self._here):
            line, part = line + 1, 0
        while line < self._line_count:
            blocks = self._here if line == self._here_line else self._blocks(line)
            if part < len(blocks):
                self._line, self._part = line, part + 1
                if (here := (line, part)) > self._furthest:
                    self._furthest = here
                else:
                    self._count_again(line)
                return blocks[part]
            line, part = line + 1, 0
        self._line, self._part = line, 0
        if not self._end_asked:
            self._run_out()
        return None

    def _end_passed(self) -> None:
        """Parts that end by their location and have been passed run again, or go back."""
        while self.calls:
            call = self.calls[-1]
            if call.last is None or self.location <= call.last:
                return
            if call.again > 0:
                call.again -= 1
                self.go(call.first)
            else:
                self._ended = self.calls.pop()
                self.go(call.back)

    def end_call(self) -> Call | None:
        """Go on behind the innermost call that a word ends, or run its part again.

        Returns:
            The call that has ended; None: its part runs again.
        """
        while self.calls[-1].last is not None:
            self.calls.pop()
        call = self.calls[-1]
        if call.again > 0:
            call.again -= 1
            self.go(call.first)
            return None
        self._ended = self.calls.pop()
        self.go(call.back)
        return call

    def _run_out(self) -> None:
        """The last line has been passed; what is to be said of that is at the last text."""
        written = (line for line in range(len(self.lines), 0, -1) if self.lines[line - 1].strip())
        self._report.line = next(written, 0)

    def go(self, location: Location) -> None:
        """Go on at a location."""
        self._line, self._part = location

    @property
    def fresh_line(self) -> int | None:
        """The line that comes next and has never been run, from 0; None where there is no such one."""
        line, part = self.location
        if line == self._here_line and part >= len(self._here):
            line, part = line + 1, 0
        repeats = bool(self.calls) and self.calls[-1].last is not None
        if part or repeats or line <= self._furthest[0] or line >= self._line_count:
            return None
        return line

    def pass_lines(self, line: int, behind: int) -> None:
        """The lines before one, of one block at most, were run elsewhere; ``behind`` lies behind the last block."""
        if behind:
            self._furthest = (behind - 1, 0)
        self.go(Location(line, 0))

    def end(self) -> None:
        """Go on behind the last line, which ends the program here."""
        self._end_asked = True
        self.go(Location(len(self.lines), 0))

    def seek(self, wanted: Callable[[Block], bool]) -> bool:
        """Go on at the next block that is wanted; stay where it is when there is none."""
        for block in self._ahead():
            if wanted(block):
                self.go(Location(block.line - 1, block.part))
                return True
        return False

    def following(self) -> Block | None:
        """The block behind this one in the text, as far as it can be read."""
        return next(self._ahead(), None)

    def _ahead(self) -> Iterator[Block]:
        line, part = self.location
        for number in range(line, len(self.lines)):
            for block in self._readable_blocks(number):
                if number > line or block.part >= part:
                    yield block

    def find_label(
        self,
        label: int | str,
        fail_at: tuple[int, int],
        word: str,
        within: Container[int] | None = None,
    ) -> Location:
        """Where the block with an N number or a name is, among these lines, from 0, or all; a word at ``fail_at`` asks for it.

        Raises:
            ProgramError: No block or more than one has it.
        """
        locations = self.labels().get(label, [])
        if within is not None:
            locations = [location for location in locations if location.line in within]
        if len(locations) != 1:
            self._refuse_label(label, len(locations), fail_at, word)
        return locations[0]

    def parsed(self, text: Hashable, parse: Callable[[], Parsed]) -> Parsed:
        """What a statement, or what was made of one, says: read when it is run first."""
        found = self._parsed.get(text)
        if found is None:
            found = parse()
            if len(self._parsed) < _CACHED_LINES:
                self._parsed[text] = found
        return cast("Parsed", found)

    def labels(self) -> dict[int | str, list[Location]]:
        """Where every N number and every name of a block stands."""
        if self._labels is None:
            self._labels = FoundInText()
            for line, text in enumerate(self.lines):
                if _LABEL.search(text) is not None:
                    for block in self._readable_blocks(line):
                        label = block.name or block.number
                        if label != NO_BLOCK_NUMBER:
                            self._labels.setdefault(label, []).append(Location(line, block.part))
        return self._labels

    def _readable_blocks(self, line: int) -> tuple[Block, ...]:
        """A line's blocks; a line that cannot be read has no labels until it is run."""
        with self._report.quietly():
            try:
                return self._blocks(line)
            except ProgramError:
                return ()

    def _blocks(self, line: int) -> tuple[Block, ...]:
        if line == self._here_line:
            return self._here
        blocks = self._cache.get(line)
        if blocks is None:
            text = self.lines.page_of(line).line(line)
            blocks = self.lexer.blocks(text, line + 1, self._line_before)
            if line <= self._furthest[0] and len(self._cache) < _CACHED_LINES:
                self._cache[line] = blocks
        self._here, self._here_line = blocks, line
        return blocks

    def _line_before(self, number: int) -> str:
        """The text before the line with a number, from 1."""
        return self.lines[number - 2] if number > 1 else ""

    def _count_again(self, line: int) -> None:
        """A block of a line runs that has run before, or that one behind it has."""
        self._budget -= 1
        if self._budget < 0:
            self._report.line = line + 1
            message = f"more than {self._step_limit} blocks were repeated"
            hint = "if the program is meant to run this long, raise the job's step_limit"
            self._report.fail("endless-program", message, hint=hint)

    def _refuse_label(
        self, label: int | str, count: int, fail_at: tuple[int, int], word: str
    ) -> NoReturn:
        known = [_shown(each) for each in self.labels()]
        shown = ", ".join(known[:_SHOWN_LABELS])
        name = _shown(label)
        more = ", ..." if len(known) > _SHOWN_LABELS else ""
        code, message = "unknown-label", f"{word} names {name}, and no block has it"
        if count > 1:
            code, message = "ambiguous-label", f"{word} names {name}, and {count} blocks have it"
        hint = f"blocks here: {shown}{more}" if known else f"write {name} before its block"
        self._report.fail(code, message, *fail_at, hint=hint)


_SHOWN_LABELS = 12


def _shown(label: int | str) -> str:
    return f"[{label}]" if isinstance(label, str) else f"N{label}"
