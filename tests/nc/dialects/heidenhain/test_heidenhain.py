"""Klartext held to what HEIDENHAIN's manuals say of it: numbers that follow from them by closed forms.

The sentences are from memory of the TNC 620 and 640 user's manuals for conversational and cycle programming, in
words of our own; where these leave something open the dialect's ``DECISIONS`` speak.
"""

import dataclasses
import math

import numpy as np
import pytest

from tests.nc.running import SETTINGS, Outcome, run
from twin.nc.canonical import Dwell, Shape
from twin.nc.control.settings import ToolData

TOOLS = {1: ToolData(5.0, 60.0), 2: ToolData(3.0, 72.5)}
BEGIN = "BEGIN PGM PROBE MM\nTOOL CALL 1 Z S1000 F500\nL X+0 Y+0 Z+10 R0 FMAX\n"
END = "\nEND PGM PROBE MM"


def klartext(body: str, begin: str = BEGIN) -> Outcome:
    settings = dataclasses.replace(SETTINGS, tools=TOOLS, machine_zero={"X": 400.0, "Z": 300.0})
    return run(begin + body + END, "heidenhain", settings)


def read(body: str, begin: str = BEGIN) -> Outcome:
    made = klartext(body, begin)
    assert made.error is None, made.error
    return made


# --- numbers

NUMBERS = {
    "multiplication goes before addition": ("Q1 = 5 * 3 + 2 * 10", 35.0),
    "powers and squares go before subtraction": ("Q1 = SQ 10 - 3 ^ 3", 73.0),
    "brackets": ("Q2 = 4\nQ1 = ( Q2 + 2 ) * ( Q2 - 1 )", 18.0),
    "FN 1 adds two signed values": ("Q2 = 3\nFN 1: Q1 = -Q2 + -5", -8.0),
    "FN 2 subtracts": ("FN 2: Q1 = +10 - +5", 5.0),
    "FN 3 multiplies": ("FN 3: Q1 = +3 * +7", 21.0),
    "FN 4 divides": ("FN 4: Q1 = +4 DIV +8", 0.5),
    "FN 5 takes a square root": ("FN 5: Q1 = SQRT 16", 4.0),
    "FN 6 takes degrees": ("Q2 = 30\nFN 6: Q1 = SIN-Q2", -0.5),
    "FN 7": ("FN 7: Q1 = COS+60", 0.5),
    "FN 8 is the hypotenuse": ("FN 8: Q1 = +10 LEN +5", math.sqrt(125.0)),
    "FN 13 finds the quadrant": ("FN 13: Q1 = +1 ANG -1", 135.0),
    "INT cuts the decimals off": ("Q1 = INT -3.7", -3.0),
    "FRAC keeps them": ("Q1 = FRAC 3.25", 0.25),
    "SGN": ("Q1 = SGN -50", -1.0),
    "NEG and ABS": ("Q1 = NEG ABS -4", -4.0),
    "% is the remainder": ("Q1 = 400 % 360", 40.0),
    "inverse functions give degrees": ("Q1 = ASIN 0.5 + ACOS 0 + ATAN 1", 165.0),
    "PI": ("Q1 = PI * 2", 2.0 * math.pi),
    "LN, LOG, EXP": ("Q1 = LN EXP 2 + LOG 1000", 5.0),
    "a parameter can be a negative coordinate": ("Q2 = 7\nFN 0: Q1 = -Q2", -7.0),
    "QL and QR are parameters of their own": ("QL1 = 1\nQR1 = 2\nQ2 = 4\nQ1 = QL1 + QR1 + Q2", 7.0),
}


@pytest.mark.parametrize("says", NUMBERS)
def test_numbers(says: str) -> None:
    text, expected = NUMBERS[says]
    made = read(f"{text}\nL X+Q1 F100")
    assert made.position["X"] == pytest.approx(expected, abs=1e-9)


def test_fn_18_numbers_axes_as_the_control_does() -> None:
    made = read(
        "L X+10 C+30 FMAX\nFN 18: SYSREAD Q1 = ID270 NR1 IDX6\nFN 18: SYSREAD Q2 = ID240 NR1 IDX3\nL X+Q1 Y+Q2 F100"
    )
    assert made.position["X"] == pytest.approx(30.0)
    assert made.position["Y"] == pytest.approx(-290.0)


