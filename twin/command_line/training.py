"""The command lines of pages: ``twin train`` and ``twin view``."""

from pathlib import Path
from typing import Annotated

import typer


def train(
    scene: Annotated[
        str, typer.Argument(help="A shipped scene's name, or a scene.toml.")
    ] = "fagor_first_steps",
    list_scenes: Annotated[bool, typer.Option("--list", help="List the shipped scenes.")] = False,
    rehearse: Annotated[
        bool, typer.Option("--rehearse", help="Play the scene's solution and mistake, no page.")
    ] = False,
    language: Annotated[
        str | None, typer.Option("--language", help="en, ru, it or cs; default: the scene's.")
    ] = None,
    host: Annotated[
        str | None, typer.Option("--host", help="Listen there; needs --certificate.")
    ] = None,
    port: Annotated[
        int, typer.Option("--port", min=0, max=65535, help="0: the first free from 8080.")
    ] = 0,
    certificate: Annotated[Path | None, typer.Option("--certificate", help="For https.")] = None,
    key: Annotated[Path | None, typer.Option("--key", help="Of the certificate.")] = None,
    out: Annotated[
        Path | None, typer.Option("--out", help="Logs and score sheets; default out/training.")
    ] = None,
) -> None:
    """Run a machine, and wreck it, in a browser: the training room."""
    from twin.commands import train as room

    if list_scenes:
        room.print_scenes(language)
        return
    if rehearse:
        raise typer.Exit(room.rehearse_and_print(scene))
    code = room.train(
        scene, language=language, host=host, port=port, certificate=certificate, key=key, out=out
    )
    raise typer.Exit(code)


def view(
    recording: Annotated[
        Path,
        typer.Argument(
            metavar="RECORDING|JOB",
            help="recording.h5; or a job file or NC program, which is run first.",
            show_default=False,
        ),
    ],
    port: Annotated[
        int, typer.Option("--port", min=0, max=65535, help="0: the first free from 8080.")
    ] = 0,
) -> None:
    """Look at a run in a browser: play, scrub, by line, with its contour error and its part."""
    from twin.commands.view import view as show

    raise typer.Exit(show(recording, port))
