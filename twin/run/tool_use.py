"""How long each tool is in the spindle, and what it takes off."""

import dataclasses
from collections import defaultdict
from typing import Any

from twin.cutting.cut import CutResult
from twin.cutting.tools import ToolPlan
from twin.job.job_file import ToolTable
from twin.recording.form import Samples
from twin.run.observers import Observer


@dataclasses.dataclass(frozen=True, slots=True)
class ToolUse:
    """One tool of a run.

    Attributes:
        tool: What it is.
        time_s: How long it is in the spindle while the program runs [s].
        removed_mm3: What it takes off [mm³]; None without a stock.
    """

    tool: ToolTable
    time_s: float
    removed_mm3: float | None

    def as_json(self) -> dict[str, Any]:
        """A row of ``tools`` of ``result.json``."""
        return {
            "number": self.tool.number,
            "kind": self.tool.kind,
            "diameter_mm": self.tool.diameter,
            "length_mm": self.tool.length,
            "time_s": self.time_s,
            "removed_mm3": self.removed_mm3,
        }


class ToolTimes(Observer):
    """Counts the time of each tool along a run."""

    stage = "compare"

    def __init__(self, plan: ToolPlan, period_s: float) -> None:
        self._plan, self._period_s = plan, period_s
        self._seconds: defaultdict[int, float] = defaultdict(float)

    def add(self, samples: Samples) -> Samples:
        """Take in the next chunk; see ``Observer``."""
        for run, tool in self._plan.runs(samples.setpoint.move):
            self._seconds[tool.number] += (run.stop - run.start) * self._period_s
        return samples

    def result(self, cut: CutResult | None = None) -> tuple[ToolUse, ...]:
        """The tools in the order in which they come into the spindle."""
        tools = {tool.number: tool for tool in self._plan.tools}
        return tuple(
            ToolUse(
                tool,
                self._seconds[number],
                None if cut is None else cut.removed_by_tool_mm3.get(number, 0.0),
            )
            for number, tool in tools.items()
        )
