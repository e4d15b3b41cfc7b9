"""Where diagnostics are made: the line in question, and whether warnings count as errors."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import NoReturn

from twin.nc.text.diagnostics.diagnostics import Diagnostic, ProgramError, Severity
from twin.nc.text.source import Source

_LONGEST_TEXT = 800
"""Characters of a message or a hint: a program may hold names of any length."""
NOTICE = "passed-over"
"""Code of what changes nothing of the path."""
_MOST_WARNINGS = 1000
"""Warnings that are kept: a program that earns more has made its point."""


class Reporter:
    """Makes the diagnostics of one program.

    Attributes:
        line: Source line that is being read or run, from 1.
    """

    def __init__(self, source: Source, *, strict: bool) -> None:
        self._source = source
        self._strict = strict
        self._said: set[str] = set()
        self.line = 0
        self.warnings: list[Diagnostic] = []

    @property
    def parts(self) -> tuple[tuple[int, str], ...]:
        """Files behind the program: number of the first line of each, from 1, and name."""
        return self._source.parts

    def text_of(self, line: int) -> str:
        """The text of a line, from 1; empty where there is none."""
        lines = self._source.lines
        return lines[line - 1] if 0 < line <= len(lines) else ""

    def fail(
        self, code: str, message: str, column: int = 0, width: int = 1, hint: str | None = None
    ) -> NoReturn:
        """Refuse the program.

        Args:
            column: First character in question, from 0.
            width: How many characters.
            hint: What would have worked.
        """
        raise ProgramError(self._diagnostic("error", code, message, column, width, hint))

    def warn(
        self, code: str, message: str, column: int = 0, width: int = 1, hint: str | None = None
    ) -> None:
        """Warn, or refuse when warnings count as errors; arguments as for ``fail``."""
        if self._strict:
            self.fail(code, message, column, width, hint)
        if len(self.warnings) < _MOST_WARNINGS:
            self.warnings.append(self._diagnostic("warning", code, message, column, width, hint))

    def warn_once(
        self, code: str, message: str, column: int = 0, width: int = 1, hint: str | None = None
    ) -> None:
        """Warn of something that holds for the whole program, where it is met first."""
        if code not in self._said:
            self._said.add(code)
            self.warn(code, message, column, width, hint)

    def notice(self, of: str, message: str, column: int = 0, width: int = 1) -> None:
        """Report once that something is ignored, and why nothing of the path is lost.

        It is no reason to refuse a program, also when warnings count as errors.
        """
        if of not in self._said and len(self.warnings) < _MOST_WARNINGS:
            self._said.add(of)
            diagnostic = self._diagnostic("warning", NOTICE, message, column, width, None)
            self.warnings.append(diagnostic)

    @contextmanager
    def quietly(self) -> Iterator[Callable[[], bool]]:
        """Look ahead: diagnostics within are dropped; yields whether there were any."""
        line, said, count = self.line, set(self._said), len(self.warnings)
        try:
            yield lambda: len(self.warnings) > count
        finally:
            self.line, self._said = line, said
            del self.warnings[count:]

    def has_said(self, code: str) -> bool:
        """Whether ``warn_once`` has given this warning."""
        return code in self._said

    def _diagnostic(
        self,
        severity: Severity,
        code: str,
        message: str,
        column: int,
        width: int,
        hint: str | None,
    ) -> Diagnostic:
        file, line = self._source.place(max(1, self.line))
        return Diagnostic(
            severity=severity,
            code=code,
            message=_shortened(message),
            file=file,
            line=line,
            column=column + 1,
            width=width,
            source=self.text_of(self.line),
            hint=None if hint is None else _shortened(hint),
        )


def _shortened(text: str) -> str:
    return text if len(text) <= _LONGEST_TEXT else f"{text[:_LONGEST_TEXT]}..."
