"""What one run leaves in force for the next one, as MDI blocks and streamed blocks do."""

from typing import NamedTuple

from twin.nc.control.control import Control
from twin.nc.control.modal import Modal
from twin.nc.geometry.frame import SHIFTS


class Inherited(NamedTuple):
    """What a block finds in force that those before it, typed in or streamed, left.

    Attributes:
        modal: G codes.
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
            column: Of the axis.
            moved: By how much it has changed [mm or deg].
        """
        if name != f"G{self.modal.active.get('offset', 0.0):g}":
            return self
        shifts = [list(shift) for shift in self.shifts]
        shifts[SHIFTS.index("offset")][column] += moved
        return self._replace(shifts=shifts)
