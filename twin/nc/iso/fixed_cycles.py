"""Drilling cycles G81 to G89 with the words of ISO 6983-1.

X and Y name the hole, Z its bottom, R the reference plane, P the seconds at the bottom, Q the depth
of one peck. All but X and Y stay in force, and every block that names a hole drills it, until G80
or a motion code. Decisions: with G91, R counts from where the tool stands and Z from R; a cycle
block without a hole drills where the tool stands; the tool returns to the height at which the cycle
was called, or with G99 to the reference plane; the plane cannot change before the cycle has ended.
"""

from twin.nc.control.codes import GCode
from twin.nc.control.interpolation import CycleRule
from twin.nc.iso.drilling import cycle_code
from twin.nc.path.drilling_cycle import BOTTOM, DWELL, PECK, REFERENCE, Cycle, Pecking, Retract


def _cycle(
    name: str,
    meaning: str,
    *,
    dwell: bool = False,
    peck: bool = False,
    retract: Retract = Retract.RAPID,
) -> GCode:
    words = {"R": REFERENCE, **({"P": DWELL} if dwell else {}), **({"Q": PECK} if peck else {})}
    cycle = Cycle(
        lasting=True,
        across=BOTTOM,
        needed=1 << REFERENCE | 1 << BOTTOM | peck << PECK,
        pecking=Pecking.TO_BOTTOM if peck else Pecking.NONE,
        dwells=dwell,
        retract=retract,
    )
    return cycle_code(CycleRule(name, cycle, words), f"{meaning}: X Y Z {' '.join(words)}")


_BY_HAND = "the operator moves the axes by hand in it"

CYCLES = {
    80: GCode(meaning="drilling cycles off", group="cycle", sets={"cycle": None}),
    81: _cycle("G81", "drilling"),
    82: _cycle("G82", "drilling with dwell", dwell=True),
    83: _cycle("G83", "deep drilling in pecks", peck=True),
    84: _cycle("G84", "tapping", dwell=True, retract=Retract.REVERSED),
    85: _cycle("G85", "reaming, back with the feed", retract=Retract.FEED),
    86: _cycle("G86", "boring, back with the spindle stopped", retract=Retract.STOPPED),
    87: GCode(meaning="boring by hand", group="cycle", refused=_BY_HAND),
    88: GCode(meaning="boring by hand with dwell", group="cycle", refused=_BY_HAND),
    89: _cycle("G89", "reaming with dwell", dwell=True, retract=Retract.FEED),
}
RETURN = {
    98: GCode(
        meaning="cycles return to the height of their call",
        group="return plane",
        sets={"return_to_reference": False},
    ),
    99: GCode(
        meaning="cycles return to the reference plane",
        group="return plane",
        sets={"return_to_reference": True},
    ),
}
