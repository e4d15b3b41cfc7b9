"""Outcomes in the forms that build servers read."""

import hashlib
import json
import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any
from xml.etree import ElementTree as ET

from twin.check.outcome import CheckOutcome, Finding

_HEADINGS = ("program", "verdict", "contour error", "line", "cycle time")


def table_rows(outcomes: Sequence[CheckOutcome]) -> list[tuple[str, str, str, str, str]]:
    """The cells of the table for a person, one row a program."""
    return [
        (
            outcome.program,
            outcome.verdict if outcome.expected is None else f"pass: {outcome.expected} expected",
            "–" if outcome.contour_um is None else f"{outcome.contour_um:.1f} µm",
            str(outcome.worst_line or "–"),
            "–" if outcome.cycle_time_s is None else f"{outcome.cycle_time_s:.2f} s",
        )
        for outcome in outcomes
    ]


def figures(outcome: CheckOutcome) -> list[tuple[str, object]]:
    """Name and value of what a run came to; empty for a program that was not run."""
    if outcome.contour_um is None:
        return []
    return [
        ("contour_um", round(outcome.contour_um, 3)),
        ("worst_line", outcome.worst_line),
        ("cycle_time_s", outcome.cycle_time_s),
    ]


def summary_line(outcomes: Sequence[CheckOutcome]) -> str:
    """How many programs came out how, and how many warnings there were."""
    counts = dict.fromkeys(("pass", "fail", "alarm", "error", "empty"), 0)
    for outcome in outcomes:
        counts[outcome.verdict] += 1
    expected = sum(outcome.expected is not None for outcome in outcomes)
    listed = ", ".join(f"{count} {name}" for name, count in counts.items() if count)
    listed += f" ({expected} of them fail as their jobs expect)" if expected else ""
    warnings = sum(len(outcome.warnings) for outcome in outcomes)
    noun = "program" if len(outcomes) == 1 else "programs"
    counted = f"; {warnings} {'warning' if warnings == 1 else 'warnings'}" if warnings else ""
    return f"{len(outcomes)} {noun}: {listed or 'none'}{counted}"


def junit_xml(outcomes: Sequence[CheckOutcome]) -> str:
    """JUnit XML as Jenkins (``junit-10.xsd``), GitLab and others read it: a test case a program.

    A tolerance or an alarm is a failure, a program that could not be run an error.
    """
    failures = sum(outcome.verdict in ("fail", "alarm", "empty") for outcome in outcomes)
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
        _add_case(suite, outcome)
    ET.indent(root)
    return ET.tostring(root, encoding="unicode", xml_declaration=True) + "\n"


def _add_case(suite: ET.Element, outcome: CheckOutcome) -> None:
    path = Path(outcome.program)
    name = {
        "name": _printable(path.name),
        "classname": _printable(".".join(part for part in path.parent.parts if part != "/")),
        "time": f"{outcome.wall_s:.3f}",
    }
    case = ET.SubElement(suite, "testcase", name)
    if not outcome.passed:
        first = outcome.findings[0]
        kind = "error" if outcome.verdict == "error" else "failure"
        about = {"type": first.code, "message": _printable(first.message)}
        problem = ET.SubElement(case, kind, about)
        problem.text = _printable("\n".join(str(finding) for finding in outcome.findings))
    listed = [*(f"{key}: {value}" for key, value in figures(outcome)), *outcome.scope]
    listed = (
        listed
        if outcome.expected is None
        else [f"ended as its job expects: {outcome.expected}", *listed]
    )
    if listed:
        ET.SubElement(case, "system-out").text = _printable("\n".join(listed))
    if outcome.warnings:
        text = "\n".join(str(warning) for warning in outcome.warnings)
        ET.SubElement(case, "system-err").text = _printable(text)


def _printable(text: str) -> str:
    """Without the control characters that XML cannot hold."""
    return "".join(char if char.isprintable() or char in "\n\t" else "\ufffd" for char in text)


def json_text(outcomes: Sequence[CheckOutcome]) -> str:
    """Every outcome as JSON: ``{"schema": 1, "programs": [...]}``."""
    content = {"schema": 1, "programs": [outcome.as_json() for outcome in outcomes]}
    return json.dumps(content, indent=2, ensure_ascii=False) + "\n"


def github_annotations(outcomes: Sequence[CheckOutcome], root: Path) -> list[str]:
    """Workflow commands that GitHub Actions shows at the program's line.

    Args:
        root: Folder of the repository, which GitHub's paths are relative to.
    """
    errors = [("error", finding) for outcome in outcomes for finding in outcome.findings]
    warnings = [("warning", finding) for outcome in outcomes for finding in outcome.warnings]
    return [_github_command(kind, finding, root) for kind, finding in errors + warnings]


def _github_command(kind: str, finding: Finding, root: Path) -> str:
    place = {"file": _within(finding.file, root)}
    if finding.line:
        place["line"] = str(finding.line)
    if finding.column:
        place["col"] = str(finding.column)
    place["title"] = finding.code
    properties = ",".join(
        f"{key}={_escaped(value).replace(':', '%3A').replace(',', '%2C')}"
        for key, value in place.items()
    )
    return f"::{kind} {properties}::{_escaped(finding.message)}"


def _within(file: str, root: Path) -> str:
    """A path as a server knows it: relative to the repository where it lies there."""
    path, root = Path(file).resolve(), root.resolve()
    return path.relative_to(root).as_posix() if path.is_relative_to(root) else file


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
    findings = [
        finding for outcome in outcomes for finding in (*outcome.findings, *outcome.warnings)
    ]
    if findings:
        lines += ["", "```", *(str(finding) for finding in findings), "```"]
    return "\n".join(lines) + "\n"


def _cell(text: str) -> str:
    return text.replace("|", "\\|")


def gitlab_code_quality(outcomes: Sequence[CheckOutcome], root: Path) -> str:
    """GitLab's code quality report, which it shows at the lines of a merge request.

    Args:
        root: Folder of the repository, which GitLab's paths are relative to.
    """
    major = [("major", finding) for outcome in outcomes for finding in outcome.findings]
    minor = [("minor", finding) for outcome in outcomes for finding in outcome.warnings]
    entries = [_quality(severity, finding, root) for severity, finding in major + minor]
    # GitLab drops what has a fingerprint that it has seen; one program may run in two jobs.
    distinct = {entry["fingerprint"]: entry for entry in entries}
    return json.dumps(list(distinct.values()), indent=2, ensure_ascii=False) + "\n"


def _quality(severity: str, finding: Finding, root: Path) -> dict[str, Any]:
    file = _within(finding.file, root)
    # Without the values, so that the same finding is known again when it has grown.
    about = re.sub(r"[\d.]+", "", finding.message)
    what = f"{file}:{finding.line}:{finding.column}:{finding.code}:{about}"
    return {
        "description": finding.message,
        "check_name": finding.code,
        "fingerprint": hashlib.sha256(what.encode()).hexdigest(),
        "severity": severity,
        "location": {"path": file, "lines": {"begin": max(finding.line, 1)}},
    }
