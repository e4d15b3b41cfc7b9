"""``twin link linuxcnc``: a real control drives the twin."""

from pathlib import Path

import typer

from twin.commands.run import print_findings, summary
from twin.compilation.announcement import announce_compilation
from twin.errors import ExitCode
from twin.run.preparation import prepare
from twin.run.progress import shown_progress
from twin.run.results import RESULT_FILES, write_results
from twin.run.run import Run
from twin.run.run_folder import run_folder

SECONDS_PER_US = 1e-6


def link_linuxcnc(
    machine: str | None,
    out: Path,
    program: Path,
    *,
    period_us: int,
    dialect: str | None,
    following_error_limit: float | None,
) -> ExitCode:
    """Let LinuxCNC run a program on the twin, and judge it as any run.

    Args:
        machine: Overrides the job's machine.
        out: Folder for the results.
        program: NC program or job file.
        period_us: Servo period of both [µs].
        dialect: Overrides the job's dialect.
        following_error_limit: LinuxCNC's own limit [mm or deg]; None: the machine's.

    Raises:
        TwinError: Something is wrong before the run could end; see each error's exit code.
    """
    from twin.link.session import run_headless

    announce_compilation()
    period = ("machine.servo_period_s", period_us * SECONDS_PER_US)
    run = Run(prepare(program, dialect=dialect, machine=machine, changes=[period]))
    dry_run = run.dry_run()
    with run_folder(out, RESULT_FILES):
        with shown_progress() as progress:
            outcome = run_headless(
                run, dry_run, out, progress,
                following_error_limit=following_error_limit,
                say=lambda text: typer.echo(text, err=True),
            )  # fmt: skip
        write_results(run, outcome, out)
    print_findings(run, outcome)
    typer.echo(summary(run, outcome, out))
    return outcome.verdict.exit_code
