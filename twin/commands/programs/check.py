"""``twin check``: many programs, a table, and files for build servers."""

import functools
import os
from collections.abc import Mapping, Sequence
from pathlib import Path

import typer
from rich.table import Table

from twin.check import forms
from twin.check.discovery import baselines_without_programs, file_of, find_programs, without_jobs
from twin.check.outcome import CheckOutcome, Finding
from twin.check.runner import check_program, run_tasks
from twin.check.task import CheckSettings
from twin.commands.console import table_console
from twin.errors import ExitCode, UsageError
from twin.files.atomic import STDOUT, remove_earlier, require_folder, require_writable, write_text
from twin.run.progress import shown_progress

_STYLES = {
    "pass": "",
    "fail": "bold yellow",
    "alarm": "bold magenta",
    "error": "bold red",
    "empty": "bold red",
}
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
    """Check programs and print their outcomes.

    Interrupted, it reports those that are complete.

    Args:
        paths: Programs, job files, folders, globs.
        junit: Write JUnit XML there; ``-`` is the standard output.
        json_file: Write every outcome as JSON there; ``-`` is the standard output.
        jobs: How many at a time; one for each core by default.
        cluster: Address of the Ray cluster to run on instead; ``local`` starts one here.
        environment: Tells GitHub Actions and GitLab by their variables.

    Returns:
        ``OK`` when every program passes; ``CRASH`` when the twin itself failed at one; else ``FAILED``.

    Raises:
        UsageError: No program was found, or ``--update-baseline`` names no folder.
        OSError: What is to be written cannot be; raised before anything runs.
        KeyboardInterrupt: It was interrupted; what is complete has been reported.
    """
    if settings.update_baseline and settings.baseline is None:
        raise UsageError("--update-baseline needs --baseline DIR")
    for earlier in filter(None, (junit, json_file)):
        remove_earlier(earlier)
    programs = find_programs(paths)
    _require_outputs(settings, junit, json_file)
    if settings.reports is not None:
        for path in programs:
            # A program may be run by the job beside it.
            for named in (path, path.with_suffix(".toml")):
                remove_earlier(file_of(settings.reports, named, ".html"))
    check = functools.partial(check_program, settings=settings)
    outcomes: list[CheckOutcome] = []
    interrupted = False
    try:
        with shown_progress() as progress:
            for outcome in run_tasks(programs, check, jobs=jobs, cluster=cluster):
                outcomes.append(outcome)
                progress("check", len(outcomes) / len(programs))
    except KeyboardInterrupt:
        interrupted = True
    order = {str(path): index for index, path in enumerate(programs)}
    outcomes.sort(key=lambda outcome: order[outcome.program])
    if settings.baseline is not None and not settings.update_baseline:
        outcomes += map(_without_program, baselines_without_programs(settings.baseline))
    # Before the table, so that a terminal that went away loses no file.
    unwritten = write_forms(outcomes, junit, json_file)
    _print(outcomes, to_stderr=STDOUT in (junit, json_file))
    if jobless := without_jobs(programs):
        names = ", ".join(map(str, jobless))
        typer.echo(
            f"run with the defaults, for no job file names them: {names}; "
            "'twin init PROGRAM' writes a job file",
            err=True,
        )
    if interrupted:
        typer.echo(f"interrupted: {len(outcomes)} of {len(programs)} programs checked", err=True)
    if unwritten is not None:
        raise unwritten
    _tell_server(outcomes, environment)
    if interrupted:
        raise KeyboardInterrupt
    return exit_code_of(outcomes)


def write_forms(
    outcomes: Sequence[CheckOutcome], junit: Path | None, json_file: Path | None
) -> OSError | None:
    """Write each file that was asked for, also where another cannot be written.

    Args:
        outcomes: How the programs came out; none where nothing was checked.
        json_file: Where every outcome goes as JSON.

    Returns:
        The first reason why one could not be written.
    """
    reason = None
    for file, text in ((junit, forms.junit_xml), (json_file, forms.json_text)):
        try:
            if file is not None:
                write_text(file, text(outcomes))
        except OSError as error:
            reason = reason or error
    return reason


def _require_outputs(settings: CheckSettings, junit: Path | None, json_file: Path | None) -> None:
    if junit == STDOUT == json_file:
        raise UsageError("--junit - and --json -: only one of them can be the standard output")
    for file in (junit, json_file):
        if file is not None:
            require_writable(file)
    if settings.reports is not None:
        require_folder(settings.reports)
    if settings.baseline is not None and settings.update_baseline:
        require_folder(settings.baseline)


def _without_program(baseline: Path) -> CheckOutcome:
    message = "there is no program or job of this baseline any more: remove it, or bring them back"
    return CheckOutcome(
        program=str(baseline),
        verdict="fail",
        exit_code=ExitCode.FAILED,
        findings=(Finding("baseline-without-program", message, str(baseline)),),
    )


def exit_code_of(outcomes: Sequence[CheckOutcome]) -> ExitCode:
    """Of many programs: whether all pass, one falls short, or the twin itself failed at one."""
    if any(outcome.exit_code is ExitCode.CRASH for outcome in outcomes):
        return ExitCode.CRASH
    return ExitCode.OK if all(outcome.passed for outcome in outcomes) else ExitCode.FAILED


def _print(outcomes: Sequence[CheckOutcome], *, to_stderr: bool) -> None:
    table = Table(box=None, pad_edge=False)
    table.add_column("program", overflow="fold", ratio=1)
    table.add_column("verdict", no_wrap=True)
    for heading in ("contour error", "line", "cycle time"):
        table.add_column(heading, justify="right", no_wrap=True)
    for outcome, row in zip(outcomes, forms.table_rows(outcomes), strict=True):
        table.add_row(*row, style=_STYLES[outcome.verdict])
    table_console(stderr=to_stderr).print(table)
    for outcome in outcomes:
        for finding in (*outcome.warnings, *outcome.findings):
            typer.echo(str(finding), err=True)
    typer.echo(forms.summary_line(outcomes), err=to_stderr)


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