def test_a_parameter_behind_the_definition_of_a_cycle_is_no_word_of_it() -> None:
    cycle = DRILL.replace(" Q2", " ~\nQ2").replace("Q201=-15", "Q201=-5").rstrip()
    made = read(f"{cycle}\nQ201 = -3\nL X+1 FMAX M99")
    assert made.moves.end[:, 2].min() == pytest.approx(-3.0)


# --- where paths end

ROOT3 = math.sqrt(3.0)
TANGENT = (55.0**2 + 35.0**2) / 110.0
"""Radius of the arc that leaves (95, 40) downwards and comes to (40, 5) [mm]."""
PLACES = {
    "a coordinate that is not named stays": ("L X+10 F100\nL Y+5", [(10, 0), (10, 5)]),
    "I before an axis is incremental, word by word": (
        "L X+10 Y+10 F100\nL IX+5 Y+3",
        [(10, 10), (15, 3)],
    ),
    "words need no blanks, and a comma is a decimal point": ("L X+10,5Y-2,25F100", [(10.5, -2.25)]),
    "polar coordinates: PA, IPA, PR kept": (
        "CC X+45 Y+25\nLP PR+30 PA+0 F100\nLP PA+60\nLP IPA+60\nLP PA+180",
        [(75, 25), (60, 25 + 15 * ROOT3), (30, 25 + 15 * ROOT3), (15, 25)],
    ),
    "IPR is incremental": ("CC X+0 Y+0\nLP PR+10 PA+0 F100\nLP IPR+5", [(10, 0), (15, 0)]),
    "CC alone takes the position as pole": (
        "L X+10 Y+10 F100\nCC\nLP PR+5 PA+90",
        [(10, 10), (10, 15)],
    ),
    "IX and IY of CC count from the position programmed last": (
        "L X+10 Y+10 F100\nCC IX+5 IY+0\nLP PR+5 PA+90",
        [(10, 10), (15, 15)],
    ),
    "C goes around CC": ("L X+10 F100\nCC X+0 Y+0\nC X+0 Y+10 DR+", [(10, 0), (0, 10)]),
    "CP goes by the angle": ("L X+10 F100\nCC X+0 Y+0\nCP PA+180 DR-", [(10, 0), (-10, 0)]),
    "CTP joins tangentially, its end in polar coordinates": (
        "CC X+40 Y+35\nL X+0 Y+35 F250\nLP PR+25 PA+120\nCTP PR+30 PA+30\nL Y+0",
        [
            (0, 35),
            (27.5, 35 + 12.5 * ROOT3),
            (40 + 15 * ROOT3, 50),
            (40 + 15 * ROOT3, 0),
        ],
    ),
    "CHF cuts off the same from both sides": (
        "L X+0 Y+30 F300\nL X+40 IY+0\nCHF 12\nL IX+0 Y+0",
        [(0, 30), (28, 30), (40, 18), (40, 0)],
    ),
    "CHF needs no blank before its length": (
        "L X+0 Y+30 F300\nL X+40 IY+0\nCHF12\nL IX+0 Y+0",
        [(0, 30), (28, 30), (40, 18), (40, 0)],
    ),
    "RND joins tangentially": (
        "L X+0 Y+30 F300\nL X+40\nRND R5\nL Y+0",
        [(0, 30), (35, 30), (40, 25), (40, 0)],
    ),
    "a part is repeated REP times more": (
        "LBL 1\nL IX+10 F100\nCALL LBL 1 REP 2",
        [(10, 0), (20, 0), (30, 0)],
    ),
    "a subprogram is left at LBL 0": (
        'CALL LBL "UP"\nL X+5 F100\nL X+6 M2\nLBL "UP"\nL Y+1 F100\nLBL 0\nL X+99',
        [(0, 1), (5, 1), (6, 1)],
    ),
    "FN 9 jumps where both are equal": (
        "Q1 = 1\nFN 9: IF +Q1 EQU +1 GOTO LBL 5\nL X+99 F100\nLBL 5\nL Y+2 F100",
        [(0, 2)],
    ),
    "FN 11 jumps where the first is greater": (
        "FN 11: IF +1 GT +1 GOTO LBL 5\nL X+9 F100\nLBL 5\nL Y+2 F100",
        [(9, 0), (9, 2)],
    ),
    "cycle 7 moves the datum; I adds to what is in force": (
        "CYCL DEF 7.0 DATUM SHIFT\nCYCL DEF 7.1 X+10\nCYCL DEF 7.0 DATUM SHIFT\nCYCL DEF 7.1 IX+5\nL X+0 Y+1 F100",
        [(15, 1)],
    ),
    "cycle 8 mirrors about the datum": (
        "CYCL DEF 8.0 MIRRORING\nCYCL DEF 8.1 X\nL X+10 Y+5 F100",
        [(-10, 5)],
    ),
    "a shift before the mirror moves the mirror's axis": (
        "CYCL DEF 7.0 DATUM SHIFT\nCYCL DEF 7.1 X+20\nCYCL DEF 8.0 MIRRORING\nCYCL DEF 8.1 X\nL X+10 Y+5 F100",
        [(10, 5)],
    ),
    "cycle 10 turns about the datum; IROT adds": (
        "CYCL DEF 10.0 ROTATION\nCYCL DEF 10.1 ROT+45\nCYCL DEF 10.1 IROT+45\nL X+10 Y+0 F100",
        [(0, 10)],
    ),
    "cycle 11 scales coordinates and radii": (
        "CYCL DEF 11.0 SCALING\nCYCL DEF 11.1 SCL 0.5\nL X+10 F100\nCR X+30 Y+0 R+10 DR+",
        [(5, 0), (15, 0)],
    ),
    "M126 takes the shorter way": ("L C+350 F100 M126\nL X+1", [(0, 0), (1, 0)]),
    "CYCL CALL POS goes to the place": (
        "CYCL DEF 9.0 DWELL TIME\nCYCL DEF 9.1 DWELL 0.1\nL X+1 F100",
        [(1, 0)],
    ),
    "APPR LT: straight, tangential, LEN before the contour; R to its left": (
        "L X-10 Y-10 FMAX\nAPPR LT X+5 Y+5 LEN10 RL F300\nL Y+95",
        [(-10, -10), (0, -5), (0, 5), (0, 95)],
    ),
    "APPR LN: straight, perpendicular, LEN plus the tool's radius away": (
        "L X-30 Y+20 FMAX\nAPPR LN X+5 Y+20 LEN15 RL F300\nL Y+95",
        [(-30, 20), (-15, 20), (0, 20), (0, 95)],
    ),
    "APPR CT: an arc of CCA into the contour": (
        "L X-40 Y+0 FMAX\nAPPR CT X+5 Y+20 CCA90 R+10 RL F300\nL Y+95",
        [(-40, 0), (-10, 10), (0, 20), (0, 95)],
    ),
    "DEP LT leaves along the tangent": (
        "L X-10 Y-10 FMAX\nAPPR LT X+5 Y+5 LEN10 RL F300\nL Y+95\nDEP LT LEN12 F1000",
        [(-10, -10), (0, -5), (0, 5), (0, 95), (0, 107)],
    ),
    "DEP LN leaves square to it": (
        "L X-10 Y-10 FMAX\nAPPR LT X+5 Y+5 LEN10 RL F300\nL Y+95\nDEP LN LEN+20 F1000",
        [(-10, -10), (0, -5), (0, 5), (0, 95), (-20, 95)],
    ),
    "DEP CT leaves on an arc": (
        "L X-10 Y-10 FMAX\nAPPR LT X+5 Y+5 LEN10 RL F300\nL Y+95\nDEP CT CCA180 R+8 F1000",
        [(-10, -10), (0, -5), (0, 5), (0, 95), (-16, 95)],
    ),
    "DR of TOOL CALL is added to the radius": (
        "TOOL CALL 1 Z S1000 DR+0.5\nL X-10 Y-10 FMAX\nAPPR LT X+5 Y+5 LEN10 RL F300\nL Y+95",
        [(-10, -10), (-0.5, -5), (-0.5, 5), (-0.5, 95)],
    ),
    "RR is to the right": (
        "L X-10 Y-10 FMAX\nAPPR LT X+5 Y+5 LEN10 RR F300\nL Y+95",
        [(-10, -10), (10, -5), (10, 5), (10, 95)],
    ),
}


