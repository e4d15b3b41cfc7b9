"""The program in the control's memory, which the operator edits."""

from collections.abc import Iterable

from twin.errors import UsageError
from twin.nc.text.source import Source, source_from_text

EDITS_KEPT = 100
"""Changes of the program that can be taken back."""


class ProgramMemory:
    """A program that can be edited, replaced and restored; other files read it and call its methods.

    Attributes:
        edits: Its lines before each change, the newest last.
        searched: Line at which the next start begins; 0: the first.
    """

    def __init__(self, source: Source) -> None:
        self._original = source
        self.source = source
        self.lines = tuple(source.lines)
        self.edits: tuple[tuple[str, ...], ...] = ()
        self.searched = 0

    def edit(self, line: int, text: str | None) -> None:
        """Replace a line by several, by one, or by none (None); the line behind the last one is added.

        Raises:
            UsageError: The program has fewer lines.
        """
        lines = list(self.lines)
        if line > len(lines) + 1:
            raise UsageError(f"the program has {len(lines)} lines")
        lines[line - 1 : line] = [] if text is None else text.split("\n")
        self._change(lines)

    def load(self, text: str) -> None:
        """Replace the whole program."""
        self._change(text.rstrip("\n").split("\n"))

    def reload(self) -> None:
        """Load the scene's program again."""
        self._change(self._original.lines)

    def undo(self) -> None:
        """Take back the last change.

        Raises:
            UsageError: There is none.
        """
        if not self.edits:
            raise UsageError("the program has not been changed")
        *edits, lines = self.edits
        self.edits = tuple(edits)
        self._store(lines)

    def begin_at(self, line: int) -> None:
        """Let the next start begin at a line; 0: at the first.

        Raises:
            UsageError: The program has fewer lines.
        """
        if line > len(self.lines):
            raise UsageError(f"the program has {len(self.lines)} lines")
        self.searched = line

    def _change(self, lines: Iterable[str]) -> None:
        self.edits = (*self.edits, self.lines)[-EDITS_KEPT:]
        self._store(lines)

    def _store(self, lines: Iterable[str]) -> None:
        self.lines = tuple(lines)
        self.source = source_from_text("\n".join(self.lines), self.source.name)
        self.searched = 0
