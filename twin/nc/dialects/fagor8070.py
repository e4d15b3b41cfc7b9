"""Fagor CNC 8070, milling model."""

from twin.nc import iso, offsets
from twin.nc.canonical import Corner
from twin.nc.control import Control
from twin.nc.dialect import Comment, Decision, Dialect, GCode, Mark, Syntax
from twin.nc.dialects.fagor8070_arcs import (
    CLOCKWISE,
    COUNTER_CLOCKWISE,
    FEED,
    RAPID,
    Polar,
    reset_polar_origin,
    set_polar_origin,
    temporary_polar_origin,
)
from twin.nc.planes import XY, YZ, ZX


def dwell(control: Control) -> None:
    """G04: wait the seconds of K."""
    word = control.take("K")
    if word is None or control.number(word) < 0.0:
        control.fail("dwell", "G04 needs its seconds", word, hint="write G04 K1.5")
    control.dwell(control.number(word))


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
        "As commanded (linear-like); the machine option 'module' makes the sign the direction.",
        "The axis type is a machine parameter.",
    ),
    Decision(
        "How does G50 pass corners?",
        "On the exact path.",
        "G50 goes on when the theoretical move has ended, without waiting for the position.",
    ),
)

FAGOR8070 = Dialect(
    name="fagor8070",
    title="Fagor CNC 8070 (milling)",
    code_page="cp1252",
    syntax=Syntax(
        comments=(Comment("(", ")"), Comment(";"), Comment("%")),
        incremental_suffix=True,
    ),
    groups=iso.GROUPS,
    g={
        0: GCode(
            meaning="rapid positioning",
            group="motion",
            sets={"interpolation": RAPID, "cycle": None},
            ground="manual",
        ),
        1: GCode(
            meaning="straight line",
            group="motion",
            sets={"interpolation": FEED, "cycle": None},
            ground="manual",
        ),
        2: GCode(
            meaning="arc clockwise",
            group="motion",
            sets={"interpolation": CLOCKWISE, "cycle": None},
            ground="seed",
        ),
        3: GCode(
            meaning="arc counter-clockwise",
            group="motion",
            sets={"interpolation": COUNTER_CLOCKWISE, "cycle": None},
            ground="seed",
        ),
        4: GCode(meaning="dwell", perform=dwell, ground="manual"),
        5: GCode(
            meaning="round corner",
            group="corner",
            sets={"corner": Corner.CONTINUOUS},
            ground="manual",
        ),
        6: GCode(
            meaning="centre in absolute coordinates, this block",
            sets={"center_absolute": True},
            once=True,
            ground="manual",
        ),
        7: GCode(
            meaning="square corner",
            group="corner",
            sets={"corner": Corner.EXACT_STOP},
            ground="manual",
        ),
        17: GCode(
            meaning="plane X Y",
            group="plane",
            sets={"plane": XY},
            action=reset_polar_origin,
            ground="seed",
        ),
        18: GCode(
            meaning="plane Z X",
            group="plane",
            sets={"plane": ZX},
            action=reset_polar_origin,
            ground="seed",
        ),
        19: GCode(
            meaning="plane Y Z",
            group="plane",
            sets={"plane": YZ},
            action=reset_polar_origin,
            ground="seed",
        ),
        30: GCode(
            meaning="polar origin: I J, or where the tool stands",
            action=set_polar_origin,
            ground="manual",
        ),
        31: GCode(
            meaning="temporary polar origin at the arc's centre",
            action=temporary_polar_origin,
            ground="manual",
        ),
        50: GCode(
            meaning="semi-rounded corner",
            group="corner",
            sets={"corner": Corner.EXACT_PATH},
            ground="manual",
        ),
        60: GCode(
            meaning="square corner, this block",
            sets={"corner": Corner.EXACT_STOP},
            once=True,
            ground="manual",
        ),
        61: GCode(
            meaning="round corner, this block",
            sets={"corner": Corner.CONTINUOUS},
            once=True,
            ground="manual",
        ),
        **iso.UNITS,
        **iso.DISTANCE,
        **offsets.PRESET,
        94: GCode(meaning="feed per minute", group="feed", ground="manual"),
        261: GCode(
            meaning="centre in absolute coordinates",
            group="centre",
            sets={"center_absolute": True},
            ground="manual",
        ),
        262: GCode(
            meaning="centre relative to the start",
            group="centre",
            sets={"center_absolute": False},
            ground="manual",
        ),
    },
    start=(1, 17, 50, 71, 90, 94, 262),
    m=iso.M_CODES,
    motion_words=frozenset("XYZABCUVWIJKRQ"),
    words=iso.WORDS,
    word_meanings={
        **iso.WORD_MEANINGS,
        "Q": "polar angle; direction of a chord",
        "R": "polar radius; radius of the arc where a coordinate of the plane stands beside it",
    },
    units="mm, degrees; F in mm/min, for rotary axes alone in deg/min",
    decisions=DECISIONS,
    marks=(
        Mark(r"\bR[ \t]*[\d.]+.*\bQ[ \t]*-?[\d.]+", "polar coordinates R and Q"),
        Mark(r"\bG0*(?:30|31|26[1-5])\b", "G30, G31, G261 to G265"),
        Mark(r";", "a comment after ;"),
    ),
    memory=Polar,
)
