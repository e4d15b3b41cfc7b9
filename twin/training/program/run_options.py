"""How a program is run, and where its blocks come from."""

import dataclasses
from typing import NamedTuple, Protocol

from twin.nc.control.control import Control
from twin.nc.control.executor import Executor
from twin.nc.control.modal import Modal
from twin.nc.geometry.frame import SHIFTS
from twin.nc.text.blocks import Block
from twin.nc.text.diagnostics.diagnostics import Diagnostic


class Inherited(NamedTuple):
    """What a block finds in force that those before it, typed in or streamed, left.

    Attributes:
        shifts: Of the part's zero, as the frame keeps them [mm or deg].
        feed: F as programmed, or None.
        spindle: S as programmed, or None [1/min].
        memory: What the dialect remembers, where it outlives a program; None: it begins with its own.
    """

    modal: Modal
    shifts: list[list[float]]
    feed: float | None
    spindle: float | None
    memory: object = None

    @classmethod
    def of(cls, control: Control, *, memory: bool) -> "Inherited":
        """What a control has in force; ``memory``: what its dialect remembers, too."""
        motion = control.motion
        shifts = [list(shift) for shift in control.frame.shifts]
        kept = control.memory if memory else None
        return cls(control.modal.fork(), shifts, motion.feed, motion.spindle, kept)

    def put_into(self, control: Control) -> None:
        """Let a control begin with it."""
        motion = control.motion
        if self.memory is not None:
            control.memory = self.memory
        control.modal.restore(self.modal)
        control.frame.set_shifts([list(shift) for shift in self.shifts])
        motion.reframed()
        motion.feed, motion.spindle = self.feed, self.spindle

    def after_offset(self, name: str, column: int, moved: float) -> "Inherited":
        """The same after a work offset has changed: the one in force shifts the part's zero.

        Args:
            name: Of the offset, such as ``G55``.
            moved: By how much it has changed [mm or deg].
        """
        if name != f"G{self.modal.active.get('offset', 0.0):g}":
            return self
        shifts = [list(shift) for shift in self.shifts]
        shifts[SHIFTS.index("offset")][column] += moved
        return self._replace(shifts=shifts)


class BlockStream(Protocol):
    """Blocks that come while they are run, as a sender streams them.

    They are a program part as long as they come: it ends where none came for a while before the axes have begun,
    or where the planner has caught up with them.
    """

    @property
    def is_idle(self) -> bool:
        """Whether no block has come for a while."""
        ...

    def next(self, executor: Executor, moves_ahead: int) -> Block | None:
        """The next block; None: none has come, or none is wanted.

        Args:
            moves_ahead: How many moves lie ahead of the axes.
        """
        ...

    def refuse(self, executor: Executor, finding: Diagnostic) -> None:
        """The last block is wrong: it is to leave no trace."""
        ...


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class RunOptions:
    """How a program is run.

    Attributes:
        soft_limits: Whether to stop before a move that leaves the travel.
        dry_feed: What all feeds are replaced by in a dry run [mm/min]; None: none.
        search: Source line to begin at: what is before it is only computed. 0: the beginning.
        inherited: What is in force at the beginning; None: what the control begins with.
        stream: Where blocks come from, in place of the source.
        typed: Blocks that are typed in, or a move by hand: no program that a code would end.
    """

    soft_limits: bool = True
    dry_feed: float | None = None
    search: int = 0
    inherited: Inherited | None = None
    stream: BlockStream | None = None
    typed: bool = False
