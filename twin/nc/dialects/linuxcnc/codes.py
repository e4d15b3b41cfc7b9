"""G codes of LinuxCNC, milling."""

from twin.nc.canonical import Corner
from twin.nc.control.codes import Action, GCode, Interpolation
from twin.nc.control.control import Control
from twin.nc.control.modal import FeedMode
from twin.nc.dialects.linuxcnc import compensation, curves, motion, offsets
from twin.nc.dialects.linuxcnc.arcs import CLOCKWISE, COUNTER_CLOCKWISE
from twin.nc.dialects.linuxcnc.cycles import CYCLES
from twin.nc.dialects.linuxcnc.memory import SYSTEMS, memory_of
from twin.nc.geometry.planes import XY, YZ, ZX, Plane
from twin.nc.iso import base
from twin.nc.iso.tool_compensation import LEFT, RIGHT

_INCH = 25.4
_LATHE = "it belongs to lathes"
_NO_UVW = "the twin's machines have no axes U, V, W"
_NO_PROBE = "nothing touches the twin's probe, and the control would stop with an alarm"


def _units(unit: float) -> Action:
    """G20, G21: lengths change their unit; a feed that was programmed before stays what it is."""

    def action(control: Control) -> None:
        offsets.refuse_in_compensation(control)
        memory = memory_of(control)
        if control.feed is not None and control.modal.unit != unit:
            memory.converted_feed = memory.converted_feed or control.feed
            control.feed *= control.modal.unit / unit
        control.modal.unit = unit

    return action


def forget_feed(control: Control) -> None:
    """G93 to G95: a feed of another block counts no more."""
    if not any(word.address == "F" for word in control.block.words):
        control.feed = memory_of(control).converted_feed = None


def change_plane(control: Control) -> None:
    """G17 to G19: not while radius compensation is in force."""
    offsets.refuse_in_compensation(control)


def corner_tolerance(control: Control) -> None:
    """G64 P Q: how far corners may be rounded; Q, for lines nearly straight, changes no path here."""
    word, straight = control.take("P"), control.take("Q")
    for each in (word, straight):
        if each is not None and control.number(each) < 0.0:
            control.fail("code-words", f"{each.text} is no distance", each)
    control.modal.corner_tolerance = float("nan") if word is None else control.length(word)


def by_interpreter(control: Control) -> None:
    """A code whose blocks the compiled tier leaves alone."""
    del control


def _motion(meaning: str, interpolation: Interpolation) -> GCode:
    return GCode(
        meaning=meaning,
        group="motion",
        sets={"interpolation": interpolation, "cycle": None},
        ground="manual",
    )


def _alone_with_axes(action: Action) -> Action:
    """A code that takes the axis words of its block, so that no motion code can stand beside it."""

    def perform(control: Control) -> None:
        if any(code.group == "motion" and not code.yields for _, code in control.codes):
            message = "two codes of the block want its axis words"
            control.fail("conflicting-codes", message, hint="write them in two blocks")
        action(control)

    return perform


def _once(meaning: str, action: Action, *, performs: bool = False) -> GCode:
    """A code of the group that is not modal."""
    if performs:
        return GCode(meaning=meaning, group="not modal", perform=action, ground="manual")
    return GCode(meaning=meaning, group="not modal", action=action, ground="manual")


def _plane(meaning: str, plane: Plane) -> GCode:
    return GCode(
        meaning=meaning,
        group="plane",
        sets={"plane": plane},
        action=change_plane,
        compiler=base.plane_effect(plane).write,
        ground="manual",
    )


def _refused(meaning: str, reason: str, group: str = "motion") -> GCode:
    return GCode(meaning=meaning, group=group, refused=reason, ground="manual")


def _feed(meaning: str, mode: FeedMode) -> GCode:
    return GCode(
        meaning=meaning, group="feed", sets={"feed_mode": mode}, action=forget_feed, ground="manual"
    )


def _compensated(meaning: str, side: float, *, by_table: bool) -> GCode:
    begin = compensation.begin_by_table if by_table else compensation.begin_by_diameter
    return GCode(meaning=meaning, group="compensation", action=begin(side), ground="manual")


MOTION = {
    0: _motion("rapid positioning", motion.RAPID),
    1: _motion("straight line", motion.FEED),
    2: _motion("arc clockwise, P turns", CLOCKWISE),
    3: _motion("arc counter-clockwise, P turns", COUNTER_CLOCKWISE),
    5: _motion("cubic spline", curves.CUBIC),
    5.1: _motion("quadratic spline", curves.QUADRATIC),
    5.2: _motion("control point of a NURBS, weight P, order L", curves.NURBS),
    33: _motion("straight line of K with each turn of the spindle", motion.THREAD),
    33.1: _motion("the same and back with the spindle reversed", motion.TAP),
    38.2: _refused("probing towards the part", _NO_PROBE),
    38.3: _motion("probing towards the part, without an alarm", motion.PROBE),
    38.4: _refused("probing away from the part", _NO_PROBE),
    38.5: _motion("probing away from the part, without an alarm", motion.PROBE),
    70: _refused("finishing cycle", _LATHE),
    71: _refused("roughing cycle", _LATHE),
    72: _refused("facing cycle", _LATHE),
    76: _refused("threading cycle", _LATHE),
    80: GCode(
        meaning="no motion: axis words need a code",
        group="motion",
        sets={"cycle": None, "interpolation": None},
        yields=True,
        ground="manual",
    ),
    **CYCLES,
    88: _refused("boring, out by hand", "the operator moves the axes by hand in it"),
}

