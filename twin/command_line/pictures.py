"""``twin render``."""

from pathlib import Path
from typing import Annotated

import typer

from twin.command_line.options import DialectOption, MachineOption

_Recording = Annotated[
    Path,
    typer.Argument(
        metavar="RECORDING|JOB",
        help="recording.h5; or a job file or NC program, which is run first.",
        show_default=False,
    ),
]
_Out = Annotated[Path | None, typer.Option("--out", help="Folder; default: the recording's.")]
_Format = Annotated[str, typer.Option("--format", help="Format of the film: mp4, gif or webp.")]
_Film = Annotated[
    bool, typer.Option("--film", help="Make a film in addition to stills, --glb or --inspect.")
]
_At = Annotated[
    list[float] | None, typer.Option("--at", help="Draw a still at this time (s); repeatable.")
]
_Line = Annotated[
    list[int] | None,
    typer.Option("--line", help="Draw a still at the end of this program line; repeatable."),
]
_Event = Annotated[
    list[str] | None,
    typer.Option("--event", help="Draw a still of end, worst, alarm, rapid or gouge."),
]
_Camera = Annotated[
    list[str] | None,
    typer.Option(
        "--camera", help="Camera; repeatable, one after the other. part and riding fit any machine."
    ),
]
_Split = Annotated[bool, typer.Option("--split", help="Show all cameras at once.")]
_Display = Annotated[
    bool | None,
    typer.Option("--display/--no-display", help="Program, axes and error over the picture."),
]
_Quality = Annotated[str | None, typer.Option("--quality", help="draft or final.")]
_Renderer = Annotated[
    str | None,
    typer.Option("--renderer", help="opengl, or filament: physically based and slower."),
]
_Seconds = Annotated[float | None, typer.Option("--seconds", help="Length of the film (s).")]
_Speed = Annotated[float | None, typer.Option("--speed", help="Times faster than real time.")]
_FramesPerSecond = Annotated[int | None, typer.Option("--fps", help="Frames per second.")]
_Size = Annotated[str | None, typer.Option("--size", help="Such as 1280x720.")]
_Glb = Annotated[bool, typer.Option("--glb", help="Write the part in colours, part.glb.")]
_Inspect = Annotated[
    str | None,
    typer.Option(
        "--inspect", help="Measure the part against an STL file, or the 'commanded' path."
    ),
]
_Tolerance = Annotated[
    float | None,
    typer.Option("--tolerance", help="Exit 1 where the part is further off than this (µm)."),
]


def render(
    recording: _Recording,
    out: _Out = None,
    form: _Format = "mp4",
    film: _Film = False,
    at: _At = None,
    line: _Line = None,
    event: _Event = None,
    camera: _Camera = None,
    split: _Split = False,
    display: _Display = None,
    quality: _Quality = None,
    renderer: _Renderer = None,
    seconds: _Seconds = None,
    speed: _Speed = None,
    fps: _FramesPerSecond = None,
    size: _Size = None,
    glb: _Glb = False,
    inspect: _Inspect = None,
    tolerance: _Tolerance = None,
    dialect: DialectOption = None,
    machine: MachineOption = None,
) -> None:
    """Film a recording or a job, draw stills, write and measure the part."""
    from twin.commands.runs.render import Wanted, render_and_print

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
