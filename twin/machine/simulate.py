"""Setpoints through the simulated drives: an open-loop run in chunks of ``mujoco.rollout``."""

from collections.abc import Iterable, Iterator

import mujoco
import numpy as np
from mujoco.rollout import Rollout

from twin.machine.alarms import Alarm, NearMiss, SimulationError
from twin.machine.clearance import Clearance
from twin.machine.config import Machine
from twin.machine.drives import feedforward_name, integral_name
from twin.machine.model import clearance_model, drives, physics_model
from twin.machine.sampling import held_commands, polyline_nodes
from twin.machine.transmission import give_name, has_give
from twin.machine.watch import Watch
from twin.motion.setpoints import Setpoints, join
from twin.nc.canonical import FloatArray
from twin.recording import Samples
from twin.units import kv_per_second

_STATE = mujoco.mjtState.mjSTATE_FULLPHYSICS


class Simulation:
    """A run of the machine along setpoints; iterate it for the samples.

    It ends with the setpoints, or at an alarm: then the last sample is the one that raised it.

    Attributes:
        alarm: What stopped the run, None while it goes on and when it ended well.
        near_miss: The closest that tool's and part's side came without touching, None when they
            kept their distance.
    """

    def __init__(
        self,
        machine: Machine,
        model: mujoco.MjModel,
        clearance: Clearance | None,
        setpoints: Iterable[Setpoints],
    ) -> None:
        self.alarm: Alarm | None = None
        self._clearance = clearance
        self._setpoints = setpoints
        self._servo = _Servo(machine, model)
        self._watch = Watch(machine)

    @property
    def near_miss(self) -> NearMiss | None:
        """The closest approach so far, where it was below the machine file's limit."""
        return None if self._clearance is None else self._clearance.near_miss

    def __iter__(self) -> Iterator[Samples]:
        """Yield chunks of samples; a run can be iterated once.

        Raises:
            SimulationError: MuJoCo warned, or a setpoint or a state is not finite.
        """
        for chunk in self._setpoints:
            if not len(chunk):
                continue
            samples = self._servo.follow(chunk)
            self.alarm = self._look(samples)
            if self.alarm is None:
                yield samples
                continue
            end = int(np.searchsorted(samples.setpoint.time, self.alarm.time_s, side="right"))
            yield samples[:end]
            return

    def _look(self, samples: Samples) -> Alarm | None:
        found = self._watch.look(samples)
        if self._clearance is None:
            return found
        collision = self._clearance.look(samples)
        both = [alarm for alarm in (collision, found) if alarm is not None]
        return min(both, key=lambda alarm: alarm.time_s, default=None)


def simulate(
    machine: Machine, model: mujoco.MjModel | mujoco.MjSpec, setpoints: Iterable[Setpoints]
) -> Simulation:
    """Run the machine along setpoints.

    Sample 0 is the state at rest at the first setpoint; sample i of the joints belongs to the
    same instant as setpoint i. How the setpoints are cut into chunks changes no bit of the result.

    Args:
        machine: The machine file.
        model: What ``build_spec`` made: the run then also watches for collisions. Or a model
            compiled from it, of which the motion alone is simulated.
        setpoints: Chunks of setpoints at the servo period, machine coordinates [mm or deg].

    Returns:
        The run: iterate it for the samples, then ask its ``alarm``.

    Raises:
        ConfigError: The specification does not compile.
    """
    if isinstance(model, mujoco.MjModel):
        return Simulation(machine, model, None, setpoints)
    clearance = Clearance(machine, clearance_model(machine, model))
    return Simulation(machine, physics_model(machine, model), clearance, setpoints)


