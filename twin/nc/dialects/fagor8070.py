"""Fagor CNC 8070, milling model."""

from collections.abc import Mapping

from twin.nc import iso, iso_cycles, offsets
from twin.nc.blocks import Word
from twin.nc.canonical import Corner
from twin.nc.control import Control
from twin.nc.dialect import (
    Action,
    Comment,
    Decision,
    Dialect,
    FeedMode,
    GCode,
    Mark,
    MCode,
    Syntax,
)
from twin.nc.dialects import fagor8070_arcs as arcs
from twin.nc.dialects import fagor8070_frames as frames
from twin.nc.dialects import fagor8070_program as program
from twin.nc.dialects.fagor8070_cycles import CYCLES
from twin.nc.dialects.fagor8070_memory import FagorMemory
from twin.nc.planes import XY, YZ, ZX, Plane


def dwell(control: Control) -> None:
    """G04 K: wait its seconds."""
    word = control.take("K")
    if word is None or control.number(word) < 0.0:
        control.fail("dwell", "G04 needs its seconds", word, hint="write G04 K1.5 or G04 1.5")
    control.dwell(control.number(word))


def plain_dwell(control: Control, word: Word) -> None:
    """G04 1.5: the seconds stand right behind the code."""
    if control.words or len(control.block.words) > 1:
        control.fail("dwell", "G04 must stand alone in its block", word)
    control.dwell(control.number(word))


def auxiliary(control: Control, word: Word) -> None:
    """H: an auxiliary function of the machine."""
    control.function(f"H{control.number(word):g}", {})


def _compensate(side: float) -> Action:
    def action(control: Control) -> None:
        tool = control.tools.data(control.tools.spindle)
        if tool is None:
            control.fail("no-such-tool", "compensation needs a tool, and the job has none")
        number = control.cycle_values.get("D", 1.0) if "D" not in control.words else 1.0
        offsets.compensate(control, side, tool.radius if number else 0.0)

    return action


def forget_polar_values(action: Action | None) -> Action:
    """Work offsets and presets: the last R and Q no longer hold."""

    def both(control: Control) -> None:
        if action is not None:
            action(control)
        arcs.forget_polar(control)

    return both


def _g(meaning: str, group: str = "", **sets: object) -> GCode:
    return GCode(meaning=meaning, group=group, sets=sets, ground="manual")


def _motion(meaning: str, interpolation: object, *, seed: bool = False) -> GCode:
    return GCode(
        meaning=meaning,
        group="motion",
        sets={"interpolation": interpolation, "cycle": None},
        ground="seed" if seed else "manual",
    )


def _once(meaning: str, **sets: object) -> GCode:
    return GCode(meaning=meaning, sets=sets, once=True, ground="manual")


def _plane(meaning: str, plane: Plane) -> GCode:
    return GCode(
        meaning=meaning,
        group="plane",
        sets={"plane": plane},
        action=frames.change_plane,
        ground="seed",
    )


def _do(meaning: str, action: Action, *, group: str = "", takes: str = "") -> GCode:
    if takes:
        return GCode(meaning=meaning, group=group, perform=action, takes=takes, ground="manual")
    return GCode(meaning=meaning, group=group, action=action, ground="manual")


def _refused(meaning: str, reason: str, numbers: Mapping[int, None] | range) -> dict[int, GCode]:
    code = GCode(meaning=meaning, refused=reason, ground="manual")
    return dict.fromkeys(numbers, code)


_PROBE = "the twin has no probe to touch with"
_BLEND = "corners are not blended by the twin; write the arc or the chamfer"
_LIMITS = "the limits are the machine file's"
_UNKNOWN = "its effect on the path is not documented well enough to be followed"

