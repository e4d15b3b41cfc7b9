"""Friction, play and spring, each switched on alone and held to its closed form."""

import mujoco
import numpy as np
import pytest

from tests.machine.machine_fixtures import PERIOD, circle, line, ramp_up, setpoints, shipped_machine
from twin.errors import ConfigError
from twin.machine.description.config import MachineConfig
from twin.machine.model.drives import integral_name
from twin.machine.model.model import MachineModel, build_spec, drives, physics_model
from twin.machine.model.transmission import give_stiffness
from twin.machine.simulation.simulate import simulate
from twin.motion.setpoints.setpoints import Setpoints
from twin.recording.reader import Samples
from twin.units import MM

PERFECT = {"velocity_feedforward": 1.0, "acceleration_feedforward": 1.0}


def run(machine: MachineConfig, points: Setpoints) -> Samples:
    (samples,) = simulate(machine, MachineModel(machine), [points])
    return samples


def back_and_forth(axis: int, stroke: float, seconds: float) -> Setpoints:
    """A slow cosine between 0 and ``stroke``."""
    time = np.arange(0, seconds, PERIOD)
    wave = 2 * np.pi / seconds * 2
    columns = [np.zeros((len(time), 4)) for _ in range(3)]
    columns[0][:, axis] = stroke / 2 * (1 - np.cos(wave * time))
    columns[1][:, axis] = stroke / 2 * wave * np.sin(wave * time)
    columns[2][:, axis] = stroke / 2 * wave**2 * np.cos(wave * time)
    return setpoints(*columns)


def test_dry_friction_adds_its_force_over_the_stiffness_of_the_loop_to_the_lag():
    force = 800.0
    machine = shipped_machine(dry_friction=force)
    samples = run(machine, line(0, 50.0, 1.0))
    loop = drives(machine, build_spec(machine).compile())[0]
    expected = 50.0 / 125.0 + force / loop.position_gain / MM
    assert (samples.setpoint.position - samples.joint_position)[-1, 0] == pytest.approx(
        expected, abs=1e-5
    )
    assert samples.drive_force[-1, 0] == pytest.approx(force + loop.velocity_gain * 0.0, rel=0.01)


def test_viscous_friction_adds_its_force_over_the_stiffness_of_the_loop_to_the_lag():
    machine = shipped_machine(viscous_friction=4.0)
    samples = run(machine, line(1, 50.0, 1.0))
    loop = drives(machine, build_spec(machine).compile())[1]
    expected = 50.0 / 125.0 + 4.0 * 50.0 / loop.position_gain / MM
    assert (samples.setpoint.position - samples.joint_position)[-1, 1] == pytest.approx(
        expected, abs=1e-6
    )


@pytest.mark.parametrize(("axis", "friction", "creep"), [("X", 80.0, 1e-7), ("C", 20.0, 5e-7)])
def test_dry_friction_does_not_creep_under_half_its_force(axis, friction, creep):
    """0.1 µm/s, for the table at its rim of 0.2 m."""
    machine = shipped_machine(dry_friction=friction)
    model = physics_model(machine, build_spec(machine))
    model.actuator_gainprm[:] = 0
    model.actuator_biasprm[:] = 0
    data = mujoco.MjData(model)
    data.qfrc_applied[model.joint(axis).dofadr[0]] = friction / 2
    for _ in range(2000):
        mujoco.mj_step(model, data)
    assert abs(data.joint(axis).qvel[0]) < creep


@pytest.mark.parametrize("backlash", [0.01, 0.1])
def test_backlash_is_lost_at_each_reversal(backlash):
    """The motor follows; the axis stays behind by half the gap and by what friction bends."""
    friction = 200.0
    machine = shipped_machine(backlash=backlash, dry_friction=friction, **PERFECT)
    samples = run(machine, back_and_forth(0, 40.0, 4.0))
    lag = (samples.setpoint.position - samples.joint_position)[:, 0]
    forth = lag[(samples.setpoint.time > 0.3) & (samples.setpoint.time < 0.7)]
    back = lag[(samples.setpoint.time > 1.3) & (samples.setpoint.time < 1.7)]
    loop = drives(machine, build_spec(machine).compile())[0]
    wall = give_stiffness(machine.axis("X"), loop.moved, PERIOD)
    expected = backlash + 2 * friction * (1 / loop.position_gain + 1 / wall) / MM
    assert np.mean(forth) - np.mean(back) == pytest.approx(expected, abs=2e-5)


