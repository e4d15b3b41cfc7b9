"""G codes of the Fagor CNC 8070."""

import re

from twin.nc.canonical import Corner
from twin.nc.control.codes import Action, GCode
from twin.nc.control.control import Control
from twin.nc.dialects.fagor8070 import arcs, polar
from twin.nc.dialects.fagor8070.cycles.canned_cycles import CYCLES
from twin.nc.dialects.fagor8070.frames import frames, transformations
from twin.nc.dialects.fagor8070.frames.machine_coordinates import refuse_offset_change
from twin.nc.dialects.fagor8070.memory import memory_of
from twin.nc.geometry.planes import XY, YZ, ZX
from twin.nc.iso import base, offsets
from twin.nc.iso.declared import modal, motion_code, plane_code, refused, replacement
from twin.nc.iso.drilling import fixed_cycles
from twin.nc.iso.tool_compensation import LEFT, RIGHT, end_compensation
from twin.nc.path.blends import Blend, BlendKind
from twin.nc.path.feed_rates import FeedMode
from twin.nc.text.blocks import Word
from twin.nc.text.expressions.arithmetic import is_whole

_BLEND_CODES = re.compile(rb"G[ \t]*0*3[69](?![0-9])", re.IGNORECASE)


def prepare_blends(control: Control) -> None:
    """Hold moves until their successor is known, where the program blends corners at all."""
    if control.program_counter.lines.any_holds(_BLEND_CODES):
        control.path.hold_for_blends()


def blend_code(kind: BlendKind, number: int) -> Action:
    """G36 I5: the corner between the last move and the next becomes an arc of radius I.

    G39 I5: it becomes a line between the points that lie I away from it.
    """

    def action(control: Control) -> None:
        memory, word = memory_of(control), control.take("I")
        if word is not None:
            memory.blend = control.length(word)
        if memory.blend <= 0.0:
            message = f"G{number} needs I above 0, the size of the blend"
            control.fail("blend", message, word, hint=f"write G{number} I5 between two moves")
        if control.words:
            message = f"G{number} is in a block of its own between two moves"
            control.fail(
                "blend", message, hint=f"write G{number} I{memory.blend:g} in its own block"
            )
        if not control.path.hold_for_blends().blend_next(
            Blend(kind, memory.blend, control.motion.part_plane)
        ):
            control.fail("blend", "there is no move before the corner")

    return action


def plain_dwell(control: Control, word: Word) -> None:
    """G04 1.5: the seconds stand right behind the code."""
    if control.words or len(control.block.words) > 1:
        control.fail("dwell", "G04 must stand alone in its block", word)
    base.wait(control, control.number(word), word)


def auxiliary(control: Control, word: Word) -> None:
    """H: an auxiliary function of the machine."""
    number = control.number(word)
    if not is_whole(number, 999_999.0):
        message = f"{word.text} is no number of a function: whole ones up to 999999 are"
        control.fail("number-range", message, word)
    control.function(f"H{int(number)}", {})


def _forgetting_polar(action: Action) -> Action:
    """Work offsets and presets: the last R and Q no longer hold."""

    def both(control: Control) -> None:
        refuse_offset_change(control)
        action(control)
        polar.forget_polar(control)

    return both


def _passed_over(number: int, meaning: str, letters: str) -> GCode:
    """A code whose words change nothing of the path here."""

    def perform(control: Control) -> None:
        word = control.code_word(number)
        assert word is not None
        for letter in letters:
            control.take(letter)
        message = f"{word.text} does not change the path here: {meaning}"
        control.report.notice(word.text, message, word.column, word.width)

    return GCode(meaning=meaning, perform=perform, consumes=letters, basis="manual")


_PROBE = "the twin has no probe to touch with"
_LEAD = "where its arc begins is not documented well enough; write the lead as an arc"
_LIMITS = "the limits are the machine file's"
_UNKNOWN = "its effect on the path is not documented well enough to be followed"

REPLACEMENTS: dict[float, str] = {
    21: "millimetres are G71",
    28: "write G53 G00 and the axes",
    43: "D1 brings the tool's length",
    49: "D0 ends the tool's length",
    64: "G05 rounds corners, G50 keeps to the path",
    68: "a rotation is G73 Q",
    69: "a rotation ends by G73 alone",
}
"""Codes of other controls, and what this one has for them."""

