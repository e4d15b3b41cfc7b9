"""``twin``: all commands, and the message when one of them fails."""

import traceback
from collections.abc import Sequence
from typing import Annotated, NoReturn

import typer

from twin.command_line.examples import epilog
from twin.command_line.knowledge import dialects, doctor, explain
from twin.command_line.machines import calibrate, machine_app
from twin.command_line.pictures import render
from twin.command_line.programs import init, interpret, plan, run
from twin.command_line.servers import link_app, serve, train, view
from twin.command_line.verdicts import check, compare, export, sweep
from twin.errors import ExitCode, TwinError
from twin.version import __version__

INTERRUPTED = "interrupted: what was complete is kept, nothing is torn"
NO_MEMORY = (
    "not enough memory: a coarser stock.cell, smaller pictures or the draft quality need less"
)
DEFECT = (
    f"twin {__version__} has met a defect of its own, which says nothing about the program: "
    "please report the lines above"
)

app = typer.Typer(
    name="twin",
    help="A digital twin of a 4-axis mill: NC text in, a verdict, a part and a picture out.",
    epilog=epilog("twin"),
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)


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


for command in (
    interpret,
    plan,
    run,
    render,
    check,
    sweep,
    compare,
    calibrate,
    export,
    train,
    view,
    serve,
    dialects,
    explain,
    doctor,
    init,
):
    app.command(epilog=epilog(command.__name__))(command)
app.add_typer(machine_app, name="machine")
app.add_typer(link_app, name="link")


def main(stopped: Sequence[int] = ()) -> None:
    """Run the command line and exit with the code that the contract promises.

    Args:
        stopped: The signals that have asked the process to end; it may grow while the command runs.
    """
    try:
        app()
    except SystemExit as leaving:
        if leaving.code == ExitCode.INTERRUPTED:
            _leave(INTERRUPTED, ExitCode.INTERRUPTED)
        raise
    except Exception as error:  # noqa: BLE001 - whatever it is, it becomes a sentence and a code
        if stopped:
            # Libraries that an interruption passes through may make another error of it.
            _leave(INTERRUPTED, ExitCode.INTERRUPTED)
        _leave(*_sentence(error))


def _sentence(error: Exception) -> tuple[str, ExitCode]:
    """What is said of an error that ends the command, and the code that says it to a program."""
    if isinstance(error, TwinError):
        return str(error), error.exit_code
    if isinstance(error, MemoryError):
        return NO_MEMORY, ExitCode.USAGE
    if isinstance(error, OSError):
        return f"{error.filename or 'a file'}: {error.strerror or error}", ExitCode.USAGE
    traceback.print_exception(error)
    return DEFECT, ExitCode.CRASH


def _leave(message: str, code: ExitCode) -> NoReturn:
    typer.echo(message, err=True)
    raise SystemExit(code)