def test_with_backlash_the_axis_trails_the_motor_whichever_way_it_goes():
    machine = shipped_machine(backlash=0.05, dry_friction=300.0, **PERFECT)
    samples = run(machine, line(0, 20.0, 1.0))
    trail = (samples.setpoint.position - samples.joint_position)[-1, 0]
    assert trail > 0.02
    samples = run(machine, line(0, -20.0, 1.0))
    assert (samples.setpoint.position - samples.joint_position)[-1, 0] == pytest.approx(
        -trail, abs=1e-6
    )


def test_a_springy_screw_gives_by_friction_over_stiffness():
    stiffness, force = 30_000.0, 500.0
    machine = shipped_machine(dry_friction=force, **PERFECT).changed("X", stiffness=stiffness)
    rigid = shipped_machine(dry_friction=force, **PERFECT)
    soft, hard = (run(m, line(0, 20.0, 1.5)) for m in (machine, rigid))
    give = (hard.joint_position - soft.joint_position)[-1, 0]
    assert give == pytest.approx(force / stiffness, rel=0.01)


def test_a_screw_that_the_step_cannot_follow_is_refused():
    """From one radian a step on, of twenty steps a period: motor and axis against each other."""
    moved, motor = 485.0 + 38.0 + 518.2, 518.2
    stiffest = motor * (moved - motor) / moved / (PERIOD / 20) ** 2 * 1e-3
    build_spec(shipped_machine().changed("X", stiffness=0.99 * stiffest))
    with pytest.raises(ConfigError, match=r"axes\.X\.stiffness = .* up to 1.04e\+08 works"):
        build_spec(shipped_machine().changed("X", stiffness=1.01 * stiffest))


def test_a_rigid_screw_with_backlash_loses_the_gap_and_little_more():
    """0.02 mm under 480 N of friction: 20 µm + 2 · 480 N over 1040 N/µm, the integrating drive holds the rest."""
    machine = shipped_machine(backlash=0.02, dry_friction=480.0, reset_time_s=0.01, **PERFECT)
    samples = run(machine, back_and_forth(0, 40.0, 4.0))
    lag = (samples.setpoint.position - samples.joint_position)[:, 0]
    forth = lag[(samples.setpoint.time > 0.45) & (samples.setpoint.time < 0.55)]
    back = lag[(samples.setpoint.time > 1.45) & (samples.setpoint.time < 1.55)]
    lost = np.mean(forth) - np.mean(back)
    assert lost == pytest.approx(0.020 + 2 * 480.0 / 1.04e6, abs=2e-5)


def in_the_gap(**fields: float) -> tuple[mujoco.MjModel, mujoco.MjData]:
    """X with a gap of 0.1 mm and a motor that nothing moves."""
    machine = shipped_machine(backlash=0.1).changed("X", **fields)
    model = physics_model(machine, build_spec(machine))
    model.dof_armature[model.joint("X").dofadr[0]] = 1e7
    return model, mujoco.MjData(model)


@pytest.mark.parametrize("speed", [0.01, 0.1])
def test_no_force_acts_within_the_gap(speed: float):
    model, data = in_the_gap()
    data.joint("X give").qvel[0] = speed
    for _ in range(int(0.05e-3 / speed / model.opt.timestep)):
        mujoco.mj_step(model, data)
        assert data.joint("X give").qvel[0] == pytest.approx(speed, rel=1e-9)


@pytest.mark.parametrize("fields", [{}, {"stiffness": 50_000.0}])
@pytest.mark.parametrize("force", [-480.0, 480.0])
def test_the_wall_gives_by_force_over_stiffness(fields: dict[str, float], force: float):
    model, data = in_the_gap(**fields)
    stiffness = 5e7 if fields else 523.0 * 518.2 / 1041.2 * (2 / PERIOD) ** 2
    data.qfrc_applied[model.joint("X give").dofadr[0]] = force
    for _ in range(4000):
        mujoco.mj_step(model, data)
    expected = np.copysign(0.05e-3 + abs(force) / stiffness, force)
    assert data.joint("X give").qpos[0] == pytest.approx(expected, abs=2e-9)


