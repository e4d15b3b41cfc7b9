"""The command lines of ``twin link``."""

from pathlib import Path
from typing import Annotated

import typer

from twin.command_line.examples import epilog
from twin.command_line.options import DialectOption, MachineOption

link_app = typer.Typer(no_args_is_help=True, help="Let a real control drive the twin.")


@link_app.command(epilog=epilog("linuxcnc"))
def linuxcnc(
    out: Annotated[Path, typer.Option("--out", help="Folder for results and LinuxCNC's files.")],
    headless: Annotated[
        Path | None,
        typer.Option(
            "--headless", metavar="PROGRAM|JOB.toml", help="Run this without a screen and end."
        ),
    ] = None,
    opened: Annotated[
        Path | None,
        typer.Option(
            "--open", metavar="PROGRAM|JOB.toml", help="Open LinuxCNC's screen with this loaded."
        ),
    ] = None,
    machine: MachineOption = None,
    period_us: Annotated[
        int, typer.Option("--period-us", min=100, max=20000, help="Servo period [µs].")
    ] = 1000,
    display: Annotated[
        str, typer.Option("--display", help="LinuxCNC's screen: axis, qtdragon, gmoccapy, ...")
    ] = "axis",
    ferror: Annotated[
        float | None,
        typer.Option("--ferror", min=1e-6, help="LinuxCNC's FERROR; default: the machine's."),
    ] = None,
    dialect: DialectOption = None,
    view: Annotated[
        bool, typer.Option("--view", help="Show the machine on a page during the run.")
    ] = False,
) -> None:
    """LinuxCNC drives the twin in lock-step: its planner, the twin's drives and axes."""
    from twin.commands.live.link import link_linuxcnc

    code = link_linuxcnc(
        out, headless, opened=opened, machine=machine, dialect=dialect, period_us=period_us, display=display,
        following_error_limit=ferror, view=view,
    )  # fmt: skip
    raise typer.Exit(code)
