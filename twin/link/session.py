"""LinuxCNC and the twin together: a program run by the one on the other."""

import re
from collections.abc import Callable
from pathlib import Path

from twin.files.atomic import write_text
from twin.link.component import install, module_folder
from twin.link.configuration import Settings, write_configuration
from twin.link.linuxcnc import (
    LOG_NAME,
    OPERATOR,
    LinuxCnc,
    operator_log,
    require_linuxcnc,
    running,
)
from twin.link.linuxcnc_program import linuxcnc_program
from twin.link.lockstep import LockstepMotion
from twin.link.place import Places
from twin.machine.simulation.live import LiveMachine
from twin.machine.watching.alarms import Alarm, AlarmCode
from twin.nc.canonical import concatenate
from twin.run.dry_run import DryRun
from twin.run.outcome import Outcome
from twin.run.progress import Progress
from twin.run.run import Run

FOLDER_NAME = "linuxcnc"
"""Where, in the folder of a run, all that LinuxCNC reads and writes lies."""
PROGRAM_NAME = "program.ngc"
_FOLLOWING_ERROR = re.compile(r"joint (\d+) following error", re.IGNORECASE)


def run_headless(
    run: Run,
    dry_run: DryRun,
    folder: Path,
    progress: Progress,
    *,
    following_error_limit: float | None = None,
    say: Callable[[str], None],
) -> Outcome:
    """Let LinuxCNC run a prepared program on the twin.

    Args:
        run: The prepared job.
        dry_run: What its dry run found.
        folder: For the results; LinuxCNC's own files go into a folder in it.
        progress: Told how far the run is.
        following_error_limit: LinuxCNC's own limit [mm or deg]; None: the machine's.
        say: Told what LinuxCNC says.

    Raises:
        UsageError: LinuxCNC or its component is not installed, or cannot drive this machine.
    """
    start = require_linuxcnc()
    preparation = run.preparation
    machine, axes = preparation.machine, preparation.machine.axes
    own = folder.resolve() / FOLDER_NAME
    own.mkdir(exist_ok=True)
    install(own, module_folder(start))
    program = linuxcnc_program(preparation.interpretation().chunks(), axes)
    write_text(own / PROGRAM_NAME, program.text)
    moves = concatenate([chunk.moves for chunk in preparation.interpretation().chunks()], axes)
    live = LiveMachine(machine, preparation.job.file.tools[0], preparation.start + run.part_zero)
    places = Places(moves, program.move_of_line)
    with LockstepMotion(live, places, run.part_zero) as motion:
        display = (
            f"{_executable_operator(own)} --program {own / PROGRAM_NAME} --joints {len(axes)} "
            f"--log {operator_log(own)}"
        )
        settings = Settings(
            display=display,
            port=motion.port,
            following_error_limit=following_error_limit,
            part_zero=run.part_zero,
            job=preparation.job.file,
        )
        ini = write_configuration(own, machine, settings)
        with running(start, ini, folder / LOG_NAME) as linuxcnc:
            motion.goes_on = linuxcnc.goes_on
            motion.last_word = _last_word(linuxcnc, axes.names)
            outcome = run.execute(dry_run, folder, progress, motion)
            linuxcnc.wait()
            for event in linuxcnc.events():
                if event.text:
                    say(f"linuxcnc: {event.text}")
    return outcome


def _executable_operator(folder: Path) -> Path:
    """LinuxCNC's Python may be another than the twin's, whose folders its user may not enter."""
    path = folder / OPERATOR.name
    write_text(path, OPERATOR.read_text(encoding="utf-8"))
    path.chmod(0o755)
    return path


def _last_word(linuxcnc: LinuxCnc, axes: tuple[str, ...]) -> Callable[[float, int], Alarm | None]:
    """What LinuxCNC itself stopped for, asked when it has gone."""

    def alarm(time_s: float, line: int) -> Alarm | None:
        linuxcnc.wait()
        events = linuxcnc.events()
        if any(event.event == "finished" for event in events):
            return None
        errors = [event.text for event in events if event.event == "error"]
        code: AlarmCode = "control-stop"
        axis = ""
        for text in errors:
            if found := _FOLLOWING_ERROR.search(text):
                code, axis = "following-error", axes[int(found.group(1))]
        said = "; ".join(errors or [event.text for event in events[-1:]])
        reason = f"LinuxCNC stopped: {said}" if said else "LinuxCNC ended before the program did"
        return Alarm(code, line, time_s, axis, reason)

    return alarm
