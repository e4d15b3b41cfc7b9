"""A program run a few servo periods at a time, with commands in between."""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from twin.api.program import Program, prepared, scratch_folder
from twin.compare.comparison import Comparison
from twin.compare.figures import Figures
from twin.coupling.operations import program_process
from twin.machine.simulation.live import LiveMachine
from twin.motion.live.live_motion import LARGEST_OVERRIDE, LiveMotion
from twin.nc.canonical import Chunk, FloatArray
from twin.recording.alarms import Alarm
from twin.recording.form import Samples
from twin.run.run import Run


class Step(NamedTuple):
    """What happened in some servo periods.

    Attributes:
        samples: Setpoints and joints of n instants, machine coordinates; fewer than were asked for at the end
            of the program and where an alarm stopped the machine.
        contour_um: Contour error of each, shape (n,) [µm].
    """

    samples: Samples
    contour_um: FloatArray


class Command(NamedTuple):
    """An operator's command and its time.

    Attributes:
        tick: Servo periods that had passed.
        name: An override's, or ``hold`` or ``start``.
    """

    tick: int
    name: str
    value: float = 0.0


class Session:
    """A program on its machine, with the drives, the cut's forces and the watching that a run has.

    Untouched it moves as ``twin.run`` does.

    Examples:
        >>> session = twin.Session("mefi/helix")
        >>> while not session.done:
        ...     step = session.step(50)
        ...     session.feed_override = 0.5 if step.contour_um.max() > 5.0 else 1.0
        >>> session.figures.contour.max
        4.1

    Attributes:
        run: The job on its machine, with which other sessions of the same program may begin.
        ticks: Servo periods that have passed.
        alarm: What stopped the machine; of a program that would leave the travel before it moves.
    """

    def __init__(
        self,
        program: Program | Run,
        *,
        dialect: str | None = None,
        machine: str | None = None,
        largest_override: float = LARGEST_OVERRIDE,
    ) -> None:
        """Prepare a program and its machine at its start.

        Args:
            program: As ``twin.run`` takes it; or one that was prepared already.
            dialect: One of ``twin dialects``; recognised from the program by default.
            machine: A shipped machine's name, or a machine file; the job's by default.
            largest_override: Highest feed override; with 1 the setpoints are those of ``twin.run`` to the bit,
                with more the look-ahead leaves room for it.

        Raises:
            ProgramError: The program is wrong.
            UsageError: A file is missing or wrong.
        """
        if isinstance(program, Run):
            self.run = program
        else:
            with scratch_folder() as folder:
                made, _ = prepared(program, folder, dialect=dialect, machine=machine, assuming=True)
                self.run = Run(made)
        dry_run = self.run.dry_run
        self.ticks = 0
        self.alarm: Alarm | None = dry_run.alarm
        self.commands: list[Command] = []
        described, job = self.run.machine, self.run.preparation.job.file
        blank = self.run.model.blank
        zero, summary = self.run.part_zero, dry_run.summary
        start = dry_run.program.start + zero
        self._tools = summary.tools
        self._tool = summary.tools.tools[0]
        self._comparison = Comparison(described.axes, self.run.part_frame, zero)
        self._motion = LiveMotion(
            self._chunks(),
            described.motion_limits,
            period_s=described.file.servo_period_s,
            part_zero=zero,
            start=start,
            largest_override=largest_override,
        )
        self._machine = LiveMachine(described, self._tool, start, blank)
        self._last = Step(self._machine.follow(self._machine.setpoint[:0]), np.zeros(0))
        self._machine.step_with(program_process(job, described, summary, self.run.part_frame, zero))

    @property
    def time_s(self) -> float:
        """Machine time that has passed [s]."""
        return self.ticks * self.run.machine.file.servo_period_s

    @property
    def done(self) -> bool:
        """The program has come to its end, or an alarm stopped the machine."""
        return self.alarm is not None or self._motion.finished

    @property
    def position(self) -> FloatArray:
        """Where the axes are, program coordinates, shape (k,) [mm or deg]."""
        return self._machine.position - self.run.part_zero

    @property
    def figures(self) -> Figures:
        """Following and contour error so far."""
        return self._comparison.result()

    @property
    def feed_override(self) -> float:
        """Factor of programmed feeds, 0 to the largest override, from the next step on.

        Raises:
            ValueError: When set to anything else.
        """
        return self._motion.feed_override

    @feed_override.setter
    def feed_override(self, factor: float) -> None:
        self._command(Command(self.ticks, "feed_override", factor))

    @property
    def rapid_override(self) -> float:
        """Factor of the velocity of rapids, 0 to 1.

        Raises:
            ValueError: When set to anything else.
        """
        return self._motion.rapid_override

    @rapid_override.setter
    def rapid_override(self, factor: float) -> None:
        self._command(Command(self.ticks, "rapid_override", factor))

    def hold(self) -> None:
        """Feed hold: come to rest on the path until ``start``."""
        self._command(Command(self.ticks, "hold"))

    def start(self) -> None:
        """Go on after ``hold``."""
        self._command(Command(self.ticks, "start"))

    def step(self, periods: int = 1) -> Step:
        """Go on by servo periods.

        Args:
            periods: How many; at least 1.

        Raises:
            ValueError: There are fewer.
            SimulationError: The simulation failed.
        """
        if periods < 1:
            raise ValueError(f"step: {periods} periods; at least 1")
        if self.done:
            return self._last._replace(samples=self._last.samples[:0], contour_um=np.zeros(0))
        setpoints = self._motion.advance(periods)
        for _, tool in self._tools.runs(setpoints.move):
            if tool is not self._tool:
                self._tool = tool
                self._machine.mount(tool)
        samples = self._machine.follow(setpoints)
        self.ticks += len(samples)
        self.alarm = self._machine.alarm
        self._last = Step(samples, self._comparison.add(samples))
        return self._last

    def copy(self) -> "Session":
        """Another session at the same instant, which goes on by itself.

        It repeats what has happened, commands at their instants: the same to the bit, in the time that the
        simulation takes.
        """
        other = Session(self.run, largest_override=self._motion.largest_override)
        for command in self.commands:
            other._go_to(command.tick)
            other._command(command)
        other._go_to(self.ticks)
        return other

    def _go_to(self, tick: int) -> None:
        if tick > self.ticks:
            self.step(tick - self.ticks)

    def _command(self, command: Command) -> None:
        if command.name == "hold":
            self._motion.hold()
        elif command.name == "start":
            self._motion.start()
        else:
            setattr(self._motion, command.name, command.value)
        self.commands.append(command)

    def _chunks(self) -> Iterator[Chunk]:
        """The program; the comparison gets its moves first."""
        for chunk in self.run.dry_run.program.timed_chunks():
            self._comparison.expect(chunk.moves)
            yield chunk
