"""The command line of ``twin serve``."""

from typing import Annotated

import typer

from twin.command_line.options import DialectOption, MachineOption, ProgramOrJob


def serve(
    job: ProgramOrJob,
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
    """Tell monitors over MTConnect of a machine that runs a job again and again."""
    from twin.commands import serve as agent

    code = agent.serve(job, host=host, port=port, speed=speed, dialect=dialect, machine=machine)
    raise typer.Exit(code)
