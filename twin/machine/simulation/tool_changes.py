"""Collisions and near misses of whichever tool is in the spindle."""

import dataclasses

from twin.job.job_file import ToolTable
from twin.machine.model.model import MachineModel
from twin.machine.model.tool_shape import tool_cylinders
from twin.machine.watching.clearance import Clearance
from twin.recording.alarms import Alarm, NearMiss
from twin.recording.reader import Samples
from twin.toolpath.tool_plan import ToolPlan

REMEDY = (
    "go up before M6, or write [tool_change] height = 0 into the job where M6 goes there by itself"
)
"""Hint for a tool that is changed where there is no room for it."""


class ToolClearances:
    """Watches a run with tool changes; each tool's clearance is built when it first comes."""

    def __init__(self, model: MachineModel, tools: ToolPlan) -> None:
        """Begin before the program.

        Args:
            model: The machine with a tool in its spindle.
        """
        self._first = model
        self._tools = tools
        self._built: dict[object, Clearance] = {}
        self._current: Clearance | None = None
        self._changes = iter(tools.changes)
        self._next = next(self._changes, None)
        self._last: Samples | None = None

    @property
    def near_miss(self) -> NearMiss | None:
        """The closest approach of all tools, where it was below the machine file's limit."""
        misses = [clearance.near_miss for clearance in self._built.values()]
        return min(filter(None, misses), key=lambda miss: miss.clearance_mm, default=None)

    def look(self, samples: Samples) -> Alarm | None:
        """Return the alarm of the first sample of the chunk at which two things meet."""
        for run, tool in self._tools.runs(samples.setpoint.move):
            part = samples[run]
            alarm = self._look_at_changes(int(part.setpoint.move[0])) or self._with(tool).look(part)
            if alarm is not None:
                return alarm
            self._last = part[-1:]
        return None

    def finish(self) -> Alarm | None:
        """Return the alarm of a tool that comes behind the last move, where the axes are then."""
        return self._look_at_changes(None)

    def _look_at_changes(self, move: int | None) -> Alarm | None:
        """Hold the tools that come before a move against what is around them where the axes are.

        Args:
            move: Its number; None: the program has ended.
        """
        while self._next is not None and (move is None or self._next.move <= move):
            change, self._next = self._next, next(self._changes, None)
            if self._last is None:
                continue
            alarm = self._with(change.tool).look(self._last)
            if alarm is not None:
                message = f"a tool of {change.tool.length:g} mm comes into the spindle: {alarm.message}; {REMEDY}"
                return dataclasses.replace(alarm, line=change.line, message=message)
        return None

    def _with(self, tool: ToolTable) -> Clearance:
        """The clearance of a tool; a tool that was not in the spindle is looked at again."""
        clearance = self._of(tool)
        if clearance is not self._current:
            clearance.begin()
            self._current = clearance
        return clearance

    def _of(self, tool: ToolTable) -> Clearance:
        """Tools of one shape share their clearance, at whatever speed they turn."""
        shape = self._shape(tool)
        if shape not in self._built:
            first = shape == self._shape(self._first.tool)
            model = self._first if first else self._first.with_tool(tool)
            self._built[shape] = Clearance(model.machine, model.solids)
        return self._built[shape]

    def _shape(self, tool: ToolTable) -> object:
        """All of a tool that a collision depends on."""
        end = tool.kind, tool.diameter, tool.corner, tool.point_angle, tool.tip, tool.shank
        return (*tool_cylinders(tool, self._first.machine.file.spindle.flange_diameter), end)
