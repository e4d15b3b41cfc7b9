"""The dry run: the whole program interpreted once, before anything moves."""

import dataclasses
from collections.abc import Iterable

from twin.cutting.program_summary import ProgramSummary, SummaryBuilder
from twin.cutting.spindle import speaks_of_spindle
from twin.machine.watching.alarms import Alarm
from twin.machine.watching.travel import soft_limit_alarm
from twin.nc.canonical import Chunk, FloatArray
from twin.nc.text.diagnostics import Diagnostic
from twin.run.preparation import Preparation
from twin.run.stages import StageClock


@dataclasses.dataclass(frozen=True, kw_only=True)
class DryRun:
    """What a program does, as far as that is known without moving anything.

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
    moves, alarm, speaks = 0, None, False
    builder = SummaryBuilder(preparation.job.file)
    chunks: Iterable[Chunk] = clock.watch("interpret", interpretation.chunks())
    for chunk in chunks:
        moves += len(chunk.moves)
        builder.add(chunk)
        speaks = speaks or speaks_of_spindle(chunk)
        if alarm is None:
            alarm = soft_limit_alarm(preparation.machine, chunk.moves, part_zero)
    return DryRun(
        moves=moves,
        warnings=tuple(interpretation.diagnostics),
        alarm=alarm,
        speaks_of_spindle=speaks,
        summary=builder.summary(),
    )
