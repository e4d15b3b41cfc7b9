"""The force of the cut: how much faster than in reality a slot in steel is simulated, and teeth beside mean."""

from collections.abc import Iterator
from functools import partial

import numpy as np
from benches.row import Row, cpu_seconds_in_turns, median_cpu_seconds

from twin.columns import join
from twin.coupling.operations import OperatorOperation, cutting_process
from twin.files.shipped import machine_file
from twin.job.job_file import StockTable, ToolTable
from twin.job.load import Job
from twin.machine.circle.circle_path import CirclePath
from twin.machine.load import read_machine
from twin.machine.model.model import build_spec, physics_model
from twin.machine.simulation.simulate import simulate
from twin.run.outcome import Outcome
from twin.run.preparation import prepare_job
from twin.run.progress import no_progress
from twin.run.run import Run
from twin.training.scene.scene_file import read_scene, scene_path

CELLS = (0.5, 0.2, 0.1)
DEPTH_MM = 3.0
TOOL = ToolTable(number=1, diameter=10.0, teeth=4)
JOB = "fagor_full_circle"
"""A scene whose job cuts a groove in aluminium: it names a material, and its program the spindle's speed."""
TEETH = "tooth by tooth"
WAYS: dict[str, dict[str, str | bool]] = {
    TEETH: {"cutting_force": "teeth"},
    "mean force": {"cutting_force": "mean"},
    "mean force, cutting_load": {"cutting_force": "mean", "cutting_load": True},
}


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


def _teeth_beside_mean() -> Iterator[Row]:
    """One job with the force of every tooth, beside the mean force told, and fed to the axes ahead."""
    outcomes: dict[str, Outcome] = {}

    def run(way: str) -> None:
        outcomes[way] = _outcome(WAYS[way])

    seconds = cpu_seconds_in_turns(*(partial(run, way) for way in WAYS))
    teeth, *means = [_told(outcomes[way], each) for way, each in zip(WAYS, seconds, strict=True)]
    bend_um = outcomes[TEETH].loads.greatest["deflection_um"].value
    yield Row("coupling", f"{JOB}, teeth: greatest deflection of the tool", bend_um, "µm")
    for peer, mean in zip([way for way in WAYS if way != TEETH], means, strict=True):
        for (task, unit), figure in teeth.items():
            beside = mean[task, unit]
            yield Row("coupling", f"{JOB}, teeth: {task}", figure, unit, peer, beside)


def _outcome(changes: dict[str, str | bool]) -> Outcome:
    job = read_scene(scene_path(JOB)).preparation.job
    run = Run(prepare_job(Job(job.folder, job.file.model_copy(update=changes))))
    return run.execute(run.dry_run(), None, no_progress)


def _told(outcome: Outcome, seconds: float) -> dict[tuple[str, str], float]:
    """The figures of a run, by name and unit."""
    assert outcome.cut is not None
    assert outcome.cut.force_n is not None
    assert not outcome.alarms
    felt = outcome.loads.greatest.get("force_n")
    return {
        ("worst contour error", "µm"): outcome.figures.contour.max,
        ("greatest force told", "N"): outcome.cut.force_n if felt is None else felt.value,
        ("material removed", "mm³"): outcome.cut.removed_mm3,
        ("processor time of the run", "s"): seconds,
    }