CODES: dict[int, GCode] = {
    0: _motion("rapid positioning", arcs.RAPID),
    1: _motion("straight line", arcs.FEED),
    2: _motion("arc clockwise, Cartesian or polar", arcs.CLOCKWISE, seed=True),
    3: _motion("arc counter-clockwise, Cartesian or polar", arcs.COUNTER_CLOCKWISE, seed=True),
    4: GCode(meaning="dwell, seconds in K or right behind", perform=dwell, ground="manual"),
    5: _g("round corner", "corner", corner=Corner.CONTINUOUS),
    6: _once("centre in absolute coordinates, this block", center_absolute=True),
    7: _g("square corner", "corner", corner=Corner.EXACT_STOP),
    8: _once("arc tangent to the last move, this block", interpolation=arcs.TANGENT, cycle=None),
    9: _once("arc through the point I J, this block", interpolation=arcs.THREE_POINTS, cycle=None),
    10: _do("mirror off", frames.mirror_off),
    11: _do("mirror X", frames.mirror_x),
    12: _do("mirror Y", frames.mirror_y),
    13: _do("mirror Z", frames.mirror_z),
    14: GCode(meaning="mirror the given axes: X-1", perform=frames.mirror_axes, ground="manual"),
    17: _plane("plane X Y", XY),
    18: _plane("plane Z X", ZX),
    19: _plane("plane Y Z", YZ),
    20: GCode(meaning="any plane: X1 Z2", group="plane", action=frames.any_plane, ground="manual"),
    30: _do("polar origin: I J, or where the tool stands", arcs.set_polar_origin),
    31: _do("temporary polar origin at the arc's centre", arcs.temporary_polar_origin),
    33: GCode(meaning="threading", refused="the twin's spindle has no angle", ground="manual"),
    **_refused("corner blend or tangential entry", _BLEND, range(36, 40)),
    40: _do("radius compensation off", offsets.end_compensation, group="compensation"),
    41: _do("compensation, tool left", _compensate(offsets.LEFT), group="compensation"),
    42: _do("compensation, tool right", _compensate(offsets.RIGHT), group="compensation"),
    **_refused("tangential control", "the twin has no axis that turns the tool", range(45, 46)),
    50: _g("semi-rounded corner", "corner", corner=Corner.EXACT_PATH),
    53: _do("offsets cancelled", forget_polar_values(offsets.cancel_offset), group="offset"),
    **{
        number: _do(
            f"work offset G{number} of the job",
            forget_polar_values(offsets.OFFSETS[number].action),
            group="offset",
        )
        for number in range(54, 60)
    },
    60: _once("square corner, this block", corner=Corner.EXACT_STOP),
    61: _once("round corner, this block", corner=Corner.CONTINUOUS),
    63: GCode(meaning="rigid tapping", refused="the twin's spindle has no angle", ground="manual"),
    70: _g("inches", "units", unit=25.4),
    71: _g("millimetres", "units", unit=1.0),
    72: _do("scale S, about part zero", frames.scale, takes="S"),
    73: GCode(
        meaning="rotation by Q about I J; alone: off", perform=frames.rotate, ground="manual"
    ),
    74: GCode(meaning="home search", refused="the twin starts homed", ground="manual"),
    **CYCLES,
    90: _g("absolute coordinates", "distance", incremental=False),
    91: _g("incremental coordinates", "distance", incremental=True),
    92: GCode(
        meaning="preset part zero",
        perform=forget_polar_values(offsets.preset),
        ground="manual",
    ),
    93: _g("feed as seconds of the block", "feed", feed_mode=FeedMode.SECONDS_PER_BLOCK),
    94: _g("feed per minute", "feed", feed_mode=FeedMode.PER_MINUTE),
    95: _g("feed per revolution", "feed", feed_mode=FeedMode.PER_REVOLUTION),
    96: GCode(
        meaning="constant cutting speed", refused="a mill's radius is the tool's", ground="manual"
    ),
    97: _g("constant spindle speed", "spindle"),
    **iso_cycles.RETURN,
    **_refused("probing", _PROBE, range(100, 105)),
    108: _g("feed blending at the start of the block", "feed blending"),
    109: _g("feed blending at the end of the block", "feed blending"),
    **_refused("change of the parameter set", _UNKNOWN, range(112, 113)),
    **_refused("acceleration and jerk", _LIMITS, range(130, 136)),
    136: _g("compensation rounds outside corners", "compensation corners", square_corners=False),
    137: _g("compensation extends outside corners", "compensation corners", square_corners=True),
    138: _g("compensation starts directly", "compensation start"),
    151: GCode(meaning="programming in diameters", refused="a mill has none", ground="manual"),
    152: _g("programming in radii", "diameters"),
    157: GCode(meaning="axes without offset", refused=_UNKNOWN, ground="manual"),
    158: GCode(meaning="incremental offset", perform=frames.incremental_offset, ground="manual"),
    **_refused("multiple machining", "write the positions one by one", range(160, 166)),
    **_refused("Hirth axes", _UNKNOWN, range(170, 172)),
    174: GCode(meaning="set the machine coordinate", refused=_UNKNOWN, ground="manual"),
    **_refused("subroutines of the machine's builder", "they are not known", range(180, 190)),
    193: _g("feed interpolation", "feed blending"),
    **_refused("spindle limit", _LIMITS, range(192, 193)),
    196: GCode(meaning="constant feed of the cutting point", refused=_UNKNOWN, ground="manual"),
    197: _g("constant feed of the tool's centre", "feed point"),
    **_refused("axis limits", _LIMITS, range(198, 200)),
    **_refused("manual intervention", "nobody stands at the twin", range(200, 203)),
    **_refused("circular probing", _PROBE, range(210, 213)),
    261: _g("centre in absolute coordinates", "centre", center_absolute=True),
    262: _g("centre relative to the start", "centre", center_absolute=False),
    264: _g("arc centre not corrected", "centre correction"),
    265: _g("arc centre corrected", "centre correction"),
    266: GCode(meaning="feed override at 100 %", refused=_UNKNOWN, ground="manual"),
}

