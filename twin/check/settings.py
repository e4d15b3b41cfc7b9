"""How many programs are to be checked."""

import dataclasses
from pathlib import Path


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
