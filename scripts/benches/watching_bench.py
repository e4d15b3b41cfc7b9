"""Whole runs with all that watches, and the same runs with nothing that does, in processor time.

The simulation is what moves the axes: the program read, planned, followed by the simulated drives and stepped by MuJoCo,
pushed by the cut where the job simulates its forces. What watches it are collisions, the cut of the part, loads, the
comparison with the path, the thinned run for plots and the recording.
"""

import tempfile
from collections.abc import Iterator
from pathlib import Path

from benches.row import Row, cpu_seconds_in_turns

from twin.files.shipped import resource_root
from twin.machine.simulation.simulate import simulate
from twin.motion.setpoints.sampling import settle
from twin.run.pipeline import cutting_forces, planned
from twin.run.preparation import prepare
from twin.run.run import Run

JOBS = (
    "gallery/fagor8070/medallion", "fanuc/cone", "fanuc/four_sides", "haas/bracket", "haas/five_sides",
    "heidenhain/flange", "linuxcnc/wrapped_spiral", "sinumerik/arcs", "sinumerik/leaning_contour",
)  # fmt: skip
"""Lines, arcs, cycles, a turning table, tilted planes and five axes together."""


def rows() -> Iterator[Row]:
    """How often the time of the simulation a run takes."""
    with tempfile.TemporaryDirectory() as name:
        for job in JOBS:
            path = resource_root("programs") / f"{job}.toml"
            watched, bare = cpu_seconds_in_turns(
                lambda path=path: _watched(path, Path(name)), lambda path=path: _bare(path)
            )
            yield Row("watching", job, watched, "s", "the simulation alone", bare)


def _watched(job: Path, out: Path) -> None:
    run = Run(prepare(job))
    run.execute(run.dry_run(), out, lambda *_: None)


def _bare(job: Path) -> None:
    run = Run(prepare(job))
    dry_run = run.dry_run()
    model = run.model.physics
    setpoints = planned(dry_run.program, run.machine, run.part_zero)
    forces = cutting_forces(run.preparation.job.file, run.machine, dry_run, run.layout)
    period_s = run.machine.file.servo_period_s
    for _ in simulate(
        run.machine, model, settle(setpoints, period_s), None, forces.load, forces.process
    ):
        pass