DECISIONS = (
    Decision(
        "What do an omitted R or Q keep after a Cartesian move or a new G30?",
        "The current point's polar value about the current origin.",
        "It is identical where the last move was polar and the origin is unchanged.",
    ),
    Decision(
        "Is R0 allowed?",
        "For G00 and G01; for arcs it is a program error.",
        "The manual's own example ends with R0 Q90; an arc of radius 0 is none.",
    ),
    Decision(
        "What if a helix's end point and pitch disagree?",
        "The end point and the height win, whole turns = nearest fit, with a warning.",
        "The end point is what the next block relies on.",
    ),
    Decision(
        "How does the rotary axis C read G90 targets?",
        "As commanded (linear-like); the machine option module_rotary makes the sign the "
        "direction, by less than one turn.",
        "The axis type is a machine parameter.",
    ),
    Decision(
        "What is R in an arc block?",
        "Beside a coordinate of the plane the circle's radius, without one the polar radius.",
        "The forms of the manual differ in nothing else.",
    ),
    Decision(
        "When does G30 in a motion block take effect?",
        "Before the motion.",
        "It says where the block's R and Q are measured from.",
    ),
    Decision(
        "Which sign has a helix's pitch?",
        "None: the height gives the direction.",
        "The manual's height -90 with K17 is legal.",
    ),
    Decision(
        "What does G53 do?",
        "Coordinates count from machine zero until the next work offset.",
        "The quick reference calls it the cancelling of offsets.",
    ),
    Decision(
        "How does G50 pass corners?",
        "On the exact path; G05 may round them by the machine's tolerance, G07 stops.",
        "G50 goes on when the theoretical move has ended, without waiting for the position.",
    ),
    Decision(
        "How does compensation (G137) pass outside corners?",
        "Between lines that turn by 90 degrees or less the parallels are extended until they meet; "
        "other corners are rolled around, and with G136 all of them.",
        "A longer extension leaves the contour without need.",
    ),
    Decision(
        "How often does NR run a block?",
        "As often as it says, the block's own run included.",
        "A number of repetitions of 1 is a block that runs.",
    ),
    Decision(
        "What if a $CASE runs into the next?",
        "A program error that asks for $BREAK.",
        "The manual's examples all end with $BREAK.",
    ),
    Decision(
        "What if a rotation (G73) begins while another is in force?",
        "A program error.",
        "Adding and replacing are both known among controls.",
    ),
    Decision(
        "Which way do arcs turn in G20?",
        "G03 turns from the abscissa towards the ordinate.",
        "It is so in G17, G18 and G19.",
    ),
    Decision(
        "What if the program ends without M30?",
        "Its last line ends it, with a warning.",
        "Nothing else can follow.",
    ),
    Decision(
        "What does D name?",
        "D1 is the tool's own length and radius, D0 none; M06 brings D1.",
        "The job's tools have one offset each.",
    ),
)

