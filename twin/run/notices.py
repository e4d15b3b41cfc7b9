"""Warnings of a run: what the verdict alone would pass over, each with its line and a code."""

import dataclasses
from collections.abc import Iterable, Iterator

from twin.nc.text.diagnostics import Diagnostic, ProgramError
from twin.nc.text.source import Source
from twin.run.messages import at_line


@dataclasses.dataclass(frozen=True, slots=True)
class Notice:
    """One warning of a run.

    Attributes:
        code: Its name in ``twin explain``.
        line: Source line of the program; 0 where it concerns the whole program.
        message: What was found, in one sentence.
    """

    code: str
    line: int
    message: str

    def diagnostic(self, source: Source) -> Diagnostic:
        """The notice at its line of the program."""
        return at_line(source, self.line, self.code, self.message, severity="warning")


def shown(notices: Iterable[Notice], source: Source, *, strict: bool) -> Iterator[Diagnostic]:
    """Notices as warnings of a program, by line.

    Raises:
        ProgramError: There is one, and ``strict`` makes it an error.
    """
    for notice in sorted(notices, key=lambda each: (each.line, each.code)):
        warning = notice.diagnostic(source)
        if strict:
            raise ProgramError(dataclasses.replace(warning, severity="error"))
        yield warning
