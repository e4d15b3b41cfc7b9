"""G codes of CODESYS SoftMotion."""

from twin.nc.control.codes import Effect, GCode, Interpolation
from twin.nc.dialects.codesys import actions, jumps, program
from twin.nc.dialects.codesys.arcs import CLOCKWISE, COUNTER_CLOCKWISE
from twin.nc.dialects.codesys.curves import (
    CLOCKWISE_ELLIPSE,
    COUNTER_CLOCKWISE_ELLIPSE,
    FLAT_SPLINE,
    PARABOLA,
    SPATIAL_SPLINE,
)
from twin.nc.geometry.planes import XY, YZ, ZX, Plane
from twin.nc.iso import base
from twin.nc.iso.tool_compensation import (
    END_OF_COMPENSATION,
    LEFT,
    RIGHT,
    compensation_by_radius,
)
from twin.nc.path.blends import BlendKind


def _motion(meaning: str, interpolation: Interpolation, *, seed: bool = False) -> GCode:
    return GCode(
        meaning=meaning,
        group="motion",
        sets={"interpolation": interpolation},
        ground="seed" if seed else "manual",
    )


def _plane(meaning: str, plane: Plane) -> GCode:
    return GCode(
        meaning=meaning,
        group="plane",
        sets={"plane": plane},
        action=actions.plane_changed,
        compiler=base.plane_effect(plane).write,
        ground="manual",
    )


_PROFILE = "what it sets in the path preprocessing has no counterpart in the twin"


CODES: dict[float, GCode] = {
    0: _motion("positioning in a straight line; FF is its feed", base.RAPID),
    1: _motion("straight line", base.FEED, seed=True),
    2: _motion("arc clockwise", CLOCKWISE, seed=True),
    3: _motion("arc counter-clockwise", COUNTER_CLOCKWISE, seed=True),
    4: GCode(
        meaning="dwell, seconds in T",
        perform=base.dwell("T", "G4 needs T, its seconds", "write G4 T1"),
        ground="manual",
    ),
    5: _motion("point of a spline in X Y", FLAT_SPLINE),
    6: _motion("parabola: X Y, vertex I J", PARABOLA),
    8: _motion("ellipse clockwise: X Y I J K R", CLOCKWISE_ELLIPSE),
    9: _motion("ellipse counter-clockwise: X Y I J K R", COUNTER_CLOCKWISE_ELLIPSE),
    10: _motion("point of a spline in space", SPATIAL_SPLINE),
    15: _plane("2D mode: arcs in X Y", XY),
    16: GCode(
        meaning="3D mode, plane with normal I J K",
        group="plane",
        action=actions.free_plane,
        ground="manual",
    ),
    17: _plane("3D mode, plane X Y", XY),
    18: _plane("3D mode, plane Z X", ZX),
    19: _plane("3D mode, plane Y Z", YZ),
    20: GCode(
        meaning="jump to L (or the label L? behind) when K is not 0",
        perform=Effect(jumps.conditional_jump),
        takes="L!",
        ground="manual",
    ),
    31: GCode(meaning="probe", perform=actions.probe, ground="manual"),
    36: GCode(
        meaning="write D to the variable O",
        perform=Effect(program.write_variable),
        takes="D",
        ground="manual",
    ),
    37: GCode(
        meaning="add D to the variable O",
        perform=Effect(program.add_to_variable),
        takes="D",
        ground="manual",
    ),
    38: GCode(meaning="state flags", refused=_PROFILE, ground="manual"),
    39: GCode(meaning="parameters of the preprocessing", refused=_PROFILE, ground="manual"),
    40: GCode(
        meaning="radius compensation off",
        group="compensation",
        action=END_OF_COMPENSATION,
        ground="manual",
    ),
    41: GCode(
        meaning="radius compensation left, radius D",
        group="compensation",
        action=compensation_by_radius(LEFT),
        ground="manual",
    ),
    42: GCode(
        meaning="radius compensation right, radius D",
        group="compensation",
        action=compensation_by_radius(RIGHT),
        ground="manual",
    ),
    43: GCode(
        meaning="tool length vector I J K; the next move leads into it",
        group="length",
        action=actions.length_vector,
        ground="manual",
    ),
    50: GCode(
        meaning="smoothing off",
        group="smoothing",
        action=actions.keep_corners,
        ground="manual",
    ),
    51: GCode(
        meaning="corners become splines, cut at the distance D",
        group="smoothing",
        action=actions.smooth_corners(BlendKind.SPLINE),
        ground="manual",
    ),
    52: GCode(
        meaning="corners become arcs, cut at the distance D",
        group="smoothing",
        action=actions.smooth_corners(BlendKind.ARC),
        ground="manual",
    ),
    53: GCode(
        meaning="coordinate shift off",
        perform=Effect(actions.reset_shift),
        ground="manual",
    ),
    54: GCode(
        meaning="coordinate shift, absolute",
        perform=Effect(actions.shift_absolutely),
        ground="manual",
    ),
    55: GCode(
        meaning="coordinate shift, relative", perform=actions.shift_relatively, ground="manual"
    ),
    56: GCode(
        meaning="set the reference here",
        perform=Effect(actions.set_reference),
        ground="manual",
    ),
    60: GCode(
        meaning="loop avoidance off", group="loops", action=actions.keep_loops, ground="manual"
    ),
    61: GCode(
        meaning="loop avoidance on: loops are cut out",
        group="loops",
        action=actions.cut_loops,
        ground="manual",
    ),
    70: GCode(
        meaning="additional axis L (6 is C) goes with each move; without L all",
        perform=actions.go_as_programmed,
        takes="L",
        ground="manual",
    ),
    71: GCode(
        meaning="additional axis L goes evenly over the moves up to G70",
        perform=actions.go_evenly,
        takes="L",
        ground="manual",
    ),
    75: GCode(meaning="wait for the motion before variables are read", ground="manual"),
    90: GCode(
        meaning="absolute coordinates",
        group="distance",
        sets={"incremental": False},
        ground="manual",
    ),
    91: GCode(
        meaning="relative coordinates",
        group="distance",
        sets={"incremental": True},
        ground="manual",
    ),
    92: GCode(
        meaning="position from which the path goes on",
        perform=actions.set_position,
        ground="manual",
    ),
    98: GCode(
        meaning="centre I J K absolute",
        group="centre",
        sets={"center_absolute": True},
        ground="seed",
    ),
    99: GCode(
        meaning="centre I J K relative to the start",
        group="centre",
        sets={"center_absolute": False},
        ground="seed",
    ),
}

INSTEAD: dict[float, str] = {
    **dict.fromkeys(range(80, 90), "there are no canned cycles: write their moves"),
    **dict.fromkeys((57, 58, 59), "shifts are G54 and G55 with their distances"),
    **dict.fromkeys((94, 95), "F counts units per second"),
    21: "lengths are in the axes' unit, millimetres",
    28: "write G53, then G0 and the axes",
    49: "write G43 I0 J0 K0",
}
"""Codes of other controls, and what this one has for them."""
