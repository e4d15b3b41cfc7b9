"""Jobs that are to end badly: ``expect`` names the alarm, tolerance or diagnostic."""

import dataclasses
from pathlib import Path

from twin.check.outcome import CheckOutcome, Finding
from twin.errors import ExitCode, TwinError
from twin.job.load import load_job


def expectation(path: Path) -> str | None:
    """The code that a job expects; None where it shall pass, or cannot be read."""
    try:
        return load_job(path).file.expect
    except (TwinError, OSError):
        return None


def held_to_expectation(outcome: CheckOutcome, expected: str | None) -> CheckOutcome:
    """Pass a program that ended as its job expects, fail one that did not.

    Args:
        outcome: How it came out by itself.
        expected: The code that its job names, if any.
    """
    if expected is None or outcome.exit_code is ExitCode.CRASH:
        return outcome
    codes = {finding.code for finding in outcome.findings}
    if codes == {expected}:
        return dataclasses.replace(
            outcome, verdict="pass", exit_code=ExitCode.OK, findings=(), expected=expected
        )
    others = tuple(finding for finding in outcome.findings if finding.code != expected)
    if expected not in codes:
        happened = ", ".join(sorted(codes)) or "none"
        message = f"the job expects '{expected}', and it did not happen; what happened: {happened}"
        others = (Finding("expectation", message, outcome.program), *others)
    verdict = "fail" if outcome.passed else outcome.verdict
    code = ExitCode.FAILED if outcome.passed else outcome.exit_code
    return dataclasses.replace(outcome, verdict=verdict, exit_code=code, findings=others)
