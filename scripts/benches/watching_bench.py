"""What watching costs: runs whose verdict looks at everything, beside the same machines stepped with nobody looking.

"`twin run` with all watching takes at most 1.15 of the simulation" is read so. The simulation is the pipeline that steps the
machine: moves planned, setpoints settled, MuJoCo stepped, pushed by the cut where the job simulates its forces. Watching is what
the verdict looks at while samples pass: collisions and limits, the cut (volume, air, what must not meet the stock, walls), loads,
the comparison with the path, the run thinned for plots. Reading, checking and laying out come before both; the recording, the part
and the report are output. Both are taken by processor time and by elapsed time: the machine is stepped a chunk ahead of
those who look, on another core where there is one, so that of a run of several chunks (16 s each) the longer of both remains.
"""

import statistics
import time
from collections.abc import Callable, Iterator

from benches.row import REPEATS, Row, processor_seconds

from twin.files.shipped import resource_root
from twin.machine.simulation.simulate import simulate
from twin.motion.setpoints.sampling import settle
from twin.run.pipeline import cutting_forces, planned
from twin.run.preparing.preparation import prepare
from twin.run.progress import no_progress
from twin.run.run import Run

JOBS = (
    "gallery/fagor8070/medallion", "fanuc/cone", "fanuc/four_sides", "haas/bracket", "haas/five_sides",
    "heidenhain/flange", "linuxcnc/wrapped_spiral", "sinumerik/arcs", "sinumerik/leaning_contour",
)  # fmt: skip
"""Lines, arcs, cycles, a turning table, tilted planes and five axes together."""


Task = Callable[[Run], object]


def rows() -> Iterator[Row]:
    """How long a run takes beside its simulation."""
    for job in JOBS:
        taken: dict[Task, list[tuple[float, float]]] = {_watched: [], _bare: []}
        for _ in range(REPEATS + 1):
            for task, kept in taken.items():
                kept.append(_seconds(task, job))
        watched, bare = (zip(*kept[1:], strict=True) for kept in taken.values())
        for kind, ours, alone in zip(("processor", "elapsed"), watched, bare, strict=True):
            figures = statistics.median(ours), statistics.median(alone)
            yield Row(
                "watching", f"{job}, {kind}", figures[0], "s", "the simulation alone", figures[1]
            )


def _seconds(task: Task, job: str) -> tuple[float, float]:
    """Processor and elapsed time of a task with a job that is prepared for it [s]."""
    run = Run(prepare(resource_root("programs") / f"{job}.toml"))
    used, began = processor_seconds(), time.perf_counter()
    task(run)
    return processor_seconds() - used, time.perf_counter() - began


def _watched(run: Run) -> None:
    run.execute(None, no_progress)


def _bare(run: Run) -> None:
    setpoints = planned(run.dry_run.program, run.preparation)
    forces = cutting_forces(run.preparation, run.dry_run.summary)
    settled = settle(setpoints, run.machine.file.servo_period_s)
    for _ in simulate(run.machine, run.model.physics, settled, None, forces.load, forces.process):
        pass
