"""What the judge and the faults see of a room, so that they depend on no room."""

from typing import Protocol

from twin.machine.simulation.live import LiveMachine
from twin.recording.reader import Samples
from twin.training.scene.fault_table import FaultTable
from twin.training.scene.modes import Mode
from twin.training.scene.scene_file import Scene
from twin.training.session.notice import Notice
from twin.training.session.program_run import ProgramRun
from twin.training.session.tables import Tables
from twin.training.session.workpiece import Workpiece


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
    def moving(self) -> bool:
        """Whether any axis moves."""
        ...

    def raise_alarm(self, code: str, message: str) -> None:
        """The control stops everything and says why."""
        ...
