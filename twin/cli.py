"""The command line: each command reads its arguments, calls the rooms, and returns an exit code."""

import sys
from pathlib import Path
from typing import Annotated, NoReturn

import typer

from twin import __version__
from twin.errors import ExitCode, TwinError

app = typer.Typer(
    name="twin",
    help="A digital twin of a 4-axis mill: NC text in, a verdict, a part and a picture out.",
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    add_completion=False,
)

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
    typer.Option("--dialect", help="Language of the program; default: told by its words."),
]
MachineOption = Annotated[
    str | None, typer.Option("--machine", help="A shipped machine's name, or a machine.toml.")
]
StrictOption = Annotated[bool, typer.Option("--strict", help="Turn warnings into errors.")]


def _print_version(value: bool) -> None:
    if value:
        typer.echo(f"twin {__version__}")
        raise typer.Exit


@app.callback()
def _root(
    version: Annotated[
        bool,
        typer.Option(
            "--version", callback=_print_version, is_eager=True, help="Print the version."
        ),
    ] = False,
) -> None:
    pass


@app.command()
def interpret(
    program: Program,
    dialect: DialectOption = None,
    machine: MachineOption = None,
    form: Annotated[str, typer.Option("--format", help="text or jsonl.")] = "text",
    strict: StrictOption = False,
) -> None:
    """Print what the interpreter made of a program, before any machine moves."""
    from twin.commands.interpret import print_interpretation

    print_interpretation(program, dialect=dialect, machine=machine, form=form, strict=strict)


@app.command()
def run(
    job: ProgramOrJob,
    out: Annotated[
        Path | None, typer.Option("--out", help="Folder; default out/<program>.")
    ] = None,
    video: Annotated[bool, typer.Option("--video", help="Film the run as video.mp4.")] = False,
    dialect: DialectOption = None,
    machine: MachineOption = None,
    strict: StrictOption = False,
) -> None:
    """Interpret, plan, simulate, compare and cut; write the results and print the verdict."""
    from twin.commands.run import run_and_print

    code = run_and_print(job, out, dialect=dialect, machine=machine, video=video, strict=strict)
    raise typer.Exit(code)


@app.command()
def doctor() -> None:
    """Say what this machine can do: libraries, off-screen pictures, video."""
    from twin.commands.doctor import print_doctor

    raise typer.Exit(print_doctor())


def main() -> None:
    """Run the command line and exit with the code that the contract promises."""
    try:
        app()
    except TwinError as error:
        _leave(str(error), error.exit_code)
    except BrokenPipeError:
        # Whoever read our output has gone (``twin interpret ... | head``): no word helps.
        sys.stderr.close()
        raise SystemExit(ExitCode.OK) from None
    except OSError as error:
        _leave(f"{error.filename or 'a file'}: {error.strerror or error}", ExitCode.USAGE)
    except SystemExit as leaving:
        if leaving.code == ExitCode.INTERRUPTED:
            _leave("interrupted: what was complete is kept, nothing is torn", ExitCode.INTERRUPTED)
        raise


def _leave(message: str, code: ExitCode) -> NoReturn:
    typer.echo(message, err=True)
    raise SystemExit(code)
