"""``twin run``: the whole chain into a folder, and the verdict for a person."""

from pathlib import Path

import typer

from twin.commands.runs.pictures import ALARMS_OF_CONTACT, draw_contact, film_run
from twin.compilation.announcement import announce_compilation
from twin.errors import ExitCode, RenderError, UsageError
from twin.files.atomic import write_text
from twin.run.judging.outcome import Outcome
from twin.run.messages import alarm_diagnostic, near_miss_diagnostic, reason_text
from twin.run.preparing.assumed_job import AssumedJob, prepare_run, reading_notes, text_beside
from twin.run.preparing.preparation import Preparation
from twin.run.progress import shown_progress
from twin.run.results import RESULT_FILES, write_results
from twin.run.run import Run
from twin.run.run_folder import program_stem, run_folder, without_verdict


def run_and_print(
    path: Path,
    out: Path | None,
    *,
    dialect: str | None,
    machine: str | None,
    video: bool,
    strict: bool,
    save_job: Path | None = None,
) -> ExitCode:
    """Run a program or a job, write its results and print the verdict.

    Args:
        out: Folder for the results; ``out/<program>`` by default.
        video: Film the run too.
        save_job: Where the job is kept that is assumed for a raw program.

    Raises:
        TwinError: Something is wrong before the run could end; see each error's exit code.
    """

    def compile_meanwhile() -> None:
        from twin.commands.compilation import start_compiling

        start_compiling(path, dialect, machine)

    announce_compilation(meanwhile=compile_meanwhile)
    folder = out or Path("out") / program_stem(path)
    with without_verdict(folder):
        preparation, assumed = prepare_run(path, dialect=dialect, machine=machine, strict=strict)
        if assumed is not None:
            _tell_assumed(preparation, assumed, save_job)
        elif save_job is not None:
            raise UsageError(f"--save-job: {preparation.job.path} is the program's job already")
        run = Run(preparation)
    with run_folder(folder, RESULT_FILES):
        with shown_progress() as progress:
            outcome = run.execute(folder, progress)
            if video and outcome.samples:
                with run.clock.stage("render"):
                    film_run(run, folder, progress)
            if any(alarm.code in ALARMS_OF_CONTACT for alarm in outcome.alarms):
                with run.clock.stage("render"):
                    _draw_contact(run, folder, outcome.alarms[0].line)
        write_results(run, outcome, folder)
    print_findings(run, outcome)
    for line in outcome.scope.lines():
        typer.echo(f"  {line}")
    typer.echo(summary(run, outcome, folder))
    return outcome.verdict.exit_code


def _tell_assumed(preparation: Preparation, assumed: AssumedJob, save_job: Path | None) -> None:
    """Print the job that is assumed for a raw program, and keep it where that is asked for."""
    if save_job is not None and save_job.exists():
        raise UsageError(f"{save_job}: exists already")
    for line in reading_notes(preparation, assumed.assumptions):
        typer.echo(line, err=True)
    if save_job is None:
        typer.echo("to keep and correct this: --save-job FILE", err=True)
    else:
        write_text(save_job, text_beside(save_job, assumed, preparation.job.program))
        typer.echo(f"the job is kept in {save_job}", err=True)


def _draw_contact(run: Run, folder: Path, line: int) -> None:
    """Draw the moment for the report; the alarm is printed even where no picture can be made."""
    try:
        draw_contact(run, folder, line)
    except RenderError as error:
        typer.echo(f"no picture of the alarm: {error}", err=True)


def print_findings(run: Run, outcome: Outcome) -> None:
    """Print what the interpreter, the machine and the verdict found."""
    for warning in outcome.warnings:
        typer.echo(str(warning), err=True)
    if outcome.near_miss is not None:
        miss = near_miss_diagnostic(outcome.near_miss, run.preparation.source)
        typer.echo(str(miss), err=True)
    for alarm in outcome.alarms:
        typer.echo(str(alarm_diagnostic(alarm, run.preparation.source)), err=True)
    if not outcome.alarms:
        for reason in outcome.verdict.reasons:
            typer.echo(reason_text(reason, run.preparation.source), err=True)


def summary(run: Run, outcome: Outcome, folder: Path) -> str:
    """The verdict in a line."""
    contour = outcome.figures.contour
    if outcome.alarms:
        first = outcome.alarms[0]
        finding = f"{first.code} at line {first.line}"
    elif outcome.duration_s == 0.0:
        finding = "nothing moves"
    else:
        finding = f"contour error at most {contour.max:.1f} µm (line {contour.worst_line})"
    reasons = dict.fromkeys(reason.what for reason in outcome.verdict.reasons)
    by = f" by {', '.join(reasons)}" if reasons and not outcome.alarms else ""
    return (
        f"{outcome.verdict.outcome}{by}: {finding}, {outcome.duration_s:.3f} s of machine time "
        f"in {run.clock.wall_s:.1f} s; results in {folder}"
    )
