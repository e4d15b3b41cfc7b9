"""From moves to samples: plan, settle, simulate, grow, each a generator that feeds the next."""

import abc
from collections.abc import Callable, Iterable, Iterator
from typing import NamedTuple

from twin.coupling.cutting_process import CuttingProcess
from twin.coupling.operations import ProgramOperation, program_process
from twin.cutting.axis_load import AxisLoad
from twin.cutting.heights.height_map import HeightMap
from twin.cutting.program_summary import ProgramSummary
from twin.errors import ConfigError
from twin.machine.description.config import MachineConfig
from twin.machine.model.model import MachineModel
from twin.machine.simulation.growth import Growth
from twin.machine.simulation.simulate import Load, Stepped, simulate
from twin.motion.planner import plan
from twin.motion.setpoints.sampling import settle
from twin.motion.setpoints.setpoints import Setpoints
from twin.nc.canonical import Chunk, Moves
from twin.processor import made_ahead
from twin.recording.alarms import Alarm, NearMiss
from twin.recording.reader import Samples
from twin.run.dry_run.dry_run import InterpretedProgram
from twin.run.preparing.preparation import Preparation


class MachineMotion(abc.ABC):
    """What moves the machine along a program; iterated once, for the samples of its joints.

    Attributes:
        alarm: What stopped it, None while nothing did.
        process: The cut whose forces push the axes; None where nothing simulates them.
        planned_s: When the last setpoint planned so far is due [s]; None where nobody plans ahead.
    """

    alarm: Alarm | None = None
    process: CuttingProcess | None = None
    planned_s: float | None = None

    @property
    @abc.abstractmethod
    def near_miss(self) -> NearMiss | None:
        """The closest that the tool's side and the part's came without touching."""

    @abc.abstractmethod
    def __iter__(self) -> Iterator[Samples]:
        """Yield chunks of samples."""


class Forces(NamedTuple):
    """What pushes the axes in addition to their drives.

    Attributes:
        process: The cut, tooth by tooth, while the machine moves.
        load: The mean force of the cut, computed ahead along the setpoints.
    """

    process: CuttingProcess | None = None
    load: Load | None = None


class PlannedMoves:
    """Moves in transit from the planner, which is ahead, to who compares what the machine makes of them."""

    def __init__(self, expect: Callable[[Moves], None]) -> None:
        """Remember none.

        Args:
            expect: Called with the moves, in order, before the first samples of theirs.
        """
        self.expect = expect
        self._planned: list[Moves] = []

    def note(self, moves: Moves) -> None:
        """Remember moves that are planned now."""
        self._planned.append(moves)

    def take(self) -> list[Moves]:
        """Those that were noted since the last time."""
        taken, self._planned = self._planned, []
        return taken


class _Ahead(NamedTuple):
    """A chunk with what was known when it was stepped."""

    stepped: Stepped
    moves: list[Moves]
    planned_s: float | None


class ProgramMotion(MachineMotion):
    """Setpoints of a program, held at their end and followed by the simulated drives.

    The machine is stepped one chunk ahead of those who look at it, on another core where there is one. What it has come to
    is reported with the chunk that it belongs to, so that an alarm finds all as it was then.
    """

    def __init__(
        self,
        setpoints: Iterable[Setpoints],
        model: MachineModel,
        summary: ProgramSummary,
        forces: Forces,
        moves: PlannedMoves | None = None,
    ) -> None:
        """Prepare the simulation.

        Args:
            setpoints: As planned, machine coordinates, in chunks.
            moves: Those that are planned; None: nobody asks for them.

        Raises:
            ConfigError: The model does not compile.
        """
        self.process = forces.process
        self._setpoints = setpoints
        self._moves = moves
        self._planned_until_s: float | None = None
        period_s = model.machine.file.servo_period_s
        self._simulation = simulate(
            model.machine,
            model,
            settle(self._noted(), period_s),
            summary.tools,
            forces.load,
            forces.process,
        )

    @property
    def near_miss(self) -> NearMiss | None:
        """The closest that the tool's side and the part's came without touching."""
        return self._simulation.near_miss

    def __iter__(self) -> Iterator[Samples]:
        """Yield chunks of samples, the last one that of an alarm if there is one.

        Raises:
            SimulationError: The simulation failed.
        """
        yield from self._simulation.watched(self._arriving())
        self.alarm = self._simulation.alarm

    def _arriving(self) -> Iterator[Stepped]:
        """Take note of what was planned for each chunk when it comes to those who look."""
        for ahead in made_ahead(self._ahead()):
            self.planned_s = ahead.planned_s
            if self._moves is not None:
                for moves in ahead.moves:
                    self._moves.expect(moves)
            yield ahead.stepped

    def _ahead(self) -> Iterator[_Ahead]:
        for stepped in self._simulation.stepped():
            moves = [] if self._moves is None else self._moves.take()
            yield _Ahead(stepped, moves, self._planned_until_s)

    def _noted(self) -> Iterator[Setpoints]:
        for chunk in self._setpoints:
            self._planned_until_s = float(chunk.time[-1])
            yield chunk


def planned(
    program: InterpretedProgram,
    preparation: Preparation,
    expect: Callable[[Moves], None] | None = None,
) -> Iterator[Setpoints]:
    """The setpoints of a program, in chunks.

    Args:
        expect: Called with the moves before setpoints of theirs are made.
    """

    def moves() -> Iterator[Chunk]:
        for chunk in program.timed_chunks():
            if expect is not None:
                expect(chunk.moves)
            yield chunk

    machine, part_zero = preparation.machine, preparation.layout.part_zero
    return plan(
        moves(),
        machine.motion_limits,
        period_s=machine.file.servo_period_s,
        part_zero=part_zero,
        start=program.start + part_zero,
    )


def cutting_forces(
    preparation: Preparation, summary: ProgramSummary, laid: HeightMap | None = None
) -> Forces:
    """What the cut of a job pushes the axes with.

    Args:
        preparation: Its job says which force is simulated.
        summary: What the program brings into the spindle when.
        laid: The blank, if it is on the table already.

    Raises:
        ConfigError: The job wants a force that cannot be computed.
    """
    job, zero, frame = preparation.job.file, *preparation.layout[:2]
    process = program_process(job, preparation.machine, summary, frame, zero, laid)
    if process is not None or not job.cutting_load:
        return Forces(process)
    if job.stock is None:
        raise ConfigError("cutting_load needs a [stock]")
    return Forces(load=AxisLoad(job.stock, summary, frame, zero))


def grown(
    chunks: Iterable[Samples], machine: MachineConfig, summary: ProgramSummary
) -> Iterator[Samples]:
    """Samples of a machine that warms up, with what it has grown."""
    growth = Growth(machine, ProgramOperation(summary).speed)
    return (growth.warm(samples) for samples in chunks)
