"""The drives of a machine as MuJoCo's actuators, and the step that they can be simulated with."""

import math
from collections.abc import Iterator, Sequence
from typing import NamedTuple

import mujoco
import numpy as np

from twin.errors import ConfigError
from twin.machine.description.config import MachineConfig
from twin.machine.description.machine_file import AxisTable
from twin.machine.model.drives import (
    Drive,
    Lag,
    feedforward_name,
    integral_name,
    is_unstable,
    lag_name,
    tune,
)
from twin.machine.model.transmission import (
    FASTEST,
    FASTEST_SPRING,
    add_friction_and_give,
    directly_driven,
    give_substeps,
    has_give,
    swinging,
)
from twin.nc.canonical import FloatArray
from twin.units import to_si

MOST_SUBSTEPS = 20
"""Of a servo period, where a drive asks for a shorter step of the simulation: it then costs so much more."""
_LAG_STEP = 0.8
"""Step over the time constant of a lag, at most: with more, MuJoCo's own rule for its state has no
time constant that acts like it."""
_POSITION_INPUT, _VELOCITY_INPUT = 1, 2
"""What MuJoCo calls ``input="pos"`` and ``input="vel"``."""


def add_drives(spec: mujoco.MjSpec, machine: MachineConfig, found: Sequence[Drive]) -> None:
    """Give every axis its drive, its friction and its give.

    Args:
        spec: The model, with an actuator and a joint for every axis.
        found: One drive per axis, in the order of ``machine.axes``.

    Raises:
        ConfigError: A loop or a spring swings faster than can be simulated, or grows by itself.
    """
    period = machine.file.servo_period_s
    substeps = 1
    for name, drive in zip(machine.axes.names, found, strict=True):
        _refuse_unstable(machine, name, drive)
        _refuse_what_outruns_the_clock(machine, name, drive)
        needed = (need.substeps for need in _needs(machine, name, drive))
        substeps = max(substeps, *needed)
    step = period / substeps
    spec.option.timestep = step
    for name, drive in zip(machine.axes.names, found, strict=True):
        axis = machine.axis(name)
        _add_drive(spec, name, axis, drive, step)
        joint = spec.joint(axis.joint)
        joint.actfrclimited = axis.force_limit > 0
        joint.actfrcrange = np.array([-axis.force_limit, axis.force_limit])
        add_friction_and_give(spec, axis, drive.moved, period)
    if any(has_give(machine.axis(name)) for name in machine.axes.names):
        for key in list(spec.keys):
            spec.delete(key)


def _add_drive(spec: mujoco.MjSpec, name: str, axis: AxisTable, drive: Drive, step: float) -> None:
    servo = spec.actuator(name)
    servo.target = axis.joint
    servo.trntype = mujoco.mjtTrn.mjTRN_JOINT
    servo.set_to_intvelocity(kp=drive.position_gain, kv=max(drive.damping_gain, 0.0))
    servo.actlimited = False
    servo.forcelimited = False
    feedforward = _on_joint(spec, axis, feedforward_name(name))
    feedforward.set_to_motor()
    if drive.integral_gain:
        integral = _on_joint(spec, axis, integral_name(name))
        integral.set_to_pid(
            kp=0.0, kv=0.0, ki=drive.integral_gain, imax=drive.integral_limit,
            ctrlspec=_POSITION_INPUT,
        )  # fmt: skip
    along = max(-drive.damping_gain, 0.0)
    for number, lag in enumerate(drive.lags):
        played = lag_actuator(lag, step)
        along += played.given_back
        _on_joint(spec, axis, lag_name(name, number)).set_to_dcmotor(
            motorconst=[1.0, 1.0],
            resistance=1.0,
            inductance=[0.0, played.time_s],
            controller=[0.0, 0.0, played.gain, 0.0, 0.0, 0.0],
            ctrlspec=_VELOCITY_INPUT,
        )
    if drive.lags:
        # MuJoCo takes a servo with a positive speed term for one given by its damping ratio.
        feedforward.biastype = mujoco.mjtBias.mjBIAS_AFFINE
        feedforward.biasprm[2] = along


def _on_joint(spec: mujoco.MjSpec, axis: AxisTable, name: str) -> mujoco.MjsActuator:
    return spec.add_actuator(name=name, target=axis.joint, trntype=mujoco.mjtTrn.mjTRN_JOINT)


class LagActuator(NamedTuple):
    """How a motor with a winding plays a lag of first order.

    It has one ohm and one newton per ampere, its controller brakes by its speed, and its state is the
    current, which trails by the winding's time constant T'. MuJoCo changes it over a step by
    (1 - exp(-h/T')) of what it is off: T' is chosen so that this is h/T. And it pushes by the
    current of the step's end, that is by h/T of the speed itself and 1 - h/T of the lagging one:
    the gain is raised until the latter is right, and what is too much of the former is given back
    by another actuator.
    """

    gain: float
    """Of the controller [N s/m or N m s/rad]."""
    time_s: float
    """T' [s]."""
    given_back: float
    """Of the axis's speed [N s/m or N m s/rad]."""
    stretch: float
    """How far the lag is behind the speed, over how far the state is: between steps RK4 moves the
    state by its rate, which belongs to T'."""

    def lagging(self, speed: FloatArray, current: FloatArray) -> FloatArray:
        """Speed as the lag shows it."""
        return speed - self.stretch * (speed + current / self.gain)

    def current(self, speed: float, lagging: float) -> float:
        """State that shows a lagging speed."""
        return self.gain * ((speed - lagging) / self.stretch - speed)


