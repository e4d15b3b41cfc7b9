"""The way from logs of a real machine to its machine file: ``twin calibrate``."""

from pathlib import Path
from typing import Annotated

import typer

from twin.command_line.options import FormatOption, JsonOption, json_file_of


def calibrate(
    logs: Annotated[
        list[Path] | None, typer.Argument(help="Logs to fit.", show_default=False)
    ] = None,
    base: Annotated[
        str, typer.Option("--base", help="Machine whose values stay where the logs determine none.")
    ] = "mill4",
    columns: Annotated[
        Path | None, typer.Option("--columns", help="Map of columns and units (TOML).")
    ] = None,
    hold_out: Annotated[
        list[Path] | None, typer.Option("--hold-out", help="Log to judge by; again for more.")
    ] = None,
    axes: Annotated[str | None, typer.Option("--axes", help="Only these: X,Y.")] = None,
    out: Annotated[Path | None, typer.Option("--out", help="Write the machine file there.")] = None,
    json_file: JsonOption = None,
    form: FormatOption = "text",
    report: Annotated[Path | None, typer.Option("--report", help="Write the page there.")] = None,
    require: Annotated[
        float | None,
        typer.Option("--require", help="Exit 1 if more of a held-out lag than this share is left."),
    ] = None,
    ball_bars: Annotated[
        list[Path] | None,
        typer.Option("--ball-bar", help="Log of a ball-bar, named by [ball_bar] of --columns."),
    ] = None,
    programs: Annotated[
        Path | None,
        typer.Option("--programs", help="Write test programs for the real machine there."),
    ] = None,
) -> None:
    """Fit a machine's drives to logs of a real one, and say what the logs do not tell."""
    from twin.commands.calibrate import Request, calibrate_and_print

    request = Request(
        logs=logs or [], base=base, columns=columns, hold_out=hold_out or [], axes=axes, out=out,
        json_file=json_file_of(form, json_file), report=report, require=require, programs=programs,
        ball_bars=ball_bars or [],
    )  # fmt: skip
    raise typer.Exit(calibrate_and_print(request))
