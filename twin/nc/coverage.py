"""Which lines of a program a run has come to, and which with motion it never did."""

import re

from twin.nc.control.dialect import Dialect
from twin.nc.text.diagnostics.diagnostics import ProgramError
from twin.nc.text.diagnostics.reporter import Reporter
from twin.nc.text.lexer import Lexer
from twin.nc.text.source import Source

_SUBPROGRAM = re.compile(r"^\s*(?:[O:%]|L\d|#?SUB|\(SUB|N\d+\s*$)", re.IGNORECASE)
"""How a line begins behind which a subprogram stands: a program's end before it is where it should be."""


class Coverage:
    """The lines that were run.

    Attributes:
        ends_at: Line of the block that ended the program; 0: none has.
    """

    def __init__(self, source: Source, dialect: Dialect) -> None:
        self._source = source
        self._dialect = dialect
        # Files behind the program hold what it may call, which need not be come to.
        own = source.parts[0][0] - 1 if source.parts else len(source.lines)
        self._own_lines = range(1, own + 1)
        self._run = bytearray(len(source.lines) + 1)
        self.ends_at = 0

    def note_line(self, line: int) -> None:
        """A line was run, numbered from 1."""
        self._run[line] = 1

    def note(self, first: int, behind: int) -> None:
        """The lines from ``first`` up to the one before ``behind`` were run, numbered from 1."""
        self._run[first:behind] = b"\1" * (behind - first)

    def never_run(self) -> list[int]:
        """Lines that would move axes and that were never come to, from 1."""
        lexer = Lexer(self._dialect, Reporter(self._source, strict=False))
        unrun = (line for line in self._own_lines if not self._run[line])
        return [line for line in unrun if self._moves(lexer, line)]

    def motion_behind_end(self) -> int:
        """First line with motion behind the program's end where none of what follows is run; 0: there is none."""
        end = self.ends_at
        if not end or any(self._run[end + 1 :]):
            return 0
        lexer = Lexer(self._dialect, Reporter(self._source, strict=False))
        for line in self._own_lines[end:]:
            if _SUBPROGRAM.search(self._source.lines[line - 1]):
                return 0
            if self._moves(lexer, line):
                return line
        return 0

    def _moves(self, lexer: Lexer, line: int) -> bool:
        """Whether a block of the line has words of axes that none of its codes takes for something else."""
        try:
            blocks = lexer.blocks(self._source.lines[line - 1], line)
        except ProgramError:
            return False  # what cannot be read has no motion
        codes = self._dialect.codes.g
        return any(
            any(word.address in self._dialect.words.axes for word in block.words)
            and not any(
                word.address == "G"
                and isinstance(word.value, float)
                and (code := codes.get(word.value)) is not None
                and code.perform is not None
                for word in block.words
            )
            for block in blocks
        )