def test_a_wall_throws_back_like_a_damped_spring_that_only_pushes():
    """x'' + 2 z w x' + w² x = 0 from x = 0 on; its force ends at the time t at which 2 z x' + w x = 0.

    With s = sqrt(1 - z²) that is at w s t = pi - 2 asin(z), and x' is then -exp(-z w t) of what it was.
    """
    model, data = in_the_gap(stiffness=5_000.0)
    data.joint("X give").qvel[0] = 0.01
    ratio = 0.1 * np.sqrt(518.2 / 1041.2)  # the damper is that of both masses, and one swings
    aside = np.sqrt(1 - ratio**2)
    expected = -0.01 * np.exp(-ratio / aside * (np.pi - 2 * np.arcsin(ratio)))
    speeds = []
    for _ in range(2000):
        mujoco.mj_step(model, data)
        speeds.append(data.joint("X give").qvel[0])
    assert min(speeds) == pytest.approx(expected, rel=0.02)


@pytest.mark.parametrize("stiffness", [30_000.0, 250_000.0])
def test_a_springy_screw_rings_at_its_natural_frequency(stiffness):
    """Motor held: the axis swings on the screw as mass on spring."""
    machine = shipped_machine().changed("X", stiffness=stiffness)
    model = physics_model(machine, build_spec(machine))
    data = mujoco.MjData(model)
    data.joint("X give").qpos[0] = 1e-4
    dof = model.joint("X give").dofadr[0]
    model.tendon_damping[model.tendon("X give").id] = 0
    model.dof_armature[model.joint("X").dofadr[0]] = 1e9
    swing = []
    for _ in range(400):
        mujoco.mj_step(model, data)
        swing.append(data.qpos[dof])
    crossings = np.flatnonzero(np.diff(np.sign(swing)) != 0)
    period = 2 * (crossings[-1] - crossings[0]) / (len(crossings) - 1) * PERIOD
    assert period == pytest.approx(2 * np.pi * np.sqrt(523.0 / (1e3 * stiffness)), rel=0.02)


def test_bristles_bend_before_they_slip():
    """Below the breakaway force G the axis gives way to x = -G/stiffness ln(1 - F/G).

    From LuGre's z' = x' (1 - stiffness z/G) on a slow, one-sided push, with F = stiffness z.
    """
    machine = shipped_machine(
        dry_friction=100.0,
        lugre={"stiffness": 20_000.0, "damping": 200.0, "static_friction": 150.0},
    )
    model = physics_model(machine, build_spec(machine))
    servo = model.actuator("X").id
    model.actuator_gainprm[servo] = 0
    model.actuator_biasprm[servo] = 0
    data = mujoco.MjData(model)
    for step in range(4000):
        data.qfrc_applied[model.joint("X").dofadr[0]] = 50.0 * min(1.0, step / 3000)
        mujoco.mj_step(model, data)
    assert data.joint("X").qpos[0] == pytest.approx(
        -150.0 / 2e7 * np.log(1 - 50.0 / 150.0), rel=0.01
    )


def test_bristles_slip_at_the_dry_friction_when_fast():
    lugre = {
        "stiffness": 20_000.0,
        "damping": 50.0,
        "static_friction": 1200.0,
        "stribeck_velocity": 2.0,
    }
    machine = shipped_machine(dry_friction=800.0, lugre=lugre)
    samples = run(machine, line(0, 400.0, 1.0))
    loop = drives(machine, build_spec(machine).compile())[0]
    lag = (samples.setpoint.position - samples.joint_position)[-1, 0]
    assert lag == pytest.approx(400.0 / 125.0 + 800.0 / loop.position_gain / MM, abs=2e-5)


def test_friction_peaks_where_a_circle_changes_quadrant():
    """At a reversal the friction changes sign: the axis is late by 2 F/kp, whatever the speed."""
    force = 1000.0
    machine = shipped_machine(dry_friction=force, **PERFECT)
    samples = run(machine, circle(50.0, 3000.0, 8.0))
    loop = drives(machine, build_spec(machine).compile())[0]
    lag = (samples.setpoint.position - samples.joint_position)[3000:, 0]
    assert np.ptp(lag) == pytest.approx(2 * force / loop.position_gain / MM, rel=0.05)


def test_an_axis_without_counterbalance_sags_by_its_weight_over_the_stiffness_of_the_loop():
    machine = shipped_machine(counterbalance=0.0)
    samples = run(machine, line(0, 0.0, 1.0))
    loop = drives(machine, build_spec(machine).compile())[2]
    weight = (430 + 12) * 9.81
    assert samples.joint_position[-1, 2] == pytest.approx(
        -weight / loop.position_gain / MM, rel=1e-3
    )
    assert samples.drive_force[-1, 2] == pytest.approx(weight, rel=1e-3)


