"""What follows a run, chunk by chunk: cut, loads, comparison, trace, times of tools, recording."""

import abc
import dataclasses
from collections import defaultdict
from collections.abc import Iterable, Iterator, Sequence
from typing import Any, ClassVar

import numpy as np

from twin.compare.comparison import Comparison
from twin.compare.figures import Figures
from twin.compare.trace import Trace
from twin.cutting.forces.load_log import LoadLog
from twin.cutting.watching.cut_log import CutResult
from twin.job.job_file import ToolTable
from twin.nc.canonical import FloatArray
from twin.recording.alarms import Alarm
from twin.recording.reader import RecordingWriter, Samples
from twin.run.progress import StageClock
from twin.toolpath.tool_plan import ToolPlan


class Observer(abc.ABC):
    """Follows a run.

    Attributes:
        stage: The stage that its time counts for.
        alarm: What it stops the machine for, None while it does not.
    """

    stage: ClassVar[str]
    alarm: Alarm | None = None

    @abc.abstractmethod
    def add(self, samples: Samples) -> Samples:
        """Take in a chunk that follows the last one.

        Returns:
            What those that come behind it see: the chunk, up to its alarm, with what it has found.
        """

    @abc.abstractmethod
    def result(self) -> object:
        """The result so far."""


def observed(
    motion: Iterable[Samples], observers: Sequence[Observer], clock: StageClock
) -> Iterator[Samples]:
    """Pass the samples of a motion to observers until one of them stops it.

    Args:
        observers: In the order in which they see each chunk.
        clock: Counts the time of motion and observers.
    """
    for samples in clock.watch("simulate", motion):
        for observer in observers:
            with clock.stage(observer.stage):
                samples = observer.add(samples)
        yield samples
        if any(observer.alarm is not None for observer in observers):
            return


class Reached(Observer):
    """How far the run has come and where the axes are, in program coordinates.

    Attributes:
        time_s: The last one's [s].
        last_motion_s: When an axis was last to move [s].
        commanded: Where the axes should be, shape (k,) [mm or deg].
        simulated: Where they are, shape (k,) [mm or deg].
    """

    stage = "compare"

    def __init__(self, part_zero: FloatArray, start: FloatArray) -> None:
        """Begin where the program does.

        Args:
            part_zero: Machine coordinates of program zero, shape (k,) [mm or deg].
            start: Program coordinates, shape (k,) [mm or deg].
        """
        self._part_zero = part_zero
        self._place = (-1, 0.0)
        self.samples = 0
        self.time_s = 0.0
        self.last_motion_s = 0.0
        self.commanded = start
        self.simulated = start

    def add(self, samples: Samples) -> Samples:
        """Take note of a chunk; see ``Observer``."""
        setpoint = samples.setpoint
        self.samples += len(samples)
        self.time_s = float(setpoint.time[-1])
        moving = np.flatnonzero(setpoint.velocity.any(axis=1))
        if len(moving):
            self.last_motion_s = float(setpoint.time[moving[-1]])
        self._place = (int(setpoint.move[-1]), float(setpoint.fraction[-1]))
        self.commanded = setpoint.position[-1] - self._part_zero
        self.simulated = samples.joint_position[-1] - self._part_zero
        return samples

    def result(self) -> "Reached":
        """Itself."""
        return self

    def share_of(self, moves: int) -> float:
        """Share of the program that is done, 0 to 1."""
        move, fraction = self._place
        return (move + fraction) / moves if moves else 1.0


class Loads(Observer):
    """The greatest of what the tools bore."""

    stage = "cut"

    def __init__(self) -> None:
        self._log = LoadLog()

    def add(self, samples: Samples) -> Samples:
        """Take note of a chunk; see ``Observer``."""
        self._log.add(samples)
        return samples

    def result(self) -> LoadLog:
        """The greatest values."""
        return self._log


class Compared(Observer):
    """Following and contour error.

    Attributes:
        comparison: Knows the moves of the program before their samples come.
    """

    stage = "compare"

    def __init__(self, comparison: Comparison) -> None:
        self.comparison = comparison

    def add(self, samples: Samples) -> Samples:
        """Compare a chunk; those behind see its contour error."""
        return dataclasses.replace(samples, contour_um=self.comparison.add(samples))

    def result(self) -> Figures:
        """The figures."""
        return self.comparison.result()


class Traced(Observer):
    """The run thinned for plots."""

    stage = "compare"

    def __init__(self, trace: Trace, tools: ToolPlan) -> None:
        self._trace, self._tools = trace, tools

    def add(self, samples: Samples) -> Samples:
        """Thin a chunk whose contour error is known."""
        assert samples.contour_um is not None
        self._trace.add(samples, samples.contour_um, self._tools.lower(samples.setpoint.move))
        return samples

    def result(self) -> Trace:
        """The points that are left."""
        return self._trace


class Recorded(Observer):
    """The recording."""

    stage = "record"

    def __init__(self, writer: RecordingWriter) -> None:
        self._writer = writer

    def add(self, samples: Samples) -> Samples:
        """Write a chunk."""
        self._writer.append(samples, samples.contour_um)
        return samples

    def result(self) -> None:
        """Nothing: what was written is in the file."""


@dataclasses.dataclass(frozen=True, slots=True)
class ToolUse:
    """One tool of a run.

    Attributes:
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
