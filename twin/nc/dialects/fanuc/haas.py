"""What the mills of Haas do differently: codes, circular pockets, decisions."""

import dataclasses
from collections.abc import Mapping

from twin.nc.control.codes import GCode, MCode
from twin.nc.control.control import Control
from twin.nc.control.dialect import Decision
from twin.nc.dialects.fanuc import programs
from twin.nc.dialects.fanuc.codes import GROUPS as FANUC_GROUPS
from twin.nc.dialects.fanuc.codes import M_CODES, NO_PROBE, codes, passed_over
from twin.nc.dialects.fanuc.cycles.bolt_holes import bolt_holes
from twin.nc.dialects.fanuc.decisions import DECISIONS as FANUC_DECISIONS
from twin.nc.dialects.fanuc.frames import offsets, tilted_planes, transformations
from twin.nc.dialects.fanuc.memory import HAAS
from twin.nc.dialects.fanuc.tools import tool_tips
from twin.nc.dialects.fanuc.tools.tool_offsets import radius_in_force
from twin.nc.geometry.planes import XY
from twin.nc.iso.declared import flow_function, modal, refused, replacement
from twin.nc.iso.tool_change import change_tool_at

_LACKING = (
    *(5, 5.1, 7.1, 8, 15, 16, 27, 30, 43.4, 43.5, 50.1, 51.1, 53.1, 53.6),
    *(54.1, 62, 63, 68.2, 68.3, 68.4, 87, 92.1),
)
"""Codes that the control lacks."""


def circular_pocket(control: Control, *, clockwise: bool) -> None:
    """G12, G13: mill a round pocket about where the tool is.

    I is the radius of the first circle, K that of the last, Q what each is larger, Z the depth that is
    plunged to first, L how many depths (in G91), D the tool. From the centre a half circle leads to
    each circle's start at +X, and one back to the centre at the end.
    """
    first, last, step = control.take("I"), control.take("K"), control.take("Q")
    depth, count = control.take("Z"), control.take("L")
    if first is None:
        message = "a circular pocket needs I, the radius of its circle"
        control.fail("cycle-word", message, hint="G12 I10. Z-5. D1 F100. mills one of radius 10")
    if control.path.compensation.in_force:
        message = (
            "a circular pocket takes the radius of D itself, and radius compensation is in force"
        )
        control.fail("compensation-change", message, hint="end it by G40 first")
    if control.modal.plane is not XY:
        control.fail("cycle-plane", "a circular pocket lies in the plane X Y", hint="write G17")
    if step is not None and last is None:
        message = "Q makes circles larger up to the radius K, which is missing"
        control.fail("cycle-word", message, step)
    tool = radius_in_force(control)
    radii = [control.length(first)]
    if last is not None:
        if step is None or control.length(step) <= 0.0:
            control.fail("cycle-word", "a pocket to the radius K needs Q above 0", last)
        if control.length(last) <= radii[0]:
            message = "the radius K of the last circle is no larger than I, that of the first"
            control.fail("cycle-size", message, last)
        while radii[-1] < control.length(last):
            radii.append(min(radii[-1] + control.length(step), control.length(last)))
            if len(radii) > control.settings.step_limit:
                control.fail("endless-program", "the pocket has too many circles", step)
    if radii[0] <= tool:
        message = f"the circle of {radii[0]:g} mm is no larger than the tool of {tool:g} mm radius"
        control.fail("cycle-size", message, first)
    often = 1 if count is None else programs.whole(control, count, "repeat-count", "count")
    if often < 1:
        control.fail("repeat-count", "a pocket is milled once at least", count)
    for number in range(often):
        if depth is not None and (number == 0 or control.modal.incremental):
            there = list(control.motion.programmed)
            height = control.length(depth)
            there[2] = height + (there[2] if control.modal.incremental else 0.0)
            control.line_to(there, rapid=False)
        _circles(control, [radius - tool for radius in radii], clockwise=clockwise)


def _circles(control: Control, radii: list[float], *, clockwise: bool) -> None:
    x, y = control.motion.programmed[:2]
    half = -180.0 if clockwise else 180.0
    at = 0.0
    for radius in radii:
        _arc(control, x + radius, y, (x + (at + radius) / 2.0, y), half if not at else None)
        _arc(control, x + radius, y, (x, y), 2.0 * half)
        at = radius
    _arc(control, x, y, (x + at / 2.0, y), half)


def _arc(
    control: Control, x: float, y: float, center: tuple[float, float], sweep: float | None
) -> None:
    """To a place by an arc in the plane X Y, or straight."""
    there = list(control.motion.programmed)
    there[0], there[1] = x, y
    if sweep is None:
        control.line_to(there, rapid=False)
    else:
        control.arc_to(there, center, sweep)


def _pocket(meaning: str, *, clockwise: bool) -> GCode:
    return replacement(
        f"{meaning}: I K Q Z L D",
        lambda control: circular_pocket(control, clockwise=clockwise),
        basis="decision",
    )


