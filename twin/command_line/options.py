"""Arguments and options that several commands share."""

from pathlib import Path
from typing import Annotated

import typer

Program = Annotated[Path, typer.Argument(help="NC program.", show_default=False)]
ProgramOrJob = Annotated[
    Path,
    typer.Argument(
        metavar="PROGRAM|JOB.toml",
        help="NC program (run by the job file of the same name beside it, if any) or job file.",
        show_default=False,
    ),
]
DialectOption = Annotated[str | None, typer.Option("--dialect", help="Default: told by its words.")]
OutOption = Annotated[Path | None, typer.Option("--out", help="Folder; default out/<program>.")]
MachineOption = Annotated[str | None, typer.Option("--machine", help="Name, or a machine.toml.")]
MachineArgument = Annotated[
    str, typer.Argument(help="A shipped machine's name, or a machine.toml.", show_default=False)
]
JobsOption = Annotated[
    int | None, typer.Option("--jobs", min=1, help="How many at a time; default: all cores.")
]
ClusterOption = Annotated[
    str | None,
    typer.Option("--cluster", help="Run on the Ray cluster at this address; local: start one."),
]
FormatOption = Annotated[str, typer.Option("--format", help="text or json.")]
StrictOption = Annotated[bool, typer.Option("--strict", help="Turn warnings into errors.")]
