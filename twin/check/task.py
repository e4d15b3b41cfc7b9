"""What is sent to another process to be checked: a program or a variant of it, and how to check it."""

import dataclasses
from pathlib import Path

from twin.files.toml import Change


@dataclasses.dataclass(frozen=True, slots=True)
class JobVariant:
    """One run of a sweep."""

    path: Path
    changes: tuple[Change, ...]

    def __str__(self) -> str:
        changed = " ".join(f"{key}={value}" for key, value in self.changes)
        return f"{self.path} {changed}".rstrip()


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class CheckSettings:
    """How programs are checked.

    Attributes:
        machine: Overrides the jobs' machines.
        dialect: Overrides the jobs' dialects.
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
