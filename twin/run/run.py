"""The order of the rooms: text, moves, setpoints, samples, cut, figures, in chunks."""

import dataclasses
from collections.abc import Iterator
from contextlib import AbstractContextManager, nullcontext
from pathlib import Path
from typing import Protocol

import mujoco
import numpy as np

from twin.compare.comparison import Comparison
from twin.compare.figures import Figures
from twin.compare.trace import Trace
from twin.compare.verdict import Check, Reason, Verdict, judge
from twin.coupling.cutting_process import CuttingProcess
from twin.coupling.operations import ProgramOperation, program_process, speeds_are_known
from twin.cutting.axis_load import AxisLoad
from twin.cutting.cut import CutResult
from twin.cutting.forces.load_log import LoadLog
from twin.cutting.inspection import Inspection
from twin.cutting.nominal import NominalGouge
from twin.cutting.program_summary import ProgramSummary
from twin.errors import ConfigError
from twin.job.job_file import ToleranceTable
from twin.machine.description.motion_limits import motion_limits
from twin.machine.model.clamping import refuse_overlaps, what_carries
from twin.machine.model.model import MachineModel
from twin.machine.simulation.growth import Growth
from twin.machine.simulation.simulate import Simulation, simulate
from twin.machine.watching.alarms import Alarm, NearMiss
from twin.motion.planner import plan
from twin.motion.setpoints.setpoints import Setpoints
from twin.motion.setpoints.settle import settle
from twin.nc.canonical import Chunk, FloatArray
from twin.nc.text.source import Source
from twin.recording.reader import LONGEST_TEXT, RecordingHeader, RecordingWriter, Samples, record
from twin.run.cut_notices import (
    cut_notices,
    tolerance_notices,
    tooth_feed_notices,
    unjudged_limit_notices,
)
from twin.run.dry_run import DryRun, InterpretedProgram, interpret_all
from twin.run.layout import bore_of, lay_out
from twin.run.machining import Machining
from twin.run.notices import Notice, shown
from twin.run.outcome import Outcome
from twin.run.preparation import Preparation
from twin.run.progress import Progress
from twin.run.scope import nothing_judged, scope_of
from twin.run.stages import StageClock
from twin.run.tool_use import ToolTimes
from twin.units import UM_PER_MM
from twin.version import __version__


class Motion(Protocol):
    """What moves the machine along a program; iterated once, for the samples of its joints."""

    @property
    def alarm(self) -> Alarm | None:
        """What stopped it, None while nothing did."""
        ...

    @property
    def near_miss(self) -> NearMiss | None:
        """The closest that the tool's side and the part's came without touching."""
        ...

    def __iter__(self) -> Iterator[Samples]: ...


