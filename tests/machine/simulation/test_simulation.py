import itertools

import mujoco
import numpy as np
import pytest

from tests.machine.machine_fixtures import circle, line, shipped_machine
from twin.columns import join
from twin.files.shipped import machine_file
from twin.machine.load import read_machine
from twin.machine.model.model import MachineModel, build_spec, physics_model
from twin.machine.simulation.sampling import held_velocity, polyline_node
from twin.machine.simulation.simulate import simulate
from twin.motion.setpoints.setpoints import Setpoints
from twin.recording.alarms import SimulationError
from twin.units import DEGREE, MM


def test_it_starts_at_rest_at_the_first_setpoint():
    machine = shipped_machine()
    points = circle(20.0, 3000.0, 0.1)
    points.position[:, 2] = -200.0
    (samples,) = simulate(machine, MachineModel(machine), [points])
    assert samples.joint_position[0] == pytest.approx(points.position[0])
    assert samples.joint_velocity[0] == pytest.approx(np.zeros(4))
    assert np.array_equal(samples.setpoint.time, points.time)


@pytest.mark.parametrize("sizes", [[1] * 5 + [395], [1, 199, 200], [400], [399, 1], [0, 7, 0, 393]])
def test_how_setpoints_are_cut_into_chunks_changes_no_bit(sizes):
    machine = shipped_machine()
    model = physics_model(machine, build_spec(machine))
    points = circle(10.0, 6000.0, 0.4)
    (whole,) = simulate(machine, model, [points])
    borders = np.cumsum([0, *sizes])
    assert borders[-1] == len(points)
    chunks = [points[first:last] for first, last in itertools.pairwise(borders)]
    parts = list(simulate(machine, model, chunks))
    assert np.array_equal(np.concatenate([p.joint_position for p in parts]), whole.joint_position)
    assert np.array_equal(np.concatenate([p.joint_velocity for p in parts]), whole.joint_velocity)
    assert np.array_equal(np.concatenate([p.drive_force for p in parts]), whole.drive_force)
    assert np.array_equal(join([p.setpoint for p in parts]).time, points.time)


IMPERFECT = {
    "mill4_light": {},
    "lugre": {
        "dry_friction": 300.0,
        "lugre": {"stiffness": 20000.0, "damping": 100.0, "static_friction": 400.0},
        "reset_time_s": 0.02,
    },
    "all": {
        "dry_friction": 200.0, "viscous_friction": 1.0, "backlash": 0.02, "stiffness": 9000.0,
        "counterbalance": 0.5, "reset_time_s": 0.05, "velocity_feedforward": 0.5,
    },
}  # fmt: skip


@pytest.mark.parametrize("name", sorted(IMPERFECT))
def test_imperfect_drives_do_not_see_the_chunks_either(name):
    if name == "mill4_light":
        machine = read_machine(machine_file(name))
    else:
        machine = shipped_machine(**IMPERFECT[name])
    model = physics_model(machine, build_spec(machine))
    points = circle(10.0, 2000.0, 0.8)
    points.position[:, 2] -= 50.0
    (whole,) = simulate(machine, model, [points])
    parts = list(simulate(machine, model, [points[i : i + 37] for i in range(0, len(points), 37)]))
    assert np.array_equal(np.concatenate([p.joint_position for p in parts]), whole.joint_position)
    assert np.array_equal(np.concatenate([p.drive_force for p in parts]), whole.drive_force)
    assert np.abs(whole.joint_position - whole.setpoint.position)[:, :3].max() < 0.5


def test_rollout_equals_stepping_in_python_bit_for_bit():
    machine = shipped_machine()
    model = physics_model(machine, build_spec(machine))
    points = circle(10.0, 6000.0, 0.3)
    (samples,) = simulate(machine, model, [points])
    data = mujoco.MjData(model)
    unit = np.array([MM, MM, MM, DEGREE])
    joints = [data.joint(machine.axis(name).joint) for name in machine.axes.names]
    for joint, value in zip(joints, points.position[0] * unit, strict=True):
        joint.qpos[0] = value
    nodes = polyline_node(points.position, points.acceleration, 0.001)
    velocity = held_velocity(nodes[:-1], nodes[1:], 0.001)
    servos = [model.actuator(name).id for name in machine.axes.names]
    data.act[model.actuator_actadr[servos]] = nodes[0] * unit
    expected = [[joint.qpos[0] for joint in joints]]
    for row in velocity:
        data.ctrl[model.actuator_ctrladr[servos]] = row * unit
        mujoco.mj_step(model, data)
        expected.append([joint.qpos[0] for joint in joints])
    assert np.array_equal(samples.joint_position, np.array(expected) / unit)


