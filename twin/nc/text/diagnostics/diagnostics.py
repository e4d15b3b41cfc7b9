"""What the interpreter has to say about a program: where, what, and what would have worked."""

import dataclasses
from typing import Literal

from twin.errors import ExitCode, TwinError

Severity = Literal["error", "warning"]


@dataclasses.dataclass(frozen=True, slots=True)
class Diagnostic:
    """One finding in an NC program.

    Attributes:
        severity: ``error`` stops the program, ``warning`` does not.
        code: Stable, searchable name of the finding, such as ``unknown-word``.
        line: Source line, from 1.
        column: Column of the first character in question, from 1.
        width: How many characters are in question.
        hint: What would have worked, or None.
    """

    severity: Severity
    code: str
    message: str
    file: str
    line: int
    column: int
    width: int = 1
    source: str = ""
    hint: str | None = None

    def __str__(self) -> str:
        """The form that compilers made familiar: place, message, line, caret, hint."""
        place = f"{self.file}:{self.line}:{self.column}"
        lines = [f"{place}: {self.severity} {self.code}: {self.message}"]
        if self.source:
            shown, caret = _excerpt(self.source, self.column - 1, self.width)
            lines += [f"    {shown}", f"    {caret}"]
        if self.hint:
            lines.append(f"    hint: {self.hint}")
        return "\n".join(lines)


_EXCERPT = 120
"""Characters of a long line that are shown around the caret."""


def _excerpt(source: str, start: int, width: int) -> tuple[str, str]:
    first = max(0, start - _EXCERPT // 2) if len(source) > _EXCERPT else 0
    shown = source[first : first + _EXCERPT]
    printable = "".join(char if char.isprintable() else " " for char in shown)
    width = max(1, min(width, len(printable) - (start - first)))
    return printable, " " * (start - first) + "^" * width


class ProgramError(TwinError):
    """The NC program is wrong; the diagnostic says where and why."""

    exit_code = ExitCode.PROGRAM

    def __init__(self, diagnostic: Diagnostic) -> None:
        super().__init__(str(diagnostic))
        self.diagnostic = diagnostic
