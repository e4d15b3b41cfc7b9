"""What all tests share: the command line in the test's own process, kinds of tests, and what they cost."""

import gc
import os
import sys
from collections.abc import Iterator
from importlib.util import find_spec

import pytest
from browsers import missing_for_browsers, missing_for_pages
from command_line import Finished, Twin
from hypothesis import HealthCheck, settings

from twin import cli
from twin.__main__ import COLLECT_AFTER
from twin.nc.line_kernel.plain_state import VARIABLE

# What is compiled beside a run, and when it is ready, would differ from one run of the tests to the next.
os.environ.setdefault(VARIABLE, "wait")
# As the command does: what is loaded, collected and compiled stays, and is searched for garbage in vain.
gc.set_threshold(COLLECT_AFTER)
# How long examples take to draw is the machine's load: a property fails by its examples alone.
settings.register_profile(
    "untimed", deadline=None, suppress_health_check=[HealthCheck.too_slow], print_blob=True
)
settings.register_profile("short", settings.get_profile("untimed"), max_examples=20)
settings.load_profile("untimed")

KINDS = frozenset(
    {"thorough", "browser", "played", "processes", "oracle", "documentation", "bench"}
)
"""Markers of what ``scripts/test`` leaves to ``scripts/test --all``."""
_NEED = {
    "api/test_feed_environment.py": "gymnasium",
    "cutting/tridexel/test_mesh_booleans.py": "manifold3d",
    "compare/report/test_report_page.py": "playwright",
    "fmu/test_unit_file.py": "fmpy",
    "motion/profile/test_time_optimality.py": "toppra",
    "serve/test_independent_client.py": "pymtconnect",
    "serve/test_official_schemas.py": "xmlschema",
    "serve/test_schemas.py": "xmlschema",
}
"""Exhaustive tests that cannot even be read without a package of the extra ``exhaustive``."""
collect_ignore = [file for file, package in _NEED.items() if find_spec(package) is None]
BY_HAND = "by_hand"
"""Marker of tests that run where ``-m`` names it, and else nowhere."""
_BEGUN = pytest.StashKey[float]()
_COST = "processor_seconds"


@pytest.hookimpl(trylast=True)
def pytest_itemcollected(item: pytest.Item) -> None:
    """Mark what is of one of the kinds, so that one word leaves all of them out; and what cannot run here."""
    if any(item.get_closest_marker(kind) for kind in KINDS):
        item.add_marker("exhaustive")
    missing: dict[str, str] = {}
    if item.get_closest_marker("browser"):
        missing = missing_for_browsers()
    elif item.get_closest_marker("three_js"):
        missing = missing_for_pages()
    for what, how in missing.items():
        item.add_marker(pytest.mark.skip(f"{what} is missing: {how}"))


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Leave out what runs by hand alone, unless it is asked for."""
    if BY_HAND in config.option.markexpr:
        return
    left_out = [item for item in items if item.get_closest_marker(BY_HAND)]
    items[:] = [item for item in items if not item.get_closest_marker(BY_HAND)]
    config.hook.pytest_deselected(items=left_out)


def pytest_collection_finish() -> None:
    """Nothing that was collected is garbage before the end."""
    gc.collect()
    gc.freeze()


def pytest_report_header() -> list[str]:
    """Name what is left out, and why."""
    return [
        f"tests marked {BY_HAND} are left out: -m {BY_HAND} runs them",
        *(
            f"tests/{file} is left out: {_NEED[file]} is missing, which the extra 'exhaustive' brings"
            for file in collect_ignore
        ),
    ]


@pytest.hookimpl(tryfirst=True)
def pytest_runtest_setup(item: pytest.Item) -> None:
    item.stash[_BEGUN] = _processor_seconds()


@pytest.hookimpl(wrapper=True)
def pytest_runtest_teardown(item: pytest.Item) -> Iterator[None]:
    """Note what a test cost that says no reason for taking long."""
    yield
    if not any(item.get_closest_marker(each) for each in ("exhaustive", "seconds")):
        cost = _processor_seconds() - item.stash[_BEGUN]
        item.user_properties.append((_COST, cost))


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter) -> None:
    """Name the tests that took more than a second of processor time without a reason."""
    costs = [
        (float(value), report.nodeid)
        for reports in terminalreporter.stats.values()
        for report in reports
        if getattr(report, "when", None) == "teardown"
        for name, value in report.user_properties
        if name == _COST and float(value) > 1.0
    ]
    if costs:
        terminalreporter.section("more than a second of processor time, without a reason")
        for cost, name in sorted(costs, reverse=True):
            terminalreporter.write_line(f"{cost:6.1f} s  {name}")


def _processor_seconds() -> float:
    """Of this process and of those that it waited for."""
    return sum(os.times()[:4])


@pytest.fixture
def twin(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> Twin:
    """Call the command with arguments; a traceback would fail the test by itself."""

    def call(*arguments: object) -> Finished:
        monkeypatch.setattr(sys, "argv", ["twin", *map(str, arguments)])
        with pytest.raises(SystemExit) as left:
            cli.main()
        captured = capsys.readouterr()
        return Finished(int(left.value.code or 0), captured.out, captured.err)

    return call
