"""What the tool does to the stock along a run, and the alarms of what must not meet it."""

import copy
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from twin.cutting.cut import Cutter
from twin.cutting.heights.height_map import HeightMap
from twin.cutting.measuring.inspection import Inspection
from twin.cutting.measuring.measured_part import measured
from twin.cutting.measuring.nominal import NominalGouge, NominalWatch
from twin.cutting.measuring.nominal_from_above import HeightMapNominalWatch
from twin.cutting.measuring.nominal_from_any_side import TriDexelNominalWatch
from twin.cutting.program_summary import ProgramSummary
from twin.cutting.tridexel.dexels import TriDexel
from twin.cutting.watching.cut_log import CutResult
from twin.cutting.watching.events import CutEvent
from twin.job.job_file import JobFile, ToolTable
from twin.machine.model.model import MachineModel
from twin.machine.simulation.tool_changes import REMEDY
from twin.nc.canonical import FloatArray
from twin.recording.alarms import Alarm
from twin.recording.form import Samples
from twin.run.dry_run.program_watch import Stop
from twin.run.observers import Observer
from twin.toolpath.part_frame import PartFrame


class Machining(Observer):
    """Cuts the stock of a run chunk by chunk; its alarm is that of what must not meet the stock.

    Attributes:
        stopped: The stops at which the tool was in the cut, in order.
        ended_in_cut: Whether the program ended with the tool in the cut.
    """

    stage = "cut"

    def __init__(
        self,
        model: MachineModel,
        job: JobFile,
        summary: ProgramSummary,
        part_frame: PartFrame,
        part_zero: FloatArray,
        stops: Sequence[Stop] = (),
    ) -> None:
        """Lay the blank on the table.

        Args:
            model: What is above the tool is its.
            job: Its blank, without which nothing is cut, and its nominal part, if it names one.
            summary: What is in the spindle when, and which moves are rapids.
            part_zero: Machine coordinates of program zero, shape (k,) [mm or deg].
            stops: Where the program stops spindle or tool, in order.

        Raises:
            ConfigError: The stock or the nominal part is wrong.
        """
        self.stopped: list[Stop] = []
        self.ended_in_cut = False
        self._stops = list(stops)
        self._due: list[tuple[Stop, float]] = []
        self._summary = summary
        self._zero = part_frame.program_zero(part_zero)
        self._cutter: Cutter | None = None
        self._nominal: NominalWatch[HeightMap] | NominalWatch[TriDexel] | None = None
        self._gouge_um = None if job.nominal is None else job.nominal.gouge_um
        self._gouge_stops = job.nominal is not None and job.nominal.gouge == "alarm"
        if job.stock is not None:
            head = model.head.above_tip
            self._cutter = Cutter(
                job.stock,
                summary.tools,
                part_frame,
                part_zero,
                halts=True,
                head=head,
                tilts=summary.tilts,
            )
            if job.nominal is not None:
                watch = TriDexelNominalWatch if summary.tilts else HeightMapNominalWatch
                self._nominal = watch(job.nominal, self._cutter, part_frame, part_zero)

    @property
    def gouge(self) -> NominalGouge | None:
        """The deepest cut into the nominal part beyond what it allows."""
        return None if self._nominal is None else self._nominal.worst

    @property
    def misfit(self) -> str | None:
        """Why the nominal part can hardly be what the blank is to become; None where it can, or there is none."""
        return None if self._nominal is None else self._nominal.misfit

    def inspect(self) -> Inspection | None:
        """How far the part is from the nominal one by now; None where the job names none."""
        if self._cutter is None or self._nominal is None or self._gouge_um is None:
            return None
        return measured(self._cutter.material, self._nominal.nominal, self._gouge_um).found

    def add(self, samples: Samples) -> Samples:
        """Cut along a chunk; see ``Observer``."""
        cutter = self._cutter
        if cutter is None:
            return samples
        uncut = copy.deepcopy(cutter) if self._gouge_stops else None
        self._cut(cutter, samples)
        found = None if self._nominal is None else self._nominal.look(samples)
        if found is not None and uncut is not None:
            return self._stop_at_gouge(uncut, samples, *found)
        self._look_at_stops(samples)
        self._note_alarm()
        if self.alarm is None:
            return samples
        end = int(np.searchsorted(samples.setpoint.time, self.alarm.time_s, side="right"))
        return samples[:end]

    def _cut(self, cutter: Cutter, samples: Samples) -> None:
        rapid = self._summary.is_rapid(samples.setpoint.move)
        standing = self._summary.standing(samples.setpoint)
        # The nominal part is looked at with the samples that cut.
        cutter.add(samples, rapid, standing, goes_on=self._nominal is None)

    def _stop_at_gouge(
        self, uncut: Cutter, samples: Samples, gouge: NominalGouge, sample: int
    ) -> Samples:
        """Cut up to where the tool goes too deep into the nominal part, and no farther.

        Args:
            uncut: The cutter before the chunk.
            gouge: What the whole chunk would have come to there.
            sample: When the tool went too deep.

        Returns:
            The samples until then.
        """
        assert self._nominal is not None
        samples = samples[: sample + 1]
        self._cutter = self._nominal.cutter = uncut
        self._cut(uncut, samples)
        self._look_at_stops(samples)
        found = self._nominal.look(samples)
        self._nominal.worst = gouge if found is None else found[0]
        self.alarm = gouge_alarm(self._nominal.worst, uncut.tool)
        return samples

    def _look_at_stops(self, samples: Samples) -> None:
        """See whether the tool is in the cut where the program stops it, within a chunk."""
        setpoint = samples.setpoint
        place = setpoint.move + np.clip(setpoint.fraction, 0.0, 1.0)
        while self._stops and len(place) and self._stops[0].place <= place[-1]:
            stop = self._stops.pop(0)
            row = max(int(np.searchsorted(place, stop.place)), 1) - 1
            self._due.append((stop, float(setpoint.time[row])))
        self._judge_stops()

    def _judge_stops(self, *, all_of_them: bool = False) -> None:
        """See whether the tool was in the cut at the stops up to which it has cut, or at all that are due."""
        cutter = self._cutter
        while cutter is not None and self._due and (all_of_them or self._due[0][1] <= cutter.until):
            stop, time = self._due.pop(0)
            if cutter.watch.engaged(time):
                self.stopped.append(stop)

    @property
    def cutter(self) -> Cutter | None:
        """What cuts the stock; None without one."""
        return self._cutter

    @property
    def laid(self) -> HeightMap | None:
        """The blank as far as it is cut; None without one, and where the part is cut from several sides."""
        return None if self._cutter is None or self._cutter.tilts else self._cutter.map

    def end_program(self) -> None:
        """Look at the tools that come behind the last move, which may be in the part then."""
        if self._cutter is not None:
            self._cutter.catch_up()
            self._due += [(stop, np.inf) for stop in self._stops]
            self._judge_stops(all_of_them=True)
            last = self.stopped[-1].place if self.stopped else -1.0
            at_end = last >= len(self._summary.rapid)
            self.ended_in_cut = not at_end and self._cutter.watch.engaged(np.inf)
            self._cutter.end_program()
            self._note_alarm()

    def _note_alarm(self) -> None:
        cutter = self._cutter
        if cutter is not None and cutter.halted is not None:
            self.alarm = stock_alarm(cutter.halted, cutter.tool, cutter.plan.before(cutter.tool))

    def picture(self) -> bytes:
        """The part from above by now, PNG; empty without a stock."""
        return b"" if self._cutter is None else self._cutter.material.picture()

    def write_part(self, folder: Path) -> None:
        """Write the part as ``part.stl``, if there is a stock.

        Raises:
            OSError: It cannot be written.
        """
        if self._cutter is not None:
            self._cutter.material.write_stl(folder / "part.stl", self._zero)

    def result(self) -> CutResult | None:
        """What the cut came to; None without a stock."""
        return None if self._cutter is None else self._cutter.result()


