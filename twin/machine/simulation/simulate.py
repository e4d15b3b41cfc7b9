"""Setpoints through the simulated drives: an open-loop run in chunks of ``mujoco.rollout``."""

from collections.abc import Callable, Iterable, Iterator
from typing import NamedTuple

import mujoco
import numpy as np

from twin.machine.description.config import MachineConfig
from twin.machine.model.model import MachineModel
from twin.machine.simulation.process import Process
from twin.machine.simulation.servo import Servo
from twin.machine.simulation.tool_changes import ToolClearances
from twin.machine.watching.clearance import Clearance
from twin.machine.watching.watch import Watch
from twin.motion.setpoints.setpoints import Setpoints
from twin.nc.canonical import FloatArray
from twin.recording.alarms import Alarm, NearMiss
from twin.recording.reader import Samples
from twin.toolpath.tool_plan import ToolPlan

Load = Callable[[Setpoints], FloatArray]


class Stepped(NamedTuple):
    """A chunk of samples that nobody has looked at.

    Attributes:
        alarm: What the process raised in it; None: nothing.
    """

    samples: Samples
    alarm: Alarm | None


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
        machine: MachineConfig,
        model: mujoco.MjModel,
        clearance: Clearance | ToolClearances | None,
        setpoints: Iterable[Setpoints],
        load: Load | None = None,
        process: Process | None = None,
    ) -> None:
        self.alarm: Alarm | None = None
        self._clearance = clearance
        self._setpoints = setpoints
        self._load = load
        self._servo = Servo(machine, model)
        self._servo.process = process
        self._watch = Watch(machine)

    @property
    def near_miss(self) -> NearMiss | None:
        """The closest approach so far, where it was below the machine file's limit.

        None after a collision, which nobody would call a near miss.
        """
        collided = self.alarm is not None and self.alarm.code == "collision"
        return None if self._clearance is None or collided else self._clearance.near_miss

    def __iter__(self) -> Iterator[Samples]:
        """Yield chunks of samples; a run can be iterated once.

        Raises:
            SimulationError: MuJoCo warned, or a setpoint or a state is not finite.
        """
        return self.watched(self.stepped())

    def stepped(self) -> Iterator[Stepped]:
        """Step the machine along the setpoints, watched by nobody.

        Raises:
            SimulationError: MuJoCo warned, or a setpoint or a state is not finite.
        """
        for chunk in self._setpoints:
            if len(chunk):
                load = None if self._load is None else self._load(chunk)
                samples, process = self._servo.follow(chunk, load), self._servo.process
                yield Stepped(samples, None if process is None else process.alarm)

    def watched(self, stepped: Iterable[Stepped]) -> Iterator[Samples]:
        """Pass samples on up to an alarm.

        Args:
            stepped: What ``stepped`` yields, which may be ahead of what is looked at.
        """
        for samples, raised in stepped:
            self.alarm = self._look(samples, raised)
            if self.alarm is None:
                yield samples
                continue
            end = int(np.searchsorted(samples.setpoint.time, self.alarm.time_s, side="right"))
            if end:
                yield samples[:end]
            return
        if isinstance(self._clearance, ToolClearances):
            self.alarm = self._clearance.finish()

    def _look(self, samples: Samples, raised: Alarm | None) -> Alarm | None:
        met = None if self._clearance is None else self._clearance.look(samples)
        found = (met, self._watch.look(samples), raised)
        return min(filter(None, found), key=lambda alarm: alarm.time_s, default=None)


def simulate(
    machine: MachineConfig,
    model: MachineModel | mujoco.MjModel,
    setpoints: Iterable[Setpoints],
    tools: ToolPlan | None = None,
    load: Load | None = None,
    process: Process | None = None,
) -> Simulation:
    """Run the machine along setpoints.

    Sample 0 is the state at rest at the first setpoint; sample i of the joints belongs to the
    same instant as setpoint i. How the setpoints are cut into chunks changes no bit of the result.

    Args:
        model: Its model: the run then also watches for collisions. Or what that compiles to, of which the
            motion alone is simulated.
        setpoints: Chunks of setpoints at the servo period, machine coordinates [mm or deg].
        tools: Which tool is in the spindle during which move; by default that of the model.
        load: Called with every chunk in turn: what pushes the axes from outside during the period
            that ends with each setpoint, shape (n, k) [N or N m]; None: nothing.
        process: What the tool does, which pushes the axes while they move; instead of ``load``.

    Returns:
        The run: iterate it for the samples, then ask its ``alarm``.

    Raises:
        ConfigError: The model does not compile.
    """
    if isinstance(model, mujoco.MjModel):
        return Simulation(machine, model, None, setpoints, load, process)
    clearance = Clearance(machine, model.solids) if tools is None else ToolClearances(model, tools)
    return Simulation(machine, model.physics, clearance, setpoints, load, process)
