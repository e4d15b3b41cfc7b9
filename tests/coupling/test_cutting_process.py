"""A tool that cuts while the machine moves: what it feels, how it bends, and what that depends on."""

import itertools

import numpy as np
import pytest

from tests.machine.machine_fixtures import line, shipped_machine
from twin.columns import join
from twin.coupling.cutting_process import CuttingProcess
from twin.coupling.operations import OperatorOperation, cutting_process
from twin.cutting.cut import Cutter
from twin.cutting.forces.tool_strength import tool_strength
from twin.job.job_file import StockTable, ToolTable
from twin.machine.description.config import MachineConfig
from twin.machine.model.model import build_spec, drives, physics_model
from twin.machine.simulation.live import LiveMachine
from twin.machine.simulation.simulate import simulate
from twin.motion.setpoints.setpoints import Setpoints
from twin.recording.form import Samples, ToolLoad

STOCK = StockTable(
    shape="box", size=(80.0, 40.0, 20.0), position=(45.0, 0.0, 4.0), cell=0.2, material="C45"
)
TOOL = ToolTable(number=1, diameter=10.0, teeth=4, made_of="carbide")
SPEED = 3000.0
WAY = line(axis=0, speed=16.0, seconds=1.5)
"""From before the stock into it, 4 mm deep: a slot with 0.08 mm a tooth."""


def process(
    machine: MachineConfig, tool: ToolTable = TOOL, stock: StockTable = STOCK, speed: float = SPEED
) -> CuttingProcess:
    operation = OperatorOperation(tool)
    operation.speed = speed
    assert stock.cell is not None
    found = cutting_process(stock, stock.cell, operation, machine, machine.part_frame, np.zeros(4))
    assert found is not None
    return found


def run(
    chunks: list[Setpoints], cut: CuttingProcess | None, machine: MachineConfig | None = None
) -> Samples:
    machine = machine or shipped_machine()
    model = physics_model(machine, build_spec(machine))
    return join(list(simulate(machine, model, chunks, process=cut)))


def loads(samples: Samples) -> ToolLoad:
    assert samples.tool is not None
    return samples.tool


def test_chunks_change_no_bit() -> None:
    machine = shipped_machine()
    whole = run([WAY], process(machine))
    borders = [0, 1, 2, 3, 500, 501, 640, len(WAY)]
    parts = [WAY[a:b] for a, b in itertools.pairwise(borders)]
    again = run(parts, process(machine))
    np.testing.assert_array_equal(whole.joint_position, again.joint_position)
    for name in ("force", "chip", "deflection", "spindle_load", "peak_force"):
        np.testing.assert_array_equal(getattr(loads(whole), name), getattr(loads(again), name))
    assert loads(whole).force.any()


def test_a_tool_in_the_air_moves_the_machine_as_none_does() -> None:
    machine = shipped_machine()
    away = STOCK.model_copy(update={"position": (0.0, 200.0, 0.0)})
    with_process = run([WAY], process(machine, stock=away))
    np.testing.assert_array_equal(with_process.joint_position, run([WAY], None).joint_position)
    assert not loads(with_process).force.any()


def test_the_axes_are_pushed_by_what_the_teeth_feel() -> None:
    machine = shipped_machine()
    cut = run([WAY], process(machine))
    free = run([WAY], None)
    off = cut.joint_position - free.joint_position
    late = slice(-300, None)
    force = loads(cut).force[late].mean(axis=0)
    assert force[0] < 0.0 < force[1], "held back along X, pushed to the left"
    # A loop without integral action gives way by force over gain.
    gain = np.array([loop.position_gain for loop in drives(machine, build_spec(machine).compile())])
    np.testing.assert_allclose(off[late, :2].mean(axis=0) * 1e-3, force[:2] / gain[:2], rtol=0.03)


def test_the_tool_bends_by_the_mean_force_over_its_stiffness() -> None:
    samples = run([WAY], process(shipped_machine()))
    load, late = loads(samples), slice(-100, None)
    # A turn takes 20 ms: its mean is the mean of 100 samples.
    meant = tool_strength(TOOL).compliance * load.force[late, :2].mean(axis=0)
    np.testing.assert_allclose(load.deflection[late, :2].mean(axis=0), meant, rtol=0.02)
    assert np.abs(load.deflection[late]).max() > 0.02
    assert load.chip[-1] == pytest.approx(0.08, rel=0.01)
    assert load.power[-1] == pytest.approx(load.spindle_load[-1] * 11000.0)


