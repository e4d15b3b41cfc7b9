"""The machine under a control that reacts: setpoints in, joints and alarms out, slice by slice."""

from typing import Any

import numpy as np

from twin.errors import ConfigError
from twin.job.job_file import ToolTable
from twin.machine.description.config import Blank, MachineConfig
from twin.machine.model.model import MachineModel
from twin.machine.simulation.process import Process
from twin.machine.simulation.servo import Servo
from twin.machine.watching.clearance import Clearance
from twin.machine.watching.watch import Watch, limit_switches
from twin.motion.setpoints.setpoints import Setpoints
from twin.nc.canonical import FloatArray
from twin.recording.alarms import Alarm, AlarmCode, AlarmStandsError, NearMiss
from twin.recording.reader import Samples

STANDSTILL = 0.01
"""Speed below which an axis counts as standing [mm/s or deg/s]."""
_BUILT_IN = ("joint", "kind", "direction", "periodic")
"""Fields of an axis that no fault can change."""


class LiveMachine:
    """A machine that someone operates.

    It is stepped in slices of any length, one setpoint per servo period, and moves bit for bit as
    ``simulate`` moves it along the same setpoints. A control that asks for one period at a time
    gives ``follow`` one row; that is made to be quick. At an alarm it goes no further: the samples
    that come back end with the one that raised it. The alarm is latched; what is left is to
    ``brake`` to rest and, once the cause is dealt with, to ``clear`` it. As at a real machine an
    axis may then be driven off its limit switch, and a holder out of the vise, but not further in.

    Example:
        >>> from twin.machine.load import read_machine
        >>> from twin.files.shipped import machine_file
        >>> live = LiveMachine(read_machine(machine_file("mill4")))
        >>> samples = live.hold(100)
        >>> live.change("X", dry_friction=2000.0)
        >>> live.raise_alarm("emergency-stop", "the operator pressed the button")
        >>> len(live.brake(50)), live.alarm.code
        (50, 'emergency-stop')
        >>> live.clear()
        >>> live.alarm is None
        True

    Attributes:
        machine: The machine with the faults that it has by now.
        alarm: What stopped it, until it is cleared.
        head: What is above the tool's holder.
    """

    def __init__(
        self,
        machine: MachineConfig,
        tool: ToolTable | None = None,
        position: FloatArray | None = None,
        blank: Blank | None = None,
    ) -> None:
        """Switch a machine on.

        Args:
            tool: What the spindle holds; a 10 mm end mill by default.
            position: Where the axes stand, machine coordinates, shape (k,) [mm or deg]; at zero by
                default.

        Raises:
            ConfigError: The model is wrong.
        """
        self.machine = machine
        self.alarm: Alarm | None = None
        self._sound = machine
        self._blank = blank
        model = MachineModel(machine, tool, blank)
        self._clearance = Clearance(machine, model.solids)
        self.head = model.head
        self._servo = Servo(machine, model.physics)
        self._watch = Watch(machine)
        stand = np.zeros(len(machine.axes)) if position is None else np.asarray(position, float)
        self._stand = self._servo.follow(_standing(stand))

    @property
    def setpoint(self) -> Setpoints:
        """The setpoint that the machine has come to, one row: whatever follows begins here."""
        return self._servo.last

    @property
    def position(self) -> FloatArray:
        """Where the axes stand, machine coordinates, shape (k,) [mm or deg]."""
        return self._stand.joint_position[-1].copy()

    @property
    def velocity(self) -> FloatArray:
        """How fast they move, shape (k,) [mm/s or deg/s]."""
        return self._stand.joint_velocity[-1].copy()

    @property
    def moving(self) -> bool:
        """Whether any axis moves."""
        return moving(self._stand)

    @property
    def on_limit_switch(self) -> str:
        """Name of an axis that is on its limit switch; empty: none is."""
        for name, place in zip(self.machine.axes.names, self.position, strict=True):
            low, high = limit_switches(self.machine.axis(name))
            if not low < place < high:
                return name
        return ""

    @property
    def near_miss(self) -> NearMiss | None:
        """The closest that the tool's side and the part's came without touching."""
        return self._clearance.near_miss

    def follow(self, setpoints: Setpoints) -> Samples:
        """Step along setpoints.

        Args:
            setpoints: n rows, the first one servo period after ``setpoint``, machine coordinates.

        Returns:
            Samples of the same instants, or fewer: the last one raised ``alarm``.

        Raises:
            AlarmStandsError: An alarm has not been cleared.
            SimulationError: MuJoCo warned, or a setpoint is not finite.
        """
        if self.alarm is not None:
            raise AlarmStandsError(f"{self.alarm.code} has not been cleared: {self.alarm.message}")
        samples = self._step(setpoints)
        if not len(samples):
            return samples
        seen, collision = self._watch.look(samples), self._clearance.look(samples)
        stalled = None if self._servo.process is None else self._servo.process.alarm
        if seen is None and collision is None and stalled is None:
            return samples
        raised = filter(None, (seen, collision, stalled))
        self.alarm = min(raised, key=lambda alarm: alarm.time_s)
        end = int(np.searchsorted(samples.setpoint.time, self.alarm.time_s, side="right"))
        self._servo.go_back(end - 1)
        self._stand = samples[end - 1 : end]
        return samples[:end]

    def step_with(self, process: Process | None) -> None:
        """Let a process push the axes from now on; None: no process."""
        if process is not None:
            process.begin(self.position)
        self._servo.process = process

    def hold(self, ticks: int) -> Samples:
        """Step without setpoints: the axes come to rest where they are, and stay.

        This is no feed hold: that keeps to the path, and is the planner's.

        Args:
            ticks: Number of servo periods.

        Raises:
            AlarmStandsError: An alarm has not been cleared.
        """
        return self.follow(self._ramp(ticks))

    def stand_at(self, position: FloatArray) -> Samples:
        """Put the axes at rest at a position, as when the machine was switched on there.

        Args:
            position: Machine coordinates, shape (k,) [mm or deg].

        Returns:
            One sample, at time 0.

        Raises:
            AlarmStandsError: An alarm has not been cleared.
        """
        if self.alarm is not None:
            raise AlarmStandsError(f"{self.alarm.code} has not been cleared")
        self._servo.restart()
        self._stand = self._servo.follow(_standing(position))
        self._watch.acknowledge(self.position)
        return self._stand

    def brake(self, ticks: int) -> Samples:
        """Bring the axes to rest, each at its own acceleration, and hold them there.

        It is what a control does at an alarm (stop category 1 of IEC 60204-1). Nothing is watched
        meanwhile: the first alarm is what counts.

        Args:
            ticks: Number of servo periods; call again until the axes are at rest.
        """
        return self._step(self._ramp(ticks))

    def raise_alarm(self, code: AlarmCode, message: str, *, axis: str = "") -> None:
        """Stop for a reason from outside, such as the stock or the operator; the first one counts."""
        now = self.setpoint
        if self.alarm is None:
            self.alarm = Alarm(code, int(now.line[0]), float(now.time[0]), axis, message)

    def clear(self) -> None:
        """Clear the alarm and switch the drives on where the axes are.

        Raises:
            AlarmStandsError: An axis still moves.
        """
        moving = np.abs(self.velocity) > STANDSTILL
        if moving.any():
            name = self.machine.axes.names[int(np.argmax(moving))]
            raise AlarmStandsError(f"{name} still moves: an alarm is cleared at rest")
        self.alarm = None
        self._servo.switch_on()
        self._watch.acknowledge(self.position)
        self._clearance.acknowledge(self.position)

    def change(self, axis: str, **fields: Any) -> None:
        """Change an axis while it is used: a fault that a trainer injects.

        Friction, play, spring, force, gain and limits are fields of ``AxisTable``; whichever is
        given applies from the next step on.

        Args:
            fields: Keys of ``[axes.NAME]`` in the machine file, with their values.

        Raises:
            ConfigError: No such axis, a wrong key or value, or the drive that comes of it cannot be
                simulated; nothing has changed then.
        """
        fixed = [key for key in fields if key in _BUILT_IN]
        if fixed:
            raise ConfigError(f"axes.{axis}.{fixed[0]} cannot change while the machine runs")
        self._rebuild(self.machine.changed(axis, **fields))

    def repair(self) -> None:
        """Take back all changes."""
        self._rebuild(self._sound)

    def mount(self, tool: ToolTable) -> None:
        """Put another tool into the spindle, as far as collisions are concerned."""
        model = MachineModel(self.machine, tool, self._blank)
        self._clearance = Clearance(self.machine, model.solids)

    def _rebuild(self, machine: MachineConfig) -> None:
        servo = Servo(machine, MachineModel(machine, None, self._blank).physics)
        servo.take_over(self._servo)
        self.machine, self._servo = machine, servo
        self._watch = Watch(machine)
        self._watch.acknowledge(self.position)

    def _step(self, setpoints: Setpoints) -> Samples:
        if not len(setpoints):
            return self._stand[:0]
        self._stand = self._servo.follow(setpoints)
        return self._stand

    def _ramp(self, ticks: int) -> Setpoints:
        """Setpoints that slow down to rest and stay there."""
        last = self.setpoint
        limit = np.array([self.machine.axis(name).acceleration for name in self.machine.axes.names])
        time = self.machine.file.servo_period_s * np.arange(1, ticks + 1)[:, None]
        speed, sense = np.abs(last.velocity), np.sign(last.velocity)
        slowing = np.minimum(time, speed / limit)
        return Setpoints(
            last.time + time[:, 0],
            np.repeat(last.line, ticks),
            np.repeat(last.move, ticks),
            np.repeat(last.fraction, ticks),
            last.position + sense * (speed - limit * slowing / 2.0) * slowing,
            sense * (speed - limit * slowing),
            np.where(time < speed / limit, -sense * limit, 0.0),
        )


def moving(samples: Samples) -> bool:
    """Whether any axis moves at the last of some samples."""
    return bool(np.abs(samples.joint_velocity[-1]).max() > STANDSTILL)


def _standing(position: FloatArray) -> Setpoints:
    """One setpoint at rest before any program."""
    still = np.zeros((1, len(position)))
    none = np.zeros(1, np.int64)
    return Setpoints(np.zeros(1), none, none - 1, np.zeros(1), position[None].copy(), still, still)
