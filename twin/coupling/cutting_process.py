"""A tool that cuts while the machine moves: the process that the drives are stepped with."""

import abc
import dataclasses
import math
from collections.abc import Iterator
from typing import NamedTuple, Protocol

import numpy as np

from twin.coupling.spindle_kernels import SpindleDrive
from twin.coupling.turning_tool import CutNumber, EdgeState, ToolLoads, TurningTool, new_memory
from twin.cutting.forces.cutter_form import cutter_form, force_law
from twin.cutting.forces.materials import Kienzle
from twin.cutting.forces.tool_strength import ToolStrength, tool_strength
from twin.job.job_file import ToolTable
from twin.machine.description.machine_file import SpindleTable
from twin.machine.simulation.process import Physics
from twin.motion.setpoints.setpoints import Setpoints
from twin.nc.canonical import FloatArray
from twin.recording.alarms import Alarm
from twin.recording.form import ToolLoad
from twin.toolpath.part_frame import PartFrame
from twin.units import SECONDS_PER_MINUTE

STALLED_SHARE = 0.1
"""Share of the commanded speed below which a spindle that cuts has stalled."""


@dataclasses.dataclass(frozen=True, slots=True)
class ToolBreak:
    """A tool that lost its edge.

    Attributes:
        time_s: When [s].
    """

    tool: int
    line: int
    time_s: float
    reason: str

    @property
    def alarm(self) -> Alarm:
        """As the run's verdict calls it."""
        message = f"tool {self.tool} broke: {self.reason}"
        return Alarm("tool-broken", self.line, self.time_s, "", message, stops=False)


class SpindleTurning(NamedTuple):
    """What is in the spindle during some setpoints, and how fast it shall turn.

    Attributes:
        length_difference: How much lower its tip is than that which positions count for [mm].
        speed: Of the spindle, shape (n,) [1/min], negative counter-clockwise; NaN where nothing is known.
    """

    rows: slice
    tool: ToolTable
    length_difference: float
    speed: FloatArray


class Operation(Protocol):
    """Who knows what is in the spindle when."""

    @property
    def speed_at_start(self) -> float:
        """How fast the spindle turns when the machine begins to move [1/min], signed."""
        ...

    def turnings(self, setpoints: Setpoints) -> Iterator[SpindleTurning]:
        """Split setpoints where the tool changes."""
        ...


class Rows(NamedTuple):
    """What the machine is commanded in n periods, and what is set by them.

    Attributes:
        controls: What the drives are commanded during the step to each setpoint, shape (n, nu).
        states: Set to the states there, shape (n, width).
    """

    controls: FloatArray
    states: FloatArray
    loads: ToolLoads


class CutSetting(NamedTuple):
    """What a process is set up with besides its material.

    Attributes:
        resists: What the material does to the teeth.
        part_frame: How the axes carry tool and part.
    """

    resists: Kienzle
    operation: Operation
    part_frame: PartFrame
    spindle: SpindleTable


