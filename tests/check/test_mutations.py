"""What a baseline catches of changes as people and post-processors make them: ``mutated`` has all of them."""

import shutil
import tomllib
from pathlib import Path
from typing import NamedTuple

import pytest

from twin.check.outcome import CheckOutcome
from twin.check.runner import check_program
from twin.check.task import CheckSettings

MUTATED = Path(__file__).parent / "mutated"
MOST_MISSED = 3
"""Of 42, so that 39 at least are caught."""
MOST_ELSEWHERE = 3
"""Caught, but at another place than that of the change."""


class Change(NamedTuple):
    """One change of a program or a job.

    Attributes:
        file: Its name.
        what: In words.
        old: What occurs once in the file.
        new: What is there instead; nothing takes the line away.
    """

    file: str
    what: str
    old: str
    new: str

    def made_in(self, text: str) -> tuple[str, range]:
        """The changed text, and the lines at which the change may be reported.

        Raises:
            ValueError: What is to be changed does not stand there exactly once.
        """
        if text.count(self.old) != 1:
            raise ValueError(f"{self.file}: '{self.old}' stands there {text.count(self.old)} times")
        line = text[: text.index(self.old)].count("\n") + 1
        if self.new:
            # A block that goes nowhere any more is lost, which is reported at the next one.
            return text.replace(self.old, self.new), range(line, line + 2 + self.new.count("\n"))
        lines = text.splitlines(keepends=True)
        # What is lost is told where it stood: at the next block, or at the table of a key.
        return "".join(lines[: line - 1] + lines[line:]), range(line - 1, line + 3)


def changes() -> list[Change]:
    """Every change."""
    content = tomllib.loads((MUTATED / "mutations.toml").read_text(encoding="utf-8"))
    return [Change(**entry) for entry in content["change"]]


@pytest.mark.thorough
def test_a_baseline_catches_nearly_every_change_at_its_place(tmp_path: Path) -> None:
    """Four programs in the style of what people post; one thing at a time is changed in them or their jobs."""
    for source in MUTATED.iterdir():
        if source.name != "mutations.toml":
            shutil.copy(source, tmp_path)
    baselines = CheckSettings(baseline=tmp_path / "baselines", update_baseline=True)
    for job in sorted(tmp_path.glob("*.toml")):
        stored = check_program(job, baselines)
        assert stored.passed, "\n".join(map(str, stored.findings))
    missed, elsewhere = [], []
    for change in changes():
        file = tmp_path / change.file
        before = file.read_text(encoding="utf-8")
        after, places = change.made_in(before)
        file.write_text(after, encoding="utf-8")
        held = CheckSettings(baseline=tmp_path / "baselines")
        outcome = check_program(file.with_suffix(".toml"), held)
        file.write_text(before, encoding="utf-8")
        if outcome.passed:
            missed.append(f"{change.file}: {change.what}")
        elif not _is_told(outcome, change.file, places):
            elsewhere.append(f"{change.file}: {change.what}")
    assert len(changes()) == 42
    assert len(missed) <= MOST_MISSED, missed
    assert len(elsewhere) <= MOST_ELSEWHERE, elsewhere


def _is_told(outcome: CheckOutcome, file: str, places: range) -> bool:
    return any(
        Path(finding.file).name == file and finding.line in places for finding in outcome.findings
    )
