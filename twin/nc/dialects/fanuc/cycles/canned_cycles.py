"""Canned cycles of a Fanuc control: G73, G74, G76, G80 to G89, with G98 and G99.

X and Y name the hole, Z its bottom, R the plane where the feed begins, Q the depth of a peck or the
shift of G76 and G87 or of a pass of G74 and G84, P milliseconds at the bottom, K (on a Haas L) how many holes the block drills.
All but the hole stay in force until G80 or a motion code. Decisions: G73 withdraws by 0.5 mm, and
G83 stops its rapid return 0.5 mm above where it was (parameters 5114 and 5115); G76 and G87 shift
towards +X of the plane (parameter 5148).
"""

import dataclasses

from twin.nc.control.codes import GCode
from twin.nc.control.control import Control
from twin.nc.dialects.fanuc import decimal_point
from twin.nc.dialects.fanuc.cycles.boring import boring_code
from twin.nc.dialects.fanuc.frames.transformations import refuse_scaled_pecks
from twin.nc.dialects.fanuc.memory import Variant, letter_patterns, memory_of
from twin.nc.dialects.fanuc.motion import holes_of
from twin.nc.iso import base
from twin.nc.iso.drilling.drilling import Pecking
from twin.nc.iso.drilling.fixed_cycles import BY_HAND, CYCLES, DRILLS, drilling_code
from twin.nc.iso.drilling.hole import CHIP_CLEARANCE, Retract
from twin.nc.text.blocks import Block

_TAPS = {
    74: DRILLS[84]._replace(
        meaning="left-hand tapping", retract=Retract.REVERSED_LEFT, lift=CHIP_CLEARANCE
    ),
    84: DRILLS[84]._replace(lift=CHIP_CLEARANCE),
}
_DRILLS = {
    **DRILLS,
    73: DRILLS[83]._replace(
        meaning="deep drilling with chip breaking", dwell=True, lift=CHIP_CLEARANCE
    ),
    **{number: drill._replace(pecking=Pecking.PASSES) for number, drill in _TAPS.items()},
    83: DRILLS[83]._replace(dwell=True),
    86: DRILLS[86]._replace(dwell=True),
}
_HAAS_DRILLS = {
    **{number: _DRILLS[number]._replace(reduces=True) for number in (73, 83)},
    **{number: drill._replace(faster=True) for number, drill in _TAPS.items()},
}


def _unscaled(number: int, code: GCode) -> GCode:
    """A cycle that is refused under a scale, where it has pecks or passes."""
    action = code.action
    assert action is not None

    def call(control: Control) -> None:
        if (
            number not in _TAPS
            or "Q" in control.words
            or control.cycle_values.get("peck", 0.0) > 0.0
        ):
            refuse_scaled_pecks(control, f"G{number}")
        action(control)

    return dataclasses.replace(code, action=call)


def begin_rigid_tapping(control: Control) -> None:
    """M29: the next tapping cycle couples the spindle and the feed, and turns the spindle itself (manual)."""
    control.tools.rigid = True


def _always_rigid(code: GCode) -> GCode:
    """A tapping cycle that needs no M29: a Haas starts the spindle in it.

    Haas, "G84 Tapping Canned Cycle (Group 09)": that it need not be started before, since the control does so
    (of the page, the edition for lathes was at hand); G74 is taken to be its mirror.
    """
    action = code.action
    assert action is not None

    def call(control: Control) -> None:
        begin_rigid_tapping(control)
        action(control)

    return dataclasses.replace(code, action=call)


def _end_rigid_tapping(control: Control) -> None:
    control.tools.rigid = False


def cycles(variant: Variant) -> dict[float, GCode]:
    """The cycles of a control of the family."""
    drills = {**_DRILLS, **(_HAAS_DRILLS if variant.own_cycle_words else {})}
    made = {
        number: drilling_code(number, drill, holes_of(variant)) for number, drill in drills.items()
    }
    if variant.own_cycle_words:
        made |= {number: _always_rigid(made[number]) for number in _TAPS}
    return {
        **{
            number: _unscaled(number, code) if drills[number].pecking else code
            for number, code in made.items()
        },
        **base.by_manual({80: dataclasses.replace(CYCLES[80], action=_end_rigid_tapping)}),
        76: boring_code(76, "fine boring, out with the tool shifted", variant),
        87: boring_code(87, "back boring, from below", variant),
        88: GCode(meaning="boring by hand", group="cycle", refused=BY_HAND, basis="manual"),
    }


# --- a motion code behind that of a cycle

OVERRULED_CYCLE = letter_patterns(
    "G", rb"[ \t]*0*(?:7[346]|8[1-9])(?![0-9])[^\r\n]*[Gg][ \t]*0*[0-3](?![0-9])"
)
"""A motion code behind that of a cycle."""
_STRAIGHT, _ARCS = (0.0, 1.0), (2.0, 3.0)
_WORDS_OF_CYCLES = "RPQKL"


def as_read(control: Control, block: Block) -> Block:
    """A block with what its words count."""
    if memory_of(control).overrules_cycles:
        block = _without_overruled_cycle(control, block)
    return decimal_point.count(control, block)


def _without_overruled_cycle(control: Control, block: Block) -> Block:
    """Of a cycle and a straight motion in a block the last counts; a motion leaves R P Q K L out (manual).

    Raises:
        ProgramError: An arc is behind a cycle, whose R would be ambiguous; or a motion on a control of
            which it is not known what counts.
    """
    codes = [word for word in block.words if word.address == "G"]
    cycle = next((word for word in codes if word.value in decimal_point.CYCLES), None)
    behind = [] if cycle is None else codes[codes.index(cycle) + 1 :]
    motion = next((word for word in behind if word.value in (*_STRAIGHT, *_ARCS)), None)
    if cycle is None or motion is None:
        return block
    control.report.line = block.line
    if motion.value in _ARCS or not memory_of(control).variant.last_code_counts:
        message = f"{cycle.text} and {motion.text} exclude each other in this order"
        control.fail("conflicting-codes", message, motion, "write them in two blocks")
    message = f"{motion.text} behind {cycle.text} moves, and nothing is drilled"
    control.report.warn("cycle-overruled", message, motion.column, motion.width)
    words = tuple(
        word for word in block.words if word is not cycle and word.address not in _WORDS_OF_CYCLES
    )
    return block._replace(words=words)