def _offset(number: int) -> GCode:
    pair = number - 109

    def action(control: Control) -> None:
        offsets.select(control, offsets.further(control, pair), control.code_word(number))

    return modal(f"work offset G154 P{pair} of the job", "offset", action)


_FIRST_HOLE = "the manual leaves open whether its first hole is where the tool stands; write the positions one by one"

_OWN: Mapping[float, GCode] = {
    12: _pocket("circular pocket clockwise", clockwise=True),
    13: _pocket("circular pocket counter-clockwise", clockwise=False),
    100: dataclasses.replace(
        codes(HAAS)[50.1], meaning="mirror off", group="mirror", perform=transformations.end_mirror
    ),
    101: dataclasses.replace(codes(HAAS)[51.1], meaning="mirror the axes at the places named"),
    103: passed_over("limit of the blocks that are looked ahead", "P"),
    154: modal("work offset P1 to P99 of the job", "offset", offsets.extended_offset),
    187: passed_over(
        "smoothness: P1 rough, P2 medium, P3 finish, E deviation at corners",
        "PE",
        modes=(1.0, 2.0, 3.0),
    ),
    **{number: _offset(number) for number in range(110, 130)},
    **refused("engraving", "the shapes of its letters are the control's own", 47),
    **refused("general pocket", "it clears any outline by a path that is the control's own", 150),
    **{number: bolt_holes(number) for number in (70, 71)},
    **refused("bolt holes on a line", _FIRST_HOLE, 72),
    **refused("probing", NO_PROBE, 35, 36, 136),
    **refused("compensation in space", "G234 leads the tip", 141, 143),
    234: modal("length by H, the tip led while axes turn", "length", tool_tips.begin("G234")),
    254: modal(
        "work offset goes with the turned part", "dynamic offset", tool_tips.begin_dynamic_offset
    ),
    255: modal("G254 off", "dynamic offset", tool_tips.end_dynamic_offset),
    253: replacement(
        "rotary axes set the tool across the plane of G268",
        tool_tips.orient("G253", "G268 X0 Y0 Z0 I J K Q123"),
    ),
    268: replacement(
        "tilted plane: origin, turns I J K in the order of Q",
        tilted_planes.tilt_by_order,
        "rotation",
    ),
    269: modal("G268 off", "rotation", tool_tips.level),
    **refused("feed on the cylinder", "write the rotary axis itself, with G93", 107),
    **refused("left-hand and any-direction tapping", "the tool stays along Z", 174, 184),
    **refused("back boring, boring by hand", "write its moves", 77),
}


def haas_codes() -> dict[float, GCode]:
    """The G codes of the control."""
    shared = {n: code for n, code in codes(HAAS).items() if n not in _LACKING}
    return {**shared, **_OWN}


GROUPS = (*FANUC_GROUPS, "dynamic offset")
START = (0, 17, 21, 40, 49, 50, 54, 64, 67, 69, 80, 90, 94, 97, 98, 100, 255)
REPLACEMENTS: Mapping[float, str] = {
    15: "the control has no polar coordinates",
    16: "write X and Y: the control has no polar coordinates",
    30: "G28, or G53 and the axes",
    51.1: "a mirror is G101",
    54.1: "further work offsets are G154 P",
    50.1: "a mirror ends by G100",
    43.4: "the tip is led by G234",
    **dict.fromkeys(
        (5, 5.1, 8, 61.1),
        "Fanuc's high speed: G187 P1 to P3 is the smoothness here, or leave it out",
    ),
}

_CHANGE_HEIGHT = 0.0
"""M6 takes Z to machine zero before the tool changes [mm]."""


def _with_words(meaning: str, letters: str) -> MCode:
    """A function of the machine with words of its own, which change nothing of the path."""

    def action(control: Control) -> None:
        for letter in letters:
            control.take(letter)

    return MCode(meaning=f"{meaning}: {' '.join(letters)}", action=action, basis="manual")


def _refused_function(meaning: str, reason: str) -> MCode:
    """A function that decides how the program goes on by what the twin does not have."""

    def action(control: Control) -> None:
        word = next((each for each in control.block.words if each.address == "M"), None)
        control.fail(
            "unknown-m", f"{'' if word is None else word.text} ({meaning}): {reason}", word
        )

    return MCode(meaning=f"{meaning}; refused: {reason}", action=action, basis="manual")


_NO_INPUTS = "the twin has no inputs to ask"

