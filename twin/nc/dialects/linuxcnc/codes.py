"""G codes of LinuxCNC, milling."""

import math

from twin.nc.canonical import Corner
from twin.nc.control.codes import Action, GCode
from twin.nc.control.control import Control
from twin.nc.dialects.linuxcnc import compensation, curves, motion, offsets
from twin.nc.dialects.linuxcnc.compensation import begin_by_diameter, begin_by_table
from twin.nc.dialects.linuxcnc.cycles import CYCLES
from twin.nc.dialects.linuxcnc.memory import SYSTEMS, memory_of
from twin.nc.dialects.linuxcnc.motion import CLOCKWISE, COUNTER_CLOCKWISE
from twin.nc.geometry.planes import XY, YZ, ZX
from twin.nc.iso import base
from twin.nc.iso.declared import modal, motion_code, plane_code, refused, replacement
from twin.nc.iso.drilling.fixed_cycles import BY_HAND
from twin.nc.iso.tool_compensation import LEFT, RIGHT
from twin.nc.path.feed_rates import FeedMode

_INCH = 25.4
_LATHE = "it belongs to lathes"
_NO_UVW = "the twin's machines have no axes U, V, W"
_NO_PROBE = "nothing touches the twin's probe, and the control would stop with an alarm"


def _units(unit: float) -> Action:
    """G20, G21: lengths change their unit; a feed that was programmed before stays what it is."""

    def action(control: Control) -> None:
        if control.modal.unit != unit:
            offsets.refuse_in_compensation(control)
        memory = memory_of(control)
        if control.motion.feed is not None and control.modal.unit != unit:
            memory.converted_feed = memory.converted_feed or control.motion.feed
            control.motion.feed *= control.modal.unit / unit
        control.modal.unit = unit

    return action


def forget_feed(control: Control) -> None:
    """G93 to G95: a feed of another block counts no more."""
    if not any(word.address == "F" for word in control.block.words):
        control.motion.feed = memory_of(control).converted_feed = None


def change_plane(control: Control) -> None:
    """G17 to G19: no other plane than that of a radius compensation in force."""
    compensated = compensation.in_force(control)
    if compensated is not None and control.modal.plane is not compensated.plane:
        offsets.refuse_in_compensation(control)


def _uncompensated(what: str) -> Action:
    """What cannot change while radius compensation is in force."""
    return lambda control: offsets.refuse_in_compensation(control, f"{what} cannot change")


change_corners = _uncompensated("how corners are passed")
change_return = _uncompensated("the return plane of cycles")


def corner_tolerance(control: Control) -> None:
    """G64 P Q: how far corners may be rounded; Q, for lines nearly straight, changes no path here.

    P0 says what G64 alone does: LinuxCNC's planner (tp.c) looks at tolerances above 0 alone.
    """
    change_corners(control)
    word, straight = control.take("P"), control.take("Q")
    for each in (word, straight):
        if each is not None and control.number(each) < 0.0:
            control.fail("code-words", f"{each.text} is no distance", each)
    control.modal.corner_tolerance = (
        control.length(word) if word is not None and control.number(word) > 0.0 else math.nan
    )


def _with_axes(meaning: str, action: Action, group: str = "not modal") -> GCode:
    """A code that takes the axis words of its block, so that its block can have no motion code."""

    def perform(control: Control) -> None:
        if any(code.group == "motion" and not code.weak for _, code in control.codes):
            message = "two codes of the block want its axis words"
            control.fail("conflicting-codes", message, hint="write them in two blocks")
        action(control)

    return replacement(meaning, perform, group)


MOTION = {
    0: motion_code("rapid positioning", motion.POSITIONING),
    1: motion_code("straight line", motion.LINEAR),
    2: motion_code("arc clockwise, P turns", CLOCKWISE),
    3: motion_code("arc counter-clockwise, P turns", COUNTER_CLOCKWISE),
    5: motion_code("cubic spline", curves.CUBIC),
    5.1: motion_code("quadratic spline", curves.QUADRATIC),
    5.2: motion_code("control point of a NURBS, weight P, order L", curves.NURBS),
    33: motion_code("straight line of K with each turn of the spindle", motion.THREAD),
    33.1: motion_code("the same and back with the spindle reversed", motion.TAP),
    **refused("probing towards the part", _NO_PROBE, 38.2, group="motion"),
    38.3: motion_code("probing towards the part, without an alarm", motion.PROBE),
    **refused("probing away from the part", _NO_PROBE, 38.4, group="motion"),
    38.5: motion_code("probing away from the part, without an alarm", motion.PROBE),
    **refused("finishing cycle", _LATHE, 70, group="motion", advice="inches are G20"),
    **refused("roughing cycle", _LATHE, 71, group="motion", advice="millimetres are G21"),
    **refused("facing cycle", _LATHE, 72, group="motion"),
    **refused("threading cycle", _LATHE, 76, group="motion"),
    80: GCode(
        meaning="no motion: axis words need a code",
        group="motion",
        sets={"cycle": None, "interpolation": None},
        weak=True,
        basis="manual",
    ),
    **CYCLES,
    **refused("boring, out by hand", BY_HAND, 88, group="motion"),
}

