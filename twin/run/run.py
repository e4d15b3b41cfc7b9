"""The order of the rooms: text, moves, setpoints, samples, figures, in chunks."""

import dataclasses
from collections.abc import Iterator
from contextlib import AbstractContextManager, nullcontext
from pathlib import Path

import mujoco
import numpy as np

from twin.compare.comparison import Comparison
from twin.compare.trace import Trace
from twin.compare.verdict import judge
from twin.cutting.axis_load import AxisLoad
from twin.cutting.cut import CutResult, Cutter
from twin.cutting.part import write_stl
from twin.cutting.program_summary import ProgramSummary, SummaryBuilder
from twin.cutting.spindle import Spindle, speaks_of_spindle
from twin.errors import ConfigError
from twin.machine.alarms import Alarm
from twin.machine.head_shape import HeadShape
from twin.machine.model import build_spec, clearance_model, spindle_over_table_mm
from twin.machine.motion_limits import motion_limits
from twin.machine.simulate import Simulation, simulate
from twin.machine.travel import soft_limit_alarm
from twin.motion.planner import plan
from twin.motion.setpoints.setpoints import Setpoints
from twin.motion.setpoints.settle import settle
from twin.nc.canonical import Chunk, FloatArray
from twin.nc.text.diagnostics import Diagnostic
from twin.nc.text.source import Source
from twin.recording.reader import LONGEST_TEXT, RecordingHeader, RecordingWriter, Samples, record
from twin.run.outcome import Outcome
from twin.run.placement import part_zero
from twin.run.preparation import Preparation
from twin.run.progress import Progress
from twin.run.stages import StageClock
from twin.run.stock_alarm import stock_alarm
from twin.toolpath.part_frame import PartFrame
from twin.version import __version__


@dataclasses.dataclass(frozen=True, kw_only=True)
class DryRun:
    """What a first pass over the program found, before anything moves.

    Attributes:
        moves: How many moves the program makes.
        warnings: What the interpreter had to say.
        alarm: The soft-limit alarm of the first move that leaves the travel, if any.
        speaks_of_spindle: Whether the program starts, stops or sets the spindle anywhere.
        summary: What the program says beside its moves.
    """

    moves: int
    warnings: tuple[Diagnostic, ...]
    alarm: Alarm | None
    speaks_of_spindle: bool
    summary: ProgramSummary