def test_halving_the_step_changes_little() -> None:
    machine = shipped_machine()
    finer = MachineConfig(machine.path, machine.file.model_copy(update={"servo_period_s": 0.5e-3}))
    twice = np.repeat(np.arange(len(WAY)), 2)[:-1]
    between = twice.copy()
    between[1::2] += 1
    mean = lambda column: 0.5 * (column[twice] + column[between])  # noqa: E731
    fine = Setpoints(
        0.5e-3 * np.arange(len(twice), dtype=np.float64), WAY.line[twice], WAY.move[twice], WAY.fraction[twice],
        mean(WAY.position), mean(WAY.velocity), mean(WAY.acceleration),
    )  # fmt: skip
    coarse = run([WAY], process(machine), machine)
    halved = run([fine], process(finer), finer)[::2]
    bend, bend_halved = loads(coarse).deflection, loads(halved).deflection
    assert np.abs(bend).max() > 0.02
    assert np.sqrt(np.mean((bend - bend_halved) ** 2)) < 0.02 * np.abs(bend).max()
    moved = np.abs(coarse.joint_position - halved.joint_position)[:, :3].max()
    assert moved < 0.0015


def walls(passes: list[float]) -> list[float]:
    """How far a wall is off after each pass along it at an offset [mm]."""
    machine = shipped_machine()
    slender = ToolTable(number=1, diameter=10.0, teeth=4, flute=40.0, free_length=55.0, length=90.0)
    narrow = StockTable(
        shape="box", size=(6.0, 6.0, 20.0), position=(15.0, -1.0, 4.0), cell=0.02, material="C45"
    )
    cutter = Cutter(narrow, slender, machine.part_frame, np.zeros(4))
    operation = OperatorOperation(slender)
    operation.speed = SPEED
    cut = cutting_process(narrow, 0.02, operation, machine, machine.part_frame, np.zeros(4))
    found = []
    for offset in passes:
        # To +X, the material on the right: climb milling, which pushes the tool off the wall.
        way = line(axis=0, speed=16.0, seconds=2.2)
        position = way.position + np.array([0.0, 5.0 + offset, 0.0, 0.0])
        moved = Setpoints(
            way.time, way.line, way.move, way.fraction, position, way.velocity, way.acceleration
        )
        samples = run([moved], cut, machine)
        cutter.add(samples, np.zeros(len(samples), np.bool_))
        heights = cutter.map.heights[:, len(cutter.map.x) // 2]
        found.append(float(cutter.map.y[heights > 1.0].max()) - offset)
    return found


def test_a_finishing_pass_leaves_less_than_the_roughing_pass_did() -> None:
    roughing, finishing = walls([-1.5, -1.7])
    assert abs(roughing) > 0.02, "the tool gave way"
    assert abs(finishing) < 0.6 * abs(roughing)


@pytest.mark.seconds("a cut goes on until its tool breaks")
def test_a_broken_tool_cuts_no_more() -> None:
    machine = shipped_machine()
    weak = TOOL.model_copy(update={"force_limit": 300.0})
    cut = process(machine, tool=weak)
    load = loads(run([WAY[:600], WAY[600:]], cut))
    (broken,) = cut.breaks
    row = int(np.argmax(load.broken))
    assert load.broken[row:].all()
    assert not load.broken[:row].any()
    assert broken.time_s == pytest.approx(WAY.time[row])
    assert broken.line == WAY.line[row]
    assert "was greater than the 300 N it bears" in broken.reason
    assert not load.force[row:].any()
    assert load.force[:row].any()


def test_a_material_that_is_not_named_is_not_simulated() -> None:
    machine = shipped_machine()
    unnamed = STOCK.model_copy(update={"material": None})
    operation = OperatorOperation(TOOL)
    assert (
        cutting_process(unnamed, 0.2, operation, machine, machine.part_frame, np.zeros(4)) is None
    )


def test_a_live_machine_feels_the_cut_as_a_run_does() -> None:
    machine = shipped_machine()
    whole = run([WAY], process(machine))
    live = LiveMachine(machine)
    live.step_with(process(machine))
    parts = [live.follow(WAY[first : first + 10]) for first in range(1, len(WAY), 10)]
    followed = join(parts)
    np.testing.assert_array_equal(followed.joint_position, whole.joint_position[1:])
    np.testing.assert_array_equal(loads(followed).force, loads(whole).force[1:])


def test_a_stalled_spindle_stops_a_live_machine() -> None:
    machine = shipped_machine()
    tough = TOOL.model_copy(update={"force_limit": 1e9, "chip_limit": 1e9, "diameter": 60.0})
    live = LiveMachine(machine)
    live.step_with(process(machine, tool=tough, speed=20.0))
    for first in range(1, len(WAY), 10):
        live.follow(WAY[first : first + 10])
        if live.alarm is not None:
            break
    assert live.alarm is not None
    assert live.alarm.code == "spindle-stall"
