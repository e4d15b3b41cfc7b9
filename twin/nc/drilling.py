"""Drilling cycles: what they do at a hole, whoever's words asked for it."""

import dataclasses
import enum

from twin.nc.control import Control

CHIP_CLEARANCE = 0.5
"""Deep drilling stops its rapid return this far above where it was [mm]."""


class Retract(enum.Enum):
    """How a cycle leaves the hole."""

    RAPID = "rapid"
    FEED = "feed"
    REVERSED = "feed with the spindle reversed"
    STOPPED = "rapid with the spindle stopped"


@dataclasses.dataclass(frozen=True, slots=True)
class Drilling:
    """A drilling cycle in force.

    Attributes:
        reference: Height at which the feed begins, programmed coordinates [mm].
        bottom: Height of the hole's bottom [mm].
        back: Height to which the tool returns [mm].
        dwell: At the bottom [s].
        peck: Depth of one peck [mm]; 0: in one go.
        retract: How it leaves the hole.
    """

    reference: float
    bottom: float
    back: float
    dwell: float = 0.0
    peck: float = 0.0
    retract: Retract = Retract.RAPID


def drill(control: Control, cycle: Drilling, target: list[float]) -> None:
    """Go over the hole, drill it, return.

    Args:
        control: The control.
        cycle: The cycle.
        target: Programmed position of the hole, shape (k,); its height is not used.
    """
    axis = control.modal.plane.axes[2]
    over = list(target)
    over[axis] = max(control.programmed[axis], cycle.reference)
    if over[axis] != control.programmed[axis]:
        up = list(control.programmed)
        up[axis] = over[axis]
        control.line_to(up, rapid=True)
    control.line_to(over, rapid=True)
    _to(control, axis, cycle.reference, rapid=True)
    depth = cycle.reference
    if cycle.peck > 0.0:
        while depth - cycle.peck > cycle.bottom:
            depth -= cycle.peck
            _to(control, axis, depth, rapid=False)
            _to(control, axis, cycle.reference, rapid=True)
            _to(control, axis, min(depth + CHIP_CLEARANCE, cycle.reference), rapid=True)
    _to(control, axis, cycle.bottom, rapid=False)
    if cycle.dwell > 0.0:
        control.dwell(cycle.dwell)
    _leave(control, axis, cycle)


def _leave(control: Control, axis: int, cycle: Drilling) -> None:
    if cycle.retract is Retract.REVERSED:
        turning = {} if control.spindle is None else {"S": control.spindle}
        control.function("M4", turning)
        _to(control, axis, cycle.reference, rapid=False)
        control.function("M3", turning)
    elif cycle.retract is Retract.FEED:
        _to(control, axis, cycle.reference, rapid=False)
    elif cycle.retract is Retract.STOPPED:
        turning = {} if control.spindle is None else {"S": control.spindle}
        control.function("M5", {})
        _to(control, axis, cycle.back, rapid=True)
        control.function("M3", turning)
    _to(control, axis, cycle.back, rapid=True)


def _to(control: Control, axis: int, height: float, *, rapid: bool) -> None:
    target = list(control.programmed)
    target[axis] = height
    control.line_to(target, rapid=rapid)
