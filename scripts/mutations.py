"""What a baseline catches: programs in the style of other people's posts, changed one thing at a time.

``scripts/mutated`` has the programs, their jobs and the changes. Prints a line for each change: what was
found, and whether it is told at the line that was changed.
"""

import shutil
import sys
import tempfile
import tomllib
from pathlib import Path
from typing import NamedTuple

from twin.check.outcome import CheckOutcome
from twin.check.runner import check_program
from twin.check.task import CheckSettings

MUTATED = Path(__file__).parent / "mutated"
MOST_MISSED = 3
"""Of 42, so that 39 at least are caught."""


class Change(NamedTuple):
    """One change of a program or a job.

    Attributes:
        file: Its name.
        what: In words.
        old: What stands once in the file.
        new: What stands there instead; nothing takes the line away.
    """

    file: str
    what: str
    old: str
    new: str

    def made_in(self, text: str) -> tuple[str, range]:
        """The changed text, and the lines at which the change may be told.

        Raises:
            ValueError: What is to be changed does not stand there exactly once.
        """
        if text.count(self.old) != 1:
            raise ValueError(f"{self.file}: '{self.old}' stands there {text.count(self.old)} times")
        line = text[: text.index(self.old)].count("\n") + 1
        if self.new:
            # A block that goes nowhere any more is lost, which is told at the next one.
            return text.replace(self.old, self.new), range(line, line + 2 + self.new.count("\n"))
        lines = text.splitlines(keepends=True)
        # What is lost is told where it stood: at the next block, or at the table of a key.
        return "".join(lines[: line - 1] + lines[line:]), range(line - 1, line + 3)


def changes() -> list[Change]:
    """Every change."""
    content = tomllib.loads((MUTATED / "mutations.toml").read_text(encoding="utf-8"))
    return [Change(**entry) for entry in content["change"]]


def main() -> int:
    """Try each change; 1 where too many are missed."""
    missed = elsewhere = 0
    with tempfile.TemporaryDirectory() as name:
        root = Path(name)
        for source in MUTATED.iterdir():
            if source.name != "mutations.toml":
                shutil.copy(source, root)
        baselines = CheckSettings(baseline=root / "baselines", update_baseline=True)
        for job in sorted(root.glob("*.toml")):
            stored = check_program(job, baselines)
            if not stored.passed:
                raise SystemExit("\n".join(map(str, stored.findings)))
        tried = changes()
        for change in tried:
            file = root / change.file
            before = file.read_text(encoding="utf-8")
            after, places = change.made_in(before)
            file.write_text(after, encoding="utf-8")
            held = CheckSettings(baseline=root / "baselines")
            outcome = check_program(file.with_suffix(".toml"), held)
            file.write_text(before, encoding="utf-8")
            missed += outcome.passed
            elsewhere += not outcome.passed and not _is_told(outcome, change.file, places)
            print(
                f"{_told(outcome, change.file, places):34} {change.file}:{places[0]}: {change.what}"
            )
    caught = len(tried) - missed
    print(f"{caught} of {len(tried)} caught, {caught - elsewhere} of them told at their place")
    return int(missed > MOST_MISSED)


def _is_told(outcome: CheckOutcome, file: str, places: range) -> bool:
    return any(
        Path(finding.file).name == file and finding.line in places for finding in outcome.findings
    )


def _told(outcome: CheckOutcome, file: str, places: range) -> str:
    if outcome.passed:
        return "MISSED"
    here = [
        each for each in outcome.findings if Path(each.file).name == file and each.line in places
    ]
    first = (here or outcome.findings)[0]
    return first.code if here else f"{first.code} (elsewhere)"


if __name__ == "__main__":
    sys.exit(main())