class CuttingProcess(abc.ABC):
    """Cuts a material of its own along the simulated motion, and pushes the axes by what the teeth feel.

    It is not the material of ``twin.cutting.cut.Cutter``, which becomes the part. A tooth wants the material cut again every
    quarter of a cell; the depth and width of a cut are those of a long straight stretch (of a ball of 6 mm, 1 mm deep, pieces
    of a quarter of a cell are 0.07 mm deep), and what must not meet the material is held against it before it is cut.
    Cutting twice takes 1 to 3 % of the processor time of a run.

    Attributes:
        breaks: The tools that broke, in order.
        alarm: The spindle's alarm of the last ``follow``.
    """

    def __init__(self, setting: CutSetting) -> None:
        self.breaks: list[ToolBreak] = []
        self.alarm: Alarm | None = None
        self._resists, self._operation = setting.resists, setting.operation
        self._table, self._drive = setting.spindle, spindle_drive(setting.spindle)
        self._memory = new_memory(0)
        self._memory.numbers[CutNumber.SPEED] = self._operation.speed_at_start / SECONDS_PER_MINUTE
        self._tool: ToolTable | None = None
        self._overloaded_s = 0.0

    @abc.abstractmethod
    def _cut_along(
        self, physics: Physics, turning: SpindleTurning, tool: TurningTool, rows: Rows
    ) -> None:
        """Step the machine from setpoint to setpoint while one tool cuts."""

    def begin(self, position: FloatArray) -> None:
        """Begin with the machine at rest; see ``Process``."""
        speed = self._memory.numbers[CutNumber.SPEED]
        self._memory = new_memory(len(position))
        self._memory.numbers[CutNumber.SPEED] = speed

    def renew(self, number: int) -> None:
        """Replace a tool, which may have lost its edge, by a new one."""
        self.breaks = [found for found in self.breaks if found.tool != number]
        if self._tool is not None and self._tool.number == number:
            self._tool = None

    def lift(self) -> None:
        """Lift the tool: what comes next is no travel of it."""
        memory = self._memory
        memory.numbers[CutNumber.FRESH] = 1.0
        for column in (memory.load, memory.bend, memory.looked, memory.scratch.figures):
            column[:] = 0.0

    def at_rest(self, count: int) -> ToolLoad:
        """What a tool feels that does not cut; see ``Process``."""
        return _load(_felt(count))

    def follow(
        self, physics: Physics, setpoints: Setpoints, controls: FloatArray, states: FloatArray
    ) -> ToolLoad:
        """Step the machine while the tool cuts; see ``Process``."""
        self.alarm = None
        loads = _felt(len(setpoints))
        for turning in self._operation.turnings(setpoints):
            rows, tool = turning.rows, turning.tool
            self._mount(tool)
            turned = TurningTool(
                cutter_form(tool), force_law(tool, self._resists), tool_strength(tool), self._drive
            )
            here = ToolLoads(*(column[rows] for column in loads))
            self._cut_along(physics, turning, turned, Rows(controls[rows], states[rows], here))
            self._note_break(tool, turned.strength, setpoints[rows], loads.broken[rows])
            self._watch_spindle(setpoints[rows], turning.speed, loads, rows, physics.drives.period)
        return _load(loads)

    def _mount(self, tool: ToolTable) -> None:
        if self._tool is not None and self._tool.number == tool.number:
            self._tool = tool
            return
        self._tool = tool
        self.lift()
        broken = any(found.tool == tool.number for found in self.breaks)
        self._memory.numbers[CutNumber.EDGE] = EdgeState.BY_FORCE if broken else EdgeState.WHOLE

    def _note_break(
        self, tool: ToolTable, strength: ToolStrength, setpoints: Setpoints, state: FloatArray
    ) -> None:
        row = int(np.argmax(state != EdgeState.WHOLE)) if len(state) else 0
        known = any(found.tool == tool.number for found in self.breaks)
        if not len(state) or state[row] == EdgeState.WHOLE or known:
            return
        value, why = float(self._memory.numbers[CutNumber.VALUE]), int(state[row])
        if why == EdgeState.BY_CHIP:
            reason = (
                f"a chip of {value:.3g} mm was thicker than the {strength.chip:.3g} mm it bears"
            )
        elif why == EdgeState.BY_FORCE:
            reason = (
                f"a force of {value:.0f} N was greater than the {strength.force:.0f} N it bears"
            )
        elif why == EdgeState.BY_TORQUE:
            reason = (
                f"a torque of {value:.3g} Nm was greater than the {strength.torque:.3g} Nm it bears"
            )
        elif why == EdgeState.BY_THRUST:
            reason = (
                f"a thrust of {value:.0f} N was greater than the {strength.thrust:.0f} N it bears"
            )
        else:
            reason = f"{value:.0f} /min were more than the {strength.speed:.0f} /min it bears"
        line, time = int(setpoints.line[row]), float(setpoints.time[row])
        self.breaks.append(ToolBreak(tool.number, line, time, reason))

    def _watch_spindle(
        self,
        setpoints: Setpoints,
        commanded: FloatArray,
        loads: ToolLoads,
        rows: slice,
        period: float,
    ) -> None:
        """Raise the alarm of a spindle that stalls, or that gives too much for too long."""
        load, speed = loads.spindle_load[rows], np.abs(loads.spindle_speed[rows])
        if self.alarm is not None or not (load > 1.0).any():
            self._overloaded_s = 0.0
            return
        for row, over in enumerate((load > 1.0).tolist()):
            self._overloaded_s = self._overloaded_s + period if over else 0.0
            place = int(setpoints.line[row]), float(setpoints.time[row])
            asked = f"it asks for {100.0 * load[row]:.0f} % of its torque"
            if over and speed[row] < STALLED_SHARE * abs(commanded[row]):
                self.alarm = Alarm(
                    "spindle-stall", *place, "", f"the cut stalled the spindle: {asked}"
                )
                return
            if self._overloaded_s > self._table.overload_time_s:
                message = f"the load of the spindle was above 100 % for {self._overloaded_s:.1f} s"
                self.alarm = Alarm("spindle-overload", *place, "", message)
                return


def spindle_drive(table: SpindleTable) -> SpindleDrive:
    """The drive of a machine file's spindle."""
    curve = np.array(table.power, np.float64).reshape(-1, 2)
    fastest = math.inf if table.max_speed is None else table.max_speed / SECONDS_PER_MINUTE
    rate = table.acceleration / SECONDS_PER_MINUTE if table.acceleration else math.inf
    return SpindleDrive(
        np.ascontiguousarray(curve[:, 0]) / SECONDS_PER_MINUTE,
        np.ascontiguousarray(curve[:, 1]),
        table.overload,
        fastest,
        rate,
    )


def _felt(count: int) -> ToolLoads:
    return ToolLoads(
        *(np.zeros((count, 3) if name in _SPATIAL else count) for name in ToolLoads._fields)
    )


_SPATIAL = ("force", "deflection")


def _load(loads: ToolLoads) -> ToolLoad:
    return ToolLoad(**{**loads._asdict(), "broken": loads.broken != EdgeState.WHOLE})
