"""``twin serve``: MTConnect over a job that is run again and again, over a training room, or over a machine for Grbl's senders."""

import asyncio
import contextlib
import dataclasses
import logging
import socket
import tempfile
import threading
from collections.abc import Callable, Coroutine, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

import typer

from twin.commands.live.interruption import stop_on_sigint
from twin.compilation.announcement import announce_compilation
from twin.errors import ExitCode, UsageError
from twin.extras import require_extra
from twin.run.preparing.preparation import prepare
from twin.run.progress import shown_progress
from twin.run.run import Run

if TYPE_CHECKING:
    from twin.job.job_file import JobFile
    from twin.machine.description.config import MachineConfig
    from twin.serve.agent import Agent
    from twin.serve.device import Component
    from twin.serve.playback import Playhead, Production
    from twin.training.scene.scene_file import Scene

PORTS = range(5000, 5100)
"""Where a free port is looked for when none is named; 5000 is what MTConnect agents use."""
_WAIT_S = 0.2


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Reported:
    """What is reported, and where.

    Attributes:
        port: 0: the first free one of ``PORTS``.
        speed: Seconds of the twin for each second of the day.
        opcua_port: Port of OPC UA, which reports in addition to MTConnect; None: it does not.
        opcua_trust: Folder of the certificates of OPC UA's clients.
        grbl: Port at which a machine takes programs from Grbl's senders, or ``pty``; None: it takes none.
        view: Whether a page shows the machine, too.
    """

    host: str
    port: int
    speed: float = 1.0
    buffer: int = 1 << 17
    dialect: str | None = None
    machine: str | None = None
    opcua_port: int | None = None
    opcua_trust: Path | None = None
    grbl: str | None = None
    view: bool = False


def serve_job(path: Path, source: Reported) -> ExitCode:
    """Simulate a job once, then report it as if the machine made part after part.

    Raises:
        UsageError: The web server is not installed, or nobody can listen there.
        TwinError: Something is wrong with the job; see each error's exit code.
    """
    _check_opcua(source)
    require_extra("serve", "twin serve")
    if source.view:
        require_extra("train", "twin serve --view")
    from twin.serve.agent import Agent, Clock
    from twin.serve.playback import Playhead, feed, ticks

    with _listen(source.host, source.port) as listener, tempfile.TemporaryDirectory() as folder:
        announce_compilation()
        run = Run(prepare(path, dialect=source.dialect, machine=source.machine))
        production = _produce(run, Path(folder))
        machine = run.preparation.machine
        device = _device(machine)
        description = _description(source.speed)
        job_tools = run.preparation.job.file.tools
        agent = Agent(device, Clock(source.speed), description, source.buffer, job_tools)
        stop = threading.Event()
        tools = _tools(run.preparation.job.file)
        named = (machine, production.program, tools)
        playhead = Playhead()

        def observe() -> Coroutine[Any, Any, None]:
            return _with_opcua(feed(agent, ticks(production), playhead), agent, source, named)

        with (
            _viewed(production, playhead, wanted=source.view),
            _served(agent, observe, listener, stop),
            stop_on_sigint(stop.set),
        ):
            typer.echo(_address(listener))
            while not stop.wait(_WAIT_S):
                pass
    return ExitCode.OK


def serve_scene(name: str, source: Reported) -> ExitCode:
    """Open a training room and report its machine to monitors, which only read.

    Args:
        name: A shipped scene's name, or a scene file.

    Raises:
        UsageError: The web server is not installed, nobody can listen there, or a room was to run
            faster than the day.
        TwinError: The scene is wrong.
    """
    if source.speed != 1.0:
        raise UsageError("--speed is for jobs: the clock of a training room is the day's")
    require_extra("train", "twin serve --scene")
    _check_opcua(source)
    from twin.training.scene.scene_file import read_scene, scene_path

    with _listen(source.host, source.port) as listener:
        announce_compilation()
        scene = read_scene(scene_path(name))
        description = f"The machine of the training scene {scene.name}"
        _serve_room(scene, source, listener, description)
    return ExitCode.OK


