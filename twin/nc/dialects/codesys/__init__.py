"""CODESYS SoftMotion CNC (DIN 66025 with SoftMotion's own codes)."""

from twin.nc import iso, offsets
from twin.nc.blends import BlendKind
from twin.nc.canonical import Corner
from twin.nc.dialect import (
    HEADING,
    Comment,
    Dialect,
    FeedMode,
    GCode,
    Interpolation,
    Mark,
    MCode,
    Syntax,
)
from twin.nc.dialects.codesys import codes, jumps, program, subprograms, words
from twin.nc.dialects.codesys.arcs import CLOCKWISE, COUNTER_CLOCKWISE
from twin.nc.dialects.codesys.codes import ADDITIONAL
from twin.nc.dialects.codesys.curves import (
    CLOCKWISE_ELLIPSE,
    COUNTER_CLOCKWISE_ELLIPSE,
    FLAT_SPLINE,
    PARABOLA,
    SPATIAL_SPLINE,
)
from twin.nc.dialects.codesys.decisions import DECISIONS
from twin.nc.linear import rapid_line
from twin.nc.planes import XY, YZ, ZX, Plane


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
        action=offsets.refuse_plane_change,
        ground="manual",
    )


RAPID = Interpolation(rapid_line, rapid=True)
"""Its pace may follow F (``words.before_motion``): no plain block."""

_PROFILE = "what it sets in the path preprocessing has no counterpart in the twin"


