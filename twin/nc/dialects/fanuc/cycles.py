"""Canned cycles of a Fanuc control: G73, G74, G76, G80 to G89, with G98 and G99.

X and Y name the hole, Z its bottom, R the plane where the feed begins, Q the depth of a peck or the
shift of G76 and G87, P milliseconds at the bottom, K (on a Haas L) how many holes the block drills.
All but the hole stay in force until G80 or a motion code. Decisions: G73 withdraws by 0.5 mm, and
G83 stops its rapid return 0.5 mm above where it was (parameters 5114 and 5115); G76 and G87 shift
towards +X of the plane (parameter 5148).
"""

import dataclasses

from twin.nc.control.codes import GCode
from twin.nc.control.control import Control
from twin.nc.dialects.fanuc.boring import boring_code
from twin.nc.dialects.fanuc.memory import Variant
from twin.nc.dialects.fanuc.motion import target
from twin.nc.dialects.fanuc.transformations import refuse_scaled_pecks
from twin.nc.iso import base
from twin.nc.iso.fixed_cycles import BY_HAND, CYCLES, DRILLS, Drill, drilling_code
from twin.nc.path.drilling_cycle import CHIP_CLEARANCE, Retract

_DRILLS = {
    **DRILLS,
    73: Drill("deep drilling with chip breaking", dwell=True, peck=True, lift=CHIP_CLEARANCE),
    74: Drill("left-hand tapping", dwell=True, retract=Retract.REVERSED_LEFT),
    83: DRILLS[83]._replace(dwell=True),
    86: DRILLS[86]._replace(dwell=True),
}


def _unscaled(number: int, code: GCode) -> GCode:
    """The same cycle, refused under a scale."""
    action = code.action
    assert action is not None

    def call(control: Control) -> None:
        refuse_scaled_pecks(control, f"G{number}")
        action(control)

    return dataclasses.replace(code, action=call)


def cycles(variant: Variant) -> dict[float, GCode]:
    """The cycles of a control of the family."""
    made = {
        number: drilling_code(number, drill, target, "manual", variant.counting)
        for number, drill in _DRILLS.items()
    }
    return {
        **{n: _unscaled(n, code) if _DRILLS[n].peck else code for n, code in made.items()},
        **base.by_manual({80: CYCLES[80]}),
        76: boring_code(76, "fine boring, out with the tool shifted", variant),
        87: boring_code(87, "back boring, from below", variant),
        88: GCode(meaning="boring by hand", group="cycle", refused=BY_HAND, ground="manual"),
    }
