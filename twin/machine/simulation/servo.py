"""The physics of a run: setpoints in, samples of the joints out, state in between."""

import dataclasses
from typing import NamedTuple

import mujoco
import numpy as np
from mujoco.rollout import Rollout

from twin.columns import join
from twin.machine.description.config import Machine
from twin.machine.model.drive_actuators import LagActuator, lag_actuator
from twin.machine.model.drives import feedforward_name, integral_name, lag_name
from twin.machine.model.model import drives
from twin.machine.model.timers import switch_off_timers
from twin.machine.model.transmission import give_name, has_give
from twin.machine.simulation.drive_commands import DriveCommands, Told
from twin.machine.simulation.sampling import held_commands, polyline_nodes
from twin.machine.watching.alarms import SimulationError
from twin.motion.setpoints.setpoints import Setpoints
from twin.nc.canonical import FloatArray, IntArray
from twin.recording.reader import Samples

_STATE = mujoco.mjtState.mjSTATE_FULLPHYSICS
_CONTROL = int(mujoco.mjtState.mjSTATE_CTRL)
_PUSH = int(mujoco.mjtState.mjSTATE_QFRC_APPLIED)


@dataclasses.dataclass(frozen=True, slots=True)
class Stand:
    """How k axes stand and move, in SI and in the sense of their joints."""

    axis: FloatArray
    speed: FloatArray
    give: FloatArray
    """How far the axis is off its motor; 0 where nothing gives."""
    setpoint: FloatArray
    integral: FloatArray
    """Force of the drive's integrator; NaN where it has none."""
    lagging: dict[str, float]
    """Speed as each lag shows it, by the lag's name."""
    commands: DriveCommands


class _Lag(NamedTuple):
    """A lag of an axis's speed, as it is played."""

    name: str
    axis: int
    gain: float
    """Of the lagging speed [N s/m or N m s/rad]."""
    actuator: LagActuator
    state: int
    """Place of the actuator's state."""


