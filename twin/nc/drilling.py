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
    turning = {} if control.spindle is None else {"S": control.spindle}
    for act, value in acts(cycle):
        if act in (Act.RAPID, Act.FEED):
            there = list(control.programmed)
            there[axis] = value
            control.line_to(there, rapid=act is Act.RAPID)
        elif act is Act.DWELL:
            control.dwell(value)
        else:
            control.function(act.name, {} if act is Act.M5 else turning)


class Act(enum.IntEnum):
    """What happens at a hole: moves to a height, a dwell, the spindle."""

    RAPID = 0
    FEED = 1
    DWELL = 2
    M3 = 3
    M4 = 4
    M5 = 5


def acts(cycle: Drilling) -> list[tuple[Act, float]]:
    """What happens when the tool stands over the hole, with heights [mm] and seconds."""
    done = [(Act.RAPID, cycle.reference)]
    for number, stop in enumerate(cycle.stops, start=1):
        full = number % cycle.full_every == 0
        up = cycle.reference if full else min(stop + cycle.lift, cycle.reference)
        done += [(Act.FEED, stop), (Act.RAPID, up), (Act.RAPID, min(stop + cycle.clearance, up))]
    done.append((Act.FEED, cycle.bottom))
    if cycle.dwell > 0.0:
        done.append((Act.DWELL, cycle.dwell))
    if cycle.retract is Retract.REVERSED:
        done += [(Act.M4, 0.0), (Act.FEED, cycle.reference), (Act.M3, 0.0)]
    elif cycle.retract is Retract.FEED:
        done.append((Act.FEED, cycle.reference))
    elif cycle.retract is Retract.STOPPED:
        done += [(Act.M5, 0.0), (Act.RAPID, cycle.back), (Act.M3, 0.0)]
    done.append((Act.RAPID, cycle.back))
    return done