def test_neither_visuals_nor_fused_bodies_change_the_motion():
    machine = shipped_machine()
    model = MachineModel(machine)
    points = circle(10.0, 6000.0, 0.3)
    (lean,) = simulate(machine, model, [points])
    (full,) = simulate(machine, model.spec.compile(), [points])
    # Fused bodies add their masses in another order: the last bits differ.
    assert np.abs(lean.joint_position - full.joint_position).max() < 1e-12


def test_a_run_does_not_ask_the_clock():
    machine = shipped_machine()
    (_,) = simulate(machine, MachineModel(machine), [line(0, 1.0, 0.1)])
    data = mujoco.MjData(build_spec(machine).compile())
    mujoco.mj_step(data.model, data)
    assert data.timer[mujoco.mjtTimer.mjTIMER_STEP].number == 1
    assert data.timer[mujoco.mjtTimer.mjTIMER_STEP].duration == 0.0


def test_the_machine_holds_still_at_home():
    machine = shipped_machine()
    points = line(0, 0.0, 2.0)
    (samples,) = simulate(machine, MachineModel(machine), [points])
    assert np.abs(samples.joint_position).max() < 1e-6
    assert np.abs(samples.drive_force).max() < 1e-3


def test_the_force_on_a_line_is_what_accelerates_the_mass():
    machine = shipped_machine()
    (samples,) = simulate(machine, MachineModel(machine), [line(0, 200.0, 0.5)])
    carried = 485.0 + 38.0
    reflected = (0.00096 + 0.0024) * (2 * np.pi / 0.016) ** 2
    acceleration = np.gradient(samples.joint_velocity[:, 0], 0.001) * MM
    expected = (carried + reflected) * acceleration
    assert np.abs(expected).max() > 2000
    assert samples.drive_force[5:-5, 0] == pytest.approx(expected[5:-5], abs=5.0)


def test_following_error_stops_the_run_and_keeps_the_samples():
    machine = shipped_machine(following_error_limit=0.5)
    points = line(0, 200.0, 0.6)
    simulation = simulate(machine, MachineModel(machine), [points[:100], points[100:]])
    chunks = list(simulation)
    alarm = simulation.alarm
    assert alarm is not None
    assert (alarm.code, alarm.axis) == ("following-error", "X")
    last = chunks[-1][len(chunks[-1]) - 1 :]
    assert last.setpoint.time[0] == alarm.time_s
    assert last.setpoint.line[0] == alarm.line
    lags = np.concatenate([np.abs(c.setpoint.position - c.joint_position)[:, 0] for c in chunks])
    assert lags[-1] > 0.5
    assert lags[:-1].max() <= 0.5


def test_a_setpoint_that_is_not_a_number_is_refused():
    machine = shipped_machine()
    points = line(0, 10.0, 0.1)
    points.position[50, 1] = np.nan
    with pytest.raises(SimulationError, match="not a finite number"):
        list(simulate(machine, MachineModel(machine), [points]))


def test_a_setpoint_beyond_all_reason_is_a_fault_and_no_result(
    monkeypatch: pytest.MonkeyPatch, tmp_path
):
    monkeypatch.chdir(tmp_path)
    machine = shipped_machine(following_error_limit=0.0, force_limit=0.0)
    points = line(0, 10.0, 0.1)
    points.position[50, 0] = 1e30
    with pytest.raises(SimulationError, match="warned"):
        list(simulate(machine, MachineModel(machine), [points]))


def test_no_setpoints_give_no_samples():
    machine = shipped_machine()
    nothing: list[Setpoints] = []
    assert list(simulate(machine, MachineModel(machine), nothing)) == []
