"""What the drives are told: setpoints behind the filter of the command, and forces in advance."""

from typing import NamedTuple

import numpy as np

from twin.machine.description.config import Machine
from twin.machine.model.drives import Drive
from twin.machine.simulation.sampling import held_commands
from twin.machine.simulation.setpoint_filter import SetpointFilter
from twin.motion.setpoints.setpoints import Setpoints
from twin.nc.canonical import FloatArray
from twin.units import kv_per_second


class Told(NamedTuple):
    """What the drives see of setpoints."""

    setpoints: Setpoints
    """Behind the filter of the command."""
    late: Setpoints
    """Behind half of the dead time as well."""


class DriveCommands:
    """The commands of k drives, carried from chunk to chunk.

    Attributes:
        trail: Time that an axis is meant to be behind its setpoint on a line, shape (k,) [s].
    """

    def __init__(self, machine: Machine, loops: tuple[Drive, ...]) -> None:
        axes = [machine.axis(name) for name in machine.axes.names]
        self._period = machine.file.servo_period_s
        self._scale = machine.joint_scale
        share = np.array([axis.velocity_feedforward for axis in axes])
        self.trail = np.array(
            [
                (1.0 - axis.velocity_feedforward) / kv_per_second(axis.kv)
                for axis in axes
            ]
        )  # fmt: skip
        self._by_velocity = share * [loop.velocity_gain for loop in loops]
        self._by_acceleration = np.array(
            [
                axis.acceleration_feedforward * loop.moved
                for axis, loop in zip(axes, loops, strict=True)
            ]
        )
        dead = np.array([loop.dead_time_s for loop in loops])
        integral = np.array([loop.integral_gain for loop in loops]) * dead
        self._stiffness = dead * [loop.position_gain for loop in loops] + dead * integral
        self._integral, self._half = integral, dead / 2.0
        filters = np.array([axis.command_filter_s for axis in axes])
        self._command_filter = SetpointFilter(filters, self._period)
        self._delay = SetpointFilter(self._half, self._period)

    def follow(self, setpoints: Setpoints) -> Told:
        """Setpoints as the drives see them; the first row is the last of the chunk before."""
        filtered = self._command_filter.follow(setpoints)
        return Told(filtered, self._delay.follow(filtered))

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
        still = np.zeros(len(self._scale))
        self._stand(still, still)

    def take_over(self, other: "DriveCommands") -> FloatArray:
        """Go on where others have come to.

        Returns:
            How far setpoints behind the filter of the command jump by that, shape (k,) [mm or deg].
        """
        filtered, delayed = other.trails
        self._stand(filtered, delayed)
        return filtered - self.trails[0]

    def _stand(self, filtered: FloatArray, delayed: FloatArray) -> None:
        self._command_filter.stand(filtered)
        self._delay.stand(delayed)

    def held_force(self, told: Told) -> FloatArray:
        """Force to add over each step, shape (n - 1, k) [N or N m], in the sense of the joints."""
        now = held_commands(told.setpoints, self._period)
        return self._force(now, held_commands(told.late, self._period) if self._delay else now)

    def force(self, told: Told) -> FloatArray:
        """Force that is added at the instant of each setpoint, shape (n, k) [N or N m]."""
        now, late = told
        return self._force(
            (now.velocity, now.acceleration), (late.velocity, late.acceleration)
        )  # fmt: skip

    def _force(
        self, now: tuple[FloatArray, FloatArray], late: tuple[FloatArray, FloatArray]
    ) -> FloatArray:
        if not self._delay:
            return self._scale * (self._by_velocity * now[0] + self._by_acceleration * now[1])
        delayed = [
            np.where(self._half > 0.0, 2.0 * behind - value, value)
            for value, behind in zip(now, late, strict=True)
        ]
        force = self._by_velocity * delayed[0] + self._by_acceleration * delayed[1]
        force += self._integral * self.trail * now[0] - self._stiffness * late[0]
        force += self._integral * self._half * (late[0] - self.trail * late[1])
        return self._scale * force
