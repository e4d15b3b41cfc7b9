"""Grbl 1.1: a declared subset of RS274/NGC for three axes, without cycles, macros and tool changes."""

from twin.nc.canonical import Corner
from twin.nc.control.codes import Action, Codes, GCode, MCode, Words
from twin.nc.control.control import Control, Rules
from twin.nc.control.dialect import Dialect
from twin.nc.control.modal import ArcRule
from twin.nc.dialects.grbl import coordinates
from twin.nc.dialects.grbl.decisions import DECISIONS
from twin.nc.dialects.grbl.memory import SYSTEMS, GrblMemory
from twin.nc.geometry.arcs import Bounds
from twin.nc.geometry.planes import XY, YZ, ZX
from twin.nc.iso import base, shared_marks
from twin.nc.iso.circular import both_senses, iso_arc, refuse_missing_center
from twin.nc.iso.declared import modal, motion_code, plane_code, refused, replacement
from twin.nc.path.feed_rates import FeedMode
from twin.nc.text.blocks import Word
from twin.nc.text.syntax import HEADING, Comment, Mark, Syntax

JUNCTION_DEVIATION = 0.010
"""Setting $11 as it comes from its maker [mm]."""
BOUNDS = Bounds(mismatch=0.005, mismatch_share=0.001, shift=0.5, shift_share=0.01)
"""How badly a centre may fit (``gcode.c``: 0.005 mm, or 0.1 % of the radius)."""
LARGEST_TOOL = 255
"""``MAX_TOOL_NUMBER``."""
_INCH = 25.4
_NO_PROBE = "nothing touches the twin's probe, and the control would stop with an alarm"


def _units(unit: float) -> Action:
    """G20, G21: a feed that was programmed before stays what it is."""

    def action(control: Control) -> None:
        if control.motion.feed is not None:
            control.motion.feed *= control.modal.unit / unit
        control.modal.unit = unit

    return action


def _forget_feed(control: Control) -> None:
    """G93 and G94: behind the other one a feed counts no more."""
    if not any(word.address == "F" for word in control.block.words):
        control.motion.feed = None


def _set_feed(control: Control, word: Word) -> None:
    """F: the feed; F0 is none."""
    feed = control.number(word)
    if feed < 0.0:
        control.fail("feed-range", f"the feed {word.text} is negative", word, base.POSITIVE_FEED)
    control.motion.feed = feed or None


def _note_tool(control: Control, word: Word) -> None:
    """T: a number that Grbl reports and does nothing with."""
    number = control.number(word)
    if not 0.0 <= number <= LARGEST_TOOL or number != int(number):
        message = f"{word.text} is no tool number from 0 to {LARGEST_TOOL}"
        control.fail("tool-number", message, word)
    control.function(f"T{int(number)}", {})


def _with_axes(meaning: str, action: Action, group: str = "not modal") -> GCode:
    """A code that takes the axis words of its block, so that its block can have no motion code."""

    def perform(control: Control) -> None:
        if any(code.group == "motion" for _, code in control.codes):
            message = "two codes of the block want its axis words"
            control.fail("conflicting-codes", message, hint="write them in two blocks")
        action(control)

    return replacement(meaning, perform, group)


POSITIONING, LINEAR = base.straight(
    lambda control, rapid: control.line_to(control.target(), rapid=rapid)
)


def _arc(control: Control, rule: ArcRule) -> None:
    """G2, G3: a centre coordinate outside the plane is passed over, as Grbl does (gcode.c, "Arc Center Format"); posts write K0."""
    by_radius = "R" in control.words
    iso_arc(control, rule)
    if not by_radius:
        for letter in "IJK":
            control.take(letter)


CLOCKWISE, COUNTER_CLOCKWISE = both_senses(_arc, ArcRule(bounds=BOUNDS), refuse_missing_center)

CODES: dict[float, GCode] = {
    0: motion_code("rapid positioning", POSITIONING),
    1: motion_code("straight line", LINEAR),
    2: motion_code("arc clockwise", CLOCKWISE),
    3: motion_code("arc counter-clockwise", COUNTER_CLOCKWISE),
    4: modal(
        "dwell, P seconds", "not modal", base.dwell("P", "G4 needs P, its seconds", "write G4 P1")
    ),
    10: _with_axes("L2, L20: zero of coordinate system P", coordinates.write_system),
    17: plane_code("plane X Y", XY),
    18: plane_code("plane Z X", ZX),
    19: plane_code("plane Y Z", YZ),
    20: modal("inches", "units", _units(_INCH)),
    21: modal("millimetres", "units", _units(1.0)),
    28: _with_axes("rapidly to the first stored position", coordinates.go_home(0)),
    28.1: modal("this is the first stored position", "not modal", coordinates.store_home(0)),
    30: _with_axes("rapidly to the second stored position", coordinates.go_home(1)),
    30.1: modal("this is the second stored position", "not modal", coordinates.store_home(1)),
    **refused("probing", _NO_PROBE, 38.2, 38.3, 38.4, 38.5, group="motion"),
    40: modal("no radius compensation: the only mode", "compensation"),
    43.1: _with_axes("length of the tool by Z", coordinates.tool_length, "length"),
    49: modal("no tool length", "length", coordinates.end_tool_length),
    53: replacement("in machine coordinates", coordinates.in_machine_coordinates, "not modal"),
    **{
        int(name[1:]): modal(
            f"coordinate system {number}", "offset", coordinates.select_system(number)
        )
        for number, name in enumerate(SYSTEMS, 1)
    },
    61: modal("exact path: the only mode", "corner"),
    80: GCode(
        meaning="no motion: axis words need a code",
        group="motion",
        sets={"interpolation": None},
        basis="manual",
    ),
    **base.by_manual(base.DISTANCE),
    91.1: modal("I J K from the start of the arc: the only mode", "centre"),
    92: _with_axes("this place gets these coordinates", coordinates.preset),
    92.1: modal("no preset", "not modal", coordinates.end_preset),
    93: modal(
        "F is the inverse of a block's minutes",
        "feed",
        _forget_feed,
        feed_mode=FeedMode.BLOCKS_PER_MINUTE,
    ),
    94: modal("feed per minute", "feed", _forget_feed, feed_mode=FeedMode.PER_MINUTE),
}

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
    "not modal",
    "motion",
)
"""In the order in which they take effect (``gc_execute_line``)."""
START = (0, 17, 21, 40, 49, 54, 61, 90, 91.1, 94)
"""In force behind a reset (``gc_init``)."""


