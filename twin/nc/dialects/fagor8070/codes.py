"""G codes of the Fagor CNC 8070."""

from collections.abc import Mapping
from typing import Unpack

from twin.nc.bytecode import opcodes
from twin.nc.bytecode.assembler import Assembler
from twin.nc.canonical import Corner
from twin.nc.control.codes import Action, CodeWriter, Effect, GCode, Interpolation
from twin.nc.control.control import Control
from twin.nc.control.modal import FeedMode, ModalChanges
from twin.nc.dialects.fagor8070 import arcs, corners, frames, polar, transformations
from twin.nc.dialects.fagor8070.cycles.canned_cycles import CYCLES
from twin.nc.dialects.fagor8070.machine_coordinates import refuse_change
from twin.nc.dialects.fagor8070.offset_table import offset_code
from twin.nc.geometry.planes import XY, YZ, ZX, Plane
from twin.nc.iso import base, fixed_cycles, offsets
from twin.nc.iso.tool_compensation import (
    END_OF_COMPENSATION,
    LEFT,
    RIGHT,
    compensation_by_tool,
)
from twin.nc.text.blocks import Word


def plain_dwell(control: Control, word: Word, assembler: Assembler) -> None:
    """G04 1.5: the seconds stand right behind the code."""
    if control.words or len(control.block.words) > 1:
        control.fail("dwell", "G04 must stand alone in its block", word)
    assembler.word_value(word)
    assembler.emit(opcodes.DWELL)


def auxiliary(_control: Control, word: Word, assembler: Assembler) -> None:
    """H: an auxiliary function of the machine."""
    assembler.word_value(word)
    assembler.emit(opcodes.AUXILIARY)


def _forgetting_polar(write: CodeWriter) -> Effect:
    """Work offsets and presets: the last R and Q no longer hold."""

    def both(control: Control, assembler: Assembler) -> None:
        assembler.disturbed(lambda: refuse_change(control))
        write(control, assembler)
        assembler.emit(opcodes.FORGET_POLAR)

    return Effect(both)


def _g(meaning: str, group: str = "", **sets: Unpack[ModalChanges]) -> GCode:
    return GCode(meaning=meaning, group=group, sets=sets, ground="manual")


def _motion(meaning: str, interpolation: Interpolation, *, seed: bool = False) -> GCode:
    return GCode(
        meaning=meaning,
        group="motion",
        sets={"interpolation": interpolation, "cycle": None},
        ground="seed" if seed else "manual",
    )


def _once(meaning: str, **sets: Unpack[ModalChanges]) -> GCode:
    return GCode(meaning=meaning, sets=sets, once=True, ground="manual")


def _plane(meaning: str, plane: Plane) -> GCode:
    return GCode(
        meaning=meaning,
        group="plane",
        sets={"plane": plane},
        action=base.plane_effect(plane),
        ground="seed",
    )


def _do(meaning: str, action: Action, *, group: str = "", takes: str = "") -> GCode:
    if takes:
        return GCode(meaning=meaning, group=group, perform=action, takes=takes, ground="manual")
    return GCode(meaning=meaning, group=group, action=action, ground="manual")


def _decided(meaning: str, action: Action) -> GCode:
    return GCode(meaning=meaning, perform=action)


def _refused(meaning: str, reason: str, numbers: Mapping[int, None] | range) -> dict[int, GCode]:
    code = GCode(meaning=meaning, refused=reason, ground="manual")
    return dict.fromkeys(numbers, code)


def _passed_over(number: int, meaning: str, letters: str) -> GCode:
    """A code whose words change nothing of the path here."""

    def perform(control: Control) -> None:
        word = control.code_word(number)
        assert word is not None
        for letter in letters:
            control.take(letter)
        message = f"{word.text} does not change the path here: {meaning}"
        control.report.notice(word.text, message, word.column, word.width)

    return GCode(meaning=meaning, perform=perform, takes=letters, ground="manual")


_PROBE = "the twin has no probe to touch with"
_LEAD = "where its arc begins is not documented well enough; write the lead as an arc"
_LIMITS = "the limits are the machine file's"
_UNKNOWN = "its effect on the path is not documented well enough to be followed"

