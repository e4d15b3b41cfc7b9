"""The twin from Python: the same rooms as the command line, with plain NumPy columns.

    from twin import api

    moves = api.interpret("programs/mefi/helix.nc")
    setpoints = api.plan("programs/mefi/helix.nc")
    done = api.run("programs/mefi/helix.nc", out="out/helix")
    difference = api.compare("out/helix/recording.h5", "log.csv")

Every function raises ``twin.errors.TwinError`` where the command would end with a message.
"""

import dataclasses
from collections.abc import Iterator
from pathlib import Path

from twin.chain import Run, motion_limits
from twin.compare.track_comparison import TrackDifference, compare_tracks
from twin.compare.tracks import read_track
from twin.motion.planner import plan as plan_chunks
from twin.motion.setpoints import Setpoints, join
from twin.nc.canonical import Moves, concatenate
from twin.outcome import Outcome
from twin.preparation import prepare
from twin.progress import no_progress


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class FinishedRun:
    """A run that was carried out.

    Attributes:
        outcome: Verdict, figures, alarms, final positions.
        recording: The recording, for ``twin.recording.open_recording``; None when nothing moved.
    """

    outcome: Outcome
    recording: Path | None


def interpret(
    program: str | Path, *, dialect: str | None = None, machine: str | None = None
) -> Moves:
    """The canonical moves of a program or job, as columns in part coordinates."""
    preparation = prepare(Path(program), dialect=dialect, machine=machine)
    chunks = preparation.interpretation().chunks()
    return concatenate([chunk.moves for chunk in chunks], preparation.machine.axes)


def plan(
    program: str | Path, *, dialect: str | None = None, machine: str | None = None
) -> Setpoints:
    """The setpoints of a program or job at the servo period, in machine coordinates."""
    return join(list(setpoints(Run(prepare(Path(program), dialect=dialect, machine=machine)))))


def setpoints(run: Run) -> Iterator[Setpoints]:
    """The same in chunks, for a run that is prepared already."""
    preparation = run.preparation
    return plan_chunks(
        preparation.interpretation().chunks(),
        motion_limits(preparation.machine),
        period_s=preparation.machine.file.servo_period_s,
        part_zero=run.part_zero,
        start=preparation.start + run.part_zero,
    )


def run(
    program: str | Path,
    *,
    out: str | Path,
    dialect: str | None = None,
    machine: str | None = None,
) -> FinishedRun:
    """Simulate, compare and cut a program or job; write its recording and part into a folder."""
    chain = Run(prepare(Path(program), dialect=dialect, machine=machine))
    outcome = chain.execute(chain.survey(), Path(out), no_progress)
    recording = Path(out) / "recording.h5"
    return FinishedRun(outcome=outcome, recording=recording if recording.is_file() else None)


def compare(
    first: str | Path,
    second: str | Path,
    *,
    period_s: float | None = None,
    offset_s: float | None = None,
) -> TrackDifference:
    """How two recordings, or a recording and a CSV log, differ after they are aligned in time."""
    one, other = (read_track(Path(path), period_s=period_s) for path in (first, second))
    return compare_tracks(one, other, offset_s=offset_s)
