"""Outcomes in the forms that build servers read."""

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any
from xml.etree import ElementTree as ET

from twin.check.outcome import CheckOutcome, Finding
from twin.files import write_text

_HEADINGS = ("program", "verdict", "contour error", "line", "cycle time")


def table_rows(outcomes: Sequence[CheckOutcome]) -> list[tuple[str, str, str, str, str]]:
    """The cells of the table for a person, one row a program."""
    return [
        (
            outcome.program,
            outcome.verdict,
            "–" if outcome.contour_um is None else f"{outcome.contour_um:.1f} µm",
            str(outcome.worst_line or "–"),
            "–" if outcome.cycle_time_s is None else f"{outcome.cycle_time_s:.2f} s",
        )
        for outcome in outcomes
    ]


def summary_line(outcomes: Sequence[CheckOutcome]) -> str:
    """How many programs came out how."""
    counts = dict.fromkeys(("pass", "fail", "alarm", "error"), 0)
    for outcome in outcomes:
        counts[outcome.verdict] += 1
    told = ", ".join(f"{count} {name}" for name, count in counts.items() if count)
    return f"{len(outcomes)} programs: {told or 'none'}"


def junit_xml(outcomes: Sequence[CheckOutcome]) -> str:
    """JUnit XML as Jenkins, GitLab and others read it: a test case for each program.

    A tolerance or an alarm is a failure, a program that could not be run an error.
    """
    failures = sum(outcome.verdict in ("fail", "alarm") for outcome in outcomes)
    errors = sum(outcome.verdict == "error" for outcome in outcomes)
    totals = {
        "name": "twin check",
        "tests": str(len(outcomes)),
        "failures": str(failures),
        "errors": str(errors),
        "time": f"{sum(outcome.wall_s for outcome in outcomes):.3f}",
    }
    root = ET.Element("testsuites", totals)
    suite = ET.SubElement(root, "testsuite", totals)
    for outcome in outcomes:
        path = Path(outcome.program)
        case = ET.SubElement(
            suite,
            "testcase",
            {
                "name": path.name,
                "classname": ".".join(part for part in path.parent.parts if part != "/"),
                "file": outcome.program,
                "time": f"{outcome.wall_s:.3f}",
            },
        )
        if outcome.passed:
            continue
        first = outcome.findings[0] if outcome.findings else None
        kind = "error" if outcome.verdict == "error" else "failure"
        problem = ET.SubElement(
            case,
            kind,
            {"type": first.code, "message": _printable(first.message)} if first else {},
        )
        problem.text = _printable("\n".join(str(finding) for finding in outcome.findings))
    ET.indent(root)
    return ET.tostring(root, encoding="unicode", xml_declaration=True) + "\n"


def _printable(text: str) -> str:
    """Without the control characters that XML cannot hold."""
    return "".join(char if char.isprintable() or char in "\n\t" else "\ufffd" for char in text)


def json_text(outcomes: Sequence[CheckOutcome]) -> str:
    """Every outcome as JSON: ``{"schema": 1, "programs": [...]}``."""
    content = {"schema": 1, "programs": [outcome.as_json() for outcome in outcomes]}
    return json.dumps(content, indent=2, ensure_ascii=False) + "\n"


def github_annotations(outcomes: Sequence[CheckOutcome]) -> list[str]:
    """Workflow commands that GitHub Actions shows at the program's line."""
    return [_github_command(finding) for outcome in outcomes for finding in outcome.findings]


def _github_command(finding: Finding) -> str:
    place = {"file": finding.file}
    if finding.line:
        place["line"] = str(finding.line)
    if finding.column:
        place["col"] = str(finding.column)
    place["title"] = finding.code
    properties = ",".join(
        f"{key}={_escaped(value).replace(':', '%3A').replace(',', '%2C')}"
        for key, value in place.items()
    )
    return f"::error {properties}::{_escaped(finding.message)}"


def _escaped(text: str) -> str:
    return text.replace("%", "%25").replace("\r", "%0D").replace("\n", "%0A")


def markdown_summary(outcomes: Sequence[CheckOutcome]) -> str:
    """A summary of the job in Markdown."""
    lines = [
        f"### twin check: {summary_line(outcomes)}",
        "",
        f"| {' | '.join(_HEADINGS)} |",
        "|---|---|--:|--:|--:|",
    ]
    lines += [f"| {' | '.join(map(_cell, row))} |" for row in table_rows(outcomes)]
    findings = [finding for outcome in outcomes for finding in outcome.findings]
    if findings:
        lines += ["", "```", *(str(finding) for finding in findings), "```"]
    return "\n".join(lines) + "\n"


def _cell(text: str) -> str:
    return text.replace("|", "\\|")


def gitlab_code_quality(outcomes: Sequence[CheckOutcome]) -> str:
    """GitLab's code quality report, which it shows at the lines of a merge request."""
    return json.dumps(
        [_quality(finding) for outcome in outcomes for finding in outcome.findings], indent=2
    )


def _quality(finding: Finding) -> dict[str, Any]:
    return {
        "description": finding.message,
        "check_name": finding.code,
        "fingerprint": f"{finding.file}:{finding.line}:{finding.code}",
        "severity": "major",
        "location": {"path": finding.file, "lines": {"begin": max(finding.line, 1)}},
    }


def write_junit(path: Path, outcomes: Sequence[CheckOutcome]) -> None:
    """Write JUnit XML, complete or not at all."""
    write_text(path, junit_xml(outcomes))
