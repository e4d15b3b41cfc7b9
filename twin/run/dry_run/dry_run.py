"""The dry run: the whole program interpreted once, before anything moves, and read by all that follows."""

import dataclasses
import pickle
import tempfile
import weakref
from collections.abc import Iterable, Iterator
from itertools import islice
from typing import IO

from twin.cutting.program_summary import PlacedPart, ProgramSummary, SummaryBuilder
from twin.machine.watching.travel import soft_limit_alarm
from twin.nc.canonical import Chunk, FloatArray, Function
from twin.nc.control.settings import is_work_offset
from twin.nc.text.diagnostics.diagnostics import Diagnostic
from twin.recording.alarms import Alarm
from twin.run.dry_run.program_watch import ProgramWatch
from twin.run.dry_run.spindle_dwells import with_spindle_dwells
from twin.run.messages import Notice, shown, speed_notice
from twin.run.preparing.control_settings import says_itself
from twin.run.preparing.preparation import Preparation
from twin.run.progress import StageClock

MOVES_IN_MEMORY = 200_000
"""Of a longer program the further moves lie in a file, at some 200 bytes each: memory stays bounded."""


NOTICES_KEPT = 100
"""Lines whose speed of the spindle was limited that are reported."""


class InterpretedProgram:
    """The moves and events that a program makes.

    Attributes:
        start: Where the axes are at the program's start, program coordinates, shape (k,) [mm or deg]. The
            job says it, or the program itself before its first move (G92 of ``codesys``).
    """

    def __init__(self, preparation: Preparation, chunks: Iterable[Chunk] = ()) -> None:
        """Take what an interpreter makes.

        Args:
            chunks: The whole program, or its begin.

        Raises:
            ProgramError: The program is wrong.
        """
        self._preparation = preparation
        self._kept: list[Chunk] = []
        self._file: IO[bytes] | None = None
        self._places: list[int] = []
        self.moves = 0
        self.start: FloatArray = preparation.layout.start
        for chunk in chunks:
            self.add(chunk)

    def add(self, chunk: Chunk) -> None:
        """Keep the moves and events that follow the last ones."""
        if self.moves == 0 and len(chunk.moves):
            self.start = chunk.moves.start[0]
        self.moves += len(chunk.moves)
        if self.moves <= MOVES_IN_MEMORY:
            self._kept.append(chunk)
            return
        if self._file is None:
            self._file = tempfile.TemporaryFile(prefix="twin-moves-")  # noqa: SIM115 - closed with this object
            weakref.finalize(self, self._file.close)
        self._places.append(self._file.tell())
        pickle.dump(chunk, self._file, protocol=pickle.HIGHEST_PROTOCOL)

    def chunks(self) -> Iterator[Chunk]:
        """All of it in the program's order, a few thousand moves at a time."""
        yield from self._kept
        for place in self._places:
            assert self._file is not None
            self._file.seek(place)
            chunk: Chunk = pickle.load(self._file)  # noqa: S301 - written by this process, a file without a name
            yield chunk

    def timed_chunks(self) -> Iterator[Chunk]:
        """The same with the time of tool changes and of the spindle as dwells."""
        made = self._preparation
        return with_spindle_dwells(
            self.chunks(), made.machine.file.spindle, made.job.file, made.spindle
        )


def interpreted(preparation: Preparation) -> InterpretedProgram:
    """A program interpreted to its end.

    Raises:
        ProgramError: The program is wrong.
    """
    return InterpretedProgram(preparation, preparation.interpretation().chunks())


@dataclasses.dataclass(frozen=True, kw_only=True)
class DryRun:
    """What a program does, as far as that is known without moving anything.

    Attributes:
        warnings: What the interpreter and the spindle had to say.
        alarm: The soft-limit alarm of the first move that leaves the travel, if any.
        summary: Its tools, speeds of the spindle and rapids.
        watch: Mistakes of its functions that no axis shows.
        lines_never_run: How many lines with motion it never came to.
        fed_without_length: Lines that feed while the length of the tool in the spindle, once called, does not count.
        drilled: Lines that make a hole by a drilling cycle.
    """

    program: InterpretedProgram
    warnings: tuple[Diagnostic, ...]
    alarm: Alarm | None
    summary: ProgramSummary
    watch: ProgramWatch
    lines_never_run: int
    fed_without_length: frozenset[int]
    drilled: frozenset[int]

    @property
    def moves(self) -> int:
        """How many moves the program makes."""
        return self.program.moves


def interpret_all(preparation: Preparation, clock: StageClock) -> DryRun:
    """Interpret a whole program, so that no error is found in the middle of the motion.

    Raises:
        ProgramError: The program is wrong.
        ConfigError: It brings a tool that the job does not list.
    """
    interpretation = preparation.interpretation()
    program, alarm = InterpretedProgram(preparation), None
    job, part_zero = preparation.job.file, preparation.layout.part_zero
    placed = PlacedPart(preparation.layout.part_frame, part_zero)
    builder = SummaryBuilder(job, preparation.spindle, placed)
    watch = ProgramWatch(job, preparation.spindle)
    limited: dict[int, str] = {}
    chunks: Iterable[Chunk] = clock.watch("interpret", interpretation.chunks())
    for chunk in chunks:
        program.add(chunk)
        builder.add(chunk)
        watch.add(chunk)
        for event in chunk.events:
            if isinstance(event, Function) and (said := preparation.spindle.limited_by(event)):
                limited.setdefault(event.line, said)
        if alarm is None:
            alarm = soft_limit_alarm(preparation.machine, chunk.moves, part_zero)
    return DryRun(
        program=program,
        warnings=(
            *interpretation.diagnostics,
            *(
                speed_notice(line, message, preparation.source)
                for line, message in islice(limited.items(), NOTICES_KEPT)
            ),
            *shown(
                [*watch.notices(interpretation), *_never_read(preparation)],
                preparation.source,
                strict=preparation.settings.strict,
            ),
        ),
        alarm=alarm,
        summary=builder.summary(),
        watch=watch,
        lines_never_run=len(interpretation.coverage.never_run()),
        fed_without_length=frozenset(interpretation.lengths.fed_without),
        drilled=frozenset(interpretation.drilled),
    )


def _never_read(preparation: Preparation) -> Iterator[Notice]:
    """Values that the job itself gives and the program never asks for, work offsets of a real name left out."""
    for table, names in preparation.settings.never_read.items():
        for name in names:
            if is_work_offset(name) or not says_itself(preparation.job, f"{table}.{name}"):
                continue
            message = f"{table} of the job has {name}, and the program never asks for it"
            yield Notice("value-never-read", 0, message)