class Run:
    """One run of a prepared job.

    Attributes:
        preparation: The job made concrete.
        part_zero: Machine coordinates of program zero, shape (k,) [mm or deg].
        part_frame: How the part turns under the tool.
        spec: The model of the machine with the job's first tool in the spindle.
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
        self.spec: mujoco.MjSpec = build_spec(machine, job.tools[0])
        self.part_zero = part_zero(job, machine, spindle_over_table_mm(machine))
        rotary = machine.part_frame.rotary
        turn_zero = 0.0 if rotary is None else float(self.part_zero[rotary])
        self.part_frame: PartFrame = dataclasses.replace(machine.part_frame, turn_zero=turn_zero)
        self.clock = StageClock()
        self.trace = Trace(machine.axes, self.part_frame, self.part_zero)
        self._planned_s = 0.0
        self._spindle = Spindle(held_to_program=False)

    def execute(self, dry_run: DryRun, out: Path | None, progress: Progress) -> Outcome:
        """Run the chain and write ``recording.h5`` and ``part.stl`` into a folder.

        A program that would leave the travel moves nothing and writes nothing.

        Args:
            dry_run: What the first pass found.
            out: The folder; None writes neither, for who wants the verdict alone.
            progress: Told how far the simulation is.

        Raises:
            SimulationError: The simulation failed; the recording is not kept.
        """
        preparation = self.preparation
        tolerance = preparation.job.file.tolerance
        comparison = Comparison(
            preparation.machine.axes,
            self.part_frame,
            self.part_zero,
            apart=[part.lines for part in tolerance.blocks],
        )
        cutter = self._cutter(dry_run.summary)
        track = _Track(self.part_zero, preparation.start)
        self._spindle = Spindle(held_to_program=dry_run.speaks_of_spindle)
        alarm, near_miss = dry_run.alarm, None
        if alarm is None:
            with self._recording(out) as writer:
                simulation = self._simulation(comparison, dry_run.summary)
                for simulated in self.clock.watch("simulate", simulation):
                    with self.clock.stage("cut"):
                        samples, alarm = self._cut(cutter, simulated, dry_run.summary)
                    track.add(samples)
                    with self.clock.stage("compare"):
                        contour_um = comparison.add(samples)
                        self.trace.add(samples, contour_um)
                    if writer is not None:
                        with self.clock.stage("record"):
                            writer.append(samples, contour_um)
                    progress("simulate", track.progress(dry_run.moves))
                    if alarm is not None:
                        break
                alarm, near_miss = alarm or simulation.alarm, simulation.near_miss
                if alarm is not None and writer is not None:
                    writer.note_alarms([(alarm.time_s, alarm.message)])
        cut = self._finish_part(cutter, out) if cutter is not None and len(track) else None
        figures = comparison.result()
        alarms = () if alarm is None else (alarm,)
        duration_s = min(self._planned_s, track.time_s)
        return Outcome(
            verdict=judge(figures, tolerance, alarms, cycle_time_s=duration_s),
            figures=figures,
            cut=cut,
            alarms=alarms,
            near_miss=near_miss,
            warnings=dry_run.warnings,
            samples=len(track),
            duration_s=duration_s,
            final_commanded=track.commanded,
            final_simulated=track.simulated,
        )

    def dry_run(self) -> DryRun:
        """Interpret the whole program once, so that no error is met with the machine half-way.

        Raises:
            ProgramError: The program is wrong.
        """
        interpretation = self.preparation.interpretation()
        moves, alarm, speaks = 0, None, False
        builder = SummaryBuilder(self.preparation.job.file)
        for chunk in self.clock.watch("interpret", interpretation.chunks()):
            moves += len(chunk.moves)
            builder.add(chunk)
            speaks = speaks or speaks_of_spindle(chunk)
            if alarm is None:
                alarm = soft_limit_alarm(self.preparation.machine, chunk.moves, self.part_zero)
        return DryRun(
            moves=moves,
            warnings=tuple(interpretation.diagnostics),
            alarm=alarm,
            speaks_of_spindle=speaks,
            summary=builder.summary(),
        )

    def _cut(
        self, cutter: Cutter | None, samples: Samples, summary: ProgramSummary
    ) -> tuple[Samples, Alarm | None]:
        """Cut along a chunk; what is left of it where the stock raised an alarm, and the alarm."""
        if cutter is None:
            return samples, None
        rapid = summary.is_rapid(samples.setpoint.move)
        cutter.add(samples, rapid, self._spindle.standing(samples.setpoint))
        if cutter.halted is None:
            return samples, None
        alarm = stock_alarm(cutter.halted, cutter.tool)
        end = int(np.searchsorted(samples.setpoint.time, alarm.time_s, side="right"))
        return samples[:end], alarm

    def _load(self, summary: ProgramSummary) -> AxisLoad | None:
        job = self.preparation.job.file
        if not job.cutting_load:
            return None
        if job.stock is None:
            raise ConfigError("cutting_load needs a [stock] to cut")
        return AxisLoad(job.stock, summary, self.part_frame, self.part_zero)

    def _simulation(self, comparison: Comparison, summary: ProgramSummary) -> Simulation:
        machine = self.preparation.machine
        period = machine.file.servo_period_s
        setpoints = plan(
            self.clock.watch("interpret", self._chunks(comparison)),
            motion_limits(machine),
            period_s=period,
            part_zero=self.part_zero,
            start=self.preparation.start + self.part_zero,
        )
        settled = self.clock.watch("plan", settle(self._planned(setpoints), period))
        load = self._load(summary)
        return simulate(machine, self.spec, settled, summary.tools, load)

    def _planned(self, setpoints: Iterator[Setpoints]) -> Iterator[Setpoints]:
        for chunk in setpoints:
            self._planned_s = float(chunk.time[-1])
            yield chunk

    def _chunks(self, comparison: Comparison) -> Iterator[Chunk]:
        """The program's moves on their way to the planner; those who judge hear of them too."""
        for chunk in self.preparation.interpretation().chunks():
            comparison.expect(chunk.moves)
            self._spindle.expect(chunk)
            yield chunk

    def _cutter(self, summary: ProgramSummary) -> Cutter | None:
        job = self.preparation.job.file
        if job.stock is None:
            return None
        machine = self.preparation.machine
        head = HeadShape(machine, clearance_model(machine, self.spec))
        return Cutter(
            job.stock,
            summary.tools,
            self.part_frame,
            self.part_zero,
            halts=True,
            head=head.above_tip,
        )

    def _recording(self, out: Path | None) -> AbstractContextManager[RecordingWriter | None]:
        return nullcontext() if out is None else record(out / "recording.h5", self.header())

    def _finish_part(self, cutter: Cutter, out: Path | None) -> CutResult:
        with self.clock.stage("cut"):
            if out is not None:
                write_stl(cutter.map, out / "part.stl")
            return cutter.result()

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


def _text_to_keep(source: Source) -> str:
    return source.text if source.lines.size <= LONGEST_TEXT else ""


class _Track:
    """How far the run has come and where the axes stand, in program coordinates."""

    def __init__(self, part_zero: FloatArray, start: FloatArray) -> None:
        self._part_zero = part_zero
        self._count = 0
        self._place = (-1, 0.0)
        self.time_s = 0.0
        self.commanded = start
        self.simulated = start

    def __len__(self) -> int:
        return self._count

    def add(self, samples: Samples) -> None:
        """Take note of a chunk."""
        setpoint = samples.setpoint
        self._count += len(samples)
        self.time_s = float(setpoint.time[-1])
        self._place = (int(setpoint.move[-1]), float(setpoint.fraction[-1]))
        self.commanded = setpoint.position[-1] - self._part_zero
        self.simulated = samples.joint_position[-1] - self._part_zero

    def progress(self, moves: int) -> float:
        """Share of the program that is done, 0 to 1."""
        move, fraction = self._place
        return (move + fraction) / moves if moves else 1.0
