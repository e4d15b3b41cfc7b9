"""The outcome of one program of many."""

import dataclasses
from typing import Any, Literal

from twin.errors import ExitCode

CheckVerdict = Literal["pass", "fail", "alarm", "error", "empty"]
"""``empty``: the program holds no block, so that nothing was checked; it counts as a failure.
``error``: the program, its job or its machine is wrong, and nothing was run to its end."""


@dataclasses.dataclass(frozen=True, slots=True)
class Finding:
    """A finding about a program.

    Attributes:
        code: The diagnostic's, alarm's or tolerance's stable name.
        file: The program or file that it is about.
        line: Source line, or 0.
        column: Column, or 0.
        text: The whole diagnostic, with source line, caret and hint where there is one.
    """

    code: str
    message: str
    file: str
    line: int = 0
    column: int = 0
    text: str = ""

    def __str__(self) -> str:
        if self.text:
            return self.text
        place = f"{self.file}:{self.line}" if self.line else self.file
        return f"{place}: {self.message}"


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class CheckOutcome:
    """How one program came out.

    Attributes:
        program: Path of the job file or program, as it was found.
        exit_code: What ``twin run`` would have returned for it.
        contour_um: Greatest contour error [µm]; None when it was not run.
        worst_line: Where that was; 0 when it was not run.
        cycle_time_s: Machine time of the program [s]; None when it was not run.
        wall_s: How long the check took [s].
        findings: Why it does not pass; empty when it does.
        warnings: What the interpreter had to say in addition.
        changes: What a sweep changed for it, keys of job or machine and their values.
        expected: The code that its job expects and that it ended with, so that it passes.
        scope: What the verdict looked at, one sentence each.
    """

    program: str
    verdict: CheckVerdict
    exit_code: ExitCode
    contour_um: float | None = None
    worst_line: int = 0
    cycle_time_s: float | None = None
    wall_s: float = 0.0
    findings: tuple[Finding, ...] = ()
    warnings: tuple[Finding, ...] = ()
    changes: tuple[tuple[str, Any], ...] = ()
    expected: str | None = None
    scope: tuple[str, ...] = ()

    @property
    def passed(self) -> bool:
        """Whether it falls short of nothing."""
        return self.verdict == "pass"

    def as_json(self) -> dict[str, Any]:
        """The outcome as plain values."""
        content = dataclasses.asdict(self)
        content["exit_code"] = int(self.exit_code)
        content["changes"] = dict(self.changes)
        return content


def died(task: str) -> CheckOutcome:
    """The outcome of a task whose process died."""
    message = "the process that ran it died; out of memory?"
    return CheckOutcome(
        program=task,
        verdict="error",
        exit_code=ExitCode.CRASH,
        findings=(Finding("process-died", message, task),),
    )
