"""Drilling cycles G81 to G89 with the words of ISO 6983-1.

X and Y name the hole, Z its bottom, R the reference plane, P the seconds at the bottom, Q the depth
of one peck. All but X and Y stay in force, and every block that names a hole drills it, until G80
or a motion code. Decisions: with G91, R counts from where the tool is and Z from R; a cycle
block without a hole drills where the tool is; the tool returns to the height at which the cycle
was called, or with G99 to the reference plane; the plane cannot change before the cycle has ended.
"""

from typing import NamedTuple

from twin.nc.control.codes import GCode
from twin.nc.iso.drilling.drilling import ONE_HOLE, Cycle, Holes, Pecking, cycle_code
from twin.nc.iso.drilling.hole import Retract


class Drill(NamedTuple):
    """What a cycle does at its hole; its words besides Z, R, and the place follow from that.

    Attributes:
        dwell: It waits at the bottom, P.
        pecking: How it goes down; by pecks or passes of Q, if not at once.
        lift: How far it withdraws between them [mm]; 0: to the reference plane.
        reduces: Its pecks may become less deep: I the first, J less each time, K the least, in place of Q.
        faster: J says how many times as fast a tap comes back.
    """

    meaning: str
    dwell: bool = False
    pecking: Pecking = Pecking.NONE
    lift: float = 0.0
    retract: Retract = Retract.RAPID
    reduces: bool = False
    faster: bool = False


DRILLS = {
    81: Drill("drilling"),
    82: Drill("drilling with dwell", dwell=True),
    83: Drill("deep drilling in pecks", pecking=Pecking.TO_BOTTOM),
    84: Drill("tapping", dwell=True, retract=Retract.REVERSED),
    85: Drill("reaming, back with the feed", retract=Retract.FEED),
    86: Drill("boring, back with the spindle stopped", retract=Retract.STOPPED),
    89: Drill("reaming with dwell", dwell=True, retract=Retract.FEED),
}


def drilling_code(number: int, drill: Drill, holes: Holes = ONE_HOLE) -> GCode:
    """The code of a cycle."""
    words = {"R": "reference"}
    if drill.dwell:
        words["P"] = "dwell"
    if drill.pecking:
        words["Q"] = "peck"
    if drill.reduces:
        words |= {"I": "first", "J": "reduction", "K": "least"}
    if drill.faster:
        words["J"] = "faster"
    pecks = drill.pecking is Pecking.TO_BOTTOM and not drill.reduces
    cycle = Cycle(
        name=f"G{number}",
        words=words,
        needed=("reference", "bottom", *(("peck",) if pecks else ())),
        pecking=drill.pecking,
        dwells=drill.dwell,
        retract=drill.retract,
        lift=drill.lift,
    )
    meaning = " ".join([f"{drill.meaning}: X Y Z", *words, *holes.repeats])
    return cycle_code(cycle, meaning, holes)


BY_HAND = "the operator moves the axes by hand in it"

CYCLES = {
    80: GCode(meaning="drilling cycles off", group="cycle", sets={"cycle": None}),
    **{number: drilling_code(number, drill) for number, drill in DRILLS.items()},
    87: GCode(meaning="boring by hand", group="cycle", refused=BY_HAND),
    88: GCode(meaning="boring by hand with dwell", group="cycle", refused=BY_HAND),
}
RETURN: dict[float, GCode] = {
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