class Run:
    """One run of a prepared job.

    Attributes:
        preparation: The job made concrete.
        machine: Its machine.
        part_zero: Machine coordinates of program zero, shape (k,) [mm or deg].
        part_frame: How the part turns under the tool.
        model: The machine's, with the blank on its table and the job's first tool in the spindle.
        clock: How long each stage took; a film's goes on it too.
        trace: The run thinned for plots.
    """

    def __init__(self, preparation: Preparation) -> None:
        """Lay the job out on its machine.

        Args:
            preparation: The job made concrete.

        Raises:
            ConfigError: The model is wrong, or the stock does not fit on the table.
        """
        machine, job = preparation.machine, preparation.job.file
        self.preparation = preparation
        self.part_zero, self.part_frame, blank = lay_out(job, machine)
        self.machine = machine
        self.model = MachineModel(machine, job.tools[0], blank)
        refuse_overlaps(self.model, bore_of(job))
        self.clock = StageClock()
        self.trace = Trace(machine.axes, self.part_frame, self.part_zero)
        self._planned_s = 0.0
        self._process: CuttingProcess | None = None

    def dry_run(self) -> DryRun:
        """Interpret the whole program once.

        Raises:
            ProgramError: The program is wrong.
            ConfigError: It brings a tool that the job does not list.
        """
        return interpret_all(self.preparation, self.part_zero, self.clock)

    def execute(
        self, dry_run: DryRun, out: Path | None, progress: Progress, motion: Motion | None = None
    ) -> Outcome:
        """Run the chain and write ``recording.h5`` and ``part.stl`` into a folder.

        A program that would leave the travel moves nothing and writes nothing.

        Args:
            dry_run: What the dry run found.
            out: The folder; None writes neither, for who wants the verdict alone.
            progress: Told how far the simulation is.
            motion: Moves the machine along the program; None: the twin's own planner and drives.

        Raises:
            ConfigError: A tolerance limits the force of the cut, and nothing simulates that.
            SimulationError: The simulation failed; the recording is not kept.
        """
        comparison, machining = self._comparison(), self._machining(dry_run)
        self._process = None
        reached = _Reached(self.part_zero, dry_run.program.start)
        alarm, near_miss = dry_run.alarm or self._overspeed(dry_run), None
        times = ToolTimes(dry_run.summary.tools, self.machine.file.servo_period_s)
        if alarm is None:
            with self._recording(out) as writer:
                if motion is None:
                    setpoints = self._setpoints(dry_run.program, comparison)
                    motion = self._simulation(setpoints, dry_run.summary)
                else:
                    _expect_all(dry_run.program, comparison)
                if self._process is None or not speeds_are_known(dry_run.summary):
                    _refuse_unjudged_loads(self.preparation.job.file.tolerance)
                growth = Growth(self.machine, ProgramOperation(dry_run.summary).speed)
                for simulated in self.clock.watch("simulate", motion):
                    with self.clock.stage("cut"):
                        samples, alarm = machining.add(growth.warm(simulated))
                    reached.add(samples)
                    machining.loads.add(samples)
                    with self.clock.stage("compare"):
                        contour_um = comparison.add(samples)
                        lower = dry_run.summary.tools.lower(samples.setpoint.move)
                        self.trace.add(samples, contour_um, lower)
                        times.add(samples)
                    if writer is not None:
                        with self.clock.stage("record"):
                            writer.append(samples, contour_um)
                    progress("simulate", reached.share_of(dry_run.moves))
                    if alarm is not None:
                        break
                alarm, near_miss = (
                    alarm or motion.alarm or machining.end_program(),
                    motion.near_miss,
                )
                alarms = (*self._breaks(reached.time_s), *(() if alarm is None else (alarm,)))
                if alarms and writer is not None:
                    writer.note_alarms([(each.time_s, each.message) for each in alarms])
        with self.clock.stage("cut"):
            cut = machining.finish(out) if len(reached) else None
            inspection = machining.inspect() if len(reached) else None
        alarms = (*self._breaks(reached.time_s), *(() if alarm is None else (alarm,)))
        outcome = self._outcome(dry_run, machining, reached, cut, inspection, alarms, comparison)
        return dataclasses.replace(
            outcome,
            near_miss=near_miss,
            tools=times.result(cut),
            part=machining.picture() if out is not None and len(reached) else b"",
        )

    def _outcome(
        self,
        dry_run: DryRun,
        machining: Machining,
        reached: "_Reached",
        cut: CutResult | None,
        inspection: Inspection | None,
        alarms: tuple[Alarm, ...],
        comparison: Comparison,
    ) -> Outcome:
        """Judge what was run, and say what was looked at."""
        figures = _as_shown(comparison.result(), dry_run.summary)
        job, duration_s = (
            self.preparation.job,
            min(self._planned_s or reached.last_motion_s, reached.time_s),
        )
        more = [
            *self._nominal_checks(machining.gouge, inspection),
            *_load_checks(job.file.tolerance, machining.loads),
        ]
        judged = judge(figures, job.file.tolerance, alarms, cycle_time_s=duration_s, more=more)
        blind = () if alarms else tuple(self._unjudged(judged, dry_run, figures))
        notices = [] if alarms else list(self._notices(dry_run, machining, cut))
        strict = self.preparation.settings.strict
        failing = [
            Reason(each.code, each.message, each.line, 0.0) for each in (notices if strict else ())
        ]
        scope = scope_of(
            job,
            dry_run,
            judged.checks,
            cut,
            forces=self._process is not None,
            unjudged=blind,
            alarms=alarms,
        )
        source = self.preparation.source
        return Outcome(
            verdict=judged.with_more([*failing, *blind]),
            figures=figures,
            cut=cut,
            gouge=machining.gouge,
            inspection=inspection,
            loads=machining.loads,
            alarms=alarms,
            near_miss=None,
            warnings=(*dry_run.warnings, *shown(notices, source, strict=False)),
            scope=scope,
            samples=len(reached),
            duration_s=duration_s,
            final_commanded=reached.commanded,
            final_simulated=reached.simulated,
        )

    def _unjudged(self, judged: Verdict, dry_run: DryRun, figures: Figures) -> Iterator[Reason]:
        """What was asked for and judged nothing."""
        job = self.preparation.job
        if not dry_run.moves:
            yield Reason("nothing-moves", "the program makes no move", 0, 0.0)
        else:
            yield from nothing_judged(
                job.file.tolerance, judged.checks, job.tolerances_from, figures
            )

    def _notices(
        self, dry_run: DryRun, machining: Machining, cut: CutResult | None
    ) -> Iterator[Notice]:
        """What there is to tell of a run that came to its end."""
        job, watch = self.preparation.job.file, dry_run.watch
        if cut is not None:
            yield from cut_notices(job, watch, machining, cut)
        elif watch.spindle_line and watch.first_feed:
            message = "the spindle turns, and the job has no [stock]: nothing that is cut is judged"
            yield Notice("no-stock", watch.spindle_line, message)
        floats = what_carries(self.model)
        if floats is not None:
            yield Notice("stock-floats", 0, f"nothing carries the stock: {floats}")
        yield from tolerance_notices(job.tolerance, len(self.preparation.source.lines))
        if self._process is None:
            yield from tooth_feed_notices(watch, cut)
            yield from unjudged_limit_notices(job, watch)

    def _overspeed(self, dry_run: DryRun) -> Alarm | None:
        """A tool that is turned faster than it bears, where no force is simulated that would show it."""
        job = self.preparation.job.file
        simulated = job.stock is not None and job.stock.material is not None
        return None if simulated and job.cutting_force == "teeth" else dry_run.watch.overspeed

    def _breaks(self, until_s: float) -> tuple[Alarm, ...]:
        """Tools that broke, which stops no machine, up to a time [s]."""
        found = () if self._process is None else self._process.breaks
        return tuple(each.alarm for each in found if each.time_s <= until_s)

    def _nominal_checks(
        self, gouge: NominalGouge | None, inspection: Inspection | None
    ) -> Iterator[Check]:
        nominal = self.preparation.job.file.nominal
        if nominal is None:
            return
        if nominal.gouge == "fail":
            depth, line, when = (0.0, 0, 0.0)
            if gouge is not None:
                depth, line, when = gouge.depth_mm * UM_PER_MM, gouge.line, gouge.time_s
            figure = "gouge into the nominal part"
            yield Check("gouge_um", figure, depth, nominal.gouge_um, "µm", line, when)
        if nominal.standing_um is not None and inspection is not None:
            figure = "material left on the nominal part"
            left = inspection.most_standing_mm * UM_PER_MM
            bound = f" (walls are known to {inspection.bound_mm * UM_PER_MM:.0f} µm)"
            yield Check("standing_um", figure, left, nominal.standing_um, "µm", 0, 0.0, bound)

    def _setpoints(
        self, program: InterpretedProgram, comparison: Comparison
    ) -> Iterator[Setpoints]:
        """The planned motion; those who judge it hear of every move before it is simulated."""
        machine = self.preparation.machine
        period = machine.file.servo_period_s

        def moves() -> Iterator[Chunk]:
            for chunk in program.timed_chunks():
                comparison.expect(chunk.moves)
                yield chunk

        def planned() -> Iterator[Setpoints]:
            for chunk in plan(
                moves(),
                motion_limits(machine),
                period_s=period,
                part_zero=self.part_zero,
                start=program.start + self.part_zero,
            ):
                self._planned_s = float(chunk.time[-1])
                yield chunk

        return self.clock.watch("plan", settle(planned(), period))

    def _simulation(self, setpoints: Iterator[Setpoints], summary: ProgramSummary) -> Simulation:
        machine, job = self.machine, self.preparation.job.file
        load = None
        self._process = program_process(job, machine, summary, self.part_frame, self.part_zero)
        if job.cutting_load and self._process is None:
            if job.stock is None:
                raise ConfigError("cutting_load needs a [stock] to cut")
            load = AxisLoad(job.stock, summary, self.part_frame, self.part_zero)
        return simulate(machine, self.model, setpoints, summary.tools, load, self._process)

    def _comparison(self) -> Comparison:
        return Comparison(
            self.preparation.machine.axes,
            self.part_frame,
            self.part_zero,
            apart=[part.lines for part in self.preparation.job.file.tolerance.blocks],
        )

    def _machining(self, dry_run: DryRun) -> Machining:
        return Machining(
            self.model,
            self.preparation.job.file,
            dry_run.summary,
            self.part_frame,
            self.part_zero,
            dry_run.watch.stops,
        )

    def _recording(self, out: Path | None) -> AbstractContextManager[RecordingWriter | None]:
        return nullcontext() if out is None else record(out / "recording.h5", self.header())

    def header(self) -> RecordingHeader:
        """What the recording says about itself."""
        preparation = self.preparation
        return RecordingHeader(
            axes=preparation.machine.axes,
            period_s=preparation.machine.file.servo_period_s,
            part_zero=self.part_zero,
            part_frame=self.part_frame,
            program=preparation.source.name,
            program_text=_text_to_keep(preparation.source),
            program_sha256=preparation.source.sha256,
            dialect=preparation.dialect.name,
            machine=preparation.machine.file.name,
            twin_version=__version__,
            mujoco_version=mujoco.__version__,
            job=preparation.job.file.model_dump_json(exclude_unset=True),
            machine_file=str(preparation.machine.path.resolve()),
        )


