"""The physics of a run: setpoints in, samples of the joints out, state in between."""

import copy
import dataclasses

import mujoco
import numpy as np
from mujoco.rollout import Rollout

from twin.columns import join
from twin.machine.description.config import MachineConfig
from twin.machine.model.model import drives
from twin.machine.model.timers import switch_off_timers
from twin.machine.model.transmission import give_stiffness
from twin.machine.simulation.drive_columns import actuators, drive_columns
from twin.machine.simulation.drive_kernels import (
    DriveSetpoints,
    all_finite,
    hold_controls,
    hold_pushes,
    read_states,
)
from twin.machine.simulation.late_drives import SeenSetpoints, late_drives
from twin.machine.simulation.process import Physics, Process
from twin.machine.simulation.sampling import polyline_node
from twin.machine.simulation.stepping import stepper
from twin.machine.simulation.tick_kernels import follow_setpoints, loop_of, step_held
from twin.motion.setpoints.setpoints import Setpoints
from twin.nc.canonical import FloatArray, IntArray
from twin.recording.alarms import SimulationError
from twin.recording.form import Samples, ToolLoad
from twin.units import to_si

_STATE = int(mujoco.mjtState.mjSTATE_FULLPHYSICS)
_CONTROL = int(mujoco.mjtState.mjSTATE_CTRL)
_PUSH = int(mujoco.mjtState.mjSTATE_QFRC_APPLIED)
_PARTS = (slice(0, 1), slice(1, None))
"""Of rows: what went before, and what follows."""
_FEW = 8
"""Servo periods that are sooner stepped one by one than by calling ``mujoco.rollout``."""


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
    trails: tuple[FloatArray, FloatArray]
    """How far the filter of the command and half of the dead time are behind [mm or deg]."""


_NOT_FINITE = "a setpoint is not a finite number"


