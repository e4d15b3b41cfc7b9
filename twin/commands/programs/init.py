"""``twin init PROGRAM``: a first job file, with what the program itself shows."""

from pathlib import Path

import typer

from twin.errors import ExitCode, UsageError
from twin.files.atomic import write_text
from twin.nc.text.diagnostics.diagnostics import ProgramError
from twin.run.preparing.assumed_job import assumed_job, read_as, reading_notes
from twin.run.preparing.preparation import prepare


def init_and_print(
    program: Path, *, dialect: str | None, machine: str | None, force: bool
) -> ExitCode:
    """Write a job file beside a program.

    Args:
        dialect: Its dialect; recognised by its words by default.
        machine: The machine; ``mill4`` or what ``twin.toml`` sets by default.
        force: Replace a job file that is there.

    Raises:
        UsageError: There is a job file already, or the program's dialect cannot be recognised.
        ProgramError: The program is wrong.
    """
    path = program.with_suffix(".toml")
    if program.suffix == ".toml":
        raise UsageError(f"{program}: give the NC program; its job file is what is written")
    if path.exists() and not force:
        raise UsageError(f"{path}: exists already; --force replaces it")
    preparation = prepare(program, dialect=dialect, machine=machine, assuming=True)
    try:
        assumed = assumed_job(preparation)
    except ProgramError as error:
        raise read_as(error, preparation) from None
    write_text(path, assumed.text)
    for line in reading_notes(preparation, assumed.assumptions):
        typer.echo(line, err=True)
    typer.echo(f"{path}: check the stock and the tools, then: twin run {path}")
    return ExitCode.OK
