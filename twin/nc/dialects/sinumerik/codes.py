"""G codes of the SINUMERIK, those with a number and those with a name."""

import tomllib
from collections.abc import Mapping
from functools import partial
from pathlib import Path

from twin.nc.canonical import Corner
from twin.nc.control.codes import Action, GCode
from twin.nc.control.control import Control
from twin.nc.dialects.sinumerik import arcs, frames, orientation, words
from twin.nc.dialects.sinumerik.leads import LEADS
from twin.nc.dialects.sinumerik.targets import forget_polar, set_pole
from twin.nc.geometry.planes import XY, YZ, ZX
from twin.nc.iso.declared import modal, motion_code, plane_code, refused, replacement
from twin.nc.iso.machine_coordinates import machine_frame
from twin.nc.iso.tool_compensation import LEFT, RIGHT
from twin.nc.path.feed_rates import FeedMode

_DATA: Mapping[str, Mapping[str, str]] = tomllib.loads(
    Path(__file__).with_name("known.toml").read_text(encoding="utf-8")
)


def _each(of_names: Mapping[str, str]) -> dict[str, str]:
    """What is said of every name, given that of names with commas between them."""
    return {name: said for names, said in of_names.items() for name in names.split(", ")}


PASSED_CODES, REFUSED_CODES = _DATA["passed_codes"], _DATA["refused_codes"]
"""What is said of codes that the twin passes over or refuses, by their names with commas between them."""
PASSED_STATEMENTS = _each(_DATA["passed_statements"])
REFUSED_STATEMENTS = _each(_DATA["refused_statements"])
"""What is said of statements, by each name."""


def to_reference(number: int) -> Action:
    """Decision: both lie at machine zero, as the machine data have it in the state of delivery.

    The values of the words do not count; ``Z1=0`` names the axis of the machine.
    """

    def action(control: Control) -> None:
        control.take("FP")
        for name in control.settings.axes.names:
            word = control.take(f"{name}1")
            if word is not None:
                control.words[name] = word._replace(address=name)
        words = dict(control.take_axis_words())
        if not words:
            message = f"G{number} needs the axes that it moves"
            control.fail("reference-axes", message, hint=f"write G{number} Z1=0")
        with machine_frame(control, f"G{number}"):
            target = list(control.motion.programmed)
            for axis in words:
                target[axis] = 0.0
            control.line_to(target, rapid=True)
        forget_polar(control)

    return action


_ACTING = (
    *("CIP", "CT", "TRANS", "ATRANS", "ROT", "AROT", "SCALE", "ASCALE", "MIRROR", "AMIRROR"),
    *("SUPA", "NORM", "KONT", "ORIWKS", "ORIMKS", "ORIVECT", "ORIPLANE", "ORIAXES"),
)
_NAMED = (*_ACTING, *PASSED_CODES, *REFUSED_CODES)
NUMBERS = {
    name: float(1001 + place) for place, names in enumerate(_NAMED) for name in names.split(", ")
}
"""The number that the table has for a code that is written by its name; those of which the same is said share one."""


def _number(names: str) -> float:
    return NUMBERS[names.split(", ", maxsplit=1)[0]]


def _passed(names: str, why: str) -> GCode:
    """Codes that change nothing of the path here."""

    def action(control: Control) -> None:
        word = control.code_word(_number(names))
        assert word is not None
        message = f"{word.text} does not change the path here: {why}"
        control.report.notice(word.text, message, word.column, word.width)

    return modal(f"passed over ({names}): {why}", action=action)


def _frame(meaning: str, change: frames.Change, *, additive: bool = False) -> GCode:
    return replacement(meaning, frames.frame_code(change, additive=additive))


def _machine_code(code: str) -> GCode:
    """G53, G153, SUPA: for its block."""
    return GCode(
        meaning="this block counts from machine zero, without any frame",
        action=frames.machine_position(code),
        after_motion=frames.leave_machine_position,
        non_modal=True,
        basis="manual",
    )


def _work_offset(number: int) -> GCode:
    return modal(f"work offset G{number} of the job", "offset", frames.work_offset(number))


def _corner(meaning: str, corner: Corner) -> GCode:
    return modal(meaning, "corner", corner=corner)


_ROUND = "rounds corners as far as the machine file's tolerance, or ADIS="
_SPINDLE = "the twin's spindle has no angle"
_TAPPING = "CYCLE84 and CYCLE840 tap"
_UNITS: Action = words.keep_feed

