"""The command line: each command reads its arguments, calls the rooms, and returns an exit code."""

import signal
import sys
from pathlib import Path
from typing import Annotated, NoReturn

import typer

from twin import __version__
from twin.cli_options import (
    ClusterOption,
    DialectOption,
    FormatOption,
    JobsOption,
    MachineArgument,
    MachineOption,
    Program,
    ProgramOrJob,
    StrictOption,
)
from twin.errors import ExitCode, TwinError

app = typer.Typer(
    name="twin",
    help="A digital twin of a 4-axis mill: NC text in, a verdict, a part and a picture out.",
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    add_completion=False,
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


@app.command()
def interpret(
    program: Program,
    dialect: DialectOption = None,
    machine: MachineOption = None,
    form: Annotated[str, typer.Option("--format", help="text or jsonl.")] = "text",
    strict: StrictOption = False,
) -> None:
    """Print what the interpreter made of a program, before any machine moves."""
    from twin.commands.interpret import print_interpretation

    print_interpretation(program, dialect=dialect, machine=machine, form=form, strict=strict)


@app.command()
def run(
    job: ProgramOrJob,
    out: Annotated[
        Path | None, typer.Option("--out", help="Folder; default out/<program>.")
    ] = None,
    video: Annotated[bool, typer.Option("--video", help="Film the run as video.mp4.")] = False,
    dialect: DialectOption = None,
    machine: MachineOption = None,
    strict: StrictOption = False,
) -> None:
    """Interpret, plan, simulate, compare and cut; write the results and print the verdict."""
    from twin.commands.run import run_and_print

    code = run_and_print(job, out, dialect=dialect, machine=machine, video=video, strict=strict)
    raise typer.Exit(code)


@app.command()
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
        list[float] | None, typer.Option("--at", help="Draw a still at this time [s]; repeatable.")
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
    quality: Annotated[str | None, typer.Option("--quality", help="draft or final.")] = None,
    seconds: Annotated[
        float | None, typer.Option("--seconds", help="Length of the film [s].")
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
        typer.Option("--tolerance", help="Exit 1 where the part is further off than this [µm]."),
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
            "quality": quality,
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


@app.command()
def check(
    paths: Annotated[list[str], typer.Argument(help="Programs, job files, folders, globs.")],
    junit: Annotated[Path | None, typer.Option("--junit", help="Write JUnit XML there.")] = None,
    json_file: Annotated[Path | None, typer.Option("--json", help="Write JSON there.")] = None,
    baseline: Annotated[
        Path | None, typer.Option("--baseline", help="Hold runs to the baselines in this folder.")
    ] = None,
    update_baseline: Annotated[
        bool, typer.Option("--update-baseline", help="Store baselines instead.")
    ] = False,
    jobs: JobsOption = None,
    cluster: ClusterOption = None,
    machine: MachineOption = None,
    strict: StrictOption = False,
) -> None:
    """Run many programs without pictures; one table, exit 1 if any falls short."""
    from twin.check.program import CheckSettings
    from twin.commands.check import check_and_print

    settings = CheckSettings(
        machine=machine, strict=strict, baseline=baseline, update_baseline=update_baseline
    )
    code = check_and_print(
        paths, settings=settings, junit=junit, json_file=json_file, jobs=jobs, cluster=cluster
    )
    raise typer.Exit(code)


@app.command()
def sweep(
    job: ProgramOrJob,
    vary: Annotated[
        list[str],
        typer.Option(
            "--vary",
            help="machine.KEY=VALUES or job.KEY=VALUES: a,b,c or FROM:TO:COUNT; again for more.",
        ),
    ],
    json_file: Annotated[Path | None, typer.Option("--json", help="Write JSON there.")] = None,
    jobs: JobsOption = None,
    cluster: ClusterOption = None,
    machine: MachineOption = None,
    strict: StrictOption = False,
) -> None:
    """Run a job for every combination of values; exit 1 if any falls short."""
    from twin.check.program import CheckSettings
    from twin.commands.sweep import sweep_and_print

    code = sweep_and_print(
        job,
        vary,
        settings=CheckSettings(machine=machine, strict=strict),
        json_file=json_file,
        jobs=jobs,
        cluster=cluster,
    )
    raise typer.Exit(code)


@app.command()
def compare(
    first: Annotated[Path, typer.Argument(help="Recording, or CSV log.", show_default=False)],
    second: Annotated[Path, typer.Argument(help="The same.", show_default=False)],
    form: FormatOption = "text",
    period: Annotated[
        float | None, typer.Option("--period", help="Sample period of logs without time [s].")
    ] = None,
    offset: Annotated[
        float | None, typer.Option("--offset", help="Known offset in time [s]; default: found.")
    ] = None,
    tolerance: Annotated[
        float | None, typer.Option("--tolerance", help="Largest actual difference [mm or deg].")
    ] = None,
) -> None:
    """Compare two recordings, or a recording with a log of the real machine."""
    from twin.commands.compare import compare_and_print

    code = compare_and_print(
        first, second, form=form, period_s=period, offset_s=offset, tolerance=tolerance
    )
    raise typer.Exit(code)


@app.command()
def export(
    recording: Annotated[Path, typer.Argument(help="recording.h5", show_default=False)],
    out: Annotated[Path | None, typer.Option("--out", help="Default: beside it, .csv.")] = None,
    every: Annotated[int, typer.Option("--every", help="Write one of so many samples.")] = 1,
) -> None:
    """Write a recording as CSV, units in the header."""
    from twin.commands.export import export_and_print

    raise typer.Exit(export_and_print(recording, out, every=every))


@app.command()
def dialects(
    name: Annotated[str | None, typer.Argument(help="One of them.", show_default=False)] = None,
) -> None:
    """Print the dialects, or what one of them understands, refuses and decided."""
    from twin.nc.describe import describe, overview
    from twin.nc.dialects import dialect_named

    typer.echo(overview() if name is None else describe(dialect_named(name)))


@app.command()
def explain(
    code: Annotated[str, typer.Argument(help="Code of a diagnostic.", show_default=False)],
) -> None:
    """Explain a diagnostic's code, with an example."""
    from twin.nc import explain as explanations

    typer.echo(explanations.explain(code))


@app.command()
def doctor() -> None:
    """Say what this computer can do: libraries, off-screen pictures, video."""
    from twin.commands.doctor import print_doctor

    raise typer.Exit(print_doctor())


machine_app = typer.Typer(no_args_is_help=True, help="Look at machines, check them, run circles.")
app.add_typer(machine_app, name="machine")


@machine_app.command("list")
def machine_list(form: FormatOption = "text") -> None:
    """List the shipped machines."""
    from twin.commands.machine import print_machines

    print_machines(form)


@machine_app.command("show")
def machine_show(
    name: MachineArgument,
    feed: Annotated[
        float, typer.Option("--feed", help="For the lag [mm/min or deg/min].")
    ] = 3000.0,
    form: FormatOption = "text",
) -> None:
    """Show travel, limits, loop gain, inertia, natural frequency, expected lag."""
    from twin.commands.machine import print_machine

    print_machine(name, feed=feed, form=form)


@machine_app.command("check")
def machine_check(name: MachineArgument) -> None:
    """Check a machine's folder: files, model, hold still at home, shake."""
    from twin.commands.machine import print_check

    raise typer.Exit(print_check(name))


@machine_app.command("circle")
def machine_circle(
    machine: Annotated[str, typer.Option("--machine", help="Name or machine.toml.")] = "mill4",
    radius: Annotated[float, typer.Option("--radius", help="[mm]")] = 50.0,
    feed: Annotated[float, typer.Option("--feed", help="[mm/min]")] = 3000.0,
    plane: Annotated[str, typer.Option("--plane", help="XY, ZX, YZ or XYC.")] = "XY",
    form: FormatOption = "text",
    plot: Annotated[Path, typer.Option("--plot", help="SVG, PNG or PDF.")] = Path("circle.svg"),
) -> None:
    """Run the circular test of ISO 230-4 in both directions and draw it."""
    from twin.commands.machine import print_circle

    print_circle(machine, radius=radius, feed=feed, plane=plane, form=form, plot=plot)


def main() -> None:
    """Run the command line and exit with the code that the contract promises."""
    # Asked to end, by a batch system say, is the same as Ctrl-C: files are left whole or absent.
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    try:
        app()
    except TwinError as error:
        _leave(str(error), error.exit_code)
    except BrokenPipeError:
        # Whoever read our output has gone (``twin interpret ... | head``): no word helps.
        sys.stderr.close()
        raise SystemExit(ExitCode.OK) from None
    except OSError as error:
        _leave(f"{error.filename or 'a file'}: {error.strerror or error}", ExitCode.USAGE)
    except MemoryError:
        _leave("there is not enough memory; what was complete is kept", ExitCode.USAGE)
    except SystemExit as leaving:
        if leaving.code == ExitCode.INTERRUPTED:
            _leave("interrupted: what was complete is kept, nothing is torn", ExitCode.INTERRUPTED)
        raise


def _leave(message: str, code: ExitCode) -> NoReturn:
    typer.echo(message, err=True)
    raise SystemExit(code)