class Servo:
    """The drives and what they move, stepped from one setpoint to the next.

    It is carried over from chunk to chunk by the state, the solver's warm start and the last
    setpoint, so that how setpoints are cut into chunks changes no bit of the motion.

    Attributes:
        process: What the tool does, which pushes the axes while they are stepped; None: nothing.
    """

    def __init__(self, machine: MachineConfig, model: mujoco.MjModel) -> None:
        switch_off_timers()
        self.model, self._period = model, machine.file.servo_period_s
        self._data = mujoco.MjData(model)
        loops = drives(machine, model)
        self._drives = drive_columns(machine, model, loops)
        self._scale, joined = self._drives.scale, 1 + model.nq
        self._qpos, self._dof = self._drives.qpos - 1, self._drives.dof
        self._setpoint_state = model.actuator_actadr[actuators(model, machine.axes.names)]
        self._integrates = np.flatnonzero(self._drives.integral >= 0)
        self._integral_state = self._drives.integral[self._integrates] - joined - model.nv
        self._gives = np.flatnonzero(self._drives.give_dof >= 0)
        self._give_qpos = self._drives.give_qpos[self._gives] - 1
        self._give_dof = self._drives.give_dof[self._gives]
        axes = [machine.axis(name) for name in machine.axes.names]
        giving = [(axes[i], loops[i].moved) for i in self._gives]
        self._stiffness = np.array([give_stiffness(*each, self._period) for each in giving])
        self._half_gap = np.array([0.5 * axis.backlash * to_si(axis.kind) for axis, _ in giving])
        self._substeps = round(self._period / model.opt.timestep)
        self._late = late_drives(machine, model, loops, self._drives)
        self.process: Process | None = None
        self._view_data()
        self._state, self._states = np.zeros(0), np.zeros((0, 0))
        self._chunk: Setpoints | None = None
        self._warmstart = np.zeros((1, model.nv))
        self._idle = np.zeros((_FEW, len(loops)))

    @property
    def last(self) -> Setpoints:
        """The setpoint that the machine has come to, one row."""
        assert self._chunk is not None, "the machine has not followed anything"
        return self._chunk[-1:]

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
        if self._is_lean and load is None and 0 < len(chunk.time) <= _FEW:
            return self._follow_few(chunk)
        points = _points(chunk)
        if not all_finite(points):
            raise SimulationError(_NOT_FINITE)
        begun: list[FloatArray] = []
        loads: list[ToolLoad] = []
        past, ahead, following = points, points, chunk
        if self._chunk is None:
            self._begin(chunk)
            begun, following = [self._state[None]], chunk[1:]
            if self.process is not None:
                self.process.begin(chunk.position[0])
                loads = [self.process.at_rest(1)]
            past = DriveSetpoints(*(column[:1] for column in points))
            ahead = DriveSetpoints(*(column[1:] for column in points))
            load = None if load is None else load[1:]
        else:
            past = _points(self._chunk)
        seen = None if self._late is None else self._late.follow(past, ahead)
        states, tool = self._roll(past, ahead, seen, load, following)
        states = np.concatenate([*begun, states]) if begun else states
        self._chunk, self._states = chunk, states
        loads += [] if tool is None else [tool]
        return Samples(chunk, *self._read(points, seen, states), join(loads) if loads else None)

    @property
    def _is_lean(self) -> bool:
        """Whether one kernel makes a servo period: it has begun, nothing is late, and no tool pushes."""
        return self._chunk is not None and self.process is None and self._late is None

    def _follow_few(self, chunk: Setpoints) -> Samples:
        """As ``follow``, with one call of a kernel."""
        assert self._chunk is not None
        points, idle = _points(chunk), self._idle[: len(chunk.time)]
        self._warned[:] = 0
        self._solver[:] = self._warmstart[0]
        followed = follow_setpoints(self._loop, self._state, _points(self._chunk), points, idle)
        states = followed.states
        if not len(states):
            raise SimulationError(_NOT_FINITE)
        self._came_to(states[-1].copy())
        self._chunk, self._states = chunk, states
        return Samples(chunk, followed.position, followed.velocity, followed.force)

    def _came_to(self, state: FloatArray) -> None:
        """Take over a state that was stepped to; refuse what MuJoCo warned of meanwhile."""
        if any(self._warned.tolist()):
            self._refuse_warnings()
        self._state = state
        self._warmstart = self._solver[None].copy()

    def _read(
        self, points: DriveSetpoints, seen: SeenSetpoints | None, states: FloatArray
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Position, velocity and force of the axes in states."""
        if self._late is None or seen is None:
            return read_states(self._drives, points, states)
        return self._late.read(seen, states, 1 + self.model.nq + self.model.nv)

    def restart(self) -> None:
        """Forget all that was followed: the next chunk is the first of all."""
        self._chunk = None
        self._warmstart = np.zeros((1, self.model.nv))
        if self._late is not None:
            self._late.come_to_rest()

    def go_back(self, row: int) -> None:
        """Take back what came after a row of the last chunk."""
        assert self._chunk is not None
        if self._late is not None:
            self._late.go_to(row - len(self._chunk))
        self._chunk = self._chunk[row : row + 1]
        self._state = self._states[row].copy()
        self._warm_up()

    def switch_on(self) -> None:
        """Take the drives' setpoints to where the axes are, every axis carrying its load."""
        model, data = self.model, self._data
        mujoco.mj_setState(model, data, self._state, _STATE)
        data.qvel[:] = 0.0
        mujoco.mj_forward(model, data)
        stand = data.qpos[self._qpos] + self._carry(self._load())
        data.act[self._setpoint_state] = stand
        if self._late is not None:
            self._late.come_to_rest()
            data.act[[lag.state for lag in self._late.lags]] = 0.0
        mujoco.mj_getState(model, data, self._state, _STATE)
        still = np.zeros((1, len(stand)))
        self._chunk = dataclasses.replace(
            self.last, position=(stand / self._scale)[None], velocity=still, acceleration=still
        )
        self._warm_up()

    def _view_data(self) -> None:
        """Views of MuJoCo's arrays, which are slow to ask for."""
        self._ctrl, self._pushed = self._data.ctrl, self._data.qfrc_applied
        self._warned = self._data.warning.number
        self._solver = self._data.qacc_warmstart
        addresses = stepper(self.model, self._data)
        arrays = (self._ctrl, self._pushed)
        self._loop = loop_of(self._drives, addresses, (self._substeps, _STATE), arrays)
        self._physics = Physics(
            addresses, self._ctrl, self._pushed, self._drives, self._substeps, _STATE
        )

    def __deepcopy__(self, memo: dict[int, object]) -> "Servo":
        """A copy whose views are those of its own data."""
        copied = memo[id(self)] = object.__new__(Servo)
        copied.__dict__ = copy.deepcopy(self.__dict__, memo)
        copied._view_data()
        return copied

    def take_over(self, other: "Servo") -> None:
        """Take over the state of a servo of the same axes, tuned or built otherwise.

        The axes stand and move as they did; where the transmission gave and no longer does, the
        motor goes with the axis.
        """
        before, data = other.stand(), self._data
        self.process = other.process
        mujoco.mj_resetData(self.model, data)
        give = np.zeros(len(self._qpos))
        give[self._gives] = before.give[self._gives]
        data.qpos[self._qpos] = before.axis - give
        data.qpos[self._give_qpos] = give[self._gives]
        data.qvel[self._dof] = before.speed
        data.act[self._setpoint_state] = before.setpoint
        self._take_over_lags(before)
        mujoco.mj_forward(self.model, data)
        self._carry(np.where(np.isnan(before.integral), self._load(), before.integral))
        self._state = np.zeros(mujoco.mj_stateSize(self.model, _STATE))
        mujoco.mj_getState(self.model, data, self._state, _STATE)
        self._chunk = other.last
        self._warm_up()

    def _take_over_lags(self, before: Stand) -> None:
        """Let lags go on where others have come to; a setpoint whose filter is gone jumps."""
        filtered, _ = before.trails
        if self._late is not None:
            self._late.stand(before.trails)
            filtered = filtered - self._late.trails[0]
            for lag in self._late.lags:
                speed = float(before.speed[lag.axis])
                lagging = before.lagging.get(lag.name, speed)
                self._data.act[lag.state] = lag.actuator.current(speed, lagging)
        self._data.act[self._setpoint_state] += filtered * self._scale

    def stand(self) -> Stand:
        """How the axes stand and move after the last chunk."""
        model, data = self.model, self._data
        mujoco.mj_setState(model, data, self._state, _STATE)
        give = np.zeros(len(self._qpos))
        give[self._gives] = data.qpos[self._give_qpos]
        speed = data.qvel[self._dof].copy()
        speed[self._gives] += data.qvel[self._give_dof]
        integral = np.full(len(self._qpos), np.nan)
        integral[self._integrates] = (
            self._drives.integral_gain[self._integrates] * data.act[self._integral_state]
        )
        setpoint = data.act[self._setpoint_state].copy()
        lagging: dict[str, float] = {}
        trails = (np.zeros(len(self._qpos)), np.zeros(len(self._qpos)))
        if self._late is not None:
            trails = self._late.trails
            for lag in self._late.lags:
                shown = lag.actuator.lagging(speed[[lag.axis]], data.act[[lag.state]])
                lagging[lag.name] = float(shown[0])
        return Stand(
            data.qpos[self._qpos] + give, speed, give, setpoint, integral, lagging, trails
        )  # fmt: skip

    def _load(self) -> FloatArray:
        """What every axis carries as it stands, shape (k,) [N or N m]."""
        return self._carried(self._dof, np.arange(len(self._dof)))

    def _carried(self, dofs: IntArray, axes: IntArray) -> FloatArray:
        """What joints of axes carry as they stand [N or N m]."""
        pulled = (self._drives.constant * np.sign(self._scale))[axes]
        return (self._data.qfrc_bias - self._data.qfrc_passive)[dofs] - pulled

    def _carry(self, load: FloatArray) -> FloatArray:
        """Give the integrators their load; return what the others are off for theirs, (k,)."""
        self._data.act[self._integral_state] = (
            load[self._integrates] / self._drives.integral_gain[self._integrates]
        )
        return np.where(self._drives.integral_gain > 0, 0.0, load / self._drives.position_gain)

    def _warm_up(self) -> None:
        """Let the solver begin where the present state leads."""
        mujoco.mj_setState(self.model, self._data, self._state, _STATE)
        mujoco.mj_forward(self.model, self._data)
        self._warmstart = self._data.qacc[None].copy()

    def _begin(self, chunk: Setpoints) -> None:
        """Put the machine at rest at the first setpoint, every axis carrying its load.

        A drive that integrates has settled at its setpoint; another is off it by load/kp, and a
        transmission that gives is strained by the load.
        """
        model, data = self.model, self._data
        mujoco.mj_resetData(model, data)
        rest = chunk.position[0] * self._scale
        data.qpos[self._qpos] = rest
        data.act[self._setpoint_state] = (
            polyline_node(chunk.position[0], chunk.acceleration[0], self._period) * self._scale
        )
        mujoco.mj_forward(model, data)
        carried = self._carried(self._give_dof, self._gives)
        data.qpos[self._qpos] = rest - self._carry(self._load())
        data.qpos[self._give_qpos] = -carried / self._stiffness - np.sign(carried) * self._half_gap
        self._state = np.zeros(mujoco.mj_stateSize(model, _STATE))
        mujoco.mj_getState(model, data, self._state, _STATE)

    def _roll(
        self,
        past: DriveSetpoints,
        points: DriveSetpoints,
        seen: SeenSetpoints | None,
        load: FloatArray | None,
        setpoints: Setpoints,
    ) -> tuple[FloatArray, ToolLoad | None]:
        """Step from the last of some setpoints to others.

        Returns:
            The states there, shape (n, width), and the load on the tool.
        """
        if len(points.position) == 0:
            return np.zeros((0, len(self._state))), None
        controls, tool = self._controls(past, points, seen), None
        self._warned[:] = 0
        if self.process is None:
            states = self._roll_alone(controls, load)
        else:
            states = np.zeros((len(controls), len(self._state)))
            mujoco.mj_setState(self.model, self._data, self._state, _STATE)
            self._solver[:] = self._warmstart[0]
            tool = self.process.follow(self._physics, setpoints, controls, states)
        self._pushed[:] = 0.0
        self._came_to(states[-1].copy())
        return states, tool

    def _roll_alone(self, controls: FloatArray, load: FloatArray | None) -> FloatArray:
        """States at setpoints, of a machine that nothing but a known load pushes, shape (n, width)."""
        if load is None:
            load = np.zeros((len(controls), len(self._dof)))
        if len(controls) <= _FEW:
            pushes = hold_pushes(self._drives, load, self.model.nv)
            self._solver[:] = self._warmstart[0]
            return step_held(self._loop, self._state, controls, pushes)
        held, steps = _CONTROL, self._substeps
        if load.any() or self._drives.constant.any():
            pushes = hold_pushes(self._drives, load, self.model.nv)
            controls, held = np.hstack([controls, pushes]), _CONTROL | _PUSH
        if steps > 1:
            controls = controls.repeat(steps, axis=0)
        with Rollout(nthread=0) as rollout:
            rolled, _ = rollout.rollout(
                self.model, self._data, self._state[None], controls[None],
                control_spec=held, initial_warmstart=self._warmstart,
            )  # fmt: skip
        return rolled[0] if steps == 1 else rolled[0][steps - 1 :: steps]

    def _controls(
        self, past: DriveSetpoints, points: DriveSetpoints, seen: SeenSetpoints | None
    ) -> FloatArray:
        """Controls to hold during the step to each setpoint, shape (n, nu), SI."""
        if self._late is None or seen is None:
            return hold_controls(self._drives, past, points, self.model.nu)
        before, after = (
            DriveSetpoints(*(column[part] for column in seen.points)) for part in _PARTS
        )
        controls = hold_controls(self._drives, before, after, self.model.nu)
        controls[:, self._drives.force_input] += self._late.held_force(seen)
        return controls

    def _refuse_warnings(self) -> None:
        names = ", ".join(
            mujoco.mjtWarning(int(code)).name for code in np.flatnonzero(self._warned)
        )
        raise SimulationError(f"MuJoCo warned during the simulation: {names}")


def _points(setpoints: Setpoints) -> DriveSetpoints:
    """What the drives receive of setpoints."""
    return DriveSetpoints(setpoints.position, setpoints.velocity, setpoints.acceleration)
