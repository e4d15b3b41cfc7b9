"""Canned cycles of the Fagor CNC 8070.

Z names the reference plane, I the depth: absolute with G90, from the reference plane with G91; D is
the distance from the reference plane to the surface of the part. Every block that names a point of
the plane runs the cycle there, until G80 or another motion code; with G98 the tool goes back to the
height at which the cycle was called, with G99 to the reference plane.

Decisions, since the manuals are only partly known: K is a dwell at the bottom [s]. In G83, I is the
depth of one peck and J their number. In G82, B is the first peck, R the factor of each next one, L
the least; after each the tool lifts by H, after every J of them (or where H is missing) to the
reference plane, and returns with rapid to C, 1 mm, above where it was.
"""

from collections.abc import Mapping

from twin.nc.control.codes import GCode, Ground, Interpolation
from twin.nc.control.interpolation import CycleRule
from twin.nc.dialects.fagor8070.pockets import call_pocket, mill_pocket
from twin.nc.dialects.fagor8070.polar import take_goal
from twin.nc.iso.drilling import cycle_code
from twin.nc.path.drilling_cycle import (
    BOTTOM,
    CHIP_CLEARANCE,
    CLEARANCE,
    COUNT,
    DWELL,
    EVERY,
    FACTOR,
    LEAST,
    LIFT,
    PECK,
    REFERENCE,
    SURFACE,
    Cycle,
    Pecking,
    Retract,
)

_CLEARANCE = 1.0
"""G82: C where it is missing [mm]."""


def _drilling(
    number: int,
    meaning: str,
    words: Mapping[str, int],
    *,
    needed: int = 0,
    pecking: Pecking = Pecking.NONE,
    clearance: float = CHIP_CLEARANCE,
    retract: Retract = Retract.RAPID,
    ground: Ground = "decision",
) -> GCode:
    """A cycle that drills, by its words besides Z and I."""
    cycle = Cycle(
        lasting=False,
        across=REFERENCE,
        needed=1 << BOTTOM | needed,
        pecking=pecking,
        clearance=clearance,
        retract=retract,
    )
    rule = CycleRule(f"G{number}", cycle, {**words, "I": BOTTOM})
    meaning = f"{meaning}: Z I {' '.join(words)}"
    return cycle_code(rule, meaning, lambda control: take_goal(control, arc=False).target, ground)


def _pocket(
    number: int, meaning: str, words: str, lengths: str, *, circular: bool = False
) -> GCode:
    """A cycle that mills, by its words besides Z and I; ``lengths`` are those that count lengths."""
    name = f"G{number}"
    mill = Interpolation(lambda control: mill_pocket(control, name, circular=circular))
    return GCode(
        meaning=f"{meaning}: Z I {' '.join(words)}",
        group="cycle",
        sets={"cycle": mill},
        action=lambda control: call_pocket(control, words, lengths),
        ground="manual",
    )


_DWELL = {"K": DWELL}

CYCLES = {
    80: GCode(meaning="cycles off", group="cycle", sets={"cycle": None}, ground="manual"),
    81: _drilling(81, "drilling", _DWELL, ground="manual"),
    82: _drilling(
        82,
        "drilling in variable pecks",
        {
            "B": PECK,
            "D": SURFACE,
            "R": FACTOR,
            "L": LEAST,
            "H": LIFT,
            "J": EVERY,
            "C": CLEARANCE,
            "K": DWELL,
        },
        needed=1 << PECK,
        pecking=Pecking.TO_BOTTOM,
        clearance=_CLEARANCE,
    ),
    83: _drilling(
        83,
        "deep drilling in equal pecks",
        {"J": COUNT, "D": SURFACE, "K": DWELL},
        needed=1 << COUNT,
        pecking=Pecking.COUNTED,
    ),
    84: _drilling(84, "tapping", _DWELL, retract=Retract.REVERSED),
    85: _drilling(85, "reaming, back with the feed", _DWELL, retract=Retract.FEED),
    86: _drilling(86, "boring, back with the spindle stopped", _DWELL, retract=Retract.STOPPED),
    87: _pocket(87, "rectangular pocket", "DAJKBCLHV", "DJKBCLHV"),
    88: _pocket(88, "circular pocket", "DJBCLHV", "DJBCLHV", circular=True),
}
