"""``twin check``: many programs, a table for a person, and what the build server wants."""

import functools
import os
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path

import typer
from rich.console import Console
from rich.table import Table

from twin.check import forms
from twin.check.discovery import find_programs
from twin.check.outcome import CheckOutcome
from twin.check.runner import run_tasks
from twin.check.settings import CheckSettings
from twin.check.task import check_program
from twin.errors import ExitCode, UsageError
from twin.files.atomic import write_text
from twin.run.progress import shown_progress

_STYLES = {"pass": "", "fail": "bold yellow", "alarm": "bold magenta", "error": "bold red"}
_LOG_WIDTH = 160
CODE_QUALITY_FILE = "gl-code-quality-report.json"
"""Where GitLab's examples look for the report; written to the working folder on GitLab alone."""


def check_and_print(
    paths: Sequence[str],
    *,
    settings: CheckSettings,
    junit: Path | None = None,
    json_file: Path | None = None,
    jobs: int | None = None,
    cluster: str | None = None,
    environment: Mapping[str, str] = os.environ,
) -> ExitCode:
    """Check programs and tell how they came out.

    Args:
        paths: Programs, job files, folders, globs.
        settings: How each is checked.
        junit: Write JUnit XML there.
        json_file: Write every outcome as JSON there.
        jobs: How many at a time; one for each core by default.
        cluster: Address of the Ray cluster to run on instead; ``local`` starts one here.
        environment: Tells GitHub Actions and GitLab by their variables.

    Returns:
        ``OK`` when every program passes, else ``FAILED``.

    Raises:
        UsageError: No program was found, or ``--update-baseline`` names no folder.
    """
    if settings.update_baseline and settings.baseline is None:
        raise UsageError("--update-baseline needs --baseline DIR")
    programs = find_programs(paths)
    check = functools.partial(check_program, settings=settings)
    outcomes: list[CheckOutcome] = []
    with shown_progress() as progress:
        for outcome in run_tasks(programs, check, jobs=jobs, cluster=cluster):
            outcomes.append(outcome)
            progress("check", len(outcomes) / len(programs))
    order = {str(path): index for index, path in enumerate(programs)}
    outcomes.sort(key=lambda outcome: order[outcome.program])
    _print(outcomes)
    if junit is not None:
        forms.write_junit(junit, outcomes)
    if json_file is not None:
        write_text(json_file, forms.json_text(outcomes))
    _tell_server(outcomes, environment)
    return ExitCode.OK if all(outcome.passed for outcome in outcomes) else ExitCode.FAILED


def _print(outcomes: Sequence[CheckOutcome]) -> None:
    table = Table(box=None, pad_edge=False)
    table.add_column("program", overflow="fold")
    table.add_column("verdict")
    for heading in ("contour error", "line", "cycle time"):
        table.add_column(heading, justify="right")
    for outcome, row in zip(outcomes, forms.table_rows(outcomes), strict=True):
        table.add_row(*row, style=_STYLES[outcome.verdict])
    # In a log nothing is gained by folding at 80 columns.
    Console(width=None if sys.stdout.isatty() else _LOG_WIDTH).print(table)
    for outcome in outcomes:
        for finding in outcome.findings:
            typer.echo(str(finding), err=True)
    typer.echo(forms.summary_line(outcomes))


def _tell_server(outcomes: Sequence[CheckOutcome], environment: Mapping[str, str]) -> None:
    if environment.get("GITHUB_ACTIONS") == "true":
        root = Path(environment.get("GITHUB_WORKSPACE") or ".")
        for command in forms.github_annotations(outcomes, root):
            typer.echo(command)
        if summary := environment.get("GITHUB_STEP_SUMMARY"):
            with Path(summary).open("a", encoding="utf-8") as file:
                file.write(forms.markdown_summary(outcomes))
    if environment.get("GITLAB_CI") == "true":
        root = Path(environment.get("CI_PROJECT_DIR") or ".")
        write_text(Path(CODE_QUALITY_FILE), forms.gitlab_code_quality(outcomes, root))