@pytest.mark.parametrize("says", PLACES)
def test_places(says: str) -> None:
    text, expected = PLACES[says]
    made = read(text)
    ends = made.moves.end[1:, :2]
    np.testing.assert_allclose(ends, np.array(expected, float), atol=1e-9)


# --- arcs

ARCS = {
    "R+ is the arc up to a half turn": ("L X+40 Y+40 F100\nCR X+70 Y+40 R+20 DR-", 20.0, -97.181),
    "R- is the one beyond": ("L X+40 Y+40 F100\nCR X+70 Y+40 R-20 DR+", 20.0, 262.819),
    "start and end the same: a full circle": (
        "L X+45 Y+25 F100\nCC X+25 Y+25\nC X+45 Y+25 DR+",
        20.0,
        360.0,
    ),
    "CT starts in the direction of what stands before": (
        "L X+95 Y+85 F100\nL Y+40\nCT X+40 Y+5",
        TANGENT,
        -math.degrees(math.atan2(35.0, TANGENT - 55.0)) % -360.0,
    ),
    "IPA beyond 360 turns on": ("L X+20 F100\nCC X+0 Y+0\nCP IPA-1980 IZ+13.5 DR-", 20.0, -1980.0),
}


@pytest.mark.parametrize("says", ARCS)
def test_arcs(says: str) -> None:
    text, radius, sweep = ARCS[says]
    moves = read(text).moves
    assert moves.shape[-1] == Shape.ARC
    spoke = moves.start[-1, :3] - moves.center[-1]
    assert math.hypot(*spoke[:2]) == pytest.approx(radius, abs=1e-9)
    assert moves.sweep[-1] * np.sign(moves.normal[-1, 2]) == pytest.approx(sweep, abs=1e-3)


