"""``twin doctor``: what this computer can do, and what to install where it cannot."""

import importlib.metadata
import platform
import sys

import typer

from twin.errors import ExitCode
from twin.files.shipped import machine_names

LIBRARIES = ("mujoco", "numpy", "numba", "h5py", "trimesh", "av", "pillow", "matplotlib", "typer")


def print_doctor(*, compile_now: bool = False) -> ExitCode:
    """Print the findings; missing pictures are an error, everything else is optional.

    Args:
        compile_now: Compile every kernel before anything else is done.

    Raises:
        UsageError: Kernels are to be compiled, and there is nowhere to keep them.
    """
    if compile_now:
        from twin.commands.compilation import compile_into_reach

        typer.echo(f"compiled into {compile_into_reach()}")
    from twin.compilation.inventory import inventory
    from twin.render.doctor import render_facts
    from twin.render.drawing.renderer import PACKAGES

    typer.echo(f"python     {platform.python_version()} ({sys.executable})")
    for name in LIBRARIES:
        typer.echo(f"{name:<10} {importlib.metadata.version(name)}")
    typer.echo(f"machines   {', '.join(machine_names())}")
    typer.echo(f"kernels    {inventory()}")
    facts = render_facts()
    typer.echo(f"OpenGL     {facts.backend or 'none'} {facts.renderer}".rstrip())
    filament = facts.filament or f"none (optional): apt-get install {PACKAGES}"
    typer.echo(f"Filament   {filament}")
    typer.echo(f"video      {facts.encoder or 'none'}")
    memory = "unknown" if facts.memory_mb is None else f"{facts.memory_mb:.0f} MB free"
    typer.echo(f"memory     {memory}")
    typer.echo(f"disk       {facts.disk_mb:.0f} MB free")
    for problem in facts.problems:
        typer.echo(f"problem: {problem}", err=True)
    typer.echo("everything works here" if facts.ready else "everything but pictures works here")
    return ExitCode.OK if facts.ready else ExitCode.USAGE
