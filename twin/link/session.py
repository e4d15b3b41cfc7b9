"""LinuxCNC and the twin together: a program, or a session at LinuxCNC's screen."""

import contextlib
import os
import re
from collections.abc import Callable
from contextlib import AbstractContextManager, nullcontext
from pathlib import Path
from typing import NamedTuple

from twin.compilation.inventory import inventory
from twin.files.atomic import write_text
from twin.job.job_file import ToolTable
from twin.link.component import install, module_folder
from twin.link.configuration import Settings, write_configuration
from twin.link.linuxcnc import (
    LOG_NAME,
    OPERATOR,
    LinuxCnc,
    claimed_linuxcnc,
    operator_log,
    require_plain,
    running,
)
from twin.link.linuxcnc_program import linuxcnc_program
from twin.link.lockstep import LockstepMotion
from twin.link.place import Places
from twin.link.program_reading import Listing
from twin.machine.simulation.live import LiveMachine
from twin.nc.canonical import FloatArray, concatenate
from twin.recording.alarms import Alarm, AlarmCode, AlarmStandsError
from twin.run.dry_run.dry_run import InterpretedProgram
from twin.run.judging.outcome import Outcome
from twin.run.preparing.preparation import Preparation
from twin.run.progress import Progress
from twin.run.run import Run


class _EnoughError(Exception):
    """Every step has been called."""


def rehearse(run: Run, tool: ToolTable, position: FloatArray) -> None:
    """Compile all that a linked run calls, by a short run that is discarded.

    Kernels compile when they are first called, which takes a minute in a new installation, and LinuxCNC's
    component gives up on a twin that is silent for two seconds.

    Args:
        tool: What the spindle holds at the start.
        position: Where the axes stand, machine coordinates, shape (k,) [mm or deg].

    Raises:
        SimulationError: The twin's own run of the program fails.
    """
    if inventory().complete:
        return
    with contextlib.suppress(_EnoughError):
        Run(run.preparation).execute(None, _enough)
    live = LiveMachine(run.machine, tool, position, run.model.blank)
    live.stand_at(position)
    live.follow(live.setpoint)
    live.brake(1)
    with contextlib.suppress(AlarmStandsError):
        live.clear()


def _enough(_stage: str, _share: float) -> None:
    raise _EnoughError


FOLDER_NAME = "linuxcnc"
"""Where, in the folder of a run, all that LinuxCNC reads and writes lies."""
PROGRAM_NAME = "program.ngc"
_FOLLOWING_ERROR = re.compile(r"joint (\d+) following error", re.IGNORECASE)


class Wish(NamedTuple):
    """How LinuxCNC is to run.

    Attributes:
        own_program: The program as LinuxCNC reads it, where the prepared one was written down from
            it; None: LinuxCNC is given the prepared program's moves.
        display: Command of the screen from which somebody works LinuxCNC as he likes; None: the
            program is run, and that is all.
        opens: Whether the screen opens with the program.
        following_error_limit: LinuxCNC's own limit [mm or deg]; None: the machine's.
    """

    own_program: Listing | None = None
    display: str | None = None
    opens: bool = False
    following_error_limit: float | None = None


