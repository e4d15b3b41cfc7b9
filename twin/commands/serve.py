"""``twin serve``: an MTConnect agent over a job that is run again and again."""

import socket
import tempfile
import threading
from pathlib import Path
from typing import TYPE_CHECKING

import typer

from twin.commands.interruption import let_interruption_stop
from twin.compilation.announcement import announce_compilation
from twin.errors import ExitCode, UsageError
from twin.run.preparation import prepare
from twin.run.progress import shown_progress
from twin.run.run import Run

if TYPE_CHECKING:
    from twin.serve.agent import Agent
    from twin.serve.playback import Production

FIRST_PORT, LAST_PORT = 5000, 5099
"""Where a free port is looked for when none is named; 5000 is what MTConnect agents use."""
_WAIT_S = 0.2


def serve(
    path: Path,
    *,
    host: str,
    port: int,
    speed: float,
    dialect: str | None,
    machine: str | None,
) -> ExitCode:
    """Simulate a job once, then tell of it as if the machine made part after part.

    Args:
        path: NC program or job file.
        host: Address to listen at.
        port: 0: the first free one from ``FIRST_PORT`` on.
        speed: Seconds of the twin for each second of the day.
        dialect: Overrides the job's dialect.
        machine: Overrides the job's machine.

    Raises:
        UsageError: The web server is not installed, or nobody can listen there.
        TwinError: Something is wrong with the job; see each error's exit code.
    """
    try:
        import starlette  # noqa: F401 - asked for before a job is simulated that nobody could serve
        import uvicorn  # noqa: F401
    except ImportError as error:
        raise UsageError(
            f"twin serve needs {error.name}: pip install 'mill-twin[serve]'"
        ) from error
    from twin.serve.agent import Agent
    from twin.serve.clock import Clock
    from twin.serve.device import device_of
    from twin.serve.playback import Production

    listener = _listen(host, port)
    announce_compilation()
    run = Run(prepare(path, dialect=dialect, machine=machine))
    preparation = run.preparation
    dry_run = run.dry_run()
    with listener, tempfile.TemporaryDirectory() as folder:
        with shown_progress() as progress:
            outcome = run.execute(dry_run, Path(folder), progress)
        recording = Path(folder) / "recording.h5"
        production = Production(
            machine=preparation.machine,
            program=preparation.source.name,
            source=preparation.source.lines,
            summary=dry_run.summary,
            recording=recording if recording.is_file() else None,
            alarms=outcome.alarms,
        )
        device = device_of(preparation.machine.file.name, preparation.machine.axes)
        _tell(Agent(device, Clock(speed), _description(speed)), production, listener)
    return ExitCode.OK


def _tell(agent: "Agent", production: "Production", listener: socket.socket) -> None:
    """Answer until somebody interrupts; what fails on the way is raised here."""
    import uvicorn

    from twin.serve.http_server import application
    from twin.serve.playback import feed, ticks

    failures: list[Exception] = []

    async def observe() -> None:
        try:
            await feed(agent, ticks(production))
        except Exception as error:
            failures.append(error)
            raise
        finally:
            server.should_exit = True

    # Answers that never end are cut off when the server ends.
    config = uvicorn.Config(
        application(agent, observe), log_level="error", timeout_graceful_shutdown=1
    )
    server = uvicorn.Server(config)
    thread = threading.Thread(target=server.run, kwargs={"sockets": [listener]})
    stop = threading.Event()
    with let_interruption_stop(stop.set):
        thread.start()
        host, port = listener.getsockname()[:2]
        typer.echo(f"http://{f'[{host}]' if ':' in host else host}:{port}/")
        while thread.is_alive() and not stop.wait(_WAIT_S):
            pass
        server.should_exit = True
        thread.join()
    if failures:
        raise failures[0]


def _description(speed: float) -> str:
    faster = "" if speed == 1.0 else f"; its clock runs {speed:g} times as fast as the day"
    return f"A simulated machine that runs one job again and again{faster}"


def _listen(host: str, port: int) -> socket.socket:
    ports = [port] if port else range(FIRST_PORT, LAST_PORT + 1)
    reason: OSError | None = None
    for candidate in ports:
        try:
            family = socket.getaddrinfo(host, candidate, type=socket.SOCK_STREAM)[0][0]
            return socket.create_server((host, candidate), family=family)
        except OSError as error:
            reason = error
    where = f"port {port}" if port else f"any port from {FIRST_PORT} to {LAST_PORT}"
    raise UsageError(f"nobody can listen at {host}, {where}: {reason}")
