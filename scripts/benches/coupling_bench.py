"""The force of the cut: how much faster than in reality a slot in steel is simulated, and teeth beside mean."""

import dataclasses
from collections.abc import Iterator

import numpy as np
from benches.row import Row, median_cpu_seconds

from twin.columns import join
from twin.coupling.operations import OperatorOperation, cutting_process
from twin.files.shipped import machine_file
from twin.job.job_file import Job, StockTable, ToolTable
from twin.machine.circle.circle_path import CirclePath
from twin.machine.description.config import read_machine
from twin.machine.model.model import build_spec, physics_model
from twin.machine.simulation.simulate import simulate
from twin.run.outcome import Outcome
from twin.run.preparation import Preparation, prepare_job
from twin.run.progress import no_progress
from twin.run.run import Run
from twin.training.scene.scene_file import read_scene, scene_path

CELLS = (0.5, 0.2, 0.1)
DEPTH_MM = 3.0
TOOL = ToolTable(number=1, diameter=10.0, teeth=4)
JOB = "fagor_full_circle"
"""A scene whose job cuts a groove in aluminium: it names a material, and its program the spindle's speed."""


def rows() -> Iterator[Row]:
    """A circle that a 10 mm cutter mills 3 mm deep, by cell; without force; then one job both ways."""
    machine = read_machine(machine_file("mill4"))
    model = physics_model(machine, build_spec(machine))
    points = join(list(CirclePath(machine, "XY", 20.0, 700.0, 1).setpoints()))
    middle = 0.5 * (points.position.min(axis=0) + points.position.max(axis=0))
    operation = OperatorOperation(TOOL)
    operation.speed = 3000.0

    def step(stock: StockTable | None) -> float:
        felt = 0.0

        def run() -> None:
            nonlocal felt
            process = None
            if stock is not None:
                assert stock.cell is not None
                frame = machine.part_frame
                process = cutting_process(stock, stock.cell, operation, machine, frame, middle)
            for samples in simulate(machine, model, [points], process=process):
                felt = 0.0 if samples.tool is None else float(np.abs(samples.tool.force).max())

        faster = float(points.time[-1] - points.time[0]) / median_cpu_seconds(run)
        assert (felt > 0.0) == (stock is not None)
        return faster

    for cell in CELLS:
        stock = StockTable(
            shape="box",
            size=(80.0, 80.0, 20.0),
            position=(0.0, 0.0, DEPTH_MM),
            cell=cell,
            material="C45",
        )
        task = f"mill4 cuts a slot in steel, 10 mm tool, cell {cell} mm"
        yield Row("coupling", task, step(stock), "x real time")
    yield Row("coupling", "the same way without force", step(None), "x real time")
    yield from _teeth_beside_mean()


@dataclasses.dataclass(frozen=True, slots=True)
class _Way:
    """What a run comes to with one ``cutting_force``."""

    contour_um: float
    bend_um: float
    force_n: float
    removed_mm3: float
    seconds: float


def _teeth_beside_mean() -> Iterator[Row]:
    """One job with the force of every tooth, beside the mean force told, and fed to the axes ahead."""
    teeth = _way({"cutting_force": "teeth"})
    yield Row("coupling", f"{JOB}, teeth: greatest deflection of the tool", teeth.bend_um, "µm")
    for peer, load in (("mean force", False), ("mean force, cutting_load", True)):
        mean = _way({"cutting_force": "mean", "cutting_load": load})
        for task, unit, figure in (
            ("worst contour error", "µm", "contour_um"),
            ("greatest force told", "N", "force_n"),
            ("material removed", "mm³", "removed_mm3"),
            ("processor time of the run", "s", "seconds"),
        ):
            ours, theirs = getattr(teeth, figure), getattr(mean, figure)
            yield Row("coupling", f"{JOB}, teeth: {task}", ours, unit, peer, theirs)


def _way(changes: dict[str, str | bool]) -> _Way:
    job = read_scene(scene_path(JOB)).preparation.job
    prepared = prepare_job(Job(job.folder, job.file.model_copy(update=changes)))
    outcomes: list[Outcome] = []
    seconds = median_cpu_seconds(lambda: outcomes.append(_outcome(prepared)))
    outcome = outcomes[-1]
    assert outcome.cut is not None
    assert outcome.cut.force_n is not None
    assert not outcome.alarms
    felt = {name: each.value for name, each in outcome.loads.greatest.items()}
    return _Way(
        outcome.figures.contour.max,
        felt.get("deflection_um", 0.0),
        felt.get("force_n", outcome.cut.force_n),
        outcome.cut.removed_mm3,
        seconds,
    )


def _outcome(prepared: Preparation) -> Outcome:
    run = Run(prepared)
    return run.execute(run.dry_run(), None, no_progress)
