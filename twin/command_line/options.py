"""Arguments and options that several commands share."""

from pathlib import Path
from typing import Annotated

import typer

from twin.errors import UsageError
from twin.files.atomic import STDOUT

Program = Annotated[Path, typer.Argument(help="NC program.", show_default=False)]
ProgramOrJob = Annotated[
    Path,
    typer.Argument(
        metavar="PROGRAM|JOB.toml",
        help="NC program (run by the job file of the same name beside it, if any) or job file.",
        show_default=False,
    ),
]
DialectOption = Annotated[
    str | None,
    typer.Option("--dialect", help="Dialect of the program; default: recognised from it."),
]
OutOption = Annotated[
    Path | None, typer.Option("--out", help="Folder for results; default out/<program>.")
]
MachineOption = Annotated[str | None, typer.Option("--machine", help="Name, or a machine.toml.")]
MachineArgument = Annotated[
    str, typer.Argument(help="A shipped machine's name, or a machine.toml.", show_default=False)
]
JobsOption = Annotated[
    int | None,
    typer.Option(
        "--jobs", min=1, help="Processes at a time; default: all cores, where that is faster."
    ),
]
ClusterOption = Annotated[
    str | None,
    typer.Option("--cluster", help="Run on the Ray cluster at this address; local: start one."),
]
JsonOption = Annotated[
    Path | None,
    typer.Option("--json", help="JSON file to write; -: the standard output, as --format json."),
]
FormatOption = Annotated[str, typer.Option("--format", help="text or json.")]
StrictOption = Annotated[bool, typer.Option("--strict", help="Turn warnings into errors.")]


def json_file_of(form: str, json_file: Path | None) -> Path | None:
    """Where JSON is written by a command that takes both ``--format json`` and ``--json FILE``.

    Raises:
        UsageError: The format is unknown, or both are given.
    """
    if form not in ("text", "json"):
        raise UsageError(f"--format {form}: use text or json")
    if form == "text":
        return json_file
    if json_file is not None:
        raise UsageError("--format json is --json -: give one of them")
    return STDOUT
