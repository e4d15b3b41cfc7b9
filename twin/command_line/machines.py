"""``twin machine``: list, show, check and circle; ``twin calibrate``: from logs of a real machine to its file."""

from pathlib import Path
from typing import Annotated

import typer

from twin.command_line.examples import epilog
from twin.command_line.options import FormatOption, JsonOption, MachineArgument, json_file_of

machine_app = typer.Typer(
    no_args_is_help=True,
    help="List, show and check machines; run circular tests.",
    epilog=epilog("machine"),
)


@machine_app.command("list", epilog=epilog("machine list"))
def machine_list(form: FormatOption = "text") -> None:
    """List the shipped machines."""
    from twin.commands.machine import print_machines

    print_machines(form)


@machine_app.command("show", epilog=epilog("machine show"))
def machine_show(
    name: MachineArgument,
    feed: Annotated[
        float, typer.Option("--feed", help="Feed at which the lag is computed (mm/min or deg/min).")
    ] = 3000.0,
    form: FormatOption = "text",
) -> None:
    """Show travel, limits, loop gain, inertia, natural frequency, expected lag."""
    from twin.commands.machine import print_machine

    print_machine(name, feed=feed, form=form)


@machine_app.command("check", epilog=epilog("machine check"))
def machine_check(name: MachineArgument) -> None:
    """Check a machine's folder: files, model, hold still at home, shake."""
    from twin.commands.machine import print_check

    raise typer.Exit(print_check(name))


@machine_app.command("circle", epilog=epilog("machine circle"))
def machine_circle(
    machine: Annotated[str, typer.Option("--machine", help="Name or machine.toml.")] = "mill4",
    radius: Annotated[float, typer.Option("--radius", help="Radius of the circle (mm).")] = 50.0,
    feed: Annotated[float, typer.Option("--feed", help="Feed along the circle (mm/min).")] = 3000.0,
    plane: Annotated[
        str, typer.Option("--plane", help="XY, ZX, YZ; with the table XYC, ZXB, YZA.")
    ] = "XY",
    form: FormatOption = "text",
    plot: Annotated[Path, typer.Option("--plot", help="SVG, PNG or PDF.")] = Path("circle.svg"),
) -> None:
    """Run the circular test of ISO 230-4 in both directions and draw it."""
    from twin.commands.machine import print_circle

    print_circle(machine, radius=radius, feed=feed, plane=plane, form=form, plot=plot)


def calibrate(
    logs: Annotated[
        list[Path] | None, typer.Argument(help="Logs to fit.", show_default=False)
    ] = None,
    base: Annotated[
        str,
        typer.Option("--base", help="Base machine: its values stay where the logs determine none."),
    ] = "mill4",
    columns: Annotated[
        Path | None, typer.Option("--columns", help="Map of columns and units (TOML).")
    ] = None,
    hold_out: Annotated[
        list[Path] | None,
        typer.Option("--hold-out", help="Log that is not fitted but judges the fit; repeatable."),
    ] = None,
    axes: Annotated[str | None, typer.Option("--axes", help="Fit only these axes: X,Y.")] = None,
    out: Annotated[Path | None, typer.Option("--out", help="Machine file to write.")] = None,
    json_file: JsonOption = None,
    form: FormatOption = "text",
    report: Annotated[Path | None, typer.Option("--report", help="HTML report to write.")] = None,
    require: Annotated[
        float | None,
        typer.Option("--require", help="Exit 1 if more of a held-out lag than this share is left."),
    ] = None,
    ball_bars: Annotated[
        list[Path] | None,
        typer.Option(
            "--ball-bar",
            help="Log of a ball-bar; the table ball_bar of --columns names its columns.",
        ),
    ] = None,
    programs: Annotated[
        Path | None,
        typer.Option("--programs", help="Folder for test programs for the real machine."),
    ] = None,
) -> None:
    """Fit a machine's drives to logs of a real one, and report what the logs do not determine."""
    from twin.commands.calibrate import CalibrationRequest, calibrate_and_print

    request = CalibrationRequest(
        logs=logs or [], base=base, columns=columns, hold_out=hold_out or [], axes=axes, out=out,
        json_file=json_file_of(form, json_file), report=report, require=require, programs=programs,
        ball_bars=ball_bars or [],
    )  # fmt: skip
    raise typer.Exit(calibrate_and_print(request))
