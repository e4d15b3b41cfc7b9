"""``twin render``."""

from pathlib import Path
from typing import Annotated

import typer

from twin.command_line.options import (
    DialectOption,
    MachineOption,
)


def render(
    recording: Annotated[
        Path,
        typer.Argument(
            metavar="RECORDING|JOB",
            help="recording.h5; or a job file or NC program, which is run first.",
            show_default=False,
        ),
    ],
    out: Annotated[
        Path | None, typer.Option("--out", help="Folder; default: the recording's.")
    ] = None,
    form: Annotated[str, typer.Option("--format", help="Of the film: mp4, gif or webp.")] = "mp4",
    film: Annotated[
        bool, typer.Option("--film", help="Film although stills, --glb or --inspect are given.")
    ] = False,
    at: Annotated[
        list[float] | None, typer.Option("--at", help="Draw a still at this time (s); repeatable.")
    ] = None,
    line: Annotated[
        list[int] | None,
        typer.Option("--line", help="Draw a still at the end of this program line; repeatable."),
    ] = None,
    event: Annotated[
        list[str] | None,
        typer.Option("--event", help="Draw a still of end, worst, alarm, rapid or gouge."),
    ] = None,
    camera: Annotated[
        list[str] | None,
        typer.Option("--camera", help="One after the other; part and riding fit any machine."),
    ] = None,
    split: Annotated[bool, typer.Option("--split", help="All cameras at once.")] = False,
    display: Annotated[
        bool | None,
        typer.Option("--display/--no-display", help="Program, axes and error over the picture."),
    ] = None,
    quality: Annotated[str | None, typer.Option("--quality", help="draft or final.")] = None,
    renderer: Annotated[
        str | None,
        typer.Option("--renderer", help="opengl, or filament: physically based and slower."),
    ] = None,
    seconds: Annotated[
        float | None, typer.Option("--seconds", help="Length of the film (s).")
    ] = None,
    speed: Annotated[
        float | None, typer.Option("--speed", help="Times faster than in reality.")
    ] = None,
    fps: Annotated[int | None, typer.Option("--fps", help="Frames per second.")] = None,
    size: Annotated[str | None, typer.Option("--size", help="Such as 1280x720.")] = None,
    glb: Annotated[
        bool, typer.Option("--glb", help="Write the part in colours, part.glb.")
    ] = False,
    inspect: Annotated[
        str | None,
        typer.Option(
            "--inspect", help="Measure the part against an STL file, or the 'commanded' path."
        ),
    ] = None,
    tolerance: Annotated[
        float | None,
        typer.Option("--tolerance", help="Exit 1 where the part is further off than this (µm)."),
    ] = None,
    dialect: DialectOption = None,
    machine: MachineOption = None,
) -> None:
    """Film a recording or a job, draw stills, write and measure the part."""
    from twin.commands.render import Wanted, render_and_print

    wanted = Wanted(
        video={
            "cameras": tuple(camera) if camera else None,
            "layout": "split" if split else None,
            "display": display,
            "quality": quality,
            "renderer": renderer,
            "seconds": seconds,
            "speed": speed,
            "fps": fps,
            "size": None if size is None else size.lower().split("x"),
        },
        form=form.lower(),
        film=film,
        times=tuple(at or ()),
        lines=tuple(line or ()),
        events=tuple(event or ()),
        glb=glb,
        inspect=inspect,
        tolerance_um=tolerance,
    )
    raise typer.Exit(render_and_print(recording, out, wanted, dialect=dialect, machine=machine))