def _function(meaning: str, group: str) -> MCode:
    """An M function that is carried out before the block moves."""
    return MCode(meaning=meaning, group=group, basis="manual")


def _end(meaning: str) -> MCode:
    return MCode(meaning=meaning, group="stop", after_motion=True, ends=True, basis="manual")


M_CODES = {
    0: MCode(meaning="program stop", group="stop", after_motion=True, basis="manual"),
    1: MCode(meaning="optional stop: passed over", group="stop", silent=True, basis="manual"),
    2: _end("end of program"),
    3: _function("spindle clockwise", "spindle"),
    4: _function("spindle counter-clockwise", "spindle"),
    5: _function("spindle stop", "spindle"),
    7: _function("mist on", ""),
    8: _function("coolant on", ""),
    9: _function("coolant off", "coolant"),
    30: _end("end of program and back to its start"),
}

GRBL = Dialect(
    name="grbl",
    title="Grbl 1.1 (three axes)",
    code_page="cp1252",
    syntax=Syntax(
        comments=(Comment("(", ")", holds_opening=True), Comment(";"), HEADING),
        statement=r"\$",
        blanks_in_numbers=True,
    ),
    codes=Codes(
        groups=GROUPS,
        g=CODES,
        replacements={
            41: "Grbl has no radius compensation: let the post compensate",
            42: "Grbl has no radius compensation: let the post compensate",
            43: "the length of a tool is G43.1 Z",
            64: "Grbl passes corners by its junction deviation",
            **dict.fromkeys(
                (73, 81, 82, 83, 85, 86, 89, 98, 99),
                "Grbl has no canned cycles: let the post write the moves (FreeCAD: --translate_drill)",
            ),
            95: "F is a feed per minute (G94) or an inverse time (G93)",
            90.1: "I, J and K count from the start of the arc, G91.1",
        },
        function_replacements={
            6: "Grbl has no tool changer: M0 stops for a change by hand",
            98: "Grbl has no subprograms: let the post write them out",
            99: "Grbl has no subprograms: let the post write them out",
            106: "a laser or a fan of Marlin: M3 S turns a laser on",
            107: "a laser or a fan of Marlin: M5 turns a laser off",
        },
        start=START,
        m=M_CODES,
        statements={"$": coordinates.run_command},
        start_state={"corner": Corner.CONTINUOUS, "corner_tolerance": JUNCTION_DEVIATION},
    ),
    words=Words(
        actions={
            "F": _set_feed,
            "S": base.spindle_speed,
            "T": _note_tool,
            **dict.fromkeys("ABCUVW", coordinates.refuse_axis),
        },
        motion=frozenset("XYZIJKR"),
        before_codes=True,
        meanings={
            "N": "line number",
            "G": "preparatory code",
            "X": "X axis",
            "Y": "Y axis",
            "Z": "Z axis",
            **dict.fromkeys("ABCUVW", "axis that Grbl does not have"),
            "I": "centre along X, from the start of the arc",
            "J": "centre along Y",
            "K": "centre along Z",
            "R": "radius of the arc, negative: the larger of the two",
            "P": "seconds of a dwell; number of a coordinate system (G10)",
            "L": "kind of G10",
            "F": "feed",
            "S": "spindle speed",
            "T": "tool, which nothing changes",
            "M": "machine function",
        },
    ),
    rules=Rules(
        memory=GrblMemory,
        before_motion=coordinates.check_feed,
        prepare=coordinates.begin,
        length_by_code=True,
    ),
    units="mm or inches (G20); F per minute",
    decisions=DECISIONS,
    marks=(
        Mark(
            r"^[ \t]*\$(?:[HXCGI#$]|RST=[$#*]|J=.*)[ \t]*(?:[;(].*)?$",
            "$H, $X, $J= (a command in a line of its own)",
        ),
        shared_marks.POINT_CODES,
        shared_marks.SEMICOLON,
        shared_marks.STORED_POSITION_OR_PROBE,
    ),
)