NOT_MODAL = {
    4: GCode(
        meaning="dwell, P seconds",
        group="not modal",
        action=base.dwell("P", "G4 needs P, its seconds", "write G4 P1"),
        ground="manual",
    ),
    5.3: _once("end of a NURBS", curves.end_nurbs, performs=True),
    10: _once(
        "L2, L20 coordinate system; L1, L10, L11 tool",
        _alone_with_axes(offsets.write_table),
        performs=True,
    ),
    28: _once(
        "rapidly to the first stored position", _alone_with_axes(motion.go_home(0)), performs=True
    ),
    28.1: _once("this is the first stored position", motion.store_home(0)),
    30: _once(
        "rapidly to the second stored position", _alone_with_axes(motion.go_home(1)), performs=True
    ),
    30.1: _once("this is the second stored position", motion.store_home(1)),
    52: _once("local shift of zero", _alone_with_axes(offsets.local_offset), performs=True),
    53: _once("in machine coordinates", motion.in_machine_coordinates, performs=True),
    92: _once("this place gets these coordinates", _alone_with_axes(offsets.preset), performs=True),
    92.1: _once("no preset, its parameters become 0", offsets.end_preset),
    92.2: _once("no preset, its parameters stay", offsets.suspend_preset),
    92.3: _once("the preset is put back", offsets.restore_preset),
}

MODAL = {
    7: _refused("diameters", _LATHE, "diameter"),
    8: GCode(meaning="radii", group="diameter", refused=_LATHE, ground="manual"),
    17: _plane("plane X Y", XY),
    18: _plane("plane Z X", ZX),
    19: _plane("plane Y Z", YZ),
    17.1: _refused("plane U V", _NO_UVW, "plane"),
    18.1: _refused("plane W U", _NO_UVW, "plane"),
    19.1: _refused("plane V W", _NO_UVW, "plane"),
    20: GCode(meaning="inches", group="units", action=_units(_INCH), ground="manual"),
    21: GCode(meaning="millimetres", group="units", action=_units(1.0), ground="manual"),
    43: GCode(
        meaning="length of tool H", group="length", action=offsets.tool_length, ground="manual"
    ),
    43.1: GCode(
        meaning="tool offset by words of axes",
        group="length",
        perform=_alone_with_axes(offsets.given_tool_length),
        ground="manual",
    ),
    43.2: GCode(
        meaning="a further tool offset, H or words of axes",
        group="length",
        perform=_alone_with_axes(offsets.further_tool_length),
        ground="manual",
    ),
    49: GCode(
        meaning="no tool length", group="length", action=offsets.no_tool_length, ground="manual"
    ),
    **{
        (int(name[1:]) if name[1:].isdigit() else float(name[1:])): GCode(
            meaning=f"coordinate system {number}",
            group="offset",
            action=offsets.select_system(number),
            ground="manual",
        )
        for number, name in enumerate(SYSTEMS, 1)
    },
    61: GCode(
        meaning="exact path", group="corner", sets={"corner": Corner.EXACT_PATH}, ground="manual"
    ),
    61.1: GCode(
        meaning="exact stop", group="corner", sets={"corner": Corner.EXACT_STOP}, ground="manual"
    ),
    64: GCode(
        meaning="corners rounded, P mm at most",
        group="corner",
        sets={"corner": Corner.CONTINUOUS},
        action=corner_tolerance,
        ground="manual",
    ),
    **base.by_manual(base.DISTANCE),
    90.1: GCode(
        meaning="I J K absolute", group="centre", sets={"center_absolute": True}, ground="manual"
    ),
    91.1: GCode(
        meaning="I J K from the start of the arc",
        group="centre",
        sets={"center_absolute": False},
        ground="manual",
    ),
    93: _feed("F is the inverse of a block's minutes", FeedMode.BLOCKS_PER_MINUTE),
    94: _feed("feed per minute", FeedMode.PER_MINUTE),
    95: _feed("feed per revolution", FeedMode.PER_REVOLUTION),
    96: _refused("constant surface speed", "it turns the spindle by X, as a lathe does", "speed"),
    97: GCode(meaning="spindle speed in revolutions", group="speed", ground="manual"),
    98: GCode(
        meaning="cycles return to the height of their call",
        group="return plane",
        sets={"return_to_reference": False},
        action=by_interpreter,
        ground="manual",
    ),
    99: GCode(
        meaning="cycles return to R",
        group="return plane",
        sets={"return_to_reference": True},
        action=by_interpreter,
        ground="manual",
    ),
}

COMPENSATION = {
    40: GCode(
        meaning="radius compensation off",
        group="compensation",
        action=compensation.end,
        ground="manual",
    ),
    41: _compensated("radius compensation, tool left of the contour", LEFT, by_table=True),
    42: _compensated("radius compensation, tool right of the contour", RIGHT, by_table=True),
    41.1: _compensated("tool left of the contour, diameter D", LEFT, by_table=False),
    42.1: _compensated("tool right of the contour, diameter D", RIGHT, by_table=False),
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
