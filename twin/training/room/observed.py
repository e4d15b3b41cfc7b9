"""What the judge and the faults see of a room, so that they do not import it."""

import dataclasses
from typing import Protocol

from twin.machine.simulation.live import LiveMachine
from twin.nc.canonical import NO_BLOCK_NUMBER
from twin.nc.text.diagnostics.diagnostics import Diagnostic, ProgramError
from twin.nc.text.diagnostics.reporter import Reporter
from twin.nc.text.lexer import Lexer
from twin.nc.text.source import Source
from twin.nc.text.syntax import Language
from twin.recording.reader import Samples
from twin.training.room.control.auxiliaries import Auxiliaries
from twin.training.room.control.panel import Panel
from twin.training.room.control.program_memory import ProgramMemory
from twin.training.room.control.program_slot import ProgramSlot
from twin.training.room.setup.setup import Setup
from twin.training.scene.scene_file import Scene


@dataclasses.dataclass(frozen=True, slots=True)
class RoomAlarm:
    """An alarm.

    Attributes:
        code: Stable, searchable name of its kind: those of ``twin.recording.alarms``, and
            ``program`` (the interpreter refused a block), ``external`` (a safety circuit).
        line: Source line of the program, 0 where none.
        time_s: When, in machine time [s].
        finding: What the interpreter found, where that is the cause.
        block: Number of the block, such as ``N20``; empty where it has none.
        between: Names of the two bodies that met; empty: none did.
        place: Where the tip was, seen from the part, X Y Z [mm]; empty: not known.
    """

    code: str
    message: str
    axis: str = ""
    line: int = 0
    time_s: float = 0.0
    finding: Diagnostic | None = None
    block: str = ""
    between: tuple[str, ...] = ()
    place: tuple[float, ...] = ()


def block_number(language: Language, program: Source, line: int) -> str:
    """The number that a line of a program gives its block, such as ``N20``; empty: none.

    Args:
        language: How the program is written.
        line: Counted from 1; 0: none.
    """
    lexer = Lexer(language, Reporter(program, strict=False))
    text = program.lines[line - 1] if 0 < line <= len(program.lines) else ""
    while text:
        try:
            numbers = [block.number for block in lexer.blocks(text, line)]
        except ProgramError as error:
            # What is before a mistake can be read.
            text = text[: min(error.diagnostic.column, len(text)) - 1]
        else:
            return next((f"N{one}" for one in numbers if one != NO_BLOCK_NUMBER), "")
    return ""


class ObservedJudge(Protocol):
    """What the alarm log tells the judge."""

    def note_alarm(self, code: str) -> None:
        """An alarm has come."""
        ...


class Observed(Protocol):
    """A running machine from outside; ``Room`` documents each attribute."""

    scene: Scene
    machine: LiveMachine
    setup: Setup
    panel: Panel
    program: ProgramMemory
    slot: ProgramSlot
    auxiliaries: Auxiliaries
    samples: Samples

    @property
    def judge(self) -> ObservedJudge:
        """Looks after the tasks."""
        ...

    @property
    def time_s(self) -> float:
        """Machine time since the beginning [s]."""
        ...

    @property
    def alarm(self) -> RoomAlarm | None:
        """The alarm that has not been cleared."""
        ...

    def raise_alarm(self, notice: RoomAlarm) -> None:
        """The control stops everything and gives the reason."""
        ...
