"""The twin under a control's commands: the answer is the machine's, and can be played back."""

import os
import socket

import numpy as np
import pytest

from tests.link.fake_control import FakeControl
from tests.machine.machine_fixtures import PERIOD, line, shipped_machine
from tests.motion.motion_programs import Program
from twin.columns import join
from twin.link.lockstep import SETTLING_S, LockstepMotion
from twin.link.packet import JOINTS, MAGIC, REQUEST_LAYOUT, REQUEST_STATES, VERSION
from twin.link.place import Places
from twin.machine.description.config import MachineConfig
from twin.machine.model.model import MachineModel
from twin.machine.simulation.live import LiveMachine
from twin.machine.simulation.simulate import simulate
from twin.nc.canonical import FloatArray
from twin.recording.alarms import Alarm
from twin.recording.form import Samples

START = np.array([10.0, 5.0, -100.0, 0.0])

PROGRAM = Program(*START).line(60.0, 5.0, -100.0, 0.0, feed=600.0).moves

STANDING = 5


def motion_of(machine: MachineConfig) -> LockstepMotion:
    places = Places(PROGRAM, np.array([1]))
    return LockstepMotion(LiveMachine(machine, position=START), places, np.zeros(4))


def commanded(speed: float, seconds: float) -> FloatArray:
    """X along a line, from rest; it stops at once and waits a moment."""
    way = line(0, speed, seconds, rise=0.1).position
    return START + np.concatenate([way, np.repeat(way[-1:], STANDING, axis=0)])


def driven(
    machine: MachineConfig, positions: FloatArray, *noise: bytes
) -> tuple[Samples, FakeControl, LockstepMotion]:
    with motion_of(machine) as motion:
        control = FakeControl(motion, noise)
        control.start(positions)
        samples = join(list(motion))
        control.finish()
    return samples, control, motion


def test_the_answer_of_a_period_is_the_joints_of_that_period():
    samples, control, motion = driven(shipped_machine(), commanded(100.0, 0.6))
    assert motion.alarm is None
    asked = commanded(100.0, 0.6)[1:]
    answered = control.feedback[: len(asked), :4]
    assert np.abs(answered - samples.joint_position[1 : len(asked) + 1]).max() < 1e-12
    lag = (asked - answered)[-STANDING - 1]
    # At a constant speed it is speed / kv; mill4's kv is 7.5 (m/min)/mm.
    assert lag[0] == pytest.approx(100.0 / (7.5 / 0.06), abs=1e-3)


def test_a_recording_played_back_gives_the_same_bits():
    samples, _, _ = driven(shipped_machine(), commanded(150.0, 0.4))
    setpoint = samples.setpoint
    machine = shipped_machine()
    again = join(list(simulate(machine, MachineModel(machine), [setpoint])))
    assert np.array_equal(again.joint_position, samples.joint_position)
    assert np.array_equal(again.drive_force, samples.drive_force)


def test_the_present_moment_is_that_of_the_last_sample():
    samples, _, motion = driven(shipped_machine(), commanded(50.0, 0.3))
    time_s, source_line, position = motion.moment
    assert time_s == pytest.approx(samples.setpoint.time[-1] + PERIOD)
    assert source_line == PROGRAM.line[0]
    assert position == pytest.approx(samples.joint_position[-1], abs=1e-6)


def test_samples_begin_at_rest_and_end_settled():
    samples, _, motion = driven(shipped_machine(), commanded(50.0, 0.3))
    setpoint = samples.setpoint
    assert np.allclose(np.diff(setpoint.time), PERIOD)
    assert setpoint.time[0] == 0.0
    assert not setpoint.velocity[0].any()
    assert setpoint.line[0] == 0
    assert setpoint.line[1] == PROGRAM.line[0]
    rest = np.flatnonzero(setpoint.velocity.any(axis=1))[-1]
    assert len(setpoint) - 1 - rest == round(SETTLING_S / PERIOD)
    assert np.all(np.diff(setpoint.fraction) >= 0.0)
    assert motion.answered == 3 + len(commanded(50.0, 0.3))


def test_an_alarm_is_told_to_the_control_and_ends_the_samples():
    machine = shipped_machine(following_error_limit=0.5)
    samples, control, motion = driven(machine, commanded(200.0, 0.5))
    assert motion.alarm is not None
    assert (motion.alarm.code, motion.alarm.axis) == ("following-error", "X")
    lag = np.abs(samples.setpoint.position - samples.joint_position)[:, 0]
    assert lag[-1] > 0.5 >= lag[:-1].max()
    told = [answer for answer in control.answers if answer[1]]
    # X is the first joint: its amplifier alone is at fault, and nothing may run.
    assert {(state, faults) for state, faults, _, _ in told} == {(0, 1)}
    assert "following-error" in told[0][2]
    # The machine brakes: the feedback goes on, further than where it tripped.
    assert control.feedback[-1, 0] > samples.joint_position[-1, 0]


def test_noise_is_not_answered():
    noise = (b"", b"x", bytes(40), os.urandom(112), os.urandom(2000))
    samples, control, motion = driven(shipped_machine(), commanded(50.0, 0.1), *noise)
    assert motion.answered == len(control.answers)
    assert len(samples) > len(commanded(50.0, 0.1))


def test_nobody_else_drives_the_machine_meanwhile():
    positions = commanded(50.0, 0.8)
    alone, _, _ = driven(shipped_machine(), positions)
    farewell = (MAGIC, VERSION, 10**6, REQUEST_STATES["leaving"], 0, 0, 0, *[0.0] * (2 * JOINTS))
    chunks = []
    with (
        motion_of(shipped_machine()) as motion,
        socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as stranger,
    ):
        control = FakeControl(motion)
        control.start(positions)
        for chunk in motion:
            stranger.sendto(REQUEST_LAYOUT.pack(*farewell), ("127.0.0.1", motion.port))
            chunks.append(chunk)
        control.finish()
        stranger.setblocking(False)
        with pytest.raises(BlockingIOError):
            stranger.recv(1)
    assert len(chunks) > 1
    assert motion.missed == 0
    assert np.array_equal(join(chunks).joint_position, alone.joint_position)


def test_a_control_that_was_killed_is_noticed():
    with motion_of(shipped_machine()) as motion:
        motion.goes_on = lambda: False
        motion.last_word = lambda time_s, line: Alarm("control-stop", line, time_s, "", "killed")
        control = FakeControl(motion)
        control.start(commanded(50.0, 0.1), leaves=False)
        samples = join(list(motion))
    assert motion.alarm is not None
    assert motion.alarm.code == "control-stop"
    assert motion.alarm.time_s == pytest.approx(samples.setpoint.time[-1], abs=SETTLING_S)


def test_a_session_keeps_what_comes_before_and_after_too():
    machine = shipped_machine(following_error_limit=0.5)
    live = LiveMachine(machine, position=START)
    places = Places(PROGRAM[:0], np.zeros(0, np.int64))
    with LockstepMotion(live, places, np.zeros(4), session=True) as motion:
        control = FakeControl(motion)
        control.start(commanded(200.0, 0.3))
        samples = join(list(motion))
        control.finish()
    assert len(samples) == motion.answered
    assert np.allclose(np.diff(samples.setpoint.time), PERIOD)
    assert set(samples.setpoint.move.tolist()) == {-1}
    assert set(samples.setpoint.line.tolist()) == {0, 1}
    assert motion.alarm is not None
    assert np.abs(samples.joint_velocity[-1]).max() < np.abs(samples.joint_velocity).max() / 2