_LOADS = {
    "force_n": ("cutting force", "N"),
    "power_w": ("power of the cut", "W"),
    "deflection_um": ("deflection of the tool", "µm"),
    "chip_mm": ("chip thickness", "mm"),
}
"""What a tolerance on a load is called, and its unit."""


def _as_shown(figures: Figures, summary: ProgramSummary) -> Figures:
    """Figures whose positions are those of the control's screen."""
    screen = summary.shown
    if screen is None:
        return figures
    worst = tuple(
        dataclasses.replace(place, position=place.position + screen.at(place.move))
        for place in figures.worst
    )
    return dataclasses.replace(figures, worst=worst)


def _refuse_unjudged_loads(tolerance: ToleranceTable) -> None:
    """A tolerance on what nobody simulates would pass unseen.

    Raises:
        ConfigError: There is one.
    """
    for key, (figure, _) in _LOADS.items():
        if getattr(tolerance, key) is not None:
            raise ConfigError(
                f"tolerance.{key}: the {figure} is not simulated in this job, or not everywhere; it needs a "
                '[stock] with a material, a spindle speed wherever it is cut, and cutting_force = "teeth"'
            )


def _load_checks(tolerance: ToleranceTable, loads: LoadLog) -> Iterator[Check]:
    for key, (figure, unit) in _LOADS.items():
        limit, most = getattr(tolerance, key), loads.greatest.get(key)
        if limit is not None and most is not None:
            yield Check(key, figure, most.value, limit, unit, most.line, most.time_s)