INSTEAD: dict[float, str] = {
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
    0: _motion("rapid positioning", arcs.RAPID),
    1: _motion("straight line", arcs.FEED),
    2: _motion("arc clockwise, Cartesian or polar", arcs.CLOCKWISE, seed=True),
    3: _motion("arc counter-clockwise, Cartesian or polar", arcs.COUNTER_CLOCKWISE, seed=True),
    4: GCode(
        meaning="dwell, seconds in K or right behind",
        perform=base.dwell("K", "G04 needs its seconds", "write G04 K1.5 or G04 1.5"),
        ground="manual",
    ),
    5: _g("round corner", "corner", corner=Corner.CONTINUOUS),
    6: _once("centre in absolute coordinates, this block", center_absolute=True),
    7: _g("square corner", "corner", corner=Corner.EXACT_STOP),
    8: _once("arc tangent to the last move, this block", interpolation=arcs.TANGENT, cycle=None),
    9: _once("arc through the point I J, this block", interpolation=arcs.THREE_POINTS, cycle=None),
    10: _do("mirror off", Effect(transformations.mirror_off)),
    11: _do("mirror X", transformations.mirror(0)),
    12: _do("mirror Y", transformations.mirror(1)),
    13: _do("mirror Z", transformations.mirror(2)),
    14: _decided("mirror the given axes: X-1", Effect(transformations.mirror_axes)),
    17: _plane("plane X Y", XY),
    18: _plane("plane Z X", ZX),
    19: _plane("plane Y Z", YZ),
    20: GCode(meaning="any plane: X1 Z2", group="plane", action=frames.any_plane, ground="manual"),
    30: _do("polar origin: I J, or where the tool stands", Effect(polar.set_polar_origin)),
    31: _do("temporary polar origin at the arc's centre", polar.temporary_polar_origin),
    33: GCode(meaning="threading", refused="the twin's spindle has no angle", ground="manual"),
    36: _decided("corner rounded by the radius I", corners.round_corner),
    **_refused("tangential entry, tangential exit", _LEAD, range(37, 39)),
    39: _decided("corner chamfered at the distance I", corners.chamfer_corner),
    40: _do("radius compensation off", END_OF_COMPENSATION, group="compensation"),
    41: _do("compensation, tool left", compensation_by_tool(LEFT), group="compensation"),
    42: _do("compensation, tool right", compensation_by_tool(RIGHT), group="compensation"),
    **_refused("tangential control", "the twin has no axis that turns the tool", range(45, 46)),
    50: _g("semi-rounded corner", "corner", corner=Corner.EXACT_PATH),
    51: _passed_over(51, "look-ahead of the CNC 8055: tolerance E and angle A", "AE"),
    53: _do(
        "offsets cancelled",
        _forgetting_polar(
            lambda control, assembler: assembler.interpreted(lambda: offsets.cancel_offset(control))
        ),
        group="offset",
    ),
    **{
        number: _do(
            f"work offset G{number} of the job",
            _forgetting_polar(offset_code(number)),
            group="offset",
        )
        for number in range(54, 60)
    },
    60: _once("square corner, this block", corner=Corner.EXACT_STOP),
    61: _once("round corner, this block", corner=Corner.CONTINUOUS),
    63: GCode(meaning="rigid tapping", refused="the twin's spindle has no angle", ground="manual"),
    70: _g("inches", "units", unit=25.4),
    71: _g("millimetres", "units", unit=1.0),
    72: _do("scale S, about part zero", Effect(transformations.scale), takes="S"),
    73: GCode(
        meaning="rotation by Q about I J; alone: off",
        perform=Effect(transformations.rotate),
        ground="manual",
    ),
    74: GCode(meaning="home search", refused="the twin starts homed", ground="manual"),
    **CYCLES,
    90: _g("absolute coordinates", "distance", incremental=False),
    91: _g("incremental coordinates", "distance", incremental=True),
    92: GCode(
        meaning="preset part zero",
        perform=_forgetting_polar(offsets.preset),
        ground="manual",
    ),
    93: GCode(
        meaning="feed as seconds of the block",
        group="feed",
        sets={"feed_mode": FeedMode.SECONDS_PER_BLOCK},
        action=polar.refuse_origin_by_g93,
        ground="manual",
    ),
    94: _g("feed per minute", "feed", feed_mode=FeedMode.PER_MINUTE),
    95: _g("feed per revolution", "feed", feed_mode=FeedMode.PER_REVOLUTION),
    96: GCode(
        meaning="constant cutting speed", refused="a mill's radius is the tool's", ground="manual"
    ),
    97: _g("constant spindle speed", "spindle"),
    **fixed_cycles.RETURN,
    **_refused("probing", _PROBE, range(100, 105)),
    108: _g("feed blending at the start of the block", "feed blending"),
    109: _g("feed blending at the end of the block", "feed blending"),
    **_refused("change of the parameter set", _UNKNOWN, range(112, 113)),
    **_refused("acceleration and jerk", _LIMITS, range(130, 136)),
    136: _g("compensation rounds outside corners", "compensation corners", square_corners=False),
    137: _g("compensation extends outside corners", "compensation corners", square_corners=True),
    138: _g("leads of compensation go straight", "compensation leads", indirect_leads=False),
    139: GCode(
        meaning="leads of compensation go around the contour's ends",
        group="compensation leads",
        sets={"indirect_leads": True},
    ),
    151: GCode(meaning="programming in diameters", refused="a mill has none", ground="manual"),
    152: _g("programming in radii", "diameters"),
    157: GCode(meaning="axes without offset", refused=_UNKNOWN, ground="manual"),
    158: GCode(
        meaning="incremental offset",
        perform=Effect(frames.incremental_offset),
        ground="manual",
    ),
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
    264: _g("arc centre not corrected", "centre correction", correct_center=False),
    265: _g("arc centre corrected", "centre correction", correct_center=True),
    500: _passed_over(500, "high-speed machining off", ""),
    501: _passed_over(501, "high-speed machining on: tolerance, acceleration, frequency", "AEJM"),
    266: GCode(meaning="feed override at 100 %", refused=_UNKNOWN, ground="manual"),
}
