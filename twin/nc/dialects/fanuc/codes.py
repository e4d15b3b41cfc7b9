"""G and M codes of the Fanuc 0i-MF and 30i, milling, as far as the controls of the family share them."""

from collections.abc import Mapping

from twin.nc.canonical import Corner
from twin.nc.control.codes import GCode, MCode
from twin.nc.control.control import Control
from twin.nc.dialects.fanuc import macro_calls, motion, programs
from twin.nc.dialects.fanuc.cycles.canned_cycles import begin_rigid_tapping, cycles
from twin.nc.dialects.fanuc.frames import (
    cylinder,
    offsets,
    reference_points,
    tilted_planes,
    transformations,
)
from twin.nc.dialects.fanuc.memory import Variant, memory_of
from twin.nc.dialects.fanuc.tools import data_setting, tool_tips
from twin.nc.dialects.fanuc.tools.tool_offsets import compensation_code, end_length, length_code
from twin.nc.iso import base
from twin.nc.iso.declared import flow_function, modal, motion_code, refused, replacement
from twin.nc.iso.drilling import fixed_cycles
from twin.nc.iso.tool_compensation import LEFT, RIGHT, end_compensation
from twin.nc.path.feed_rates import FeedMode


def _lose_feed(control: Control) -> None:
    """G93 to G95: F of another mode counts no more."""
    memory, mode = memory_of(control), control.modal.feed_mode
    if mode is not memory.feed_mode:
        memory.feed_mode = mode
        if not any(word.address == "F" for word in control.block.words):
            memory.feed_lost = control.motion.feed is not None or memory.feed_lost
            control.motion.feed = None


def passed_over(meaning: str, letters: str, *, modes: tuple[float, ...] = ()) -> GCode:
    """A code whose words change nothing of the path here; of modes P others are refused, and P0 is none to be left out."""

    def perform(control: Control) -> None:
        mode, code = control.words.get("P"), control.codes[-1][0]
        left_out = mode is None and 0.0 not in modes
        if modes and not left_out and (mode is None or control.number(mode) not in modes):
            known = ", ".join(f"P{each:g}" for each in modes)
            message = f"{code.text} is followed with {known} alone"
            control.fail("unsupported-g", message, mode or code, f"{code.text} P{modes[-1]:g}")
        for letter in letters:
            control.take(letter)
        message = f"{code.text} does not change the path here: {meaning}"
        control.report.notice(code.text, message, code.column, code.width)

    return GCode(meaning=meaning, action=perform, basis="manual")


NO_PROBE = "the twin has no probe to touch with"
_TIP_LED = "G43.4 leads the tip, G234 on a Haas"
_NO_ANGLE = "the twin's spindle has no angle"
_UNKNOWN = "its effect on the path is not documented well enough to be followed"
_LIMITS = "the limits are the machine file's"