class _Servo:
    """The physics between two chunks: state, solver's warm start, the last setpoint."""

    def __init__(self, machine: Machine, model: mujoco.MjModel) -> None:
        self._period = machine.file.servo_period_s
        self._model = model
        self._data = mujoco.MjData(model)
        loops = drives(machine, model)
        self._position_gain = np.array([loop.position_gain for loop in loops])
        self._velocity_gain = np.array([loop.velocity_gain for loop in loops])
        self._moved = np.array([loop.moved for loop in loops])
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
        self._trail = np.array(
            [(1.0 - axis.velocity_feedforward) / kv_per_second(axis.kv) for axis in axes]
        )
        self._gives = np.flatnonzero([has_give(axis) for axis in axes])
        give = [model.joint(give_name(axes[index])) for index in self._gives]
        self._give_qpos = np.array([int(joint.qposadr[0]) for joint in give], np.int64)
        self._give_dof = np.array([int(joint.dofadr[0]) for joint in give], np.int64)
        walls = [model.tendon(give_name(axes[index])).id for index in self._gives]
        self._stiffness = model.tendon_stiffness[walls]
        self._half_gap = model.tendon_lengthspring[walls, 1]
        self._scale = machine.joint_scale
        self._velocity_share = np.array([axis.velocity_feedforward for axis in axes])
        self._limit = np.array([axis.force_limit or np.inf for axis in axes])
        self._acceleration_share = np.array([axis.acceleration_feedforward for axis in axes])
        self._last: Setpoints | None = None
        self._state = np.zeros(0)
        self._warmstart = np.zeros((1, model.nv))

    def follow(self, chunk: Setpoints) -> Samples:
        """Step through one chunk and give its samples."""
        if not all(
            np.isfinite(v).all() for v in (chunk.position, chunk.velocity, chunk.acceleration)
        ):
            raise SimulationError("a setpoint is not a finite number")
        if self._last is None:
            self._begin(chunk)
            states = np.concatenate([self._state[None], self._roll(chunk)])
        else:
            states = self._roll(join([self._last, chunk]))
        self._last = chunk[-1:]
        return self._samples(chunk, states)

    def _begin(self, chunk: Setpoints) -> None:
        """Put the machine at rest at the first setpoint, every axis carrying its load.

        A drive that integrates has settled at its setpoint; another stands off it by load/kp, and a
        transmission that gives is strained by the load.
        """
        model, data = self._model, self._data
        mujoco.mj_resetData(model, data)
        rest = chunk.position[0] * self._scale
        data.qpos[self._qpos] = rest
        data.act[self._setpoint_state] = polyline_nodes(chunk[:1], self._period)[0] * self._scale
        mujoco.mj_forward(model, data)
        load = data.qfrc_bias - data.qfrc_passive
        settled = self._integral_gain > 0
        data.act[self._integral_state] = (
            load[self._dof[self._integrates]] / self._integral_gain[self._integrates]
        )
        sag = np.where(settled, 0.0, load[self._dof] / self._position_gain)
        data.qpos[self._qpos] = rest - sag
        carried = load[self._give_dof]
        data.qpos[self._give_qpos] = -carried / self._stiffness - np.sign(carried) * self._half_gap
        self._state = np.zeros(mujoco.mj_stateSize(model, _STATE))
        mujoco.mj_getState(model, data, self._state, _STATE)

    def _roll(self, setpoints: Setpoints) -> FloatArray:
        steps = len(setpoints) - 1
        if steps == 0:
            return np.zeros((0, len(self._state)))
        self._data.warning.number[:] = 0
        with Rollout(nthread=0) as rollout:
            states, _ = rollout.rollout(
                self._model, self._data, self._state[None], self._controls(setpoints)[None],
                initial_warmstart=self._warmstart,
            )  # fmt: skip
        self._refuse_warnings()
        self._state = states[0, -1].copy()
        self._warmstart = self._data.qacc_warmstart[None].copy()
        return states[0]

    def _refuse_warnings(self) -> None:
        raised = np.flatnonzero(self._data.warning.number)
        if len(raised):
            names = ", ".join(mujoco.mjtWarning(int(code)).name for code in raised)
            raise SimulationError(f"MuJoCo warned during the simulation: {names}")

    def _controls(self, setpoints: Setpoints) -> FloatArray:
        """Controls to hold between consecutive setpoints, shape (n - 1, nu), SI."""
        velocity, acceleration = held_commands(setpoints, self._period)
        controls = np.zeros((len(velocity), self._model.nu))
        controls[:, self._velocity_input] = velocity * self._scale
        controls[:, self._force_input] = self._told(velocity, acceleration)
        if len(self._integrates):
            nodes = polyline_nodes(setpoints, self._period)
            meant = ((nodes[1:] + nodes[:-1]) / 2 - self._trail * velocity) * self._scale
            controls[:, self._position_input] = meant[:, self._integrates]
        return controls

    def _told(self, velocity: FloatArray, acceleration: FloatArray) -> FloatArray:
        """Force that the drives add in advance [N or N m]."""
        return self._scale * (
            self._velocity_share * self._velocity_gain * velocity
            + self._acceleration_share * self._moved * acceleration
        )

    def _samples(self, setpoint: Setpoints, states: FloatArray) -> Samples:
        motor = states[:, 1 + self._qpos] / self._scale
        speed = states[:, 1 + self._model.nq + self._dof] / self._scale
        force = self._force(setpoint, motor, speed, states)
        position, velocity = motor.copy(), speed.copy()
        position[:, self._gives] += states[:, 1 + self._give_qpos] / self._scale[self._gives]
        velocity[:, self._gives] += (
            states[:, 1 + self._model.nq + self._give_dof] / self._scale[self._gives]
        )
        return Samples(setpoint, position, velocity, force)

    def _force(
        self, setpoint: Setpoints, position: FloatArray, velocity: FloatArray, states: FloatArray
    ) -> FloatArray:
        """What the drives push with around the instants of the samples, within their limits.

        Taken from the setpoint itself: at a corner of the polyline that is drawn through it the
        push is off by kp h²/12 a for a part of the step.
        """
        lag = (setpoint.position - position) * self._scale
        force = (
            self._position_gain * lag
            - self._velocity_gain * velocity * self._scale
            + self._told(setpoint.velocity, setpoint.acceleration)
        )
        first = 1 + self._model.nq + self._model.nv
        left_behind = states[:, first + self._integral_state]
        # Within a step the axis passes under the held input: the integral bulges by V h²/12.
        left_behind = (
            left_behind + self._period**2 / 12 * (velocity * self._scale)[:, self._integrates]
        )
        force[:, self._integrates] += self._integral_gain[self._integrates] * left_behind
        return np.clip(force * np.sign(self._scale), -self._limit, self._limit)