# --- feeds

FEEDS = {
    "FMAX counts in its block alone": ("L X+10 F200\nL Y+10 FMAX\nL X+0", [200, None, 200]),
    "F of RND counts in its block alone": (
        "L X+40 F300\nRND R5 F100\nL Y+40",
        [300, 100, 300],
    ),
    "F of CHF counts in its block alone": ("L X+40 F300\nCHF 5 F100\nL Y+40", [300, 100, 300]),
    "F AUTO is that of TOOL CALL": ("L X+10 F200\nL X+20 F AUTO", [200, 500]),
    "a parameter can be a feed": ("Q5 = 150\nL X+10 FQ5", [150]),
}


@pytest.mark.parametrize("says", FEEDS)
def test_feeds(says: str) -> None:
    text, expected = FEEDS[says]
    moves = read(text).moves
    found = [None if math.isnan(feed) else feed for feed in moves.feed]
    assert found[1:] == pytest.approx(expected)


def test_inch_programs_count_tenths_of_an_inch_per_minute() -> None:
    made = read("", "BEGIN PGM PROBE INCH\nL X+1 F100")
    assert made.position["X"] == pytest.approx(25.4)
    assert made.moves.feed[0] == pytest.approx(254.0)


# --- cycles

DRILL = "CYCL DEF 200 DRILLING Q200=2 Q201=-15 Q206=250 Q202=5 Q210=0 Q203=0 Q204=50 Q211=0\n"
DEPTHS = {
    "200 drills in steps of Q202, and leaves at Q204": (
        DRILL + "L X+30 FMAX M99",
        [10, 2, -5, 2, -4.8, -10, 2, -9.8, -15, 50],
    ),
    "M89 calls at every place until M99": (
        (
            "CYCL DEF 201 REAMING Q200=2 Q201=-5 Q206=100 Q211=0 Q208=250 Q203=0 Q204=20\n"
            "L X+10 FMAX M89\nL X+20 FMAX M99\nL X+30 FMAX"
        ),
        [10, 2, -5, 2, 20, 20, 2, -5, 2, 20, 20],
    ),
    "CYCL CALL POS calls at a place above the part": (
        (
            "CYCL DEF 201 REAMING Q200=2 Q201=-5 Q206=100 Q211=0 Q208=250 Q203=0 Q204=20\n"
            "CYCL CALL POS X+10 Y+0 Z+0 FMAX"
        ),
        [10, 2, -5, 2, 20],
    ),
    "Q203 is where the surface lies, absolute": (
        "CYCL DEF 201 REAMING Q200=2 Q201=-5 Q206=100 Q211=0 Q208=250 Q203=3 Q204=20\nL X+10 FMAX M99",
        [10, 5, -2, 5, 23],
    ),
    "204 bores from below, its tooth above its tip": (
        (
            "CYCL DEF 204 BACK BORING Q200=2 Q249=5 Q250=20 Q251=3.5 Q252=15 Q253=750 Q254=200 Q255=0.5 Q203=0 Q204=50 "
            "Q214=1 Q336=0\nL X+30 FMAX M99"
        ),
        [10, 2, 2, -37, -37, -30, -37, -37, 2, 50, 50],
    ),
    "Q201=0 drills nothing": (DRILL.replace("Q201=-15", "Q201=0") + "L X+30 FMAX M99", [10]),
}


