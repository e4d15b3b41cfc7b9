"""What the tool does to the stock and to the fixtures along a run, and the alarms of both."""

from pathlib import Path

import numpy as np

from twin.cutting.cut import CutResult, Cutter
from twin.cutting.events import CutEvent
from twin.cutting.fixtures import FixtureGuard
from twin.cutting.part import write_stl
from twin.cutting.program_summary import ProgramSummary
from twin.cutting.spindle import Spindle
from twin.job.job_file import StockTable, ToolTable
from twin.machine.alarms import Alarm
from twin.machine.config import Machine
from twin.machine.model import spindle_over_table_mm
from twin.nc.canonical import Chunk, FloatArray
from twin.recording.form import Samples
from twin.toolpath.part_frame import PartFrame


class Machining:
    """Cuts the stock of a run chunk by chunk and keeps the cutter off the fixtures."""

    def __init__(
        self,
        machine: Machine,
        stock: StockTable | None,
        summary: ProgramSummary,
        part_frame: PartFrame,
        part_zero: FloatArray,
        *,
        speaks_of_spindle: bool,
    ) -> None:
        """Lay the blank on the table.

        Args:
            machine: Its fixtures are those of the job.
            stock: The blank; None where nothing is cut.
            summary: What is in the spindle when, and which moves are rapids.
            part_frame: How the part turns under the tool.
            part_zero: Machine coordinates of program zero, shape (k,) [mm or deg].
            speaks_of_spindle: Whether the program starts, stops or sets the spindle anywhere.
        """
        self._summary = summary
        self._spindle = Spindle(held_to_program=speaks_of_spindle)
        self._cutter: Cutter | None = None
        if stock is not None:
            self._cutter = Cutter(stock, summary.tools, part_frame, part_zero, halts=True)
        self._guard: FixtureGuard | None = None
        # Without a rotary table the model has no part frame in which a fixture could stand.
        if machine.file.fixtures and machine.part_frame.rotary is not None:
            height = summary.tools.tools[0].length - spindle_over_table_mm(machine)
            self._guard = FixtureGuard(machine.file.fixtures, summary.tools, part_frame, height)

    def expect(self, chunk: Chunk) -> None:
        """Take note of a chunk of the program, before its samples come."""
        self._spindle.expect(chunk)

    def add(self, samples: Samples) -> tuple[Samples, Alarm | None]:
        """Cut along a chunk.

        Returns:
            The samples up to the first alarm, and that alarm.
        """
        touched = None
        found = None if self._guard is None else self._guard.look(samples)
        if found is not None:
            row, event, name = found
            samples, touched = samples[: row + 1], fixture_alarm(event, name)
        samples, alarm = self._cut(samples)
        return samples, alarm or touched

    def finish(self, out: Path | None) -> CutResult | None:
        """What the cut came to; the part is written as ``part.stl`` into a folder, if one is given.

        Returns:
            None without a stock.

        Raises:
            OSError: The part cannot be written.
        """
        if self._cutter is None:
            return None
        if out is not None:
            write_stl(self._cutter.map, out / "part.stl")
        return self._cutter.result()

    def _cut(self, samples: Samples) -> tuple[Samples, Alarm | None]:
        cutter = self._cutter
        if cutter is None:
            return samples, None
        rapid = self._summary.is_rapid(samples.setpoint.move)
        cutter.add(samples, rapid, self._spindle.standing(samples.setpoint))
        if cutter.halted is None:
            return samples, None
        alarm = stock_alarm(cutter.halted, cutter.tool)
        end = int(np.searchsorted(samples.setpoint.time, alarm.time_s, side="right"))
        return samples[:end], alarm


def stock_alarm(event: CutEvent, tool: ToolTable) -> Alarm:
    """The alarm of a rapid, or of a feed with the spindle off, that met the stock.

    Args:
        event: What the cutter noted.
        tool: What was in the spindle.
    """
    depth = f"{event.depth_mm:.2f} mm deep into the stock"
    if event.what == "rapid":
        message = f"a rapid drives tool {tool.number} {depth}"
        return Alarm("rapid-into-stock", event.line, event.time_s, "", message)
    message = f"tool {tool.number} feeds {depth} with the spindle off"
    return Alarm("spindle-off", event.line, event.time_s, "", message)


def fixture_alarm(event: CutEvent, name: str) -> Alarm:
    """The alarm of a cutter that met what holds the part.

    Args:
        event: Where and how deep.
        name: Of the fixture.
    """
    message = f"the cutter meets the {name} ({event.depth_mm:.2f} mm deep)"
    return Alarm("collision", event.line, event.time_s, "", message)
