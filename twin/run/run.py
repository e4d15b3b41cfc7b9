"""A run: moves are planned, settled and simulated; what follows them cuts, compares, records; the whole is judged."""

import dataclasses
from contextlib import AbstractContextManager, nullcontext
from pathlib import Path

import mujoco

from twin.compare.comparison import Comparison
from twin.compare.trace import Trace
from twin.coupling.operations import speeds_are_known
from twin.machine.model.clamping import refuse_overlaps, what_carries
from twin.machine.model.model import MachineModel
from twin.nc.text.source import Source
from twin.recording.alarms import Alarm
from twin.recording.reader import LONGEST_TEXT, RecordingHeader, RecordingWriter, record
from twin.run.dry_run.dry_run import interpret_all
from twin.run.judging.outcome import Followers, Outcome, outcome_of, refuse_unjudged_loads
from twin.run.machining import Machining
from twin.run.observers import (
    Compared,
    Loads,
    Reached,
    ToolTimes,
    Traced,
    observed,
)
from twin.run.pipeline import (
    MachineMotion,
    PlannedMoves,
    ProgramMotion,
    cutting_forces,
    grown,
    planned,
)
from twin.run.preparing.layout import bore_of
from twin.run.preparing.preparation import Preparation
from twin.run.progress import Progress, StageClock
from twin.version import __version__


class Run:
    """A prepared job laid out on its machine, its program interpreted; ``execute`` runs it.

    Attributes:
        part_zero: Machine coordinates of program zero, shape (k,) [mm or deg].
        part_frame: How the part turns under the tool.
        model: The machine's, with the blank on its table and the job's first tool in the spindle.
        clock: How long each stage took; a film's goes on it too.
    """

    def __init__(self, preparation: Preparation) -> None:
        """Build the machine, and interpret the whole program, so that no error is found in the middle of the motion.

        Raises:
            ConfigError: The model is wrong, or the program brings a tool that the job does not list.
            ProgramError: The program is wrong.
        """
        machine, job = preparation.machine, preparation.job.file
        self.preparation = preparation
        self.machine = machine
        self.part_zero, self.part_frame, blank, _ = preparation.layout
        self.model = MachineModel(machine, job.tools[0], blank)
        refuse_overlaps(self.model, bore_of(job))
        self.clock = StageClock()
        self.dry_run = interpret_all(preparation, self.clock)

    def execute(
        self, out: Path | None, progress: Progress, motion: MachineMotion | None = None
    ) -> Outcome:
        """Run the chain and write ``recording.h5`` and ``part.stl`` into a folder.

        A program that would leave the travel moves nothing and writes nothing.

        Args:
            out: The folder; None writes neither, for who wants the verdict alone.
            progress: Called with how far the simulation is.
            motion: Moves the machine along the program; None: the twin's own planner and drives.

        Raises:
            ConfigError: A tolerance limits the force of the cut, and nothing simulates that.
            SimulationError: The simulation failed; the recording is not kept.
        """
        followers = self._followers()
        alarm = self.dry_run.alarm or self._overspeed()
        if alarm is not None:
            return self._outcome(followers, None, (alarm,), out)
        with self._recording(out) as writer:
            motion = self._motion(followers, motion)
            samples = grown(motion, self.machine, self.dry_run.summary)
            for _ in observed(samples, followers.in_order(writer), self.clock):
                progress("simulate", followers.reached.share_of(self.dry_run.moves))
            alarms = _alarms(motion, followers)
            if alarms and writer is not None:
                writer.note_alarms([(each.time_s, each.message) for each in alarms])
        return self._outcome(followers, motion, alarms, out)

    def header(self) -> RecordingHeader:
        """The attributes of the recording."""
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

    def _followers(self) -> Followers:
        job, machine, summary = self.preparation.job.file, self.machine, self.dry_run.summary
        apart = [part.lines for part in job.tolerance.blocks]
        trace = Trace(machine.axes, self.part_frame, self.part_zero)
        comparison = Comparison(
            machine.axes, self.part_frame, self.part_zero, apart, lower=summary.tools.lower
        )
        return Followers(
            machining=Machining(
                self.model,
                job,
                summary,
                self.part_frame,
                self.part_zero,
                self.dry_run.watch.stops,
            ),
            reached=Reached(self.part_zero, self.dry_run.program.start),
            loads=Loads(),
            compared=Compared(comparison),
            traced=Traced(trace, summary.tools),
            tools=ToolTimes(summary.tools, machine.file.servo_period_s),
        )

    def _motion(self, followers: Followers, given: MachineMotion | None) -> MachineMotion:
        """What moves the machine; those who judge it know of every move before it is simulated."""
        job, dry_run = self.preparation.job.file, self.dry_run
        program, summary = dry_run.program, dry_run.summary
        expect = followers.compared.comparison.expect
        if given is None:
            moves = PlannedMoves(expect)
            setpoints = planned(program, self.preparation, moves.note)
            laid = followers.machining.laid
            forces = cutting_forces(self.preparation, summary, laid)
            watched = self.clock.watch("plan", setpoints)
            motion = ProgramMotion(watched, self.model, summary, forces, moves)
        else:
            motion = given
            for chunk in program.chunks():
                expect(chunk.moves)
        if motion.process is None or not speeds_are_known(summary):
            refuse_unjudged_loads(job.tolerance)
        return motion

    def _outcome(
        self,
        followers: Followers,
        motion: MachineMotion | None,
        alarms: tuple[Alarm, ...],
        out: Path | None,
    ) -> Outcome:
        """Judge what was run; a part that was cut is written."""
        floats = None if alarms else what_carries(self.model)
        with self.clock.stage("cut"):
            outcome = outcome_of(self.preparation, self.dry_run, followers, motion, alarms, floats)
            if out is None or not outcome.samples:
                return outcome
            followers.machining.write_part(out)
            return dataclasses.replace(outcome, part=followers.machining.picture())

    def _overspeed(self) -> Alarm | None:
        """A tool that is turned faster than it bears, where no force is simulated that would show it."""
        job = self.preparation.job.file
        simulated = job.stock is not None and job.stock.material is not None
        return None if simulated and job.cutting_force == "teeth" else self.dry_run.watch.overspeed

    def _recording(self, out: Path | None) -> AbstractContextManager[RecordingWriter | None]:
        return nullcontext() if out is None else record(out / "recording.h5", self.header())


def _alarms(motion: MachineMotion, followers: Followers) -> tuple[Alarm, ...]:
    """Tools that broke, which stops no machine, and what stopped it, if anything did."""
    machining, until_s = followers.machining, followers.reached.time_s
    if machining.alarm is None and motion.alarm is None:
        machining.end_program()
    stopped = machining.alarm or motion.alarm
    broken = () if motion.process is None else motion.process.breaks
    return (
        *(each.alarm for each in broken if each.time_s <= until_s),
        *(() if stopped is None else (stopped,)),
    )


def _text_to_keep(source: Source) -> str:
    return source.text if source.lines.size <= LONGEST_TEXT else ""