NOT_MODAL = {
    4: modal(
        "dwell, P seconds", "not modal", base.dwell("P", "G4 needs P, its seconds", "write G4 P1")
    ),
    5.3: replacement("end of a NURBS", curves.end_nurbs, "not modal"),
    10: _with_axes("L2, L20 coordinate system; L1, L10, L11 tool", offsets.write_table),
    28: _with_axes("rapidly to the first stored position", motion.go_home(0)),
    28.1: modal("this is the first stored position", "not modal", motion.store_home(0)),
    30: _with_axes("rapidly to the second stored position", motion.go_home(1)),
    30.1: modal("this is the second stored position", "not modal", motion.store_home(1)),
    52: _with_axes("local shift of zero", offsets.local_offset),
    53: replacement("in machine coordinates", motion.in_machine_coordinates, "not modal"),
    92: _with_axes("this place gets these coordinates", offsets.preset),
    92.1: modal(
        "no preset, its parameters become 0",
        "not modal",
        offsets.change_preset(on=False, forgets=True),
    ),
    92.2: modal("no preset, its parameters stay", "not modal", offsets.change_preset(on=False)),
    92.3: modal("the preset is put back", "not modal", offsets.change_preset(on=True)),
}

MODAL = {
    **refused("diameters", _LATHE, 7, group="diameter"),
    **refused("radii", _LATHE, 8, group="diameter"),
    17: plane_code("plane X Y", XY, change_plane),
    18: plane_code("plane Z X", ZX, change_plane),
    19: plane_code("plane Y Z", YZ, change_plane),
    **refused("plane U V", _NO_UVW, 17.1, group="plane"),
    **refused("plane W U", _NO_UVW, 18.1, group="plane"),
    **refused("plane V W", _NO_UVW, 19.1, group="plane"),
    20: modal("inches", "units", _units(_INCH)),
    21: modal("millimetres", "units", _units(1.0)),
    43: modal("length of tool H", "length", offsets.tool_length),
    43.1: _with_axes("tool offset by words of axes", offsets.given_tool_length, "length"),
    43.2: _with_axes(
        "a further tool offset, H or words of axes", offsets.further_tool_length, "length"
    ),
    49: modal("no tool length", "length", offsets.end_tool_length),
    **{
        (int(name[1:]) if name[1:].isdigit() else float(name[1:])): modal(
            f"coordinate system {number}", "offset", offsets.select_system(number)
        )
        for number, name in enumerate(SYSTEMS, 1)
    },
    61: modal("exact path", "corner", change_corners, corner=Corner.EXACT_PATH),
    61.1: modal("exact stop", "corner", change_corners, corner=Corner.EXACT_STOP),
    64: modal(
        "corners rounded, P mm at most", "corner", corner_tolerance, corner=Corner.CONTINUOUS
    ),
    **base.by_manual(base.DISTANCE),
    90.1: modal("I J K absolute", "centre", center_absolute=True),
    91.1: modal("I J K from the start of the arc", "centre", center_absolute=False),
    93: modal(
        "F is the inverse of a block's minutes",
        "feed",
        forget_feed,
        feed_mode=FeedMode.BLOCKS_PER_MINUTE,
    ),
    94: modal("feed per minute", "feed", forget_feed, feed_mode=FeedMode.PER_MINUTE),
    95: modal("feed per revolution", "feed", forget_feed, feed_mode=FeedMode.PER_REVOLUTION),
    **refused(
        "constant surface speed", "it turns the spindle by X, as a lathe does", 96, group="speed"
    ),
    97: modal("spindle speed in revolutions", "speed"),
    98: modal(
        "cycles return to the height of their call",
        "return plane",
        change_return,
        return_to_reference=False,
    ),
    99: modal("cycles return to R", "return plane", change_return, return_to_reference=True),
}

COMPENSATION = {
    40: modal("radius compensation off", "compensation", compensation.end),
    41: modal(
        "radius compensation, tool left of the contour", "compensation", begin_by_table(LEFT)
    ),
    42: modal(
        "radius compensation, tool right of the contour", "compensation", begin_by_table(RIGHT)
    ),
    41.1: modal("tool left of the contour, diameter D", "compensation", begin_by_diameter(LEFT)),
    42.1: modal("tool right of the contour, diameter D", "compensation", begin_by_diameter(RIGHT)),
}

CODES: dict[float, GCode] = {**MOTION, **NOT_MODAL, **MODAL, **COMPENSATION}
START = (17, 21, 40, 49, 54, 64, 80, 90, 91.1, 94, 97, 99)
"""In force when a program starts, as ``rs274`` begins; G80: nothing moves until a code does."""
GROUPS = (
    "feed",
    "plane",
    "units",
    "compensation",
    "length",
    "offset",
    "corner",
    "distance",
    "centre",
    "return plane",
    "speed",
    "diameter",
    "not modal",
    "motion",
)