def serve_grbl(job: Path | None, source: Reported) -> ExitCode:
    """Let Grbl's senders stream programs to the machine of a job, and report it to monitors.

    Args:
        job: NC program or job file: machine, blank, tool; none: of the shipped one.

    Raises:
        UsageError: The web server is not installed, or nobody can or may listen there.
        TwinError: The job is wrong.
    """
    from twin.files.shipped import resource_root
    from twin.training.scene.scene_file import scene_of_job

    require_extra("train", "twin serve --grbl")
    _check_opcua(source)
    with _listen(source.host, source.port) as listener, _grbl_line(source) as line:
        announce_compilation()
        prepared = prepare(
            job or resource_root("programs") / "grbl" / "box_lid.toml",
            dialect="grbl",
            machine=source.machine,
        )
        scene = scene_of_job("grbl", prepared)
        description = f"A simulated machine that senders of Grbl drive{_faster(source.speed)}"
        _serve_room(scene, source, listener, description, line)
    return ExitCode.OK


@contextlib.contextmanager
def _grbl_line(source: Reported) -> "Iterator[socket.socket | int]":
    """Where senders come in: a socket, or the twin's end of a pseudo-terminal."""
    from twin.serve.grbl.server import PSEUDO_TERMINAL, pseudo_terminal
    from twin.web.origin_check import LOCAL_NAMES

    if source.grbl == PSEUDO_TERMINAL:
        with pseudo_terminal() as (master, path):
            typer.echo(f"Grbl's senders open {path}")
            yield master
        return
    if source.host not in LOCAL_NAMES:
        raise UsageError(
            f"Grbl's protocol has no passwords: --grbl listens on this computer only, not at {source.host}"
        )
    if source.grbl is None or not source.grbl.isdecimal() or not 0 < int(source.grbl) < 1 << 16:
        raise UsageError(f"--grbl {source.grbl}: give a port from 1 to 65535, or {PSEUDO_TERMINAL}")
    with _listen(source.host, int(source.grbl)) as listener:
        typer.echo(
            f"Grbl's senders connect to {_address(listener).removeprefix('http://').rstrip('/')}"
        )
        yield listener


def _serve_room(
    scene: "Scene", source: Reported, listener: socket.socket, description: str,
    line: "socket.socket | int | None" = None,
) -> None:  # fmt: skip
    """Open a room, report its machine to monitors, and let senders drive it where there is a line for them."""
    from twin.serve.agent import Agent, Clock
    from twin.serve.grbl.server import GrblLine
    from twin.serve.room import RoomObserver, observe_room
    from twin.training.server.launch import open_room

    machine = scene.preparation.machine
    device = _device(machine)
    job_tools = scene.preparation.job.file.tools
    agent = Agent(device, Clock(source.speed), description, source.buffer, job_tools)
    observer = RoomObserver(scene.preparation.source.name)
    out = Path("out") / "training" if line is None else None
    with open_room(scene, out=out, promptly=True) as room:
        room.driver.speed = source.speed
        stop = threading.Event()

        def leave() -> None:
            stop.set()
            room.stop()

        def observe() -> Coroutine[Any, Any, None]:
            seen = observe_room(agent, observer, lambda: room.driver.look.now)
            program = scene.preparation.source.name
            tools = _tools(scene.preparation.job.file)
            serving = _with_opcua(seen, agent, source, (machine, program, tools))
            return serving if line is None else _beside(GrblLine(room.driver).serve(line), serving)

        with (
            _served(agent, observe, listener, stop, room.stop),
            stop_on_sigint(leave),
        ):
            typer.echo(_address(listener))
            for role, address in room.addresses.items():
                typer.echo(f"{scene.name}, {role}: {address}", err=True)
            room.serve()


@contextlib.contextmanager
def _viewed(production: "Production", playhead: "Playhead", *, wanted: bool) -> Iterator[None]:
    """Show the machine on a page as well, where that is asked for."""
    if not wanted:
        yield
        return
    if production.recording is None:
        raise UsageError("--view: nothing moved, so there is nothing to show")
    from twin.run.replay import open_scene
    from twin.view.app import open_view
    from twin.view.recorded_run import RecordedRun

    with open_scene(production.recording) as (scene, _):
        run = RecordedRun(scene, production.machine)
        with open_view(run, now=lambda: {"time": playhead.time_s}) as address:
            typer.echo(f"{production.program}: open {address} in a browser", err=True)
            yield


async def _beside(*tasks: Coroutine[Any, Any, None]) -> None:
    """Run tasks until one fails or all are cancelled."""
    async with asyncio.TaskGroup() as group:
        for task in tasks:
            group.create_task(task)


