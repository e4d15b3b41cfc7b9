"""The lines of a program beside what was run of them: which were never come to."""

import bisect
import re
from collections.abc import Sequence

import numpy as np

from twin.nc.canonical import IntArray

_COMMENT = re.compile(r"\([^()]*\)|;.*|%.*")
_MOTION = re.compile(r"(?<![A-Z])[XYZABC]\s*=?\s*[-+]?[\d.]", re.IGNORECASE)
_SETTING = re.compile(r"\bG0*(?:10|92|52|54|5[5-9]|15|68|28|30|4)\b", re.IGNORECASE)
"""Codes whose axis words move nothing, or somewhere else."""
_BRANCH = re.compile(
    r"GOTO|\bIF\b|WHILE|\bDO\b|JUMP|JMP|CALL|\bM9[789]\b|\bG(?:2[5-7]|6[5-7])\b|\bG73\b|^\s*/|\$",
    re.IGNORECASE,
)
"""What may pass lines over."""
_SUBPROGRAM = re.compile(r"^\s*(?:[O:%]|L\d|#?SUB|\(SUB|N\d+\s*$)", re.IGNORECASE)
"""How a line begins behind which a subprogram stands."""
_LENGTH = re.compile(r"\bG0*43\b(?!\.)", re.IGNORECASE)
_LENGTH_NUMBER = re.compile(r"(?<![A-Z])H\s*0*(\d+)", re.IGNORECASE)
_LENGTH_DIALECTS = frozenset({"fanuc", "haas", "linuxcnc"})
"""Controls on which nothing but G43 puts a tool's length into force."""


class ProgramText:
    """The lines of a program and which of them have done something.

    Attributes:
        length_calls: Numbers behind H of G43, by line.
        calls_lengths: Whether G43 is written anywhere.
        knows_lengths: Whether the control takes a tool's length by G43 alone.
    """

    def __init__(self, lines: Sequence[str], dialect: str) -> None:
        self.knows_lengths = dialect in _LENGTH_DIALECTS
        self._lines = lines
        self._visited: set[int] = set()
        self.length_calls: dict[int, int] = {}
        self.calls_lengths = False
        if self.knows_lengths:
            self._find_lengths()

    def _find_lengths(self) -> None:
        for number, line in enumerate(self._lines, start=1):
            if "43" not in line or not _LENGTH.search(plain := self._plain(number)):
                continue
            self.calls_lengths = True
            found = _LENGTH_NUMBER.search(plain)
            if found is not None:
                self.length_calls[number] = int(found[1])

    def visit(self, lines: IntArray) -> None:
        """Take note of lines that have moved something, or acted."""
        self._visited.update(np.unique(lines).tolist())

    def never_run(self) -> list[int]:
        """Lines with words of axes that were never come to.

        A line between two that were run one behind the other, such as one that moves nothing because the
        axes stand there, was run if nothing near it can pass lines over.
        """
        run = sorted(self._visited)
        found = []
        for number in range(1, len(self._lines) + 1):
            if number in self._visited or not self._moves(number):
                continue
            place = bisect.bisect(run, number)
            enclosed = 0 < place < len(run)
            if not enclosed or self.branches(run[place - 1], run[place]):
                found.append(number)
        return found

    def motion_behind(self, end: int) -> int:
        """First line with motion behind the line that ended the program, if none of what follows is run."""
        if not end or any(line > end for line in self._visited):
            return 0
        for number in range(end + 1, len(self._lines) + 1):
            text = self._lines[number - 1]
            if _SUBPROGRAM.search(text):
                return 0
            if self._moves(number):
                return number
        return 0

    def _plain(self, line: int) -> str:
        return _COMMENT.sub(" ", self._lines[line - 1])

    def _moves(self, line: int) -> bool:
        plain = self._plain(line)
        return bool(_MOTION.search(plain)) and not _SETTING.search(plain)

    def branches(self, first: int, last: int) -> bool:
        """Whether something in these lines may pass lines over, or run others in between."""
        return any(_BRANCH.search(self._plain(line)) for line in range(first, last + 1))
