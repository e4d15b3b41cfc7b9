"""The dry run: the whole program interpreted once, before anything moves."""

import dataclasses
from collections.abc import Iterable
from itertools import islice

from twin.cutting.program_summary import ProgramSummary, SummaryBuilder
from twin.machine.watching.alarms import Alarm
from twin.machine.watching.travel import soft_limit_alarm
from twin.nc.canonical import Chunk, FloatArray, Function
from twin.nc.text.diagnostics import Diagnostic
from twin.run.interpreted import InterpretedProgram
from twin.run.messages import speed_notice
from twin.run.notices import shown
from twin.run.preparation import Preparation
from twin.run.program_watch import ProgramWatch
from twin.run.stages import StageClock

NOTICES_KEPT = 100
"""Lines whose speed of the spindle was limited that are told."""


@dataclasses.dataclass(frozen=True, kw_only=True)
class DryRun:
    """What a program does, as far as that is known without moving anything.

    Attributes:
        program: Its moves and events.
        warnings: What the interpreter and the spindle had to say.
        alarm: The soft-limit alarm of the first move that leaves the travel, if any.
        summary: What the program says beside its moves.
        watch: What it tells that no axis feels.
        lines_never_run: How many lines with motion it never came to.
    """

    program: InterpretedProgram
    warnings: tuple[Diagnostic, ...]
    alarm: Alarm | None
    summary: ProgramSummary
    watch: ProgramWatch
    lines_never_run: int

    @property
    def moves(self) -> int:
        """How many moves the program makes."""
        return self.program.moves


def interpret_all(preparation: Preparation, part_zero: FloatArray, clock: StageClock) -> DryRun:
    """Interpret a whole program, so that no error is met with the machine half-way.

    Args:
        preparation: The job made concrete.
        part_zero: Machine coordinates of program zero, shape (k,) [mm or deg].
        clock: Counts the time as interpretation.

    Raises:
        ProgramError: The program is wrong.
        ConfigError: It brings a tool that the job does not list.
    """
    interpretation = preparation.interpretation()
    program, alarm = InterpretedProgram(preparation), None
    builder = SummaryBuilder(preparation.job.file, preparation.spindle)
    watch = ProgramWatch(preparation.job.file, preparation.spindle)
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
                watch.notices(interpretation),
                preparation.source,
                strict=preparation.settings.strict,
            ),
        ),
        alarm=alarm,
        summary=builder.summary(),
        watch=watch,
        lines_never_run=len(interpretation.coverage.never_run()),
    )