_MOTION: Mapping[float, GCode] = {
    0: motion_code("rapid positioning", motion.POSITIONING),
    1: motion_code("straight line", motion.LINEAR),
    2: motion_code("arc clockwise, by I J K or R", motion.CLOCKWISE),
    3: motion_code("arc counter-clockwise, by I J K or R", motion.COUNTER_CLOCKWISE),
    4: replacement(
        "dwell, seconds in X or milliseconds in P",
        base.dwell("PX", "G4 needs its time", "G4 P500 or G4 X0.5 waits half a second"),
    ),
    5: passed_over(
        "look-ahead (high-precision contour control): P10000 on, P0 off", "P", modes=(10000.0, 0.0)
    ),
    5.1: passed_over("look-ahead (AI contour control): Q1 on, Q0 off", "QRXYZC"),
    8: passed_over("look-ahead (advanced preview): P1 on, P0 off", "P"),
    9: modal("exact stop in this block", non_modal=True, corner=Corner.EXACT_STOP),
    61: modal("exact stop mode", "corner", corner=Corner.EXACT_STOP),
    62: modal("override at corners", "corner", corner=Corner.EXACT_PATH),
    63: modal("tapping mode", "corner", corner=Corner.EXACT_PATH),
    64: modal("cutting mode", "corner", corner=Corner.EXACT_PATH),
}
_PLACE: Mapping[float, GCode] = {
    **dict.fromkeys(
        (7.1, 107),
        replacement(
            "contours on a cylinder: rotary axis and radius, 0 ends it", cylinder.begin_or_end
        ),
    ),
    10: replacement("offsets from the program: L P and values", data_setting.set_data),
    11: passed_over("setting of data off", ""),
    15: modal("polar coordinates off", "polar", motion.end_polar),
    16: modal("polar coordinates: radius and angle", "polar", motion.begin_polar),
    **base.by_manual(base.PLANES),
    20: modal("inches", "units", unit=25.4),
    21: modal("millimetres", "units", unit=1.0),
    27: replacement("check of the reference point", reference_points.check_reference),
    28: replacement("to machine zero, by the block's point", reference_points.go_home),
    29: replacement("from machine zero, by the point of G28", reference_points.leave_reference),
    30: replacement("to a further reference point P2 P3 P4", reference_points.go_to_reference),
    52: replacement("local origin, in every work offset", offsets.local_offset),
    53: replacement("machine coordinates in this block", reference_points.machine_move),
    **{
        number: modal(f"work offset G{number} of the job", "offset", offsets.offset_code(number))
        for number in range(54, 60)
    },
    54.1: modal("work offset P1 to P300 of the job", "offset", offsets.extended_offset),
    **base.by_manual(base.DISTANCE),
    92: replacement("preset the position, in every work offset", offsets.preset),
    92.1: replacement("presets end for the axes named", offsets.end_preset),
}
_TOOL: Mapping[float, GCode] = {
    40: modal("radius compensation off", "compensation", end_compensation),
    41: modal("compensation by D, tool left", "compensation", compensation_code(41, LEFT)),
    42: modal("compensation by D, tool right", "compensation", compensation_code(42, RIGHT)),
    43: modal("tool length by H", "length", length_code(43, 1.0)),
    44: modal("tool length by H, reversed", "length", length_code(44, -1.0)),
    43.4: modal("length by H, the tip led while axes turn", "length", tool_tips.begin("G43.4")),
    43.5: modal("as G43.4, vectors I J K point the tool", "length", tool_tips.begin("G43.5")),
    49: modal("tool length off", "length", end_length),
}
_TRANSFORMATIONS: Mapping[float, GCode] = {
    50: modal("scale off", "scale", transformations.end("scale")),
    51: replacement("scale about X Y Z: P, or I J K", transformations.scale, "scale"),
    50.1: replacement("mirror off", transformations.end_mirror, "mirror"),
    51.1: replacement("mirror the axes at the places named", transformations.mirror, "mirror"),
    68: replacement("rotation by R about a point of the plane", transformations.rotate, "rotation"),
    68.2: replacement(
        "tilted plane: origin, and by P angles I J K, points or vectors",
        tilted_planes.tilt,
        "rotation",
    ),
    53.1: replacement(
        "rotary axes set the tool across the tilted plane",
        tool_tips.orient("G53.1", "G68.2 X0 Y0 Z0 I J K"),
    ),
    53.6: replacement(
        "as G53.1, about the tip of the tool",
        tool_tips.orient("G53.6", "G68.2 X0 Y0 Z0 I J K", about_tip=True),
    ),
    69: modal("rotation and tilted plane off", "rotation", tool_tips.level),
}
_FEEDS: Mapping[float, GCode] = {
    93: modal(
        "feed as blocks per minute", "feed", _lose_feed, feed_mode=FeedMode.BLOCKS_PER_MINUTE
    ),
    94: modal("feed per minute", "feed", _lose_feed, feed_mode=FeedMode.PER_MINUTE),
    95: modal("feed per revolution", "feed", _lose_feed, feed_mode=FeedMode.PER_REVOLUTION),
    97: modal("constant spindle speed", "spindle"),
    65: replacement("macro call: P L and arguments", macro_calls.refuse_late_call),
    66: modal("modal macro call behind every move", "modal call", macro_calls.refuse_late_call),
    67: modal("modal macro call off", "modal call", macro_calls.end_modal_call),
}
_REFUSED: Mapping[float, GCode] = {
    **refused("smooth and spline interpolation", _UNKNOWN, 5.4, 6.1, 6.2),
    **refused("helical and spiral interpolation in space", _UNKNOWN, 2.2, 3.2, 2.3, 3.3, 2.4, 3.4),
    **refused("polar coordinate interpolation", "a lathe's, of a rotating part", 12.1, 13.1),
    **refused("stored stroke check", _LIMITS, 22, 23),
    **refused("modal macro call in every block", _UNKNOWN, 66.1),
    **refused("skip until a signal", NO_PROBE, 31, 31.8),
    **refused("threading", _NO_ANGLE, 33),
    **refused("tool length measurement", NO_PROBE, 37),
    **refused("corner compensation", "write the arc, or ,R", 39),
    **refused(
        "tool position offset", "write the coordinates, or compensate by G41", 45, 46, 47, 48
    ),
    **refused("tool centre point control", _TIP_LED, 43.1, 43.3, 43.8, 43.9),
    **refused("normal direction control", "the twin has no axis that turns the tool", 41.1, 42.1),
    **refused("tilted plane by other forms", "G68.2 X Y Z I J K is", 68.3, 68.4),
    **refused("single direction positioning", "the backlash is the machine file's", 60),
    **refused("constant cutting speed", "a mill's radius is the tool's", 96),
}


def codes(variant: Variant) -> dict[float, GCode]:
    """The G codes that a control of the family shares with the others."""
    return {
        **_MOTION,
        **_PLACE,
        **_TOOL,
        **_TRANSFORMATIONS,
        **cycles(variant),
        **_FEEDS,
        **base.by_manual(fixed_cycles.RETURN),
        **_REFUSED,
    }


GROUPS = (
    "units",
    "plane",
    "distance",
    "feed",
    "spindle",
    "corner",
    "polar",
    "offset",
    "scale",
    "mirror",
    "rotation",
    "length",
    "modal call",
    "return plane",
    "compensation",
    "motion",
    "cycle",
)
START = (0, 15, 17, 21, 40, 49, 50, 50.1, 54, 64, 67, 69, 80, 90, 94, 97, 98)

REPLACEMENTS: Mapping[float, str] = {
    70: "inches are G20",
    71: "millimetres are G21",
    90.1: "I, J and K always count from the start of the arc",
    91.1: "I, J and K count from the start of the arc anyway: leave it out",
    158: "write G52 or G10 L2",
}
"""Codes of other controls, and what this one has for them."""

M_CODES: Mapping[int, MCode] = {
    **base.M_CODES,
    19: MCode(meaning="spindle orientation", basis="manual"),
    29: MCode(meaning="rigid tapping", action=begin_rigid_tapping, basis="manual"),
    98: flow_function("run a subprogram: P L", programs.call),
    99: flow_function("end of a subprogram, or jump: P", programs.return_),
}
