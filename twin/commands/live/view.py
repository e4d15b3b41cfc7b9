"""``twin view``: a run in a browser."""

import contextlib
import threading
from pathlib import Path

import typer

from twin.commands.live.interruption import stop_on_sigint
from twin.commands.runs.run import run_and_print
from twin.compilation.announcement import announce_compilation
from twin.errors import ExitCode, UsageError
from twin.extras import require_extra
from twin.render.scene.scene import RenderScene
from twin.run.replay import open_scene

RECORDING_SUFFIX = ".h5"


def report_of(scene: RenderScene, recording: Path) -> Path | None:
    """The report beside a recording; None: there is none, or it is that of another program."""
    report = recording.parent / "report.html"
    try:
        known = scene.recording.header.program_sha256 in report.read_text("utf-8")
    except (OSError, UnicodeDecodeError):
        return None
    return report if known else None


def view(path: Path, port: int) -> ExitCode:
    """Show a recording, or a job that is run first, until Ctrl+C is pressed.

    Args:
        path: ``recording.h5``, an NC program or a job file.
        port: 0: the first free one.

    Raises:
        TwinError: Something is missing or wrong; see each error's exit code.
    """
    if not path.is_file():
        raise UsageError(f"{path}: no such file")
    require_extra("train", "twin view")
    from twin.view.app import open_view
    from twin.view.recorded_run import RecordedRun

    announce_compilation()
    recording, code = path, ExitCode.OK
    if path.suffix != RECORDING_SUFFIX:
        folder = Path("out") / path.stem
        code = run_and_print(path, folder, dialect=None, machine=None, video=False, strict=False)
        recording = folder / "recording.h5"
        if not recording.is_file():
            return code
    over = threading.Event()
    with contextlib.ExitStack() as stack:
        scene, preparation = stack.enter_context(open_scene(recording))
        if not len(scene.recording):
            raise UsageError(f"{recording}: the recording has no samples: there is nothing to show")
        run = RecordedRun(scene, preparation.machine)
        address = stack.enter_context(open_view(run, port, report=report_of(scene, recording)))
        stack.enter_context(stop_on_sigint(over.set))
        typer.echo(f"{recording}: open {address} in a browser; Ctrl+C ends")
        while not over.wait(0.2):
            pass
    return code