def test_integral_action_leaves_the_lag_and_takes_the_sag():
    machine = shipped_machine(counterbalance=0.0, reset_time_s=0.02, dry_friction=300.0)
    moving = run(machine, line(0, 50.0, 2.0))
    lag = moving.setpoint.position - moving.joint_position
    assert lag[-1, 0] == pytest.approx(50.0 / 125.0, abs=1e-5)
    assert abs(lag[-1, 2]) < 5e-5
    assert moving.drive_force[-1, 0] == pytest.approx(300.0, rel=2e-3)
    assert moving.drive_force[-1, 2] == pytest.approx((430 + 12) * 9.81, rel=1e-3)


def test_integral_action_on_a_circle_agrees_with_its_closed_form():
    """|G(jW)| of the third-order loop: (b s + c)/(s³ + a s² + b s + c), a = 4 z² Kv, b = a (Kv + 1/Tn),
    c = a Kv/Tn, with the numerator that the trail of the setpoint leaves.
    """
    reset, radius, feed = 0.02, 20.0, 3000.0
    machine = shipped_machine(reset_time_s=reset)
    samples = run(machine, circle(radius, feed, 4.0))
    settled = samples.joint_position[2500:]
    measured = np.hypot(settled[:, 0] + radius, settled[:, 1]) - radius
    gain = 125.0
    s = 1j * feed / 60 / radius
    a = 4 * gain
    proportional = a * (gain + 1 / reset)
    top = proportional + a * gain / reset * (1 - s / gain) / s
    bottom = s**2 + a * s + proportional + a * gain / reset / s
    expected = radius * (abs(top / bottom) - 1)
    assert measured == pytest.approx(np.full(len(measured), expected), abs=5e-5)


def test_what_a_drive_at_its_limit_cannot_do_does_not_pile_up():
    """Pushed away for a second by a little more than it can hold, an axis comes back sooner."""
    limit = 2000.0
    machine = shipped_machine(
        force_limit=limit, reset_time_s=0.02, following_error_limit=0.0, saturation_time_s=10.0
    )
    model = physics_model(machine, build_spec(machine))
    still = line(0, 0.0, 4.0)
    load = np.zeros((len(still), 4))
    load[still.time < 1.0, 0] = 1.05 * limit
    beyond = []
    for limited in (True, False):
        if not limited:
            model.actuator_dynprm[model.actuator(integral_name("X")).id] = 0.0
        (samples,) = simulate(machine, model, [still], load=lambda _: load)
        assert samples.joint_position[:, 0].max() > 10.0
        assert np.abs(samples.drive_force[:, 0]).max() == limit
        beyond.append(-samples.joint_position[:, 0].min())
    assert beyond[0] < 0.5 * beyond[1]


def test_half_the_velocity_told_halves_the_lag():
    machine = shipped_machine(velocity_feedforward=0.5)
    samples = run(machine, line(0, 50.0, 1.0))
    lag = (samples.setpoint.position - samples.joint_position)[-1, 0]
    assert lag == pytest.approx(0.2, abs=1e-6)


def test_a_drive_at_its_force_limit_pushes_no_harder():
    machine = shipped_machine(force_limit=2000.0, following_error_limit=0.0, saturation_time_s=10.0)
    time = np.arange(0, 1.0, PERIOD)
    columns = [np.zeros((len(time), 4)) for _ in range(3)]
    for column, value in zip(columns, ramp_up(time, 400.0, 0.2), strict=True):
        column[:, 0] = value
    samples = run(machine, setpoints(*columns))
    assert np.abs(samples.drive_force[:, 0]).max() == 2000.0
    moved = drives(machine, build_spec(machine).compile())[0].moved
    rise = np.gradient(samples.joint_velocity[:, 0], PERIOD) * MM
    assert np.abs(rise).max() == pytest.approx(2000.0 / moved, rel=0.01)


@pytest.mark.parametrize(
    "fields",
    [{"kv": 1000.0}, {"kv": 7.5, "backlash": 0.01, "motor_inertia": 1e-6, "screw_inertia": 0.0}],
)
def test_a_loop_faster_than_the_shortest_step_is_refused_with_what_works(fields):
    with pytest.raises(ConfigError, match=r"axes\.[XYZC]: with kv = .* works"):
        build_spec(shipped_machine(**fields))
