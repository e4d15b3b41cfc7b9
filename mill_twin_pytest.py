"""A pytest plugin: job files are tests, so that ``pytest programs/`` is a tolerance suite.

Every TOML file with a key ``program`` that pytest comes across becomes one test, which passes when
``twin check`` would pass it; so does an NC program that is named itself. The tests have the marker
``twin``, the figures of a run are properties of its test in ``--junitxml``. Options:

* ``--twin-machine NAME`` runs all of them on one machine;
* ``--twin-dialect NAME`` reads all of them in one dialect;
* ``--twin-baseline DIR`` holds them to the baselines stored there;
* ``--twin-update-baseline`` stores these again instead;
* ``--twin-strict`` turns the interpreter's warnings into errors.

The plugin is loaded in every project whose environment has it. It stands outside the package
``twin``, which it imports when a job is run and no earlier; where the project under test has a
package ``twin`` of its own, jobs are run by another process.
"""

import importlib.util
import json
import os
import subprocess
import sys
import tomllib
import warnings
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import pytest

MARKER = "twin"
OUR_PACKAGE = Path(__file__).resolve().parent / "twin"
NC_SUFFIXES = frozenset(
    {".nc", ".cnc", ".ngc", ".tap", ".mpf", ".spf", ".iso", ".gcode", ".eia", ".min", ".h"}
)
"""As ``twin.check.discovery`` has them; a test holds the two together."""


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
    named = parent.session.isinitpath(file_path)
    wanted = (file_path.suffix == ".toml" and _is_job(file_path)) or (
        named and file_path.suffix.lower() in NC_SUFFIXES
    )
    return JobCollector.from_parent(parent, path=file_path) if wanted else None


def _is_job(path: Path) -> bool:
    """Whether a TOML file is a job; one that cannot be read is when a program of its name exists."""
    try:
        return isinstance(tomllib.loads(path.read_text(encoding="utf-8")).get("program"), str)
    except (OSError, ValueError):
        return any(path.with_suffix(suffix).is_file() for suffix in NC_SUFFIXES)


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
        outcome = self._here() if _package_is_ours() else self._in_another_process()
        if outcome["contour_um"] is not None:
            names = ("contour_um", "worst_line", "cycle_time_s")
            self.user_properties += [(name, outcome[name]) for name in names]
        self.user_properties += [("scope", line) for line in outcome["scope"]]
        if outcome["expected"] is not None:
            self.user_properties.append(("expected", outcome["expected"]))
        if outcome["warnings"]:
            warning = JobWarning(_told(outcome["warnings"]))
            warnings.warn_explicit(warning, None, str(self.path), 1)
        if outcome["verdict"] != "pass":
            raise JobError(_told(outcome["findings"]))

    def _here(self) -> dict[str, Any]:
        from twin.check.runner import check_program
        from twin.check.task import CheckSettings

        option = self.config.getoption
        baseline = option("--twin-baseline")
        settings = CheckSettings(
            machine=option("--twin-machine"),
            dialect=option("--twin-dialect"),
            strict=bool(option("--twin-strict")),
            baseline=None if baseline is None else Path(baseline),
            update_baseline=bool(option("--twin-update-baseline")),
        )
        return check_program(self.path, settings).as_json()

    def _in_another_process(self) -> dict[str, Any]:
        option = self.config.getoption
        arguments = [str(self.path), "--json", "-"]
        for name in ("machine", "dialect", "baseline"):
            if value := option(f"--twin-{name}"):
                arguments += [f"--{name}", value]
        for name in ("strict", "update-baseline"):
            if option(f"--twin-{name}"):
                arguments.append(f"--{name}")
        # -P: the package is not looked for in the working folder, where the other one may lie.
        done = subprocess.run(
            [sys.executable, "-P", "-m", "twin", "check", *arguments],
            env=os.environ | {"PYTHONPATH": str(OUR_PACKAGE.parent)},
            capture_output=True, text=True, check=False,
        )  # fmt: skip
        try:
            programs = json.loads(done.stdout)["programs"]
        except ValueError:
            raise JobError(done.stderr) from None
        return programs[0]

    def repr_failure(self, excinfo: pytest.ExceptionInfo[BaseException], style: Any = None) -> Any:
        """The diagnostics of the job are the failure's text; anything else is a defect."""
        if isinstance(excinfo.value, JobError):
            return str(excinfo.value)
        return super().repr_failure(excinfo, style)

    def reportinfo(self) -> tuple[Path, int | None, str]:
        """Where the test is, for reports."""
        return self.path, None, f"job {self.name}"


class JobWarning(pytest.PytestWarning):
    """What ``twin check`` warns of in a job."""


class JobError(Exception):
    """A job does not pass; the message holds its diagnostics."""


def _package_is_ours() -> bool:
    """Whether ``import twin`` gives the package that this plugin belongs to."""
    if (loaded := sys.modules.get("twin")) is not None:
        origin = getattr(loaded, "__file__", None)
    else:
        found = importlib.util.find_spec("twin")
        origin = None if found is None else found.origin
    return origin is not None and Path(origin).resolve().parent == OUR_PACKAGE


def _told(findings: list[dict[str, Any]]) -> str:
    return "\n".join(map(_one_told, findings))


def _one_told(finding: dict[str, Any]) -> str:
    place = f"{finding['file']}:{finding['line']}" if finding["line"] else finding["file"]
    return finding["text"] or f"{place}: {finding['message']}"