def _tools(job: "JobFile") -> dict[int, str]:
    """Names of a job's tools by their numbers."""
    return {tool.number: f"{tool.kind} {tool.diameter:g} mm" for tool in job.tools}


def _check_opcua(source: Reported) -> None:
    """Refuse an OPC UA server that cannot be, before anything is simulated."""
    if source.opcua_port is None:
        if source.opcua_trust is not None:
            raise UsageError("--opcua-trust is for --opcua PORT")
        return
    require_extra("opcua", "twin serve --opcua")
    from twin.serve.opcua.machine_tool import require_node_sets
    from twin.serve.opcua.server import Endpoint, check_place

    require_node_sets()
    check_place(Endpoint(source.host, source.opcua_port, source.opcua_trust))


def _say(text: str) -> None:
    typer.echo(text, err=True)


async def _with_opcua(
    observe: Coroutine[Any, Any, None], agent: "Agent", source: Reported,
    named: tuple["MachineConfig", str, dict[int, str]],
) -> None:  # fmt: skip
    """Observe a machine, and tell it in OPC UA too where that is asked for."""
    if source.opcua_port is None:
        await observe
        return
    from twin.serve.opcua.server import Content, Endpoint, mirror

    place = Endpoint(source.host, source.opcua_port, source.opcua_trust)
    await _beside(mirror(agent, place, Content(*named), _say), observe)


def _produce(run: Run, folder: Path) -> "Production":
    """Run a job once and keep its recording in a folder."""
    from twin.serve.playback import Production, coolant_of

    with shown_progress() as progress:
        outcome = run.execute(folder, progress)
    recording = folder / "recording.h5"
    return Production(
        machine=run.preparation.machine,
        program=run.preparation.source.name,
        source=run.preparation.source.lines,
        summary=run.dry_run.summary,
        recording=recording if recording.is_file() else None,
        alarms=outcome.alarms,
        coolant=coolant_of(run.dry_run.program.chunks()),
    )


@contextlib.contextmanager
def _served(
    agent: "Agent",
    observe: Callable[[], Coroutine[Any, Any, None]],
    listener: socket.socket,
    stop: threading.Event,
    failed: Callable[[], None] = lambda: None,
) -> Iterator[None]:
    """Answer clients on a thread of its own while the block runs.

    Args:
        observe: Lets it observe the machine until it is cancelled.
        listener: Where clients come in.
        stop: Set when the observation has come to an end by itself.
        failed: Called then, too.
    """
    import uvicorn

    from twin.serve.http_server import application, without_broken_requests
    from twin.web.origin_check import LOCAL_NAMES

    failures: list[Exception] = []

    async def observed() -> None:
        try:
            await observe()
        except Exception as error:
            failures.append(error)
            raise
        finally:
            stop.set()
            failed()

    local = listener.getsockname()[0] in LOCAL_NAMES
    config = uvicorn.Config(
        application(agent, observed, local=local), log_level="error", timeout_graceful_shutdown=1
    )
    server = uvicorn.Server(config)
    logging.getLogger("uvicorn.error").addFilter(without_broken_requests)
    thread = threading.Thread(target=server.run, kwargs={"sockets": [listener]})
    thread.start()
    try:
        yield
    finally:
        # Streams never end by themselves: that they are cut off here is no error.
        logging.getLogger("uvicorn.error").disabled = True
        server.should_exit = True
        thread.join()
    if failures:
        raise failures[0]


def _device(machine: "MachineConfig") -> "Component":
    """The machine as monitors see it.

    Raises:
        ConfigError: Its model is no mill.
    """
    from twin.serve.device import device_of, motions_of

    endless = {name for name in machine.axes.names if machine.axis(name).periodic}
    motions = motions_of(machine.axes, machine.kinematics, endless)
    return device_of(machine.file.name, machine.axes, motions)


def _description(speed: float) -> str:
    return f"A simulated machine that runs one job again and again{_faster(speed)}"


def _faster(speed: float) -> str:
    return "" if speed == 1.0 else f"; its clock runs {speed:g} times as fast as the day"


def _address(listener: socket.socket) -> str:
    host, port = listener.getsockname()[:2]
    return f"http://{f'[{host}]' if ':' in host else host}:{port}/"


def _listen(host: str, port: int) -> socket.socket:
    from twin.web.server import listening

    return listening(host, port, PORTS)
