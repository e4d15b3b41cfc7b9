"""The command line of ``twin serve``."""

from pathlib import Path
from typing import Annotated

import typer

from twin.command_line.options import DialectOption, MachineOption
from twin.errors import UsageError


def serve(
    job: Annotated[
        Path | None,
        typer.Argument(
            metavar="PROGRAM|JOB.toml", help="Made again and again.", show_default=False
        ),
    ] = None,
    scene: Annotated[
        str | None, typer.Option("--scene", help="A training room instead; it opens.")
    ] = None,
    host: Annotated[str, typer.Option("--host", help="Address to listen at.")] = "127.0.0.1",
    port: Annotated[
        int, typer.Option("--port", min=0, max=65535, help="0: the first free from 5000.")
    ] = 0,
    speed: Annotated[
        float,
        typer.Option("--speed", min=0.01, max=1000.0, help="How much faster than the day."),
    ] = 1.0,
    dialect: DialectOption = None,
    machine: MachineOption = None,
) -> None:
    """Tell monitors over MTConnect of a machine that runs a job again and again, or of a room."""
    from twin.commands import serve as agent

    source = agent.Source(host=host, port=port, speed=speed, dialect=dialect, machine=machine)
    if (job is None) == (scene is None):
        raise UsageError("give a program or a job, or --scene and a training scene")
    if scene is not None:
        raise typer.Exit(agent.serve_scene(scene, source))
    assert job is not None
    raise typer.Exit(agent.serve_job(job, source))