def gouge_alarm(gouge: NominalGouge, tool: ToolTable) -> Alarm:
    """The alarm of a tool that cuts into the nominal part."""
    message = f"tool {tool.number} cuts {gouge.depth_mm:.2f} mm deep into the nominal part"
    return Alarm("gouge", gouge.line, gouge.time_s, "", message)


def stock_alarm(event: CutEvent, tool: ToolTable, before: ToolTable | None = None) -> Alarm:
    """The alarm of what met the stock: a rapid, a feed with the spindle off, shank, holder, head."""
    depth = f"{event.depth_mm:.2f} mm deep"
    if event.what == "rapid":
        message = f"a rapid drives tool {tool.number} {depth} into the stock"
        return Alarm("rapid-into-stock", event.line, event.time_s, "", message)
    if event.what == "standing":
        message = f"tool {tool.number} feeds {depth} into the stock with the spindle off"
        return Alarm("spindle-off", event.line, event.time_s, "", message)
    if event.what == "arrival":
        message = f"tool {tool.number}, {tool.length:g} mm long, comes into the spindle {depth} in the part"
        if before is not None:
            message += f" where tool {before.number} of {before.length:g} mm was"
        message += f": {REMEDY}"
    elif event.what == "flute":
        message = f"the shank of tool {tool.number} meets the part above its flutes ({depth})"
    elif event.what in ("shank", "holder"):
        message = f"the {event.what} of tool {tool.number} meets the part ({depth})"
    else:
        message = f"the {event.what} meets the part ({depth})"
    return Alarm("collision", event.line, event.time_s, "", message)
