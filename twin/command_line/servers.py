"""Commands that run until they are interrupted: ``twin train``, ``view``, ``serve`` and ``link``."""

from pathlib import Path
from typing import Annotated

import typer

from twin.command_line.examples import epilog
from twin.command_line.options import ClusterOption, DialectOption, MachineOption
from twin.errors import UsageError


def train(
    scene: Annotated[
        str, typer.Argument(help="A shipped scene's name, or a scene.toml.")
    ] = "fagor_first_steps",
    list_scenes: Annotated[bool, typer.Option("--list", help="List the shipped scenes.")] = False,
    rehearse: Annotated[
        bool,
        typer.Option("--rehearse", help="Play the scene's solution and mistake without a page."),
    ] = False,
    course: Annotated[
        Path | None,
        typer.Option(
            "--course", help="List the score sheets of a folder; writes course.html there."
        ),
    ] = None,
    roster: Annotated[
        Path | None,
        typer.Option(
            "--class",
            metavar="ROSTER.csv",
            help="A room for each pupil of a list (columns name, scene), and a page for the teacher.",
        ),
    ] = None,
    seats: Annotated[
        int | None, typer.Option("--seats", help="A class with this number of unnamed pupils.")
    ] = None,
    language: Annotated[
        str | None,
        typer.Option(
            "--language",
            help="en, ru, it or cs; default: the scene's; of a course that of most sheets.",
        ),
    ] = None,
    host: Annotated[
        str | None, typer.Option("--host", help="Address to listen at; needs --certificate.")
    ] = None,
    port: Annotated[
        int, typer.Option("--port", min=0, max=65535, help="0: the first free from 8080.")
    ] = 0,
    certificate: Annotated[
        Path | None, typer.Option("--certificate", help="Certificate for https.")
    ] = None,
    key: Annotated[Path | None, typer.Option("--key", help="Key of the certificate.")] = None,
    out: Annotated[
        Path | None,
        typer.Option(
            "--out",
            help="Folder for logs and score sheets; default out/training, for a class out/class/ROSTER.",
        ),
    ] = None,
    cluster: ClusterOption = None,
) -> None:
    """Run a machine, and crash it, in a browser: the training room."""
    from twin.commands.live import train as room

    if list_scenes:
        room.print_scenes(language)
        return
    if course is not None:
        room.print_course(course, language)
        return
    if rehearse:
        raise typer.Exit(room.rehearse_and_print(scene))
    place = room.PageAddress(
        language=language, host=host, port=port, certificate=certificate, key=key
    )
    if roster is not None or seats is not None:
        room.teach(scene, roster, seats, place, out, cluster)
        return
    if cluster is not None:
        raise UsageError("--cluster spreads the rooms of a class: it needs --class or --seats")
    raise typer.Exit(room.train(scene, place, out))


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
    """Show a run in a browser: play, scrub, jump by line, with its contour error and its part."""
    from twin.commands.live.view import view as show

    raise typer.Exit(show(recording, port))


def serve(
    job: Annotated[
        Path | None,
        typer.Argument(
            metavar="PROGRAM|JOB.toml",
            help="Program or job, which is repeated.",
            show_default=False,
        ),
    ] = None,
    scene: Annotated[
        str | None, typer.Option("--scene", help="Open this training room instead of a program.")
    ] = None,
    host: Annotated[str, typer.Option("--host", help="Address to listen at.")] = "127.0.0.1",
    port: Annotated[
        int, typer.Option("--port", min=0, max=65535, help="0: the first free from 5000.")
    ] = 0,
    speed: Annotated[
        float,
        typer.Option("--speed", min=0.01, max=1000.0, help="Times faster than real time."),
    ] = 1.0,
    buffer: Annotated[
        int,
        typer.Option("--buffer", min=100, max=1 << 24, help="Observations that are kept."),
    ] = 1 << 17,
    opcua: Annotated[
        int | None,
        typer.Option(
            "--opcua", metavar="PORT", min=1, max=65535, help="Serve OPC UA too, at this port."
        ),
    ] = None,
    opcua_trust: Annotated[
        Path | None,
        typer.Option("--opcua-trust", metavar="DIR", help="Certificates of OPC UA's clients."),
    ] = None,
    grbl: Annotated[
        str | None,
        typer.Option(
            "--grbl",
            metavar="PORT|pty",
            help="Accept programs from Grbl senders, on the job's machine.",
        ),
    ] = None,
    view: Annotated[bool, typer.Option("--view", help="Show the job's machine on a page.")] = False,
    dialect: DialectOption = None,
    machine: MachineOption = None,
) -> None:
    """Serve a machine over MTConnect: one that repeats a job, or that of a training room."""
    from twin.commands.live import serve as agent

    source = agent.Reported(
        host=host, port=port, speed=speed, buffer=buffer, dialect=dialect, machine=machine,
        opcua_port=opcua, opcua_trust=opcua_trust, grbl=grbl, view=view,
    )  # fmt: skip
    if view and (scene is not None or grbl is not None):
        raise UsageError("--view is for a job; a room has its own pages")
    if grbl is not None:
        if scene is not None or dialect is not None:
            raise UsageError("--grbl drives the machine of a job, in Grbl's own dialect")
        raise typer.Exit(agent.serve_grbl(job, source))
    if (job is None) == (scene is None):
        raise UsageError("give a program or a job, or --scene and a training scene")
    if scene is not None:
        raise typer.Exit(agent.serve_scene(scene, source))
    assert job is not None
    raise typer.Exit(agent.serve_job(job, source))


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
