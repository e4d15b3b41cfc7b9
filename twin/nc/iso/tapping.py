"""Tapping in passes that break the chip: every way is made with the feed, since the tap stays in its thread."""

import math
from typing import NamedTuple

from twin.nc.control.control import Control


class Passes(NamedTuple):
    """The passes of one hole; heights are programmed coordinates.

    Attributes:
        reference: Height at which the first begins [mm].
        bottom: Height at which the last one ends [mm].
        depth: Of each pass [mm].
        lift: How far the tap comes back after each; 0: to the reference plane [mm].
        dwell: At the bottom [s].
        back: Height to which the tool returns behind the hole [mm].
        left: The thread is a left-hand one.
    """

    reference: float
    bottom: float
    depth: float
    lift: float
    dwell: float
    back: float
    left: bool = False

    @property
    def total(self) -> int:
        """How many there are."""
        return math.ceil((self.reference - self.bottom) / self.depth - 1e-9)


def tap_in_passes(control: Control, hole: list[float], passes: Passes) -> None:
    """Tap at a programmed position, shape (k,), whose height is not used."""
    axis, reference = control.modal.plane.axes[2], passes.reference
    inwards, outwards = ("M4", "M3") if passes.left else ("M3", "M4")
    hole[axis] = max(control.programmed[axis], reference)
    _go(control, axis, hole[axis], rapid=True)
    control.line_to(hole, rapid=True)
    _go(control, axis, reference, rapid=True)
    turning = {} if control.spindle is None else {"S": control.spindle}
    for number in range(1, passes.total + 1):
        is_last = number == passes.total
        depth = passes.bottom if is_last else reference - number * passes.depth
        _go(control, axis, depth, rapid=False)
        if is_last and passes.dwell > 0.0:
            control.dwell(passes.dwell)
        control.function(outwards, turning)
        stays = not is_last and passes.lift > 0.0
        _go(control, axis, min(depth + passes.lift, reference) if stays else reference, rapid=False)
        control.function(inwards, turning)
    _go(control, axis, passes.back, rapid=True)


def _go(control: Control, axis: int, height: float, *, rapid: bool) -> None:
    there = list(control.programmed)
    there[axis] = height
    control.line_to(there, rapid=rapid)