def lag_actuator(lag: Lag, step: float) -> LagActuator:
    """The motor that plays a lag.

    Args:
        step: h, of the simulation [s].
    """
    share = step / lag.time_s
    rate = -math.log1p(-share)
    # What a state is off in the four stages of a step, per what it is off at first and per h/2 times
    # the acceleration that the speed has.
    off: list[tuple[float, float]] = [(1.0, 0.0)]
    for part, gained in ((0.5, 1.0), (0.5, 1.0), (1.0, 2.0)):
        first, second = off[-1]
        off.append((1.0 - part * rate * first, gained - part * rate * second))
    mean = [(a + 2.0 * b + 2.0 * c + d) / 6.0 for a, b, c, d in zip(*off, strict=True)]
    behind = (lag.time_s - mean[1] * step / 2.0) / mean[0]
    gain = lag.gain / (1.0 - share)
    return LagActuator(gain, step / rate, gain - lag.gain, lag.time_s / behind)


class _Need(NamedTuple):
    """Steps per servo period that something of a drive asks for."""

    key: str
    substeps: int


def _needs(machine: MachineConfig, name: str, drive: Drive) -> Iterator[_Need]:
    axis, period = machine.axis(name), machine.file.servo_period_s
    fastest = drive.velocity_gain / directly_driven(axis, drive.moved) * period
    yield _Need("kv", math.ceil(fastest / FASTEST))
    yield _Need("stiffness", give_substeps(axis, drive.moved, period))
    for lag in drive.lags:
        of_delay = lag.time_s == drive.dead_time_s / 2.0
        key = "loop_delay_s" if of_delay else "velocity_filter_s"
        yield _Need(key, math.ceil(period / lag.time_s / _LAG_STEP))


def _refuse_unstable(machine: MachineConfig, name: str, drive: Drive) -> None:
    """A loop whose lags make it grow by itself is no drive that anybody runs."""
    if not drive.lags or not is_unstable(drive):
        return
    axis = machine.axis(name)
    steady, growing = 0.0, axis.kv
    for _ in range(40):
        middle = (steady + growing) / 2.0
        grows = is_unstable(tune(axis.model_copy(update={"kv": middle}), drive.moved))
        steady, growing = (steady, middle) if grows else (middle, growing)
    keys = [key for key in ("loop_delay_s", "velocity_filter_s") if getattr(axis, key)]
    raise ConfigError(
        f"{machine.path}: axes.{name}: with kv = {axis.kv:g} and damping_ratio = "
        f"{axis.damping_ratio:g} the loop swings up by itself, because of "
        f"{' and '.join(keys)}; kv up to {steady:.3g} works, or a lower damping_ratio"
    )


def stiffest(axis: AxisTable, moved: float, period_s: float) -> float:
    """The stiffest spring of an axis that can be simulated [N/mm or N m/deg].

    Args:
        moved: What its drive moves [kg or kg m²].
        period_s: Servo period [s].
    """
    fastest = FASTEST_SPRING * MOST_SUBSTEPS / period_s
    return swinging(axis, moved) * fastest**2 * to_si(axis.kind)


def _refuse_what_outruns_the_clock(machine: MachineConfig, name: str, drive: Drive) -> None:
    """A loop or a spring that swings within a step cannot be simulated with it."""
    axis = machine.axis(name)
    period = machine.file.servo_period_s
    if not directly_driven(axis, drive.moved) > 0.0:
        raise ConfigError(
            f"{machine.path}: axes.{name}: behind a backlash or spring the motor needs an inertia "
            "of its own; give motor_inertia"
        )
    for need in _needs(machine, name, drive):
        if need.substeps <= MOST_SUBSTEPS or need.key == "stiffness":
            continue
        if need.key == "kv":
            reason = " behind the backlash or spring, where it moves no more than itself" * (
                has_give(axis)
            )
            raise ConfigError(
                f"{machine.path}: axes.{name}: with kv = {axis.kv:g} the motor{reason} reacts "
                f"faster than a {MOST_SUBSTEPS}th of the servo period; kv up to "
                f"{axis.kv * MOST_SUBSTEPS / need.substeps:.3g} works"
            )
        least = period / _LAG_STEP / MOST_SUBSTEPS * (2.0 if need.key == "loop_delay_s" else 1.0)
        raise ConfigError(
            f"{machine.path}: axes.{name}.{need.key} = {getattr(axis, need.key):g} is too short to "
            f"be simulated; from {least:.2g} on it works, and 0 is none"
        )
    springs = []
    if axis.stiffness:
        most = stiffest(axis, drive.moved, period)
        springs.append(("stiffness", axis.stiffness, most, "0 is rigid"))
    if axis.lugre is not None:
        bristles = axis.lugre.stiffness
        most = drive.moved * (FASTEST / period) ** 2 * to_si(axis.kind)
        springs.append(("lugre.stiffness", bristles, most, "none is Coulomb"))
    for key, stiffness, most, otherwise in springs:
        if stiffness > most:
            raise ConfigError(
                f"{machine.path}: axes.{name}.{key} = {stiffness:g} swings faster than can "
                f"be simulated; up to {most:.3g} works, and {otherwise}"
            )