CODES: dict[float, GCode] = {
    0: motion_code("rapid positioning", arcs.POSITIONING),
    1: motion_code("straight line", arcs.LINEAR),
    2: motion_code("arc clockwise, Cartesian or polar", arcs.CLOCKWISE, "control page"),
    3: motion_code(
        "arc counter-clockwise, Cartesian or polar", arcs.COUNTER_CLOCKWISE, "control page"
    ),
    4: replacement(
        "dwell, seconds in K or right behind",
        base.dwell("K", "G04 needs its seconds", "write G04 K1.5 or G04 1.5"),
    ),
    5: modal("round corner", "corner", corner=Corner.CONTINUOUS),
    6: modal("centre in absolute coordinates, this block", non_modal=True, center_absolute=True),
    7: modal("square corner", "corner", corner=Corner.EXACT_STOP),
    8: modal(
        "arc tangent to the last move, this block",
        non_modal=True,
        interpolation=arcs.TANGENT,
        cycle=None,
    ),
    9: modal(
        "arc through the point I J, this block",
        non_modal=True,
        interpolation=arcs.THREE_POINTS,
        cycle=None,
    ),
    10: modal("mirror off", action=transformations.mirror_off),
    11: modal("mirror X", action=transformations.mirror(0)),
    12: modal("mirror Y", action=transformations.mirror(1)),
    13: modal("mirror Z", action=transformations.mirror(2)),
    14: replacement("mirror the given axes: X-1", transformations.mirror_axes, basis="decision"),
    17: plane_code("plane X Y", XY, frames.choose_plane, "control page"),
    18: plane_code("plane Z X", ZX, frames.choose_plane, "control page"),
    19: plane_code("plane Y Z", YZ, frames.choose_plane, "control page"),
    20: modal("any plane: X1 Z2", "plane", frames.any_plane),
    30: modal("polar origin: I J, or where the tool is", action=polar.set_polar_origin),
    31: modal("temporary polar origin at the arc's centre", action=polar.temporary_polar_origin),
    **refused("threading", "the twin's spindle has no angle", 33),
    36: replacement(
        "corner rounded by the radius I", blend_code(BlendKind.FILLET, 36), basis="decision"
    ),
    **refused("tangential entry, tangential exit", _LEAD, *range(37, 39)),
    39: replacement(
        "corner chamfered at the distance I", blend_code(BlendKind.CHAMFER, 39), basis="decision"
    ),
    40: modal("radius compensation off", "compensation", end_compensation),
    41: modal("compensation, tool left", "compensation", frames.compensation_by_tool(LEFT)),
    42: modal("compensation, tool right", "compensation", frames.compensation_by_tool(RIGHT)),
    **refused("tangential control", "the twin has no axis that turns the tool", 45),
    50: modal("semi-rounded corner", "corner", corner=Corner.EXACT_PATH),
    51: _passed_over(51, "look-ahead of the CNC 8055: tolerance E and angle A", "AE"),
    53: modal(
        "offsets cancelled",
        "offset",
        _forgetting_polar(offsets.cancel_offset),
    ),
    **{
        n: modal(f"work offset G{n} of the job", "offset", _forgetting_polar(frames.offset_code(n)))
        for n in range(54, 60)
    },
    60: modal("square corner, this block", non_modal=True, corner=Corner.EXACT_STOP),
    61: modal("round corner, this block", non_modal=True, corner=Corner.CONTINUOUS),
    **refused("rigid tapping", "the twin's spindle has no angle", 63),
    70: modal("inches", "units", unit=25.4),
    71: modal("millimetres", "units", unit=1.0),
    72: replacement("scale S, about part zero", transformations.scale, consumes="S"),
    73: replacement("rotation by Q about I J; alone: off", transformations.rotate),
    **refused("home search", "the twin starts homed", 74),
    **CYCLES,
    90: modal("absolute coordinates", "distance", incremental=False),
    91: modal("incremental coordinates", "distance", incremental=True),
    92: replacement("preset part zero", _forgetting_polar(offsets.preset)),
    93: modal(
        "feed as seconds of the block",
        "feed",
        polar.refuse_origin_by_g93,
        feed_mode=FeedMode.SECONDS_PER_BLOCK,
    ),
    94: modal("feed per minute", "feed", feed_mode=FeedMode.PER_MINUTE),
    95: modal("feed per revolution", "feed", feed_mode=FeedMode.PER_REVOLUTION),
    **refused("constant cutting speed", "a mill's radius is the tool's", 96),
    97: modal("constant spindle speed", "spindle"),
    **fixed_cycles.RETURN,
    **refused("probing", _PROBE, *range(100, 105)),
    108: modal("feed blending at the start of the block", "feed blending"),
    109: modal("feed blending at the end of the block", "feed blending"),
    **refused("change of the parameter set", _UNKNOWN, 112),
    **refused("acceleration and jerk", _LIMITS, *range(130, 136)),
    136: modal("compensation rounds outside corners", "compensation corners", square_corners=False),
    137: modal("compensation extends outside corners", "compensation corners", square_corners=True),
    138: modal("leads of compensation go straight", "compensation leads", indirect_leads=False),
    139: modal(
        "leads of compensation go around the contour's ends",
        "compensation leads",
        basis="decision",
        indirect_leads=True,
    ),
    **refused("programming in diameters", "a mill has none", 151),
    152: modal("programming in radii", "diameters"),
    **refused("axes without offset", _UNKNOWN, 157),
    158: replacement("incremental offset", frames.incremental_offset),
    **refused(
        "multiple machining",
        "the twin has no patterns",
        *range(160, 166),
        advice="write the positions one by one",
    ),
    **refused("Hirth axes", _UNKNOWN, *range(170, 172)),
    **refused("set the machine coordinate", _UNKNOWN, 174),
    **refused("subroutines of the machine's builder", "they are not known", *range(180, 190)),
    193: modal("feed interpolation", "feed blending"),
    **refused("spindle limit", _LIMITS, 192),
    **refused("constant feed of the cutting point", _UNKNOWN, 196),
    197: modal("constant feed of the tool's centre", "feed point"),
    **refused("axis limits", _LIMITS, *range(198, 200)),
    **refused("manual intervention", "there is no operator", *range(200, 203)),
    **refused("circular probing", _PROBE, *range(210, 213)),
    261: modal("centre in absolute coordinates", "centre", center_absolute=True),
    262: modal("centre relative to the start", "centre", center_absolute=False),
    264: modal("arc centre not corrected", "centre correction", correct_center=False),
    265: modal("arc centre corrected", "centre correction", correct_center=True),
    500: _passed_over(500, "high-speed machining off", ""),
    501: _passed_over(501, "high-speed machining on: tolerance, acceleration, frequency", "AEJM"),
    **refused("feed override at 100 %", _UNKNOWN, 266),
}
