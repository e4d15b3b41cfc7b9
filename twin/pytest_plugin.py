"""A pytest plugin: job files are tests, so that ``pytest programs/`` is a tolerance suite.

Every TOML file with a key ``program`` that pytest comes across becomes one test, which passes when
``twin check`` would pass it; so does an NC program that is named itself. The tests have the marker
``twin``, the figures of a run are properties of its test in ``--junitxml``. Options:

* ``--twin-machine NAME`` runs all of them on one machine;
* ``--twin-dialect NAME`` reads all of them in one dialect;
* ``--twin-baseline DIR`` holds them to the baselines stored there;
* ``--twin-update-baseline`` stores these anew instead;
* ``--twin-strict`` turns the interpreter's warnings into errors.
"""

from collections.abc import Iterable
from pathlib import Path
from typing import Any

import pytest

MARKER = "twin"


def pytest_addoption(parser: pytest.Parser) -> None:
    """Add the options of the plugin."""
    group = parser.getgroup("twin", "NC programs on the digital twin")
    group.addoption("--twin-machine", metavar="NAME", help="run every job on this machine")
    group.addoption("--twin-dialect", metavar="NAME", help="read every program in this dialect")
    group.addoption("--twin-baseline", metavar="DIR", help="hold every job to its baseline there")
    group.addoption(
        "--twin-update-baseline", action="store_true", help="store baselines there instead"
    )
    group.addoption("--twin-strict", action="store_true", help="turn warnings into errors")


def pytest_configure(config: pytest.Config) -> None:
    """Make the marker known.

    Raises:
        pytest.UsageError: Baselines are to be stored, but no folder is named.
    """
    config.addinivalue_line("markers", f"{MARKER}: an NC program run on the digital twin")
    if config.getoption("--twin-update-baseline") and not config.getoption("--twin-baseline"):
        raise pytest.UsageError("--twin-update-baseline needs --twin-baseline DIR")


def pytest_collect_file(file_path: Path, parent: pytest.Collector) -> "JobCollector | None":
    """Collect job files, and NC programs that are named on the command line."""
    from twin.check.discovery import NC_SUFFIXES, program_of

    named = parent.session.isinitpath(file_path)
    wanted = (file_path.suffix == ".toml" and program_of(file_path) is not None) or (
        named and file_path.suffix.lower() in NC_SUFFIXES
    )
    return JobCollector.from_parent(parent, path=file_path) if wanted else None


class JobCollector(pytest.File):
    """A job file, or an NC program."""

    def collect(self) -> Iterable["JobItem"]:
        """The one test that it is."""
        yield JobItem.from_parent(self, name=self.path.stem)


class JobItem(pytest.Item):
    """One job, run for its verdict."""

    def __init__(self, **arguments: Any) -> None:
        super().__init__(**arguments)
        self.add_marker(MARKER)

    def runtest(self) -> None:
        """Run the job.

        Raises:
            JobError: It does not pass.
        """
        from twin.check.forms import figures
        from twin.check.settings import CheckSettings
        from twin.check.task import check_program

        option = self.config.getoption
        baseline = option("--twin-baseline")
        settings = CheckSettings(
            machine=option("--twin-machine"),
            dialect=option("--twin-dialect"),
            strict=bool(option("--twin-strict")),
            baseline=None if baseline is None else Path(baseline),
            update_baseline=bool(option("--twin-update-baseline")),
        )
        outcome = check_program(self.path, settings)
        self.user_properties += figures(outcome)
        if outcome.warnings:
            self.add_report_section("call", "warnings", "\n".join(map(str, outcome.warnings)))
        if not outcome.passed:
            raise JobError("\n".join(map(str, outcome.findings)))

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
