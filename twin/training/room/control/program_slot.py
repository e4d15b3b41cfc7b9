"""What the control runs, and the program that it has set aside meanwhile."""

from typing import Literal, NamedTuple

import numpy as np

from twin.errors import UsageError
from twin.motion.setpoints.setpoints import Setpoints
from twin.nc.canonical import FloatArray, Function
from twin.training.program.block_tracker import ModalState
from twin.training.program.program_run import ProgramRun
from twin.training.program.run_options import Inherited
from twin.training.room.control.panel import Panel

ON_PATH = 1e-3
"""How near to where it was held a program may go on [mm or deg]."""

Kind = Literal["", "program", "mdi", "jog"]


class Suspended(NamedTuple):
    """A program that was held, while the axes are jogged.

    Attributes:
        place: Where it was held, machine coordinates, shape (k,) [mm or deg].
        line: Source line of the block that was held.
        waits: It waits at a program stop, behind that block.
    """

    run: ProgramRun
    place: FloatArray
    line: int
    waits: bool


class ProgramSlot:
    """The run that moves the axes; other files read it and call its methods.

    Attributes:
        run: The program, MDI block or jog that is being run.
        running: What is being run; empty: nothing.
        suspended: A program that was held, while the axes are jogged.
        modal: What was in force last, where nothing runs.
        inherited: What the last MDI block left in force for the next one.
        label: What the screen adds to the position: a control may relabel an axis that turns, shape (k,)
            [mm or deg].
    """

    def __init__(self, axes: int) -> None:
        """Begin empty, for so many axes."""
        self.run: ProgramRun | None = None
        self.running: Kind = ""
        self.waiting = False
        self.suspended: Suspended | None = None
        self.modal: ModalState | None = None
        self.inherited: Inherited | None = None
        self.label = np.zeros(axes)

    @property
    def held(self) -> bool:
        """Whether cycle start is waited for within something that runs."""
        held = self.suspended is not None and self.run is None
        return held or self.waiting or (self.run is not None and self.run.held)

    @property
    def empty(self) -> bool:
        """Whether nothing runs, and no program is suspended."""
        return self.run is None and self.suspended is None

    def line(self, setpoint: Setpoints) -> int:
        """Source line of the program that runs, or behind which it waits; 0: none."""
        if self.suspended is not None:
            return self.suspended.line
        if self.running != "program" or self.run is None:
            return 0
        if self.waiting:
            return self.run.reader.ending_line
        return self.run.line(int(setpoint.line[0]))

    def begin(self, run: ProgramRun, kind: Kind) -> None:
        """Run something."""
        self.run, self.running, self.waiting = run, kind, False
        if kind == "program":
            self.inherited = None

    def wait(self, *, waiting: bool) -> None:
        """Wait for cycle start at a program stop, or no longer."""
        self.waiting = waiting

    def drop(self, setpoint: Setpoints) -> None:
        """Forget what runs; the axes slow down where they are."""
        if self.run is not None and self.running != "jog":
            self.modal = self.run.modal(int(setpoint.move[0])) or self.modal
        self._empty()

    def forget_suspended(self) -> None:
        """Give up the program that was held."""
        self.suspended = None

    def suspend(self, setpoint: Setpoints) -> None:
        """Let the axes be jogged while the program is held, or waits at a program stop.

        At M0 a part is measured and chips are cleared (Fagor 8070: tool inspection; SINUMERIK Operate:
        JOG in an interruption, REPOS).
        """
        assert self.run is not None
        place = setpoint.position[0].copy()
        self.modal = self.run.modal(int(setpoint.move[0]))
        self.suspended = Suspended(self.run, place, self.line(setpoint), self.waiting)
        self._empty()

    def resume(self, setpoint: Setpoints) -> None:
        """Take the held program up again.

        Raises:
            UsageError: That is elsewhere.
        """
        assert self.suspended is not None
        if np.abs(setpoint.position[0] - self.suspended.place).max() > ON_PATH:
            raise UsageError("the axes stand off the path: return to it first")
        self.run, self.running, self.waiting = self.suspended.run, "program", self.suspended.waits
        self.suspended = None

    def inherit(self) -> None:
        """The MDI block that has run leaves what it has set in force for the next one."""
        assert self.run is not None
        self.inherited = self.run.reader.left()

    def forget_inherited(self) -> None:
        """The next MDI block begins with what the control begins with."""
        self.inherited = None

    def shift_offset(self, name: str, column: int, moved: float) -> None:
        """A work offset in the table has changed: where it is in force it shifts the next MDI block.

        Args:
            name: Of the offset, such as ``G55``.
            moved: By how much it has changed [mm or deg].
        """
        if self.inherited is not None:
            self.inherited = self.inherited.after_offset(name, column, moved)

    def drive(self, count: int, panel: Panel) -> Setpoints | None:
        """The next setpoints of what runs; None: nothing moves the axes.

        Args:
            panel: Its overrides, and whether it stops behind every block.
        """
        if self.run is None or self.waiting:
            return None
        return self.run.drive(
            count,
            panel.feed_override / 100.0,
            panel.rapid_override / 100.0,
            single=self.running == "program" and panel.mode == "single",
        )

    def stop_jog(self) -> None:
        """Bring an axis that is driven by hand to rest."""
        if self.running == "jog" and self.run is not None:
            self.run.drop()

    def functions(self, setpoints: Setpoints) -> list[Function]:
        """The functions that happened along setpoints, and before them."""
        return [] if self.run is None else self.run.passed(setpoints)

    def relabel(self, setpoint: Setpoints) -> None:
        """Take over what the move that runs, at one row, adds to the position on the screen."""
        target = None if self.run is None else self.run.reader.moves.target(int(setpoint.move[0]))
        if target is not None:
            end, display = target
            self.label = display - end

    def reset_label(self) -> None:
        """The screen adds nothing to the position."""
        self.label = np.zeros(len(self.label))

    def _empty(self) -> None:
        self.run, self.running, self.waiting = None, "", False
