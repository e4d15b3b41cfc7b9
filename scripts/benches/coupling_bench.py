"""The force of the cut: how much faster than in reality a slot in steel is simulated."""

from collections.abc import Iterator

import numpy as np
from benches.row import Row, median_cpu_seconds

from twin.columns import join
from twin.coupling.operations import OperatorOperation, cutting_process
from twin.files.shipped import machine_file
from twin.job.job_file import StockTable, ToolTable
from twin.machine.circle.circle_path import CirclePath
from twin.machine.load import read_machine
from twin.machine.model.model import build_spec, physics_model
from twin.machine.simulation.simulate import simulate

CELLS = (0.5, 0.2, 0.1)
DEPTH_MM = 3.0
TOOL = ToolTable(number=1, diameter=10.0, teeth=4)


def rows() -> Iterator[Row]:
    """A circle that a 10 mm cutter mills 3 mm deep, by cell; then without force."""
    machine = read_machine(machine_file("mill4"))
    model = physics_model(machine, build_spec(machine))
    points = join(list(CirclePath(machine, "XY", 20.0, 700.0, 1).setpoints()))
    middle = 0.5 * (points.position.min(axis=0) + points.position.max(axis=0))
    operation = OperatorOperation(TOOL)
    operation.speed = 3000.0

    def step(stock: StockTable | None) -> float:
        loads = 0.0

        def run() -> None:
            nonlocal loads
            process = None
            if stock is not None:
                assert stock.cell is not None
                frame = machine.part_frame
                process = cutting_process(stock, stock.cell, operation, machine, frame, middle)
            for samples in simulate(machine, model, [points], process=process):
                loads = 0.0 if samples.tool is None else float(np.abs(samples.tool.force).max())

        faster = float(points.time[-1] - points.time[0]) / median_cpu_seconds(run)
        assert (loads > 0.0) == (stock is not None)
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