def _expect_all(program: InterpretedProgram, comparison: Comparison) -> None:
    """Let those who judge the motion hear of the whole program at once."""
    for chunk in program.chunks():
        comparison.expect(chunk.moves)


def _text_to_keep(source: Source) -> str:
    return source.text if source.lines.size <= LONGEST_TEXT else ""


class _Reached:
    """How far the run has come and where the axes stand, in program coordinates."""

    def __init__(self, part_zero: FloatArray, start: FloatArray) -> None:
        self._part_zero = part_zero
        self._count = 0
        self._place = (-1, 0.0)
        self.time_s = 0.0
        self.last_motion_s = 0.0
        self.commanded = start
        self.simulated = start

    def __len__(self) -> int:
        return self._count

    def add(self, samples: Samples) -> None:
        """Take note of a chunk."""
        setpoint = samples.setpoint
        self._count += len(samples)
        self.time_s = float(setpoint.time[-1])
        moving = np.flatnonzero(setpoint.velocity.any(axis=1))
        if len(moving):
            self.last_motion_s = float(setpoint.time[moving[-1]])
        self._place = (int(setpoint.move[-1]), float(setpoint.fraction[-1]))
        self.commanded = setpoint.position[-1] - self._part_zero
        self.simulated = samples.joint_position[-1] - self._part_zero

    def share_of(self, moves: int) -> float:
        """Share of the program that is done, 0 to 1."""
        move, fraction = self._place
        return (move + fraction) / moves if moves else 1.0
