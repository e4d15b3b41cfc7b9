"""``twin sweep``: one job with values varied, one line of a table for each combination."""

import functools
from collections.abc import Sequence
from pathlib import Path

import typer
from rich.table import Table

from twin.check import forms
from twin.check.outcome import CheckOutcome
from twin.check.runner import check_variant, run_tasks
from twin.check.task import CheckSettings
from twin.check.variation import variants
from twin.commands.console import table_console
from twin.commands.programs.check import exit_code_of
from twin.errors import ExitCode, UsageError
from twin.files.atomic import STDOUT, remove_earlier, require_writable, write_text
from twin.run.progress import shown_progress


def sweep_and_print(
    path: Path,
    vary: Sequence[str],
    *,
    settings: CheckSettings,
    json_file: Path | None,
    jobs: int | None,
    cluster: str | None,
) -> ExitCode:
    """Run a job for every combination of the values and print how each came out.

    Args:
        vary: ``KEY=VALUES`` each, as ``variants`` reads them.
        jobs: How many at a time; one for each core by default.
        cluster: Address of the Ray cluster to run on instead; ``local`` starts one here.

    Returns:
        ``OK`` when every run passes; ``CRASH`` when the twin itself failed at one; ``USAGE`` when none of the
        combinations is a job that can be run, as with a key that does not exist; else ``FAILED``.

    Raises:
        UsageError: The job is missing, or a text says no values.
    """
    if json_file is not None:
        remove_earlier(json_file)
    if not path.is_file():
        raise UsageError(f"{path}: no such file")
    tasks = variants(path, vary)
    if json_file is not None:
        require_writable(json_file)
    check = functools.partial(check_variant, settings=settings)
    outcomes: list[CheckOutcome] = []
    with shown_progress() as progress:
        for outcome in run_tasks(tasks, check, jobs=jobs, cluster=cluster):
            outcomes.append(outcome)
            progress("sweep", len(outcomes) / len(tasks))
    order = {task.changes: index for index, task in enumerate(tasks)}
    outcomes.sort(key=lambda outcome: order.get(outcome.changes, len(order)))
    if json_file is not None:
        write_text(json_file, forms.json_text(outcomes))
    _print(outcomes, [key for key, _ in tasks[0].changes], to_stderr=json_file == STDOUT)
    if all(outcome.exit_code is ExitCode.USAGE for outcome in outcomes):
        return ExitCode.USAGE
    return exit_code_of(outcomes)


def _print(outcomes: Sequence[CheckOutcome], keys: Sequence[str], *, to_stderr: bool) -> None:
    table = Table(box=None, pad_edge=False)
    for key in keys:
        table.add_column(key.partition(".")[2], justify="right")
    table.add_column("verdict")
    for heading in ("contour error", "line", "cycle time"):
        table.add_column(heading, justify="right")
    for outcome, row in zip(outcomes, forms.table_rows(outcomes), strict=True):
        values = [_shown(value) for _, value in outcome.changes] or ["?"] * len(keys)
        table.add_row(*values, *row[1:])
    table_console(stderr=to_stderr).print(table)
    messages = (each for outcome in outcomes for each in (*outcome.warnings, *outcome.findings))
    for text in dict.fromkeys(map(str, messages)):
        typer.echo(text, err=True)


def _shown(value: object) -> str:
    return f"{value:.6g}" if isinstance(value, float) else str(value)