FAGOR8070 = Dialect(
    name="fagor8070",
    title="Fagor CNC 8070 (milling)",
    code_page="cp1252",
    syntax=Syntax(
        address=(
            r"G0*4(?=[ \t]+[0-9.])|G263[ \t]*=|G159[ \t]*=|R1[ \t]*="
            r"|[XYZABCUVW]1?[ \t]*=|NR|[A-Z]"
        ),
        comments=(Comment("(", ")"), Comment(";")),
        expressions=program.EXPRESSIONS,
        statement=program.STATEMENT,
        named_labels=True,
        incremental_suffix=True,
        aliases={
            **{f"{axis}1": axis for axis in "XYZABCUVW"},
            **{f"G{'0' * zeros}4": "G04" for zeros in range(4)},
        },
    ),
    groups=(
        "units",
        "plane",
        "distance",
        "centre",
        "feed",
        "corner",
        "offset",
        "return plane",
        "compensation corners",
        "compensation",
        "motion",
        "cycle",
    ),
    g=CODES,
    start=(1, 17, 40, 50, 71, 80, 90, 94, 97, 98, 108, 137, 138, 152, 197, 262, 265),
    m={
        **iso.M_CODES,
        6: MCode(meaning="tool change", action=frames.change_tool, ground="manual"),
        17: MCode(
            meaning="end of subroutine",
            late=True,
            action=program.return_,
            silent=True,
            ground="manual",
        ),
        19: MCode(meaning="spindle orientation", ground="manual"),
        29: MCode(
            meaning="end of subroutine",
            late=True,
            action=program.return_,
            silent=True,
            ground="manual",
        ),
        **{number: MCode(meaning="spindle gear", ground="manual") for number in range(41, 45)},
    },
    motion_words=frozenset("XYZABCUVWIJKRQ") | {"R1"},
    repeat_word="NR",
    words={
        "F": iso.set_feed,
        "S": iso.set_spindle,
        "T": frames.select_tool,
        "D": frames.tool_offset,
        "H": auxiliary,
        "G04": plain_dwell,
        "G159": frames.numbered_offset,
        "G263": arcs.set_circle_radius,
    },
    statements=program.STATEMENTS,
    other_statement=program.other_statement,
    word_meanings={
        "N": "block number",
        "G": "preparatory code",
        **{
            axis: f"{axis} axis; {axis}1= and a trailing I (incremental) too"
            for axis in "XYZABCUVW"
        },
        "I": "centre along X; abscissa of G30; depth of a cycle",
        "J": "centre along Y; ordinate of G30; number of pecks",
        "K": "centre along Z; pitch of a helix; seconds of G04 and of a cycle",
        "R": "polar radius; radius of the arc where a coordinate of the plane stands beside it",
        "R1": "radius of the arc, in force as G263=",
        "Q": "polar angle; direction of a chord; angle of G73",
        "F": "feed",
        "S": "spindle speed; scale of G72",
        "T": "tool",
        "D": "tool offset: 1, or 0 for none",
        "H": "auxiliary function",
        "M": "machine function",
        "NR": "how often the block runs",
        "G04": "seconds of a dwell",
        "G159": "number of a work offset",
        "G263": "radius of the arcs that follow",
    },
    units="mm, degrees; F in mm/min, for rotary axes alone in deg/min",
    decisions=DECISIONS,
    marks=(
        Mark(r"\bR[ \t]*[\d.]+.*\bQ[ \t]*-?[\d.]+", "polar coordinates R and Q"),
        Mark(r"\bG0*(?:30|31|26[1-5])\b", "G30, G31, G261 to G265"),
        Mark(r"^[^\"$]*;", "a comment after ;"),
        Mark(r"\$(?:IF|ELSE|ENDIF|WHILE|DO|ENDDO|FOR|SWITCH|GOTO)\b(?!\$)", "$IF, $WHILE, $GOTO"),
        Mark(r"#(?:RPT|TIME|CALL|PCALL|MCALL|RET|COMMENT)\b", "#RPT, #CALL, #TIME"),
        Mark(r"\bP\d+[ \t]*=", "P1= (a parameter)"),
        Mark(r"\b[XYZC]-?[\d.]+I(?![\d-])", "X20I (one word incremental)"),
        Mark(r"\b[XYZ]1[ \t]*=", "X1="),
    ),
    start_state={"square_corners": True},
    memory=FagorMemory,
    before_motion=frames.turn_in_commanded_direction,
    read_variable=program.read_variable,
    prepare=program.begin,
    after_motion=program.call_after_motion,
    finish=program.warn_of_missing_end,
)
