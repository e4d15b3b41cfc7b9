"""The twin from Python: the same rooms as the command line, with plain NumPy columns.

    import twin

    moves = twin.interpret("programs/mefi/helix.nc")
    setpoints = twin.plan("programs/mefi/helix.nc")
    done = twin.run("programs/mefi/helix.nc", out="out/helix")
    difference = twin.compare("out/helix/recording.h5", "log.csv")

Every function raises ``twin.errors.TwinError`` where the command would end with a message.
"""

import dataclasses
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy.typing as npt

from twin.columns import join
from twin.compare.track_comparison import compare_files
from twin.errors import RecordingError
from twin.machine.description.motion_limits import motion_limits
from twin.motion.planner import plan as plan_chunks
from twin.motion.setpoints.setpoints import Setpoints
from twin.nc.canonical import Moves, concatenate
from twin.recording.reader import open_recording
from twin.run.interpreted import InterpretedProgram, interpreted
from twin.run.outcome import Outcome
from twin.run.preparation import prepare
from twin.run.progress import no_progress
from twin.run.results import RESULT_FILES, write_results
from twin.run.run import Run
from twin.run.run_folder import run_folder


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class FinishedRun:
    """A run that was carried out.

    Attributes:
        outcome: Verdict, figures, alarms, final positions.
        recording: The recording, for ``twin.recording.reader.open_recording``; None when nothing moved.
    """

    outcome: Outcome
    recording: Path | None

    def column(self, name: str) -> npt.NDArray[Any]:
        """One dataset of the recording, such as ``joint/position``, shape (n,) or (n, k).

        Raises:
            RecordingError: Nothing moved, so that there is none.
        """
        if self.recording is None:
            raise RecordingError("nothing moved: there is no recording")
        with open_recording(self.recording) as recording:
            return recording.column(name)


compare = compare_files


def interpret(
    program: str | Path, *, dialect: str | None = None, machine: str | None = None
) -> Moves:
    """The canonical moves of a program or job, as columns in part coordinates.

    Args:
        program: NC program, job file, or a shipped program's name (``mefi/helix``).
        dialect: One of ``twin dialects``; told by the program's words by default.
        machine: A shipped machine's name, or a machine file; the job's by default.

    Returns:
        n moves over k axes. ``start``, ``end``: shape (n, k) [mm or deg]; ``feed``: shape (n,)
        [mm/min or deg/min], NaN for rapids; ``line``: shape (n,); arcs with ``center`` and ``normal``,
        shape (n, 3), ``radius`` [mm] and ``sweep`` [deg]. ``pandas.DataFrame(moves)`` has a column for
        each, ``start`` and ``end`` by axis.

    Raises:
        ProgramError: The program is wrong; the message has the line and a caret.
        UsageError: A file is missing or wrong.

    Example:
        >>> moves = twin.interpret("part.nc")
        >>> moves.end[-1]
        array([20.5 , -4.25,  0.  ,  0.  ])
    """
    preparation = prepare(Path(program), dialect=dialect, machine=machine)
    chunks = preparation.interpretation().chunks()
    return concatenate([chunk.moves for chunk in chunks], preparation.machine.axes)


def plan(
    program: str | Path, *, dialect: str | None = None, machine: str | None = None
) -> Setpoints:
    """The setpoints of a program or job at the servo period, in machine coordinates.

    Args:
        program: NC program, job file, or a shipped program's name.
        dialect: One of ``twin dialects``; told by the program's words by default.
        machine: A shipped machine's name, or a machine file; the job's by default.

    Returns:
        n samples over k axes: ``time`` [s] and ``line``, shape (n,); ``position`` [mm or deg],
        ``velocity`` [per s] and ``acceleration`` [per s²], shape (n, k).

    Raises:
        ProgramError: The program is wrong.
        UsageError: A file is missing or wrong.

    Example:
        >>> setpoints = twin.plan("part.nc")
        >>> setpoints.time[-1]  # the cycle time [s]
        2.31
    """
    run = Run(prepare(Path(program), dialect=dialect, machine=machine))
    return join(list(setpoints(run, interpreted(run.preparation))))


def setpoints(run: Run, program: InterpretedProgram) -> Iterator[Setpoints]:
    """The setpoints of a run's program, in chunks."""
    machine = run.machine
    return plan_chunks(
        program.timed_chunks(),
        motion_limits(machine),
        period_s=machine.file.servo_period_s,
        part_zero=run.part_zero,
        start=program.start + run.part_zero,
    )


def run(
    program: str | Path,
    *,
    out: str | Path,
    dialect: str | None = None,
    machine: str | None = None,
) -> FinishedRun:
    """Simulate, compare and cut a program or job.

    Writes what ``twin run`` writes into the folder ``out``: result, report, recording, part.

    Args:
        program: NC program, job file, or a shipped program's name.
        out: The folder; made when missing.
        dialect: One of ``twin dialects``; told by the program's words by default.
        machine: A shipped machine's name, or a machine file; the job's by default.

    Returns:
        ``outcome`` with verdict and figures [µm, mdeg], and ``column(name)`` for the datasets of the
        recording, such as ``joint/position``, shape (n, k) [mm or deg].

    Raises:
        ProgramError: The program is wrong.
        UsageError: A file is missing or wrong, or another run holds the folder.

    Example:
        >>> done = twin.run("part.toml", out="out/part")
        >>> done.outcome.verdict.outcome, done.outcome.figures.contour.max
        ('pass', 3.4)
    """
    folder = Path(out)
    chain = Run(prepare(Path(program), dialect=dialect, machine=machine))
    dry_run = chain.dry_run()
    with run_folder(folder, RESULT_FILES):
        outcome = chain.execute(dry_run, folder, no_progress)
        write_results(chain, outcome, folder)
    recording = folder / "recording.h5"
    return FinishedRun(outcome=outcome, recording=recording if recording.is_file() else None)
