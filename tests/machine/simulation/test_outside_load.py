"""What pushes the axes from outside, against the formulas of the position loop."""

import numpy as np
import pytest

from tests.machine.machine_fixtures import line, shipped_machine
from twin.machine.model.drives import Drive
from twin.machine.model.model import build_spec, drives, physics_model
from twin.machine.simulation.simulate import Load, simulate
from twin.motion.setpoints.setpoints import Setpoints
from twin.nc.canonical import FloatArray
from twin.recording.reader import Samples

LOAD = np.array([400.0, -300.0, 200.0, 25.0])


def stand_still(seconds: float) -> Setpoints:
    return line(axis=0, speed=0.0, seconds=seconds)


def constant(setpoint: Setpoints) -> FloatArray:
    return np.tile(LOAD, (len(setpoint), 1))


def loops() -> tuple[Drive, ...]:
    machine = shipped_machine()
    return drives(machine, build_spec(machine).compile())


def run(chunks: list[Setpoints], load: Load | None = constant, **changes: float) -> list[Samples]:
    machine = shipped_machine(**changes)
    model = physics_model(machine, build_spec(machine))
    return list(simulate(machine, model, chunks, load=load))


def test_a_constant_load_bends_the_position_loop_by_force_over_gain() -> None:
    samples = run([stand_still(1.0)])
    off = samples[-1].joint_position[-1] - samples[0].joint_position[0]
    for index, loop in enumerate(loops()):
        scale = 1e-3 if index < 3 else np.deg2rad(1.0)
        meant = LOAD[index] / loop.position_gain / scale
        if loop.integral_gain == 0.0:
            assert off[index] == pytest.approx(meant, rel=0.02), index
        else:
            assert abs(off[index]) < abs(meant), "the integrator works it off"


def test_loads_are_carried_over_chunks_without_a_trace() -> None:
    whole = stand_still(0.3)
    (one,) = run([whole])
    three = run([whole[:70], whole[70:71], whole[71:]])
    np.testing.assert_array_equal(
        one.joint_position, np.concatenate([part.joint_position for part in three])
    )
    assert np.abs(np.diff(one.joint_position, axis=0)).max() > 0.0


def test_no_load_is_the_same_as_none() -> None:
    moving = line(axis=1, speed=50.0, seconds=0.4)
    (without,) = run([moving], None)
    (nothing,) = run([moving], lambda chunk: np.zeros((len(chunk), 4)))
    np.testing.assert_array_equal(without.joint_position, nothing.joint_position)


def test_a_load_strains_what_gives_on_the_axis_side() -> None:
    still = stand_still(1.0)
    rigid = run([still])[-1].joint_position[-1]
    springy = run([still], stiffness=2000.0)[-1].joint_position[-1]
    assert springy[0] - rigid[0] == pytest.approx(LOAD[0] / 2000.0, rel=0.1)