HAAS_M_CODES: Mapping[int, MCode] = {
    **M_CODES,
    6: dataclasses.replace(M_CODES[6], action=change_tool_at(_CHANGE_HEIGHT), basis="manual"),
    97: flow_function("run blocks of this program as a subprogram: P L", programs.call_block),
    46: _refused_function("jump where a pallet is loaded", "the twin has no pallets"),
    78: _refused_function("alarm where a probe has touched", NO_PROBE),
    79: _refused_function("alarm where no probe has touched", NO_PROBE),
    96: _refused_function("jump where an input is off", _NO_INPUTS),
    109: _refused_function("question to the operator", _NO_INPUTS),
    59: _with_words("output relay on", "P"),
    69: _with_words("output relay off", "P"),
    70: _with_words("vice clamped", "P"),
    71: _with_words("vice unclamped", "P"),
    138: _with_words("spindle speed swings by E every P", "EP"),
    **{number: _with_words("oil pulses", "P") for number in (161, 162, 163)},
    **{
        number: MCode(meaning=meaning, basis="manual")
        for number, meaning in {
            10: "brake of the fourth axis on",
            11: "brake of the fourth axis off",
            12: "brake of the fifth axis on",
            13: "brake of the fifth axis off",
            **{
                number: f"relay {number} on, and waiting for its answer" for number in range(21, 29)
            },
            31: "chip conveyor forward",
            33: "chip conveyor stop",
            34: "coolant nozzle up",
            35: "coolant nozzle down",
            36: "pallet: waiting for its part",
            41: "low gear",
            42: "high gear",
            **{number: f"relay {number - 30} on" for number in range(51, 57)},
            **{number: f"relay {number - 40} off" for number in range(61, 67)},
            73: "air blast through the spindle on",
            74: "air blast through the spindle off",
            76: "screen off",
            77: "screen on",
            80: "door open",
            81: "door closed",
            83: "air on",
            84: "air off",
            88: "coolant through the spindle on",
            89: "coolant through the spindle off",
            90: "input of a fixture's clamp watched",
            91: "input of a fixture's clamp passed over",
            95: "sleep",
            104: "arm of the probe out",
            105: "arm of the probe in",
            130: "picture or film on the screen",
            131: "picture or film off the screen",
            139: "spindle speed swings no more",
            158: "mist extractor on",
            159: "mist extractor off",
            160: "oil pulses off",
            180: "side door open",
            181: "side door closed",
        }.items()
    },
}
"""M codes of the control."""

_SHARED_EXAMPLES = {
    "feed_of_another_mode",
    "rapids_go_straight",
    "exact_path",
    "arc_centre_moved_to_fit",
    "compensation_start",
    "compensation_corners",
    "narrow_contour",
    "work_offsets",
    "chip_clearance",
    "main_ends_by_m99",
    "kept_variables",
    "stops_by_variable",
    "angles",
    "timers",
    "radius_changes",
    "lines_of_screens",
}
DECISIONS: tuple[Decision, ...] = (
    Decision(
        "What does a number without a decimal point count?",
        "Least increments: 0.001 mm, 0.0001 inch, 0.001 degree; F too, 0.001 mm/min. "
        'decimal_point = "calculator" of the job or the machine file lets it count whole units. The '
        "first one is warned of.",
        "Settings 77 and 162 are so when a control comes from its maker.",
        example="decimal_point",
    ),
    Decision(
        "What does P of a dwell count?",
        "Milliseconds without a decimal point, seconds with one.",
        "The manual says so of G4; cycles follow it.",
        example="dwell",
    ),
    Decision(
        "Which codes are in force when a program starts?",
        "G0 G17 G21 G40 G49 G50 G54 G64 G67 G69 G80 G90 G94 G97 G98 G100.",
        "Setting 9, inches or millimetres, is the machine's: here it is millimetres.",
        example="start_state",
    ),
    Decision(
        "Where does a tool change?",
        "M6 takes Z to machine zero first, or to tool_change.height of the job or the machine file; where nobody "
        "says where the part stands, it changes where it is.",
        "The manual lets M6 go to the position of the tool change by itself; without a part zero nobody knows how "
        "far that is.",
        example="tool_change_height",
    ),
    Decision(
        "How does G12 or G13 mill its pocket?",
        "A half circle from the centre to +X, the circle, straight out by Q to the next one, and a "
        "half circle back to the centre; D's radius is taken from each.",
        "The manual shows the leads and leaves their shape to the control.",
        example="circular_pocket",
    ),
    Decision(
        "What do the settings of G92, G52 and D say?",
        "G52 and G92 shift every work offset (setting 33: FANUC); D holds radii (setting 40).",
        "Settings decide.",
        example="settings",
    ),
    Decision(
        "Which G28 cancels the tool length?",
        "Every one, whatever axes it names, until the next G43, G44 or H.",
        "The manual says that G28 cancels tool lengths for the lines that follow, and excepts no axis.",
        example="length_behind_g28",
    ),
    Decision(
        "What does R of G68 count from in G91?",
        "From the plane's first axis, as in G90; over a rotation in force with a warning.",
        "Setting 73, G68 incremental angle, is OFF when a control comes from its maker.",
        example="rotation_is_absolute",
    ),
    Decision(
        "How does the tool change sides, G42 while G41 is in force?",
        "Along the move of G42: it begins beside the contour on the old side and ends beside it on the new one; an "
        "arc is a spiral then.",
        "The manual says so of a move; it names no arc.",
        example="side_changes",
    ),
    *(each for each in FANUC_DECISIONS if each.example in _SHARED_EXAMPLES),
)
