"""Drilling cycles: what they do at a hole, whoever's words asked for it."""

import dataclasses
import enum

from twin.nc.control import Control

CHIP_CLEARANCE = 0.5
"""Deep drilling stops its rapid return this far above where it was [mm]."""


MOST_PECKS = 10_000
"""Pecks of one hole: more is a slip of the pen."""


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
        stops: Heights at which it withdraws to break or clear chips, downwards [mm].
        clearance: It returns with rapid to this far above where it was [mm].
        full_every: After how many stops it withdraws to the reference plane.
        lift: How far it withdraws at the other stops [mm].
        retract: How it leaves the hole.
    """

    reference: float
    bottom: float
    back: float
    dwell: float = 0.0
    stops: tuple[float, ...] = ()
    clearance: float = CHIP_CLEARANCE
    full_every: int = 1
    lift: float = 0.0
    retract: Retract = Retract.RAPID


def pecks(
    control: Control,
    surface: float,
    bottom: float,
    first: float,
    factor: float = 1.0,
    least: float = 0.0,
) -> tuple[float, ...]:
    """Heights at which deep drilling stops on its way down [mm].

    Args:
        control: The control.
        surface: Height at which the first peck begins [mm].
        bottom: Height of the hole's bottom [mm].
        first: Depth of the first peck, above 0 [mm].
        factor: By which each peck is deeper than the one before.
        least: No peck is less deep, except the last [mm].

    Raises:
        ProgramError: There are more than ``MOST_PECKS``.
    """
    stops: list[float] = []
    depth, peck = surface, first
    while depth - peck > bottom:
        depth -= peck
        peck = max(peck * factor, least)
        stops.append(depth)
        if len(stops) > MOST_PECKS:
            message = f"the hole would need more than {MOST_PECKS} pecks"
            control.fail("cycle-depth", message, hint="write deeper pecks")
    return tuple(stops)


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
    for number, stop in enumerate(cycle.stops, start=1):
        _to(control, axis, stop, rapid=False)
        full = number % cycle.full_every == 0
        up = cycle.reference if full else min(stop + cycle.lift, cycle.reference)
        _to(control, axis, up, rapid=True)
        _to(control, axis, min(stop + cycle.clearance, up), rapid=True)
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
