"""G codes of CODESYS SoftMotion."""

from twin.nc.control.codes import GCode
from twin.nc.dialects.codesys import actions, program, subprograms
from twin.nc.dialects.codesys.arcs import CLOCKWISE, COUNTER_CLOCKWISE
from twin.nc.dialects.codesys.curves import (
    CLOCKWISE_ELLIPSE,
    COUNTER_CLOCKWISE_ELLIPSE,
    FLAT_SPLINE,
    PARABOLA,
    SPATIAL_SPLINE,
)
from twin.nc.geometry.planes import XY, YZ, ZX
from twin.nc.iso import base
from twin.nc.iso.declared import modal, motion_code, plane_code, refused, replacement
from twin.nc.iso.tool_compensation import LEFT, RIGHT, end_compensation
from twin.nc.path.blends import BlendKind

_PROFILE = "what it sets in the path preprocessing has no counterpart in the twin"


CODES: dict[float, GCode] = {
    0: motion_code("positioning in a straight line; FF is its feed", base.POSITIONING),
    1: motion_code("straight line", base.LINEAR, "control page"),
    2: motion_code("arc clockwise", CLOCKWISE, "control page"),
    3: motion_code("arc counter-clockwise", COUNTER_CLOCKWISE, "control page"),
    4: replacement(
        "dwell, seconds in T", base.dwell("T", "G4 needs T, its seconds", "write G4 T1")
    ),
    5: motion_code("point of a spline in X Y", FLAT_SPLINE),
    6: motion_code("parabola: X Y, vertex I J", PARABOLA),
    8: motion_code("ellipse clockwise: X Y I J K R", CLOCKWISE_ELLIPSE),
    9: motion_code("ellipse counter-clockwise: X Y I J K R", COUNTER_CLOCKWISE_ELLIPSE),
    10: motion_code("point of a spline in space", SPATIAL_SPLINE),
    15: plane_code("2D mode: arcs in X Y", XY, actions.plane_changed),
    16: modal("3D mode, plane with normal I J K", "plane", actions.free_plane),
    17: plane_code("3D mode, plane X Y", XY, actions.plane_changed),
    18: plane_code("3D mode, plane Z X", ZX, actions.plane_changed),
    19: plane_code("3D mode, plane Y Z", YZ, actions.plane_changed),
    20: replacement(
        "jump to L (or the label L? behind) when K is not 0",
        subprograms.conditional_jump,
        consumes="L!",
    ),
    31: replacement("probe", actions.probe),
    36: replacement("write D to the variable O", program.write_variable, consumes="D"),
    37: replacement("add D to the variable O", program.add_to_variable, consumes="D"),
    **refused("state flags", _PROFILE, 38),
    **refused("parameters of the preprocessing", _PROFILE, 39),
    40: modal("radius compensation off", "compensation", end_compensation),
    41: modal(
        "radius compensation left, radius D", "compensation", actions.compensation_by_radius(LEFT)
    ),
    42: modal(
        "radius compensation right, radius D", "compensation", actions.compensation_by_radius(RIGHT)
    ),
    43: modal(
        "tool length vector I J K; the next move leads into it", "length", actions.length_vector
    ),
    50: modal("smoothing off", "smoothing", actions.keep_corners),
    51: modal(
        "corners become splines, cut at the distance D",
        "smoothing",
        actions.smooth_corners(BlendKind.SPLINE),
    ),
    52: modal(
        "corners become arcs, cut at the distance D",
        "smoothing",
        actions.smooth_corners(BlendKind.ARC),
    ),
    53: replacement("coordinate shift off", actions.reset_shift),
    54: replacement("coordinate shift, absolute", actions.shift_absolutely),
    55: replacement("coordinate shift, relative", actions.shift_relatively),
    56: replacement("set the reference here", actions.set_reference),
    60: modal("loop avoidance off", "loops", actions.keep_loops),
    61: modal("loop avoidance on: loops are cut out", "loops", actions.cut_loops),
    70: replacement(
        "additional axis L (6 is C) goes with each move; without L all",
        actions.go_as_programmed,
        consumes="L",
    ),
    71: replacement(
        "additional axis L goes evenly over the moves up to G70", actions.go_evenly, consumes="L"
    ),
    75: modal("wait for the motion before variables are read"),
    90: modal("absolute coordinates", "distance", incremental=False),
    91: modal("relative coordinates", "distance", incremental=True),
    92: replacement("position from which the path goes on", actions.set_position),
    98: modal("centre I J K absolute", "centre", basis="control page", center_absolute=True),
    99: modal(
        "centre I J K relative to the start", "centre", basis="control page", center_absolute=False
    ),
}

REPLACEMENTS: dict[float, str] = {
    **dict.fromkeys(range(80, 90), "there are no canned cycles: write their moves"),
    **dict.fromkeys((57, 58, 59), "shifts are G54 and G55 with their distances"),
    **dict.fromkeys((94, 95), "F counts units per second"),
    21: "lengths are in the axes' unit, millimetres",
    28: "write G53, then G0 and the axes",
    49: "write G43 I0 J0 K0",
}
"""Codes of other controls, and what this one has for them."""
