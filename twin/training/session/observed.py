"""What the judge and the faults see of a room, so that they depend on no room."""

import dataclasses
import re
from collections.abc import Sequence
from typing import Protocol

from twin.machine.simulation.live import LiveMachine
from twin.nc.text.diagnostics import Diagnostic
from twin.recording.reader import Samples
from twin.training.scene.fault_table import FaultTable
from twin.training.scene.scene_file import Mode, Scene
from twin.training.session.program_run import ProgramRun
from twin.training.session.tables import Tables
from twin.training.session.workpiece import Workpiece

_NUMBER = re.compile(r"\s*/?\s*[Nn]\s*(\d+)")


@dataclasses.dataclass(frozen=True, slots=True)
class Notice:
    """An alarm.

    Attributes:
        code: Stable, searchable name of its kind: those of ``twin.machine.watching.alarms``, and
            ``program`` (the interpreter refused a block), ``external`` (a safety circuit).
        message: What happened, with numbers.
        axis: Name of the axis, or empty.
        line: Source line of the program, 0 where none.
        time_s: When, in machine time [s].
        finding: What the interpreter found, where that is the cause.
        block: Number of the block, such as ``N20``; empty where it has none.
    """

    code: str
    message: str
    axis: str
    line: int
    time_s: float
    finding: Diagnostic | None = None
    block: str = ""


def block_number(lines: Sequence[str], line: int) -> str:
    """The number that a line of a program gives its block, such as ``N20``; empty: none.

    Args:
        lines: Of the program.
        line: Counted from 1; 0: none.
    """
    found = _NUMBER.match(lines[line - 1]) if 0 < line <= len(lines) else None
    return "" if found is None else f"N{found[1]}"


class Observed(Protocol):
    """A running machine from outside; ``Room`` documents each attribute."""

    scene: Scene
    machine: LiveMachine
    tables: Tables
    work: Workpiece | None
    mode: Mode
    run: ProgramRun | None
    running: str
    alarm: Notice | None
    samples: Samples
    faults: list[FaultTable]

    @property
    def time_s(self) -> float:
        """Machine time since the beginning [s]."""
        ...

    @property
    def line(self) -> int:
        """Source line of the program that runs; 0: none."""
        ...

    @property
    def moving(self) -> bool:
        """Whether any axis moves."""
        ...

    def raise_alarm(self, code: str, message: str) -> None:
        """The control stops everything and says why."""
        ...
