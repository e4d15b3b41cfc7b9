"""What one program does: ``twin interpret``, ``plan`` and ``run``; and ``init``, its first job."""

from pathlib import Path
from typing import Annotated

import typer

from twin.command_line.options import (
    DialectOption,
    FormatOption,
    MachineOption,
    OutOption,
    Program,
    ProgramOrJob,
    StrictOption,
)


def interpret(
    program: Program,
    dialect: DialectOption = None,
    machine: MachineOption = None,
    form: Annotated[str, typer.Option("--format", help="text or jsonl.")] = "text",
    strict: StrictOption = False,
) -> None:
    """Print what the interpreter made of a program, before any machine moves."""
    from twin.commands.programs.interpret import print_interpretation

    print_interpretation(program, dialect=dialect, machine=machine, form=form, strict=strict)


def plan(
    job: ProgramOrJob,
    out: OutOption = None,
    dialect: DialectOption = None,
    machine: MachineOption = None,
    form: FormatOption = "text",
    strict: StrictOption = False,
) -> None:
    """Print the cycle time and where it is lost, and draw feed and axis speeds."""
    from twin.commands.programs.plan import plan_and_print

    plan_and_print(job, out, dialect=dialect, machine=machine, form=form, strict=strict)


def run(
    job: ProgramOrJob,
    out: OutOption = None,
    video: Annotated[bool, typer.Option("--video", help="Film the run as video.mp4.")] = False,
    dialect: DialectOption = None,
    machine: MachineOption = None,
    strict: StrictOption = False,
    save_job: Annotated[
        Path | None,
        typer.Option("--save-job", help="Write the job that is assumed for a raw program."),
    ] = None,
) -> None:
    """Interpret, plan, simulate, compare and cut; write the results and print the verdict."""
    from twin.commands.runs.run import run_and_print

    code = run_and_print(
        job, out, dialect=dialect, machine=machine, video=video, strict=strict, save_job=save_job
    )
    raise typer.Exit(code)


def init(
    program: Program,
    dialect: DialectOption = None,
    machine: MachineOption = None,
    force: Annotated[bool, typer.Option("--force", help="Replace a job file.")] = False,
) -> None:
    """Write a first job file beside a program, with stock and tools derived from the program."""
    from twin.commands.programs.init import init_and_print

    code = init_and_print(program, dialect=dialect, machine=machine, force=force)
    raise typer.Exit(code)
