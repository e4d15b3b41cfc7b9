"""Delays of drives: the filter of the command, dead time, the filter of the measured speed."""

from typing import Any, NamedTuple

import mujoco
import numpy as np

from twin.machine.description.config import MachineConfig
from twin.machine.model.drive_actuators import LagActuator, lag_actuator
from twin.machine.model.drives import Drive, lag_name
from twin.machine.simulation.drive_kernels import Drives, DriveSetpoints, read_states
from twin.machine.simulation.sampling import held_acceleration, held_velocity, polyline_node
from twin.machine.simulation.setpoint_filter import SetpointFilter
from twin.nc.canonical import FloatArray


class SeenSetpoints(NamedTuple):
    """What drives see of setpoints, n + 1 rows: the last of what went before, and n that follow."""

    points: DriveSetpoints
    """Behind the filter of the command."""
    late: DriveSetpoints
    """Behind half of the dead time as well."""


class PlayedLag(NamedTuple):
    """A lag of an axis's speed, as an actuator plays it."""

    name: str
    axis: int
    gain: float
    """Of the lagging speed [N s/m or N m s/rad]."""
    actuator: LagActuator
    state: int
    """Place of the actuator's state among all of them."""


class LateDrives:
    """Drives with delays, carried from chunk to chunk.

    Attributes:
        lags: Of speeds, as the model has them.
    """

    def __init__(
        self, machine: MachineConfig, loops: tuple[Drive, ...], drives: Drives, places: dict[str, int],
        step: float,
    ) -> None:  # fmt: skip
        """Begin at rest.

        Args:
            loops: One per axis.
            drives: The same, as the kernels have them.
            places: Of the lags' states, by name.
            step: Of the simulation [s].
        """
        self._drives = drives
        dead = np.array([loop.dead_time_s for loop in loops])
        self._half, self._integral = dead / 2.0, drives.integral_gain * dead
        self._stiffness = dead * (drives.position_gain + self._integral)
        filters = [machine.axis(name).command_filter_s for name in machine.axes.names]
        self._command_filter = SetpointFilter(np.array(filters), drives.period)
        self._delay = SetpointFilter(self._half, drives.period)
        self.lags = [
            PlayedLag(name, index, lag.gain, lag_actuator(lag, step), places[name])
            for index, loop in enumerate(loops)
            for name, lag in zip(_lag_names(machine, index, loop), loop.lags, strict=True)
        ]

    def follow(self, past: DriveSetpoints, points: DriveSetpoints) -> SeenSetpoints:
        """Setpoints as the drives see them.

        Args:
            past: What was followed last, or is at the first.
        """
        rows = DriveSetpoints(
            *(
                np.concatenate([before[-1:], after])
                for before, after in zip(past, points, strict=True)
            )
        )
        filtered = self._command_filter.follow(rows)
        return SeenSetpoints(filtered, self._delay.follow(filtered))

    def go_to(self, row: int) -> None:
        """Stand at a row of what was followed last."""
        self._command_filter.go_to(row)
        self._delay.go_to(row)

    @property
    def trails(self) -> tuple[FloatArray, FloatArray]:
        """How far the filter of the command and half of the dead time are behind, (k,) each."""
        return self._command_filter.trail.copy(), self._delay.trail.copy()

    def come_to_rest(self) -> None:
        """Let every filter stand where its setpoint stands."""
        still = np.zeros(len(self._half))
        self.stand((still, still))

    def stand(self, trails: tuple[FloatArray, FloatArray]) -> None:
        """Set how far the filters are behind, where an axis has a lag."""
        self._command_filter.stand(trails[0])
        self._delay.stand(trails[1])

    def held_force(self, seen: SeenSetpoints) -> FloatArray:
        """Force to add over each step because of the dead time, shape (n, k) [N or N m]."""
        now, late = (self._held(points) for points in seen)
        return self._drives.scale * self._force(now, late)

    def force(self, seen: SeenSetpoints, speed: FloatArray, states: FloatArray) -> FloatArray:
        """Force that is added at the instants of setpoints, shape (n, k) [N or N m].

        Args:
            speed: Of the motors, shape (n, k) [mm/s or deg/s].
            states: Of the actuators, shape (n, width).
        """
        now, late = seen
        scale = self._drives.scale
        force = scale * self._force(
            (now.velocity, now.acceleration), (late.velocity, late.acceleration)
        )
        for lag in self.lags:
            lagging = lag.actuator.lagging(
                speed[:, lag.axis] * scale[lag.axis], states[:, lag.state]
            )
            force[:, lag.axis] -= lag.gain * lagging
        return force

    def _held(self, points: DriveSetpoints) -> tuple[FloatArray, FloatArray]:
        period = self._drives.period
        rows: Any = points  # the rules of sampling hold for numbers and for columns of them
        node: Any = polyline_node(rows.position, rows.acceleration, period)
        velocity: Any = held_velocity(node[:-1], node[1:], period)
        acceleration: Any = held_acceleration(rows.velocity[:-1], rows.velocity[1:], period)
        return velocity, acceleration

    def _force(
        self, now: tuple[FloatArray, FloatArray], late: tuple[FloatArray, FloatArray]
    ) -> FloatArray:
        """What a dead time adds to a drive's feed-forward of velocity and acceleration."""
        drives, dead = self._drives, self._half > 0.0
        behind = [2.0 * dead * (after - at) for at, after in zip(now, late, strict=True)]
        force = (
            drives.velocity_feedforward * behind[0] + drives.acceleration_feedforward * behind[1]
        )
        force += self._integral * drives.trail * now[0] - self._stiffness * late[0]
        force += self._integral * self._half * (late[0] - drives.trail * late[1])
        return np.asarray(force)

    def read(
        self, seen: SeenSetpoints, states: FloatArray, first_act: int
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Position, velocity and force of the axes in states.

        Args:
            seen: What the drives saw until then; the last rows of it belong to the states.
            states: Shape (n, width).
            first_act: Column of the first actuator's state.
        """
        drives = self._drives
        last = SeenSetpoints(
            *(DriveSetpoints(*(column[-len(states) :] for column in part)) for part in seen)
        )
        unlimited = drives._replace(limit=np.full(len(drives.scale), np.inf))
        position, velocity, force = read_states(unlimited, last.points, states)
        speed = states[:, drives.qvel] / drives.scale
        force += np.sign(drives.scale) * self.force(last, speed, states[:, first_act:])
        return position, velocity, np.clip(force, -drives.limit, drives.limit)


def is_late(machine: MachineConfig, loops: tuple[Drive, ...]) -> bool:
    """Whether any drive of a machine has a delay."""
    filters = any(machine.axis(name).command_filter_s for name in machine.axes.names)
    return filters or any(loop.lags for loop in loops)


def _lag_names(machine: MachineConfig, index: int, loop: Drive) -> list[str]:
    return [lag_name(machine.axes.names[index], number) for number in range(len(loop.lags))]


def late_drives(
    machine: MachineConfig, model: mujoco.MjModel, loops: tuple[Drive, ...], drives: Drives
) -> LateDrives | None:
    """The delays of the drives; None where there are none.

    Args:
        loops: One per axis.
        drives: The same, as the kernels have them.
    """
    if not is_late(machine, loops):
        return None
    places = {
        model.actuator(index).name: int(address)
        for index, address in enumerate(model.actuator_actadr)
    }
    return LateDrives(machine, loops, drives, places, model.opt.timestep)
