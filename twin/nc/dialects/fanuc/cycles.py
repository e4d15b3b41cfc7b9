"""Canned cycles of a Fanuc control: G73, G74, G76, G80 to G89, with G98 and G99.

X and Y name the hole, Z its bottom, R the plane where the feed begins, Q the depth of a peck or the
shift of G76 and G87, P milliseconds at the bottom, K (on a Haas L) how many holes the block drills.
All but the hole stay in force until G80 or a motion code. Decisions: G73 withdraws by 0.5 mm, and
G83 stops its rapid return 0.5 mm above where it was (parameters 5114 and 5115); G76 and G87 shift
towards +X of the plane (parameter 5148).
"""

import dataclasses
from collections.abc import Callable

from twin.nc.control.codes import GCode
from twin.nc.control.control import Control
from twin.nc.control.interpolation import CycleRule
from twin.nc.dialects.fanuc.boring import boring_code
from twin.nc.dialects.fanuc.memory import Variant
from twin.nc.dialects.fanuc.motion import target
from twin.nc.dialects.fanuc.transformations import refuse_scaled_pecks
from twin.nc.iso.drilling import cycle_code
from twin.nc.path.drilling_cycle import (
    BOTTOM,
    CHIP_CLEARANCE,
    DWELL,
    PECK,
    REFERENCE,
    Cycle,
    Pecking,
    Retract,
)


def _cycle(
    number: int,
    meaning: str,
    *,
    dwell: bool = True,
    peck: bool = False,
    lift: float = 0.0,
    retract: Retract = Retract.RAPID,
) -> Callable[[Variant], GCode]:
    words = {"R": REFERENCE, **({"P": DWELL} if dwell else {}), **({"Q": PECK} if peck else {})}
    cycle = Cycle(
        lasting=True,
        across=BOTTOM,
        needed=1 << REFERENCE | 1 << BOTTOM | peck << PECK,
        pecking=Pecking.TO_BOTTOM if peck else Pecking.NONE,
        dwells=dwell,
        retract=retract,
        lift=lift,
        clearance=CHIP_CLEARANCE,
    )

    def code(variant: Variant) -> GCode:
        made = cycle_code(
            CycleRule(f"G{number}", cycle, words),
            f"{meaning}: X Y Z {' '.join(words)} {variant.counting}",
            target,
            "manual",
            variant.counting,
        )
        return _unscaled(number, made) if peck else made

    return code


def _unscaled(number: int, code: GCode) -> GCode:
    """A cycle that is refused under a scale."""
    action = code.action
    assert action is not None

    def call(control: Control) -> None:
        refuse_scaled_pecks(control, f"G{number}")
        action(control)

    return dataclasses.replace(code, action=call)


_BY_HAND = "the operator moves the axes by hand in it"
_CYCLES: dict[int, Callable[[Variant], GCode]] = {
    73: _cycle(73, "deep drilling with chip breaking", peck=True, lift=CHIP_CLEARANCE),
    74: _cycle(74, "left-hand tapping", retract=Retract.REVERSED_LEFT),
    81: _cycle(81, "drilling", dwell=False),
    82: _cycle(82, "drilling with dwell"),
    83: _cycle(83, "deep drilling in pecks", peck=True),
    84: _cycle(84, "tapping", retract=Retract.REVERSED),
    85: _cycle(85, "reaming, back with the feed", dwell=False, retract=Retract.FEED),
    86: _cycle(86, "boring, back with the spindle stopped", retract=Retract.STOPPED),
    89: _cycle(89, "reaming with dwell", retract=Retract.FEED),
}


def cycles(variant: Variant) -> dict[float, GCode]:
    """The cycles of a control of the family."""
    return {
        **{number: make(variant) for number, make in _CYCLES.items()},
        80: GCode(meaning="cycles off", group="cycle", sets={"cycle": None}, ground="manual"),
        76: boring_code(76, "fine boring, out with the tool shifted", variant),
        87: boring_code(87, "back boring, from below", variant),
        88: GCode(meaning="boring by hand", group="cycle", refused=_BY_HAND, ground="manual"),
    }