CODESYS = Dialect(
    name="codesys",
    title="CODESYS SoftMotion CNC (DIN 66025)",
    code_page="cp1252",
    syntax=Syntax(
        address=r"FF|EF|[FE][XYZABCPQUVW](?![A-Z])|P[ABCPQUVW](?![A-Z])|L[?!]|[A-Z]",
        comments=(Comment("(*", "*)"), Comment("(", ")"), Comment("//"), HEADING),
        expressions=program.EXPRESSIONS,
        statement=program.STATEMENT,
        several_blocks=True,
        trailing_prose=True,
    ),
    groups=(
        "plane",
        "distance",
        "centre",
        "offset",
        "length",
        "compensation",
        "smoothing",
        "loops",
        "motion",
    ),
    g={
        0: _motion("positioning in a straight line; FF is its feed", RAPID),
        1: _motion("straight line", iso.FEED, seed=True),
        2: _motion("arc clockwise", CLOCKWISE, seed=True),
        3: _motion("arc counter-clockwise", COUNTER_CLOCKWISE, seed=True),
        4: GCode(meaning="dwell, seconds in T", perform=codes.dwell, ground="manual"),
        5: _motion("point of a spline in X Y", FLAT_SPLINE),
        6: _motion("parabola: X Y, vertex I J", PARABOLA),
        8: _motion("ellipse clockwise: X Y I J K R", CLOCKWISE_ELLIPSE),
        9: _motion("ellipse counter-clockwise: X Y I J K R", COUNTER_CLOCKWISE_ELLIPSE),
        10: _motion("point of a spline in space", SPATIAL_SPLINE),
        15: _plane("2D mode: arcs in X Y", XY),
        16: GCode(
            meaning="3D mode, plane with normal I J K",
            group="plane",
            action=codes.free_plane,
            ground="manual",
        ),
        17: _plane("3D mode, plane X Y", XY),
        18: _plane("3D mode, plane Z X", ZX),
        19: _plane("3D mode, plane Y Z", YZ),
        20: GCode(
            meaning="jump to L (or the label L? behind) when K is not 0",
            perform=jumps.conditional_jump,
            takes="L!",
            ground="manual",
        ),
        31: GCode(meaning="probe", perform=codes.probe, ground="manual"),
        36: GCode(
            meaning="write D to the variable O",
            perform=program.write_variable,
            takes="D",
            ground="manual",
        ),
        37: GCode(
            meaning="add D to the variable O",
            perform=program.add_to_variable,
            takes="D",
            ground="manual",
        ),
        38: GCode(meaning="state flags", refused=_PROFILE, ground="manual"),
        39: GCode(meaning="parameters of the preprocessing", refused=_PROFILE, ground="manual"),
        40: GCode(
            meaning="radius compensation off",
            group="compensation",
            action=offsets.end_compensation,
            ground="manual",
        ),
        41: GCode(
            meaning="radius compensation left, radius D",
            group="compensation",
            action=codes.left_of_contour,
            ground="manual",
        ),
        42: GCode(
            meaning="radius compensation right, radius D",
            group="compensation",
            action=codes.right_of_contour,
            ground="manual",
        ),
        43: GCode(
            meaning="tool length vector I J K",
            group="length",
            action=codes.length_vector,
            ground="manual",
        ),
        50: GCode(
            meaning="smoothing off",
            group="smoothing",
            action=codes.keep_corners,
            ground="manual",
        ),
        51: GCode(
            meaning="corners become splines, cut at the distance D",
            group="smoothing",
            action=codes.smooth_corners(BlendKind.SPLINE),
            ground="manual",
        ),
        52: GCode(
            meaning="corners become arcs, cut at the distance D",
            group="smoothing",
            action=codes.smooth_corners(BlendKind.ARC),
            ground="manual",
        ),
        53: GCode(meaning="coordinate shift off", perform=codes.reset_shift, ground="manual"),
        54: GCode(
            meaning="coordinate shift, absolute", perform=codes.shift_absolutely, ground="manual"
        ),
        55: GCode(
            meaning="coordinate shift, relative", perform=codes.shift_relatively, ground="manual"
        ),
        56: GCode(meaning="set the reference here", perform=codes.set_reference, ground="manual"),
        60: GCode(
            meaning="loop avoidance off", group="loops", action=codes.keep_loops, ground="manual"
        ),
        61: GCode(
            meaning="loop avoidance on: loops are cut out",
            group="loops",
            action=codes.cut_loops,
            ground="manual",
        ),
        70: GCode(
            meaning="additional axis L (6 is C) goes with each move; without L all",
            perform=codes.go_as_programmed,
            takes="L",
            ground="manual",
        ),
        71: GCode(
            meaning="additional axis L goes evenly over the moves up to G70",
            perform=codes.go_evenly,
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
        92: GCode(meaning="set position", perform=codes.set_position, ground="manual"),
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
    },
    instead={
        **dict.fromkeys(range(80, 90), "there are no canned cycles: write their moves"),
        **dict.fromkeys((57, 58, 59), "shifts are G54 and G55 with their distances"),
        **dict.fromkeys((94, 95), "F counts units per second"),
        21: "lengths are in the axes' unit, millimetres",
        28: "write G53, then G0 and the axes",
        49: "write G43 I0 J0 K0",
    },
    start=(15, 40, 50, 60, 90, 99),
    start_state={"feed_mode": FeedMode.PER_SECOND, "corner": Corner.EXACT_PATH},
    m={number: MCode(meaning="end of program", late=True, ends=True) for number in (2, 30)},
    any_m=True,
    axis_letters=frozenset(f"XYZ{ADDITIONAL}"),
    motion_words=frozenset(f"XYZ{ADDITIONAL}IJKRT"),
    function_letters="KLO",
    references="O",
    signed=("E", "EF"),
    series="HOL",
    words={
        "F": iso.set_feed,
        "E": words.set_acceleration,
        "E-": words.set_acceleration,
        "FF": words.set_rapid_feed,
        "EF": words.set_rapid_acceleration,
        "EF-": words.set_rapid_acceleration,
        "D": codes.set_smoothing,
        "S": words.refuse_profile,
        "L!": words.pass_label,
        **{f"P{letter}": words.set_period(letter) for letter in ADDITIONAL},
        **{
            f"F{letter}": words.axis_limit(letter, acceleration=False)
            for letter in f"XYZ{ADDITIONAL}"
        },
        **{
            f"E{letter}": words.axis_limit(letter, acceleration=True)
            for letter in f"XYZ{ADDITIONAL}"
        },
    },
    statements={
        "LET": program.let,
        "SUBPROGRAM": subprograms.define,
        "END_SUBPROGRAM": subprograms.leave_subprogram,
        "RETURN": subprograms.leave_subprogram,
    },
    other_statement=subprograms.assign_or_call,
    word_meanings={
        "N": "block number",
        "G": "preparatory code",
        "X": "X axis",
        "Y": "Y axis",
        "Z": "Z axis",
        **dict.fromkeys(ADDITIONAL, "additional axis, linear along the path"),
        "I": "centre along X; component of a normal or a vector",
        "J": "centre along Y",
        "K": "centre along Z; condition of a jump; angle of an ellipse; parameter of M",
        "R": "radius; short by long half axis of an ellipse",
        "T": "opening angle of an arc; seconds of G4; no tool",
        "F": "feed per second",
        "E": "acceleration per second squared",
        "E-": "deceleration per second squared, below 0",
        "FF": "feed of G0 per second; 0: as F",
        "EF": "acceleration of G0; 0: as E",
        "EF-": "deceleration of G0, below 0",
        "D": "tool radius; distance of smoothing; value of G36 and G37",
        "H": "switch point, negative: off",
        "O": "place of a switch point as a share; variable of G36 and G37; parameter of M",
        "L": "block to jump to; place of a switch point as a distance; axis of G70 and G71; "
        "parameter of M",
        "L?": "label to jump to, forwards",
        "L!": "label",
        "S": "profile of additional axes; 0 only",
        "M": "machine function",
        **{f"P{letter}": f"modulo period of {letter}; 0: none" for letter in ADDITIONAL},
        **{f"F{letter}": f"largest velocity of {letter}" for letter in f"XYZ{ADDITIONAL}"},
        **{f"E{letter}": f"largest acceleration of {letter}" for letter in f"XYZ{ADDITIONAL}"},
    },
    units="mm, degrees; F in units per second, E in units per second squared",
    decisions=DECISIONS,
    marks=(
        Mark(r"^[^\"$;\[]*\bN[ \t]*\d+\b[^\"$;\[]*\bN[ \t]*\d+\b", "several N blocks on one line"),
        Mark(r"\bG0?[23]\b.*[IJK].*\bT[ \t]*\d", "an arc with the opening angle T"),
        Mark(r"\bG0?4[ \t]*T", "G4 T"),
        Mark(r"\bE[ \t]*[-+]?\d", "E, the acceleration"),
        Mark(r"\$[A-Z_]\w*\$", "$variable$"),
        Mark(r"\bLET[ \t]+#|\bSUBPROGRAM\b", "LET, SUBPROGRAM"),
        Mark(r"\bG20[ \t]+L|\bL[?!][ \t]*\d", "G20 L, L?, L!"),
        Mark(r"\bG5[12][ \t]*D|\bG1[56]\b|\bG3[67]\b.*\bD", "G51 D, G52 D, G15, G16, G36 D"),
        Mark(r"\b(?:FF|P[ABC])[ \t]*\d", "FF, PA, PB, PC"),
        Mark(r"\bH[ \t]*-?\d+[ \t]*[OL][ \t]*-?[\d.]", "a switch point H with O or L"),
        Mark(r"[XYZ][^ \t;$\"]*\b(?:SIN|COS|SQRT|PI)\b(?!\[)", "functions with round brackets"),
    ),
    memory=program.Variables,
    before_motion=words.before_motion,
    read_variable=program.read_variable,
    place_switches=words.place_switches,
    library=subprograms.with_files,
    disturbed=lambda control: bool(program.variables(control).periods),
)