@pytest.mark.parametrize("says", DEPTHS)
def test_depths(says: str) -> None:
    text, expected = DEPTHS[says]
    heights = read(text).moves.end[1:, 2]
    assert list(heights) == pytest.approx(expected)


def test_204_passes_the_hole_beside_its_axis() -> None:
    text = "CYCL DEF 204 BACK BORING Q200=2 Q249=5 Q250=20 Q251=3.5 Q252=15 Q253=750 Q254=200 Q203=0 Q214=2\nL X+30 FMAX M99"
    moves = read(text).moves
    down = next(row for row in range(len(moves.end)) if moves.end[row, 2] == -37.0)
    assert moves.start[down, :2].tolist() == [30.0, -3.5]
    assert moves.end[-1, :2].tolist() == [30.0, 0.0]


def test_fn_17_writes_the_radius_of_a_tool() -> None:
    begin = BEGIN.replace("TOOL CALL", "FN 17: SYSWRITE ID50 NR2 IDX1 = +7\nTOOL CALL")
    made = read("L X-20 Y+0 FMAX\nL X+0 Y+0 RL F100\nL Y+30", begin)
    assert made.position["X"] == pytest.approx(-7.0)


def test_m94_of_one_axis() -> None:
    assert read("L C+400 FMAX\nM94 C\nL C+41 FMAX").position["C"] == pytest.approx(401.0)


def test_places_of_a_pattern_count_on_from_the_one_before() -> None:
    made = read(DRILL + "PATTERN DEF POS1 (X+25 Y+33.5 Z+0) POS2 (X+15 IY+6.5 Z+0)\nCYCL CALL PAT")
    bottoms = made.moves.end[made.moves.end[:, 2] == -15.0]
    assert bottoms[:, :2].tolist() == [[25.0, 33.5], [15.0, 40.0]]


def test_cycle_9_dwells_where_it_is_defined() -> None:
    made = read("CYCL DEF 9.0 DWELL TIME\nCYCL DEF 9.1 DWELL 1.5")
    assert [event.seconds for event in made.events if isinstance(event, Dwell)] == [1.5]


def test_a_pattern_calls_at_every_place() -> None:
    made = read(DRILL + "PATTERN DEF ROW1 (X+25 Y+10 D+8 NUM4 ROT+90 Z+0)\nCYCL CALL PAT FMAX")
    bottoms = made.moves.end[made.moves.end[:, 2] == -15.0]
    np.testing.assert_allclose(
        bottoms[:, :2], [(25.0, 10.0 + 8.0 * i) for i in range(4)], atol=1e-9
    )


def test_cycle_220_drills_on_a_circle_by_itself() -> None:
    polar = "CYCL DEF 220 POLAR PATTERN Q216=30 Q217=20 Q244=80 Q245=0 Q246=360 Q247=0 Q241=8 Q200=2 Q203=0 Q204=50 Q301=1 Q365=0"
    made = read(DRILL + polar)
    bottoms = made.moves.end[made.moves.end[:, 2] == -15.0]
    expected = [
        (30 + 40 * math.cos(i * math.pi / 4), 20 + 40 * math.sin(i * math.pi / 4)) for i in range(8)
    ]
    np.testing.assert_allclose(bottoms[:, :2], expected, atol=1e-9)


