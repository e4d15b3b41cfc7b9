"""A job that is to end badly passes when it does so, and in no other case."""

import pytest

from twin.check.expectation import held_to_expectation
from twin.check.outcome import CheckOutcome, Finding
from twin.errors import ExitCode

ALARM = CheckOutcome(
    program="part.toml",
    verdict="alarm",
    exit_code=ExitCode.ALARM,
    findings=(Finding("soft-limit", "X leaves its travel", "part.nc", 3),),
)
PASS = CheckOutcome(program="part.toml", verdict="pass", exit_code=ExitCode.OK)


def test_what_is_expected_passes_and_says_so():
    held = held_to_expectation(ALARM, "soft-limit")
    assert (held.passed, held.exit_code, held.expected) == (True, ExitCode.OK, "soft-limit")
    assert held_to_expectation(ALARM, None) is ALARM


@pytest.mark.parametrize(("outcome", "told"), [(PASS, "none"), (ALARM, "soft-limit")])
def test_what_did_not_happen_fails(outcome: CheckOutcome, told: str):
    held = held_to_expectation(outcome, "collision")
    assert not held.passed
    assert held.exit_code is not ExitCode.OK
    assert held.findings[0].code == "expectation"
    assert told in held.findings[0].message


def test_something_else_beside_it_fails():
    both = CheckOutcome(
        program="part.toml", verdict="alarm", exit_code=ExitCode.ALARM,
        findings=(*ALARM.findings, Finding("baseline-path", "ends at Y1", "part.nc", 2)),
    )  # fmt: skip
    held = held_to_expectation(both, "soft-limit")
    assert not held.passed
    assert [finding.code for finding in held.findings] == ["baseline-path"]


def test_a_defect_is_never_expected():
    crashed = CheckOutcome(program="part.toml", verdict="error", exit_code=ExitCode.CRASH)
    assert held_to_expectation(crashed, "crash") is crashed
