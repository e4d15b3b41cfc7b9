"""CODESYS SoftMotion CNC (DIN 66025 with SoftMotion's own codes)."""

from twin.nc import iso
from twin.nc.blocks import Word
from twin.nc.canonical import Corner
from twin.nc.control import Control
from twin.nc.dialect import (
    Comment,
    Decision,
    Dialect,
    FeedMode,
    GCode,
    Mark,
    MCode,
    Syntax,
)
from twin.nc.dialects.codesys_arcs import CLOCKWISE, COUNTER_CLOCKWISE
from twin.nc.planes import XY, YZ, ZX, plane_with_normal


def dwell(control: Control) -> None:
    """G4: wait T seconds."""
    word = control.take("T")
    if word is None or control.number(word) < 0.0:
        control.fail("dwell", "G4 needs T, its seconds", word, hint="write G4 T1")
    control.dwell(control.number(word))


def free_plane(control: Control) -> None:
    """G16: the plane whose normal is I, J, K."""
    words = [control.words.pop(letter) for letter in "IJK" if letter in control.words]
    values = {word.address: control.number(word) for word in words}
    normal = (values.get("I", 0.0), values.get("J", 0.0), values.get("K", 0.0))
    if not any(normal):
        control.fail("plane-normal", "G16 needs the plane's normal", control.code_word(16))
    control.modal.plane = plane_with_normal(normal)


def set_acceleration(control: Control, word: Word) -> None:
    """E: above 0 the path's acceleration, below 0 its deceleration [units/s²]."""
    value = control.number(word)
    if value > 0.0:
        control.acceleration = value
    elif value < 0.0:
        control.deceleration = -value
    else:
        control.fail("acceleration-range", "an acceleration of 0 never moves", word)


DECISIONS = (
    Decision(
        "How is the centre's deviation of 10 % measured?",
        "r_s = start to centre, r_e = end to centre: if |r_s - r_e| <= 0.1 max(r_s, r_e) the "
        "centre is projected on the perpendicular bisector (with a warning if it moved by more "
        "than 1 µm), else the block becomes a straight line, with a warning.",
        "The page names 10 % and no measure; its hint says that inconsistent arcs become lines.",
    ),
    Decision(
        "What does R shorter than half the chord give?",
        "A straight line, with a warning.",
        "The page says so.",
    ),
    Decision(
        "What does R give where start and end are one point?",
        "A program error: the centre is undefined.",
        "The page's sentence on full circles fits the centre method alone.",
    ),
    Decision(
        "What do I, J, K give where start and end are one point?",
        "A full circle.",
        "The page says that the system inserts a full circle.",
    ),
    Decision(
        "Which opening angles are allowed?",
        "Above 0 and up to 1080 degrees; others are a program error.",
        "The page allows three turns at most and no negative angle.",
    ),
    Decision(
        "What if T stands together with a target in the plane?",
        "T wins, with a warning.",
        "The page computes the target from T.",
    ),
    Decision(
        "Which way do arcs turn in G18?",
        "By ISO: seen from +Y; G18 G2 X200 R50 from X100 Z0 passes Z -50.",
        "The page does not say.",
    ),
    Decision(
        "Is the mode 2D or 3D when a program starts?",
        "2D (G15): arcs lie in X Y and Z runs along.",
        "The application decides; without b3DMode the decoder starts in 2D.",
    ),
    Decision(
        "What is a centre coordinate that G98 leaves out?",
        "The start's.",
        "The centre then lies beside the start along the axis that was given.",
    ),
    Decision(
        "How does a path pass its corners?",
        "Exactly; the speed falls to 0 where the direction changes and next to G0.",
        "The documentation's block transition speed.",
    ),
)

CODESYS = Dialect(
    name="codesys",
    title="CODESYS SoftMotion CNC",
    code_page="cp1252",
    syntax=Syntax(
        comments=(Comment("(*", "*)"), Comment("(", ")"), Comment("//"), Comment("%")),
        several_blocks=True,
    ),
    groups=("plane", "distance", "centre", "motion"),
    g={
        0: iso.MOTION[0],
        1: iso.MOTION[1],
        2: GCode(
            meaning="arc clockwise",
            group="motion",
            sets={"interpolation": CLOCKWISE},
            ground="seed",
        ),
        3: GCode(
            meaning="arc counter-clockwise",
            group="motion",
            sets={"interpolation": COUNTER_CLOCKWISE},
            ground="seed",
        ),
        4: GCode(meaning="dwell, seconds in T", perform=dwell, ground="manual"),
        15: GCode(
            meaning="2D mode: arcs in X Y", group="plane", sets={"plane": XY}, ground="manual"
        ),
        16: GCode(
            meaning="3D mode, plane with normal I J K",
            group="plane",
            action=free_plane,
            ground="manual",
        ),
        17: GCode(meaning="3D mode, plane X Y", group="plane", sets={"plane": XY}, ground="manual"),
        18: GCode(meaning="3D mode, plane Z X", group="plane", sets={"plane": ZX}, ground="manual"),
        19: GCode(meaning="3D mode, plane Y Z", group="plane", sets={"plane": YZ}, ground="manual"),
        **iso.DISTANCE,
        92: GCode(meaning="set position", perform=iso.preset, ground="manual"),
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
    start=(15, 90, 99),
    start_state={"feed_mode": FeedMode.PER_SECOND, "corner": Corner.EXACT_PATH},
    m={
        2: MCode(meaning="end of program", late=True, ends=True),
        30: MCode(meaning="end of program", late=True, ends=True),
    },
    any_m=True,
    axis_letters=frozenset("XYZABCPQUVW"),
    motion_words=frozenset("XYZABCPQUVWIJKRT"),
    function_letters="KLO",
    words={"F": iso.set_feed, "E": set_acceleration},
    word_meanings={
        "N": "block number",
        "G": "preparatory code",
        "X": "X axis",
        "Y": "Y axis",
        "Z": "Z axis",
        "A": "additional axis",
        "B": "additional axis",
        "C": "additional axis",
        "P": "additional axis",
        "Q": "additional axis",
        "U": "additional axis",
        "V": "additional axis",
        "W": "additional axis",
        "I": "centre along X",
        "J": "centre along Y",
        "K": "centre along Z; condition of a jump; parameter of M",
        "R": "radius",
        "T": "opening angle; seconds of G4",
        "F": "feed per second",
        "E": "above 0 acceleration, below 0 deceleration, per second squared",
        "M": "machine function",
    },
    units="mm, degrees; F in units per second, E in units per second squared",
    decisions=DECISIONS,
    marks=(
        Mark(r"\bN[ \t]*\d+\b.*\bN[ \t]*\d+\b", "several N blocks on one line"),
        Mark(r"\bG0?[23]\b.*[IJK].*\bT[ \t]*\d", "an arc with the opening angle T"),
        Mark(r"\bE[ \t]*[-+]?\d", "E, the acceleration"),
    ),
)