def test_m91_counts_from_machine_zero() -> None:
    made = read("L Z-10 R0 FMAX M91\nL X+1 FMAX")
    assert made.position == pytest.approx({"X": 1.0, "Y": 0.0, "Z": 290.0, "C": 0.0})


def test_m140_moves_away_along_the_tool() -> None:
    assert read("M140 MB 40 F750").position["Z"] == pytest.approx(50.0)


# --- refused

REFUSED = {
    "FK": ("FPOL X+20 Y+30\nFL IX+10 Y+20 F100", "FPOL"),
    "a tilted plane of a machine without the axes": (
        "PLANE SPATIAL SPA+27 SPB+0 SPC+45 STAY",
        "PLANE",
    ),
    "TCPM": ("FUNCTION TCPM F TCP AXIS POS PATHCTRL AXIS", "TCPM"),
    "M128": ("M128", "M128"),
    "a vector without a led tip": ("LN X+1 Y+2 Z+3 TX0 TY0 TZ1 F100", "M128"),
    "a table of points": ('SEL PATTERN "A.PNT"', "SEL PATTERN"),
    "a datum that FN 17 cannot write": ("FN 17: SYSWRITE ID210 NR4 IDX3 = +1", "ID50"),
    "back boring without a direction": (
        "CYCL DEF 204 BACK BORING Q200=2 Q249=5 Q250=20 Q251=3 Q252=15 Q253=750 Q254=200 Q203=0 Q214=0\nCYCL CALL",
        "Q214",
    ),
    "a contour of cycle 14": ("CYCL DEF 14.0 CONTOUR GEOMETRY", "14"),
    "a probe": ("TCH PROBE 400 BASIC ROTATION", "TCH PROBE"),
    "a label that is not there": ("CALL LBL 7", "7"),
    "a label that is there twice": ("LBL 1\nLBL 1\nCALL LBL 1 REP 1", "1"),
    "C without CC": ("L X+10 F100\nC X+0 Y+10 DR+", "CC"),
    "LP without CC": ("LP PR+10 PA+0 F100", "CC"),
    "an end that is not on the circle": ("L X+10 F100\nCC X+0 Y+0\nC X+0 Y+11 DR+", "centre"),
    "a radius that is too small": ("L X+0 F100\nCR X+30 Y+0 R+10 DR+", "radius"),
    "an arc that has no direction": ("L X+10 F100\nCR X+20 Y+0 R+10", "DR"),
    "a rounding that does not fit": ("L X+5 F100\nRND R20\nL Y+5", "radius 20"),
    "a rounding at the end": ("L X+5 F100\nRND R2", "no move follows"),
    "a parameter without a value": ("L X+Q77 F100", "Q77"),
    "a division by nothing": ("FN 4: Q1 = +4 DIV +0", "DIV"),
    "a root of less": ("FN 5: Q1 = SQRT -4", "SQRT"),
    "a cycle that lacks a value": (DRILL.replace("Q202=5 ", "") + "CYCL CALL", "Q202"),
    "a call with no cycle": ("CYCL CALL", "CYCL DEF"),
    "a cycle that is not known": ("CYCL DEF 999 MAGIC Q200=2", "999"),
    "an axis that the machine lacks": ("L A+10 F100", "A"),
    "a word of another control": ("G1 X10 F100", "L X+10"),
    "an M function that is not known": ("L X+1 F100 M777", "M777"),
    "compensation begun on an arc": ("L X+10 F100\nCC X+0 Y+0\nC X+0 Y+10 DR+ RL", "line"),
    "a tool that the job lacks": ("TOOL CALL 9 Z S1000", "9"),
    "a tool along another axis": ("TOOL CALL 1 X S1000", "Z"),
    "a program that is not there": ("CALL PGM NOWHERE.H", "NOWHERE"),
    "the same word twice": ("L X+1 X+2 F100", "X"),
    "an endless loop": ("LBL 1\nFN 9: IF +1 EQU +1 GOTO LBL 1", "step"),
}


@pytest.mark.parametrize("what", REFUSED)
def test_refused_by_name(what: str) -> None:
    text, named = REFUSED[what]
    made = klartext(text)
    assert made.error is not None, what
    assert named in f"{made.error.message} {made.error.hint}"
    assert made.error.line > 3
    assert made.error.column > 0
