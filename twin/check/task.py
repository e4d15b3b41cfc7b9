"""What is sent to another process to be checked: a program or a variant, and how to check it.

What runs programs is loaded by the process that runs one, and not by the one that hands them out.
"""

import dataclasses
from pathlib import Path

from twin.check.outcome import CheckOutcome
from twin.check.variation import Variant


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class CheckSettings:
    """How programs are checked.

    Attributes:
        machine: Overrides the jobs' machines.
        dialect: Overrides the jobs' dialects.
        strict: Warnings of the interpreter are errors.
        baseline: Folder of the baselines that runs are held to, or None.
        update_baseline: Store baselines there instead of holding runs to them.
        reports: Folder for a report on every program that was run, or None.
    """

    machine: str | None = None
    dialect: str | None = None
    strict: bool = False
    baseline: Path | None = None
    update_baseline: bool = False
    reports: Path | None = None


def check_program(path: Path, settings: CheckSettings) -> CheckOutcome:
    """Run a job or a program and say how it came out; what is wrong with it becomes a finding."""
    return check_variant(Variant(path, ()), settings)


def check_variant(variant: Variant, settings: CheckSettings) -> CheckOutcome:
    """The same with some values of the job or the machine changed."""
    from twin.check.program import run_variant

    return run_variant(variant, settings)