CODES: dict[float, GCode] = {
    0: motion_code("rapid positioning", arcs.POSITIONING),
    1: motion_code("straight line; ANG= with one coordinate", arcs.LINEAR),
    2: motion_code("arc clockwise: centre, CR=, AR= or polar; TURN=", arcs.CLOCKWISE),
    3: motion_code("arc counter-clockwise", arcs.COUNTER_CLOCKWISE),
    4: replacement("dwell, seconds in F or revolutions in S", words.dwell, consumes="FS"),
    **refused("path across two axes of a slanting machine", "the axes stand square", 5, 7),
    9: modal("exact stop, this block", non_modal=True, corner=Corner.EXACT_STOP),
    17: plane_code("plane X Y", XY, words.choose_plane),
    18: plane_code("plane Z X", ZX, words.choose_plane),
    19: plane_code("plane Y Z", YZ, words.choose_plane),
    **refused(
        "limits of the working area or of the spindle", "they are the machine file's", 25, 26
    ),
    **refused("threading", _SPINDLE, 33, 34, 35, advice=_TAPPING),
    40: modal("radius compensation off", "compensation", words.end_compensation),
    41: modal("compensation, tool left", "compensation", words.compensation(LEFT)),
    42: modal("compensation, tool right", "compensation", words.compensation(RIGHT)),
    53: _machine_code("G53"),
    **{number: _work_offset(number) for number in range(54, 58)},
    58: replacement("shift of the frame along single axes", frames.translate_axes(fine=False)),
    59: replacement("fine shift of the frame along single axes", frames.translate_axes(fine=True)),
    60: _corner("exact stop", Corner.EXACT_STOP),
    62: modal("slower at inside corners: no change here", "corner override"),
    **refused("tapping without an encoder", _SPINDLE, 63, advice=_TAPPING),
    64: _corner(_ROUND, Corner.CONTINUOUS),
    70: modal("lengths in inches, feeds as before", "units", _UNITS, unit=25.4),
    71: modal("lengths in millimetres, feeds as before", "units", _UNITS, unit=1.0),
    74: replacement("rapidly to the reference points of the axes", to_reference(74)),
    75: replacement("rapidly to the fixed point of the axes", to_reference(75)),
    90: modal("absolute coordinates", "distance", incremental=False),
    91: modal("incremental coordinates", "distance", incremental=True),
    93: modal(
        "feed as the inverse of the block's minutes", "feed", feed_mode=FeedMode.BLOCKS_PER_MINUTE
    ),
    94: modal("feed per minute", "feed", feed_mode=FeedMode.PER_MINUTE),
    95: modal("feed per revolution", "feed", feed_mode=FeedMode.PER_REVOLUTION),
    **refused("constant cutting speed", "a mill's radius is the tool's", 96, 961, 962),
    97: modal("constant spindle speed", "spindle"),
    **{
        number: replacement(f"pole of AP= and RP=, from {place}", partial(set_pole, number))
        for number, place in enumerate(("where the tool stands", "zero", "the pole before"), 110)
    },
    140: modal("smooth leads come from the side of the tool", "lead side"),
    **refused("direction of smooth leads", "they come from the side of the tool", 141, 142, 143),
    340: modal("smooth leads fall and rise in space", "leads"),
    341: modal("smooth leads lie in the plane", "leads"),
    **LEADS,
    153: _machine_code("G153"),
    290: modal("the control's own language", "language"),
    **refused(
        "ISO language",
        "programs of the ISO mode are another language; --dialect fanuc reads them",
        291,
    ),
    **refused("tapping", _SPINDLE, 331, 332, advice=_TAPPING),
    450: modal("compensation rounds outside corners", "compensation corners", square_corners=False),
    451: modal(
        "compensation goes to the intersection", "compensation corners", square_corners=True
    ),
    460: modal("leads of compensation are watched", "compensation watch"),
    **refused(
        "leads of compensation beyond the contour", "write the lead so that it fits", 461, 462
    ),
    500: modal("no work offset", "offset", frames.cancel_offsets),
    **{n: modal("how exactly G9 and G60 stop", "exact stop") for n in (601, 602, 603)},
    621: modal("slower at all corners: no change here", "corner override"),
    **{n: _corner(_ROUND, Corner.CONTINUOUS) for n in (641, 642, 643, 644, 645)},
    700: modal("lengths and feeds in inches", "units", _UNITS, unit=25.4),
    710: modal("lengths and feeds in millimetres", "units", _UNITS, unit=1.0),
    **refused("codes of the machine's builder", "they are not known", *range(810, 830)),
    NUMBERS["CIP"]: motion_code("arc through a point between: I1= J1= K1=", arcs.THREE_POINTS),
    NUMBERS["CT"]: motion_code("arc tangent to the move before", arcs.TANGENT),
    NUMBERS["TRANS"]: _frame("shift of the frame", frames.translation),
    NUMBERS["ATRANS"]: _frame("shift on top of the frame", frames.translation, additive=True),
    NUMBERS["ROT"]: _frame("turn of the frame; RPL= in the plane", frames.rotation),
    NUMBERS["AROT"]: _frame("turn on top of the frame", frames.rotation, additive=True),
    NUMBERS["SCALE"]: _frame("scale of the frame", frames.scaling),
    NUMBERS["ASCALE"]: _frame("scale on top of the frame", frames.scaling, additive=True),
    NUMBERS["MIRROR"]: _frame("mirror of the frame", frames.mirroring),
    NUMBERS["AMIRROR"]: _frame("mirror on top of the frame", frames.mirroring, additive=True),
    NUMBERS["SUPA"]: _machine_code("SUPA"),
    **{
        NUMBERS[name]: modal(meaning, group, orientation.interpolate(name))
        for name, (meaning, group) in orientation.INTERPOLATIONS.items()
    },
    NUMBERS["NORM"]: modal(
        "leads of compensation go straight", "compensation leads", indirect_leads=False
    ),
    NUMBERS["KONT"]: modal(
        "leads of compensation go around the contour's ends",
        "compensation leads",
        indirect_leads=True,
    ),
    **{_number(names): _passed(names, why) for names, why in PASSED_CODES.items()},
    **{
        _number(names): GCode(meaning=names, refused=why, basis="manual")
        for names, why in REFUSED_CODES.items()
    },
}

REPLACEMENTS: dict[float, str] = {
    20: "inches are G70 or G700",
    21: "millimetres are G71 or G710",
    28: "write SUPA G0 and the axes, or G74 Z1=0",
    43: "D1 brings the tool's length",
    49: "D0 ends the tool's length",
    68: "a rotation is ROT RPL= or ROT Z",
    69: "a rotation ends by ROT alone",
    80: "a modal cycle ends by MCALL alone",
    **{number: f"the cycle is CYCLE{number}(...)" for number in range(81, 90)},
    92: "write TRANS, or a work offset of the job",
    98: "the cycle's RTP says where it returns to",
    99: "the cycle's RTP says where it returns to",
}
"""Codes of other controls, and what this one has for them."""
