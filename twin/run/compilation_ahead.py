"""A second process that compiles what the later stages of a run call, while the run plans its first part.

A run that finds a kernel missing compiles one after the other as its stages come to them: the planner's first,
then those of drives, cut and comparison. Here these last ones are called at once with some setpoints that no planner
made. Both processes keep what they compile in one folder, and wait there for each other (``twin.compilation.cache``).
"""

import contextlib
import multiprocessing
import os
import signal
import sys
import threading
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from twin.compare.comparison import Comparison
from twin.compilation.folders import lasts
from twin.errors import TwinError
from twin.motion.setpoints.setpoints import Setpoints
from twin.nc.canonical import FloatArray, Motion
from twin.processor import available_cores
from twin.run.assumed_job import with_assumptions
from twin.run.preparation import prepare
from twin.run.progress import no_progress
from twin.run.run import Run

SETPOINTS = 64
BELOW_MM = 0.5
STEP_MM = np.array([0.005, 0.005, -0.01])
"""From one to the next: slow enough for any machine."""


def start_compiling(path: Path, dialect: str | None, machine: str | None) -> None:
    """Begin to compile beside this process, where a second core and a common folder for kernels are there.

    The process ends with this one.

    Args:
        path: NC program or job file that is run.
        dialect: Overrides the job's dialect.
        machine: Overrides the job's machine.
    """
    if available_cores() < 2 or not lasts():
        return
    context = multiprocessing.get_context("spawn")
    context.Process(target=_compile, args=(path, dialect, machine), daemon=True).start()


def _compile(path: Path, dialect: str | None, machine: str | None) -> None:
    """Go through the later stages; what is wrong with the job is told by the run itself."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    sys.stdout = sys.stderr = Path(os.devnull).open("w", encoding="utf-8")  # noqa: SIM115 (until the process ends)
    threading.Thread(target=_end_with_parent, daemon=True).start()
    with contextlib.suppress(TwinError):
        preparation = prepare(path, dialect=dialect, machine=machine)
        if preparation.job.path is None:
            preparation, _ = with_assumptions(preparation, machine=machine, strict=False)
        run = LaterStages(preparation)
        run.execute(run.dry_run(), None, no_progress)


def _end_with_parent() -> None:
    parent = multiprocessing.parent_process()
    if parent is not None:
        parent.join()
        os._exit(0)


class LaterStages(Run):
    """A run whose setpoints go aslant into the middle of the blank and need no planner."""

    def _setpoints(self, comparison: Comparison) -> Iterator[Setpoints]:
        before = 0
        for chunk in self.preparation.timed_chunks():
            moves = chunk.moves
            comparison.expect(moves)
            feeds = np.flatnonzero(moves.motion == Motion.FEED)
            if not len(feeds):
                before += len(moves)
                continue
            # Two moves, for what is done where one ends.
            ticks = np.arange(SETPOINTS)
            move = np.minimum(feeds[0] + ticks // (SETPOINTS // 2), len(moves) - 1)
            step = np.zeros(moves.start.shape[1])
            step[:3] = STEP_MM
            position = np.tile(moves.end[feeds[0]], (SETPOINTS, 1))
            position[:, :3] = self._into_the_blank()
            period = self.preparation.machine.file.servo_period_s
            yield Setpoints(
                time=ticks * period,
                line=moves.line[move],
                move=before + move,
                fraction=ticks % (SETPOINTS // 2) / (SETPOINTS // 2),
                position=position + self.part_zero + np.outer(ticks, step),
                velocity=np.tile(step / period, (SETPOINTS, 1)),
                acceleration=np.zeros((SETPOINTS, len(step))),
            )
            return

    def _into_the_blank(self) -> FloatArray:
        """Just below its top, in the middle of what is not bored, part coordinates, shape (3,) [mm]."""
        stock = self.preparation.job.file.stock
        if stock is None:
            return np.zeros(3)
        aside = 0.0 if stock.bore is None else 0.25 * (stock.extent[0] + stock.bore)
        return np.array(stock.position) + [aside, 0.0, -BELOW_MM]