def run_on_twin(
    run: Run,
    folder: Path,
    progress: Progress,
    wish: Wish,
    say: Callable[[str], None],
    meanwhile: Callable[[LockstepMotion], AbstractContextManager[None]] = lambda _motion: (
        nullcontext()
    ),
) -> tuple[Outcome, dict[str, float]]:
    """Let LinuxCNC drive the twin; one pair at a time on a computer.

    Args:
        folder: For the results; LinuxCNC's own files go into a folder in it.
        say: Called with what LinuxCNC prints.
        meanwhile: Open while the control drives the machine, such as a page that shows it.

    Returns:
        What the run came to, and how the two got on: ``answered`` and ``missed`` servo periods, and
        the largest difference between LinuxCNC's f-error and the recorded lag [mm or deg].

    Raises:
        UsageError: LinuxCNC or its component is not installed, or cannot drive this machine.
    """
    with claimed_linuxcnc() as start:
        preparation, program = run.preparation, run.dry_run.program
        axes = preparation.machine.axes
        own = folder.resolve() / FOLDER_NAME
        require_plain(own)
        own.mkdir(exist_ok=True)
        install(own, module_folder(start))
        tool, position = preparation.job.file.tools[0], program.start + run.part_zero
        rehearse(run, tool, position)
        live = LiveMachine(run.machine, tool, position, run.model.blank)
        places = _write_program(program, preparation, own / PROGRAM_NAME, wish.own_program)
        session = wish.display is not None
        with LockstepMotion(live, places, run.part_zero, session=session) as motion:
            settings = Settings(
                display=wish.display or _operator_command(own, len(axes)),
                port=motion.port,
                programs=_path_of(preparation, wish).resolve().parent,
                opened=own / PROGRAM_NAME if wish.opens else None,
                following_error_limit=wish.following_error_limit,
                part_zero=run.part_zero,
                job=preparation.job.file,
            )
            ini = write_configuration(own, preparation.machine, settings)
            with (
                meanwhile(motion),
                running(start, ini, folder / LOG_NAME) as linuxcnc,
            ):
                motion.goes_on = linuxcnc.goes_on
                motion.last_word = _last_word(linuxcnc, places, axes.names, session=session)
                outcome = run.execute(folder, progress, motion)
                if motion.left:
                    linuxcnc.end_soon()
                else:
                    linuxcnc.end()
                for event in linuxcnc.events():
                    if event.text:
                        say(f"linuxcnc: {event.text}")
            figures = {
                "answered": motion.answered,
                "missed": motion.missed,
                "f_error_difference": motion.greatest_disagreement,
            }
        return outcome, figures


def _path_of(preparation: Preparation, wish: Wish) -> Path:
    own = wish.own_program
    return preparation.job.program if own is None else own.path


def _write_program(
    program: InterpretedProgram, preparation: Preparation, path: Path, own_program: Listing | None
) -> Places:
    """Write what LinuxCNC reads, and tell where its lines lie in the prepared program."""
    chunks, axes = list(program.chunks()), preparation.machine.axes
    moves = concatenate([chunk.moves for chunk in chunks], axes)
    if own_program is not None:
        write_text(path, own_program.text)
        return Places(moves, moves.block)
    written = linuxcnc_program(
        chunks, axes, lambda line: "{}:{}".format(*preparation.source.place(line))
    )
    write_text(path, written.text)
    return Places(moves, written.line_of_move)


def _operator_command(folder: Path, joints: int) -> str:
    """Command of the screen that runs the program, as LinuxCNC's configuration names it.

    LinuxCNC's Python may be another than the twin's, whose folders its user may not enter, so the
    operator's file is copied.
    """
    path = folder / OPERATOR.name
    write_text(path, OPERATOR.read_text(encoding="utf-8"))
    path.chmod(0o755)
    program, log = folder / PROGRAM_NAME, operator_log(folder)
    return f"{path} --program {program} --joints {joints} --twin {os.getpid()} --log {log}"


def _last_word(
    linuxcnc: LinuxCnc, places: Places, axes: tuple[str, ...], *, session: bool
) -> Callable[[float, int], Alarm | None]:
    """What LinuxCNC itself stopped for, asked when it has gone: with or without a word, before its program's end."""

    def alarm(time_s: float, line: int) -> Alarm | None:
        linuxcnc.end_soon()
        events = linuxcnc.events()
        finished = session or any(event.event == "finished" for event in events)
        if finished and places.done:
            return None
        errors = [event.text for event in events if event.event == "error"]
        code: AlarmCode = "control-stop"
        axis = ""
        for text in errors:
            if found := _FOLLOWING_ERROR.search(text):
                code, axis = "following-error", axes[int(found.group(1))]
        gone = [f"its process {linuxcnc.lost} has gone"] if linuxcnc.lost else []
        said = "; ".join(errors + gone or [event.text for event in events[-1:]])
        reason = f"LinuxCNC stopped: {said}" if said else "LinuxCNC ended before the program did"
        return Alarm(code, line, time_s, axis, reason)

    return alarm