class Servo:
    """The drives and what they move, stepped through ``mujoco.rollout`` from one setpoint to the next.

    It is carried over from chunk to chunk by the state, the solver's warm start and the last
    setpoint, so that how setpoints are cut into chunks changes no bit of the motion.

    Attributes:
        model: What is stepped.
    """

    def __init__(self, machine: Machine, model: mujoco.MjModel) -> None:
        switch_off_timers()
        self._period = machine.file.servo_period_s
        self.model = model
        self._data = mujoco.MjData(model)
        loops = drives(machine, model)
        self._position_gain = np.array([loop.position_gain for loop in loops])
        self._damping_gain = np.array([loop.damping_gain for loop in loops])
        self._commands = DriveCommands(machine, loops)
        self._substeps = round(self._period / model.opt.timestep)
        axes = [machine.axis(name) for name in machine.axes.names]
        joints = [model.joint(axis.joint) for axis in axes]
        self._qpos = np.array([int(joint.qposadr[0]) for joint in joints])
        self._dof = np.array([int(joint.dofadr[0]) for joint in joints])
        servos = [model.actuator(name).id for name in machine.axes.names]
        forces = [model.actuator(feedforward_name(name)).id for name in machine.axes.names]
        self._velocity_input = model.actuator_ctrladr[servos]
        self._force_input = model.actuator_ctrladr[forces]
        self._setpoint_state = model.actuator_actadr[servos]
        self._integrates = np.flatnonzero([loop.integral_gain > 0 for loop in loops])
        integral = [
            model.actuator(integral_name(machine.axes.names[index])).id
            for index in self._integrates
        ]
        self._position_input = model.actuator_ctrladr[integral]
        self._integral_state = model.actuator_actadr[integral]
        self._integral_gain = np.array([loop.integral_gain for loop in loops])
        self._lags = [
            _Lag(
                lag_name(name, number), index, lag.gain, lag_actuator(lag, model.opt.timestep),
                int(model.actuator_actadr[model.actuator(lag_name(name, number)).id]),
            )
            for index, (name, loop) in enumerate(zip(machine.axes.names, loops, strict=True))
            for number, lag in enumerate(loop.lags)
        ]  # fmt: skip
        self._gives = np.flatnonzero([has_give(axis) for axis in axes])
        give = [model.joint(give_name(axes[index])) for index in self._gives]
        self._give_qpos = np.array([int(joint.qposadr[0]) for joint in give], np.int64)
        self._give_dof = np.array([int(joint.dofadr[0]) for joint in give], np.int64)
        walls = [model.tendon(give_name(axes[index])).id for index in self._gives]
        self._stiffness = model.tendon_stiffness[walls]
        self._half_gap = model.tendon_lengthspring[walls, 1]
        self._scale = machine.joint_scale
        self._limit = np.array([axis.force_limit or np.inf for axis in axes])
        self._constant = np.array([axis.constant_force for axis in axes])
        self._last: Setpoints | None = None
        self._state = np.zeros(0)
        self._states = np.zeros((0, 0))
        self._chunk: Setpoints | None = None
        self._warmstart = np.zeros((1, model.nv))

    @property
    def last(self) -> Setpoints:
        """The setpoint that the machine has come to, one row."""
        assert self._last is not None, "the machine has not followed anything"
        return self._last

    def follow(self, chunk: Setpoints, load: FloatArray | None = None) -> Samples:
        """Step through one chunk and give its samples.

        Args:
            chunk: Setpoints that go on one period after the last; the first chunk of all begins
                with the machine at rest.
            load: What pushes each axis from outside during the period that ends with each
                setpoint, shape (n, k) [N or N m]; None: nothing.

        Raises:
            SimulationError: MuJoCo warned, or a setpoint is not finite.
        """
        if not all(
            np.isfinite(v).all() for v in (chunk.position, chunk.velocity, chunk.acceleration)
        ):
            raise SimulationError("a setpoint is not a finite number")
        if self._last is None:
            self._begin(chunk)
            told = self._commands.follow(chunk)
            after = None if load is None else load[1:]
            states = np.concatenate([self._state[None], self._roll(told, after)])
        else:
            told = self._commands.follow(join([self._last, chunk]))
            states = self._roll(told, load)
            told = Told(told.setpoints[1:], told.late[1:])
        self._last, self._chunk, self._states = chunk[-1:], chunk, states
        return self._samples(chunk, told, states)

    def go_back(self, row: int) -> None:
        """Take back what came after a row of the last chunk."""
        assert self._chunk is not None
        self._commands.go_to(row - len(self._chunk))
        self._last = self._chunk[row : row + 1]
        self._state = self._states[row].copy()
        self._warm_up()

    def switch_on(self) -> None:
        """Take the drives' setpoints to where the axes stand, every axis carrying its load."""
        model, data = self.model, self._data
        mujoco.mj_setState(model, data, self._state, _STATE)
        data.qvel[:] = 0.0
        mujoco.mj_forward(model, data)
        stand = data.qpos[self._qpos] + self._carry(self._load())
        data.act[self._setpoint_state] = stand
        data.act[[lag.state for lag in self._lags]] = 0.0
        self._commands.come_to_rest()
        mujoco.mj_getState(model, data, self._state, _STATE)
        still = np.zeros((1, len(stand)))
        self._last = dataclasses.replace(
            self.last, position=(stand / self._scale)[None], velocity=still, acceleration=still
        )
        self._warm_up()

    def take_over(self, other: "Servo") -> None:
        """Go on where a servo of the same axes, tuned or built otherwise, has come to.

        The axes stand and move as they did; where the transmission gave and no longer does, the
        motor goes with the axis.
        """
        before, data = other.stand(), self._data
        mujoco.mj_resetData(self.model, data)
        give = np.zeros(len(self._qpos))
        give[self._gives] = before.give[self._gives]
        data.qpos[self._qpos] = before.axis - give
        data.qpos[self._give_qpos] = give[self._gives]
        data.qvel[self._dof] = before.speed
        jump = self._commands.take_over(before.commands)
        data.act[self._setpoint_state] = before.setpoint + jump * self._scale
        for lag in self._lags:
            speed = float(before.speed[lag.axis])
            data.act[lag.state] = lag.actuator.current(speed, before.lagging.get(lag.name, speed))
        mujoco.mj_forward(self.model, data)
        self._carry(np.where(np.isnan(before.integral), self._load(), before.integral))
        self._state = np.zeros(mujoco.mj_stateSize(self.model, _STATE))
        mujoco.mj_getState(self.model, data, self._state, _STATE)
        self._last = other.last
        self._warm_up()

    def stand(self) -> "Stand":
        """How the axes stand and move after the last chunk."""
        model, data = self.model, self._data
        mujoco.mj_setState(model, data, self._state, _STATE)
        give = np.zeros(len(self._qpos))
        give[self._gives] = data.qpos[self._give_qpos]
        speed = data.qvel[self._dof].copy()
        speed[self._gives] += data.qvel[self._give_dof]
        integral = np.full(len(self._qpos), np.nan)
        integral[self._integrates] = (
            self._integral_gain[self._integrates] * data.act[self._integral_state]
        )
        setpoint = data.act[self._setpoint_state].copy()
        lagging = {
            lag.name: float(lag.actuator.lagging(speed[[lag.axis]], data.act[[lag.state]])[0])
            for lag in self._lags
        }
        return Stand(
            data.qpos[self._qpos] + give, speed, give, setpoint, integral, lagging, self._commands
        )

    def _load(self) -> FloatArray:
        """What every axis carries as it stands, shape (k,) [N or N m]."""
        return self._carried(self._dof, np.arange(len(self._dof)))

    def _carried(self, dofs: IntArray, axes: IntArray) -> FloatArray:
        """What joints of axes carry as they stand [N or N m]."""
        pulled = (self._constant * np.sign(self._scale))[axes]
        return (self._data.qfrc_bias - self._data.qfrc_passive)[dofs] - pulled

    def _carry(self, load: FloatArray) -> FloatArray:
        """Give the integrators their load; return what the others stand off for theirs, (k,)."""
        self._data.act[self._integral_state] = (
            load[self._integrates] / self._integral_gain[self._integrates]
        )
        return np.where(self._integral_gain > 0, 0.0, load / self._position_gain)

    def _warm_up(self) -> None:
        """Let the solver begin where the present state leads."""
        mujoco.mj_setState(self.model, self._data, self._state, _STATE)
        mujoco.mj_forward(self.model, self._data)
        self._warmstart = self._data.qacc[None].copy()

    def _begin(self, chunk: Setpoints) -> None:
        """Put the machine at rest at the first setpoint, every axis carrying its load.

        A drive that integrates has settled at its setpoint; another stands off it by load/kp, and a
        transmission that gives is strained by the load.
        """
        model, data = self.model, self._data
        mujoco.mj_resetData(model, data)
        rest = chunk.position[0] * self._scale
        data.qpos[self._qpos] = rest
        data.act[self._setpoint_state] = polyline_nodes(chunk[:1], self._period)[0] * self._scale
        mujoco.mj_forward(model, data)
        carried = self._carried(self._give_dof, self._gives)
        data.qpos[self._qpos] = rest - self._carry(self._load())
        data.qpos[self._give_qpos] = -carried / self._stiffness - np.sign(carried) * self._half_gap
        self._state = np.zeros(mujoco.mj_stateSize(model, _STATE))
        mujoco.mj_getState(model, data, self._state, _STATE)

    def _roll(self, told: Told, load: FloatArray | None) -> FloatArray:
        steps = len(told.setpoints) - 1
        if steps == 0:
            return np.zeros((0, len(self._state)))
        self._data.warning.number[:] = 0
        controls, held = self._controls(told), _CONTROL
        if load is None and self._constant.any():
            load = np.zeros((steps, len(self._dof)))
        if load is not None:
            controls, held = np.hstack([controls, self._pushes(load)]), _CONTROL | _PUSH
        if self._substeps > 1:
            controls = controls.repeat(self._substeps, axis=0)
        with Rollout(nthread=0) as rollout:
            states, _ = rollout.rollout(
                self.model, self._data, self._state[None], controls[None],
                control_spec=held, initial_warmstart=self._warmstart,
            )  # fmt: skip
        self._data.qfrc_applied[:] = 0.0
        self._refuse_warnings()
        self._state = states[0, -1].copy()
        self._warmstart = self._data.qacc_warmstart[None].copy()
        return states[0, self._substeps - 1 :: self._substeps]

    def _refuse_warnings(self) -> None:
        raised = np.flatnonzero(self._data.warning.number)
        if len(raised):
            names = ", ".join(mujoco.mjtWarning(int(code)).name for code in raised)
            raise SimulationError(f"MuJoCo warned during the simulation: {names}")

    def _controls(self, told: Told) -> FloatArray:
        """Controls to hold between consecutive setpoints, shape (n - 1, nu), SI."""
        velocity, _ = held_commands(told.setpoints, self._period)
        controls = np.zeros((len(velocity), self.model.nu))
        controls[:, self._velocity_input] = velocity * self._scale
        controls[:, self._force_input] = self._commands.held_force(told)
        if len(self._integrates):
            nodes = polyline_nodes(told.setpoints, self._period)
            meant = (nodes[1:] + nodes[:-1]) / 2 - self._commands.trail * velocity
            controls[:, self._position_input] = (meant * self._scale)[:, self._integrates]
        return controls

    def _pushes(self, load: FloatArray) -> FloatArray:
        """Load and constant forces as generalised forces, (n, nv); they act beyond what gives."""
        pushes = np.zeros((len(load), self.model.nv))
        pushes[:, self._dof] = (load + self._constant) * np.sign(self._scale)
        pushes[:, self._give_dof] = pushes[:, self._dof[self._gives]]
        return pushes

    def _samples(self, setpoint: Setpoints, told: Told, states: FloatArray) -> Samples:
        motor = states[:, 1 + self._qpos] / self._scale
        speed = states[:, 1 + self.model.nq + self._dof] / self._scale
        force = self._force(told, motor, speed, states)
        position, velocity = motor.copy(), speed.copy()
        position[:, self._gives] += states[:, 1 + self._give_qpos] / self._scale[self._gives]
        velocity[:, self._gives] += (
            states[:, 1 + self.model.nq + self._give_dof] / self._scale[self._gives]
        )
        return Samples(setpoint, position, velocity, force)

    def _force(
        self, told: Told, position: FloatArray, velocity: FloatArray, states: FloatArray
    ) -> FloatArray:
        """What the drives push with around the instants of the samples, within their limits.

        Taken from the setpoint itself: at a corner of the polyline that is drawn through it the
        push is off by kp h²/12 a for a part of the step.
        """
        lag = (told.setpoints.position - position) * self._scale
        force = (
            self._position_gain * lag
            - self._damping_gain * velocity * self._scale
            + self._commands.force(told)
        )
        first = 1 + self.model.nq + self.model.nv
        for lag in self._lags:
            speed = velocity[:, lag.axis] * self._scale[lag.axis]
            force[:, lag.axis] -= lag.gain * lag.actuator.lagging(
                speed, states[:, first + lag.state]
            )
        left_behind = states[:, first + self._integral_state]
        # Within a step the axis passes under the held input: the integral bulges by V h²/12.
        left_behind = (
            left_behind + self._period**2 / 12 * (velocity * self._scale)[:, self._integrates]
        )
        force[:, self._integrates] += self._integral_gain[self._integrates] * left_behind
        return np.clip(force * np.sign(self._scale), -self._limit, self._limit)
