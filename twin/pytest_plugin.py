"""A pytest plugin: job files are tests, so that ``pytest programs/`` is a tolerance suite.

Every TOML file with a key ``program`` that pytest comes across becomes one test, which passes when
``twin check`` would pass it. Options:

* ``--twin-machine NAME`` runs all of them on one machine;
* ``--twin-baseline DIR`` holds them to the baselines stored there.
"""

import tomllib
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import pytest


def pytest_addoption(parser: pytest.Parser) -> None:
    """Add the options of the plugin."""
    group = parser.getgroup("twin", "NC programs on the digital twin")
    group.addoption("--twin-machine", metavar="NAME", help="run every job on this machine")
    group.addoption("--twin-baseline", metavar="DIR", help="hold every job to its baseline there")


def pytest_collect_file(file_path: Path, parent: pytest.Collector) -> "JobCollector | None":
    """Collect job files."""
    if file_path.suffix == ".toml" and _is_job(file_path):
        return JobCollector.from_parent(parent, path=file_path)
    return None


def _is_job(path: Path) -> bool:
    try:
        return "program" in tomllib.loads(path.read_text(encoding="utf-8"))
    except (OSError, UnicodeDecodeError, tomllib.TOMLDecodeError):
        return False


class JobCollector(pytest.File):
    """A job file."""

    def collect(self) -> Iterable["JobItem"]:
        """The one test that it is."""
        yield JobItem.from_parent(self, name=self.path.stem)


class JobItem(pytest.Item):
    """One job, run for its verdict."""

    def runtest(self) -> None:
        """Run the job.

        Raises:
            JobError: It does not pass.
        """
        from twin.check.program import CheckSettings, check_program

        baseline = self.config.getoption("--twin-baseline")
        settings = CheckSettings(
            machine=self.config.getoption("--twin-machine"),
            baseline=None if baseline is None else Path(baseline),
        )
        outcome = check_program(self.path, settings)
        if not outcome.passed:
            raise JobError("\n".join(str(finding) for finding in outcome.findings))

    def repr_failure(self, excinfo: pytest.ExceptionInfo[BaseException], style: Any = None) -> Any:
        """The diagnostics of the job are the failure's text; anything else is a defect."""
        if isinstance(excinfo.value, JobError):
            return str(excinfo.value)
        return super().repr_failure(excinfo, style)

    def reportinfo(self) -> tuple[Path, int | None, str]:
        """Where the test stands, for reports."""
        return self.path, None, f"job {self.name}"


class JobError(Exception):
    """A job does not pass; the message holds its diagnostics."""
