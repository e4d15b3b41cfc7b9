"""A machine that another simulator steps by servo periods: setpoints in, joints and loads out.

What happens in a period is what ``twin run`` does with the same setpoint, to the last bit (``LiveMachine``). An alarm
is latched, and brakes the axes; what the setpoints ask for counts no more then.
"""

import math

import numpy as np

from twin.machine.description.config import MachineConfig
from twin.machine.simulation.live import LiveMachine
from twin.motion.setpoints.setpoints import Setpoints
from twin.nc.canonical import FloatArray
from twin.recording.alarms import SimulationError

_SAME_STEP = 1e-6
"""How far a step may differ from the servo period, as a share of it."""
_PERCENT = 100.0


class MachineUnit:
    """One machine, from its start on.

    Attributes:
        start: Where its axes are before the first step, machine coordinates, shape (k,) [mm or deg].
        position: Setpoint at the end of the next step, machine coordinates, shape (k,) [mm or deg].
        velocity: The same, shape (k,) [mm/s or deg/s]; what feed-forward is computed from.
        acceleration: The same, shape (k,) [mm/s² or deg/s²].
        joint_position: At the end of the last step, shape (k,) [mm or deg].
        joint_velocity: The same, shape (k,) [mm/s or deg/s].
        force: Of the drives during it, shape (k,) [N or N m].
    """

    def __init__(self, machine: MachineConfig) -> None:
        count = len(machine.axes)
        self.machine = machine
        self.start = np.zeros(count)
        self.position, self.velocity, self.acceleration = np.zeros((3, count))
        self.joint_position, self.joint_velocity, self.force = np.zeros((3, count))
        self._live: LiveMachine | None = None
        self._tick = 0

    @property
    def period_s(self) -> float:
        """Servo period, the only step [s]."""
        return self.machine.file.servo_period_s

    @property
    def alarm(self) -> str:
        """Code of the alarm that is active; empty: none does."""
        return "" if self._live is None or self._live.alarm is None else self._live.alarm.code

    @property
    def load(self) -> FloatArray:
        """Force of each drive as a share of what it can give, shape (k,) [%]; 0 where that is not limited."""
        limits = [self.machine.axis(name).force_limit for name in self.machine.axes.names]
        shares = [
            _PERCENT * abs(force) / limit if limit > 0.0 else 0.0
            for force, limit in zip(self.force, limits, strict=True)
        ]
        return np.array(shares)

    def begin(self) -> None:
        """Switch the machine on where ``start`` says; its setpoints are there, too."""
        self._live = LiveMachine(self.machine, position=self.start)
        self._tick = 0
        self.position = self.start.copy()
        self.joint_position, self.joint_velocity = self._live.position, self._live.velocity

    def step(self, step_s: float) -> None:
        """Go on by one servo period, to the setpoint.

        Raises:
            SimulationError: The step is none of one servo period, the machine is not switched on, or a setpoint
                is not finite.
        """
        live = self._live
        if live is None:
            raise SimulationError("the machine is not switched on")
        if not math.isclose(step_s, self.period_s, rel_tol=_SAME_STEP):
            raise SimulationError(
                f"a step of {step_s:g} s: this machine steps by its servo period, {self.period_s:g} s"
            )
        self._tick += 1
        samples = live.brake(1) if live.alarm is not None else live.follow(self._setpoint())
        self.joint_position = samples.joint_position[-1].copy()
        self.joint_velocity = samples.joint_velocity[-1].copy()
        self.force = samples.drive_force[-1].copy()

    def _setpoint(self) -> Setpoints:
        none = np.zeros(1, np.int64)
        columns = (self.position, self.velocity, self.acceleration)
        return Setpoints(
            np.array([self._tick * self.period_s]),
            none,
            none,
            np.zeros(1),
            *(column[None].copy() for column in columns),
        )
