"""The SINUMERIK by its programming manuals: what a program says, and where it leads or what refuses it."""

import math
import random
from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.nc.running import WITH_TABLES, bad, good
from twin.nc.canonical import Corner, Function
from twin.nc.control.settings import ToolData
from twin.nc.dialects.sinumerik.cycles.drilling import pecks

LEADS: dict[str, tuple[str, dict[str, float]]] = {
    # words and numbers
    "a word may have = before its number": ("G0 X=5 Y6", {"X": 5, "Y": 6}),
    "an expression needs it": ("G0 X=2+3*4", {"X": 14}),
    "an exponent is written EX": ("G0 X=2.5EX1", {"X": 25}),
    "IC counts on in G90": ("G0 X5\nX=IC(3)", {"X": 8}),
    "AC counts from zero in G91": ("G91 G0 X5\nX=AC(3)", {"X": 3}),
    "upper and lower case are the same": ("g0 x5\nr1=4 \ny=R1", {"X": 5, "Y": 4}),
    "a main block has a colon": (":10 G0 X4", {"X": 4}),
    "a semicolon begins a comment": ("G0 X4 ;X5", {"X": 4}),
    # computing, by the table of priorities
    "multiplication before addition": ("R1=2+3*4\nG0 X=R1", {"X": 14}),
    "a comparison binds least": ("R1=1+1==2\nG0 X=R1", {"X": 1}),
    "AND before OR": ("R1=TRUE OR FALSE AND FALSE\nG0 X=R1", {"X": 1}),
    "XOR between both": ("R1=TRUE XOR TRUE AND FALSE\nG0 X=R1", {"X": 1}),
    "NOT binds tightest": ("R1=NOT FALSE AND FALSE\nG0 X=R1", {"X": 0}),
    "bits before truth": ("R1=6 B_AND 3 B_OR 8\nG0 X=R1", {"X": 10}),
    "DIV leaves the rest": ("R1=7 DIV 2 R2=-7 DIV 2\nG0 X=R1 Y=R2", {"X": 3, "Y": -3}),
    "MOD is the rest": ("R1=7 MOD 4\nG0 X=R1", {"X": 3}),
    "a quotient of whole numbers is none": ("R1=3/4\nG0 X=R1", {"X": 0.75}),
    "digits to the base 16 and 2": ("R1='HFF' R2='B101' B_OR 'H2'\nG0 X=R1 Y=R2", {"X": 255, "Y": 7}),
    "texts are compared": ('DEF STRING[9] NN="AB"\nIF NN=="AB" AND NN<>"A"\nG0 X1\nENDIF\nIF NN=="ab" GOTOF OUT\nG0 Y1\nOUT: M30', {"X": 1, "Y": 1}),
    "angles are degrees": ("R1=SIN(30) R2=ATAN2(1,-1)\nG0 X=R1 Y=R2", {"X": 0.5, "Y": 135}),
    "TRUNC cuts, ROUND rounds": ("R1=TRUNC(-3.7) R2=ROUND(-3.5)\nG0 X=R1 Y=R2", {"X": -3, "Y": -4}),
    "equality is relative": ("R1=0.1+0.2==0.3\nG0 X=R1", {"X": 1}),
    "an INT rounds what it is given": ("DEF INT WHOLE=2.5\nG0 X=WHOLE", {"X": 3}),
    "a BOOL is true of all but 0": ("DEF BOOL FLAG=7\nG0 X=FLAG", {"X": 1}),
    "SET fills a table, its last index first": ("DEF REAL TT[2,2]=SET(1,2,3,4)\nG0 X=TT[1,0]", {"X": 3}),
    "REP gives all elements one value": ("DEF REAL TT[3]=REP(4)\nG0 X=TT[2]", {"X": 4}),
    "SET leaves an element as it is where it says none": ("DEF REAL TT[4]=REP(7)\nTT[0]=SET(1,,3)\nG0 X=TT[0] Y=TT[1] Z=TT[2]", {"X": 1, "Y": 7, "Z": 3}),
    "REP counts the elements that it gives a value": ("DEF REAL TT[4]=REP(5,2)\nG0 X=TT[1] Y=TT[2]", {"X": 5, "Y": 0}),
    "REP from an element on": ("DEF REAL TT[4]\nTT[1]=REP(5)\nG0 X=TT[0] Y=TT[3]", {"X": 0, "Y": 5}),
    "an R parameter by its number": ("R3=2 R2=3\nG0 X=R[R2]", {"X": 2}),
    # frames
    "TRANS replaces": ("TRANS X10\nTRANS Y5\nG0 X0 Y0", {"X": 0, "Y": 5}),
    "ATRANS adds": ("TRANS X10\nATRANS Y5\nG0 X0 Y0", {"X": 10, "Y": 5}),
    "ATRANS shifts along turned axes": ("ROT Z90\nATRANS X10\nG0 X0 Y0", {"X": 0, "Y": 10}),
    "ROT ends a TRANS": ("TRANS X10\nROT Z90\nG0 X5 Y0", {"X": 0, "Y": 5}),
    "RPL turns the plane": ("G18\nROT RPL=90\nG0 X5 Z0", {"X": 0, "Z": -5}),
    "ROT X90 Z90 turns about Z first, then the new X": ("ROT X90 Z90\nG0 X0 Y5 Z0", {"X": 0, "Y": 0, "Z": 5}),
    "SCALE ends a ROT": ("ROT Z90\nSCALE X2 Y2\nG0 X5 Y1", {"X": 10, "Y": 2}),
    "MIRROR needs no value": ("MIRROR X0 Y7\nG0 X5 Y5", {"X": -5, "Y": -5}),
    "TRANS alone ends all": ("TRANS X5\nAROT Z30\nTRANS\nG0 X5 Y0", {"X": 5, "Y": 0}),
    "G54 lies under the programmable frame": ("G55\nROT Z90\nG0 X5 Y0", {"X": 20, "Y": 5}),
    "G53 counts from machine zero for its block": ("G55\nTRANS X5\nG0 G53 X0 Z0\nX0", {"X": 25, "Z": 300}),
    "$P_UIFR counts when the offset is called again": ("G54\n$P_UIFR[1,X,TR]=3\nG0 X0\nG54\nG0 Y0", {"X": 10}),
    "CTRANS writes all shifts of a work offset": (
        "R1=4\n$P_UIFR[2,Z,TR]=7\n$P_UIFR[2]=CTRANS(X,R1*2, Y ,-3)\nG55 G0 X0 Y0 Z0", {"X": 8, "Y": -3, "Z": 0}),
    # poles
    "G111 sets the pole from zero": ("G111 X10 Y10\nG0 RP=5 AP=90", {"X": 10, "Y": 15}),
    "G110 from where the tool stands": ("G0 X3\nG110 X1 Y0\nG0 RP=5 AP=0", {"X": 9, "Y": 0}),
    "AP=IC counts on from the last angle": ("G111 X0 Y0\nG0 RP=5 AP=30\nAP=IC(60)", {"X": 0, "Y": 5}),
    # arcs
    "CR below 0 is the larger arc": ("G2 X10 Y0 CR=-5.5 F100", {"X": 10, "Y": 0}),
    "an arc about the pole": ("G0 X10\nG111 X0 Y0\nG3 AP=90 RP=10 F100", {"X": 0, "Y": 10}),
    "AR with the centre says the end": ("G3 I0 J5 AR=90 F100", {"X": 5, "Y": 5}),
    "ANG= with one coordinate": ("G1 Y10 ANG=45 F100", {"X": 10, "Y": 10}),
    "CT goes on along the tangent": ("G1 X5 F100\nCT X10 Y5", {"X": 10, "Y": 5}),
    # flow
    "FOR counts up to its last value": ("DEF INT II\nFOR II=1 TO 3\nG91 G0 X1\nENDFOR", {"X": 3}),
    "FOR runs nothing when it begins beyond": ("FOR R1=3 TO 1\nG0 X1\nENDFOR\nY1", {"X": 0, "Y": 1}),
    "UNTIL looks behind the body": ("R1=9\nREPEAT\nG91 G0 X1\nUNTIL R1>1", {"X": 1}),
    "GOTOB goes back": ("R1=0\nBACK: R1=R1+1\nIF R1<3 GOTOB BACK\nG0 X=R1", {"X": 3}),
    "GOTOC goes on where there is no label": ("GOTOC NOWHERE\nG0 X1", {"X": 1}),
    "REPEATB runs one block again": ("G91\nONE: G0 X1\nREPEATB ONE P=3", {"X": 4}),
    "REPEAT runs up to its own block": ("G91\nONE: G0 X1\nY1\nREPEAT ONE P=2", {"X": 3, "Y": 3}),
    "M17 in the main program ends it": ("G0 X1\nM17\nX5", {"X": 1}),
    # what a line holds besides a statement
    "words behind a message are a block": ('MSG("A;B") G0 X10 ; X99', {"X": 10}),
    "words behind STOPRE too": ("STOPRE G0 X5", {"X": 5}),
    "several limits of acceleration": ("ACC[X]=50 ACC[Y]=60 G0 X3", {"X": 3}),
    # calls
    "CALL by a text that a variable holds": ('DEF STRING[20] PP="SUB"\nCALL PP\nM30\n%_N_SUB_SPF\nG0 X1\nRET', {"X": 1}),
    "CALL of a part of another program": (
        'CALL "SUB" BLOCK LA TO LB\nM30\n%_N_SUB_SPF\nG0 X5\nLA: G91 G0 X1\nLB: Y2\nG90 G0 X7\nRET', {"X": 1, "Y": 2}),
    "PCALL with its path and values": (
        "PCALL /_N_WKS_DIR/_N_SUB_SPF(3)\nM30\n%_N_SUB_SPF\nPROC SUB(REAL AA)\nG0 X=AA\nRET", {"X": 3}),
    "EXTCALL with a folder": ('EXTCALL "DIR/SUB.SPF"\nM30\n%_N_SUB_SPF\nG0 X1\nRET', {"X": 1}),
    "VAR of a table changes the caller's": (
        "DEF REAL TT[3]=SET(1,2,3)\nSUB(TT)\nG0 X=TT[0] Y=TT[2]\nM30\n%_N_SUB_SPF\nPROC SUB(VAR REAL AA[3])\nAA[0]=9\nRET",
        {"X": 9, "Y": 3}),
    "a table by its values stays": (
        "DEF REAL TT[2,2]=SET(1,2,3,4)\nSUB(TT)\nG0 X=TT[0,0]\nM30\n%_N_SUB_SPF\nPROC SUB(REAL AA[,])\nG0 Y=AA[1,0]\nAA[0,0]=9\nRET",
        {"X": 1, "Y": 3}),
    "a text for a parameter": (
        'SUB("ABC",1)\nM30\n%_N_SUB_SPF\nPROC SUB(STRING[20] NAME, REAL AA)\nG0 X=AA\nRET', {"X": 1}),
    # feeds and planes
    "G70 counts lengths in inches": ("G70 G0 X1", {"X": 25.4}),
    "the length acts along Z in every plane": ("T2 M6\nG18 G0 Z0", {"Z": 12.5}),
}  # fmt: skip
REFUSED: dict[str, tuple[str, str]] = {
    "a value that is computed without =": ("G1 X2+3 F100", "expression"),
    "MOD of parts of numbers": ("R1=7.5 MOD 2", "undefined-value"),
    "a variable that nobody defined": ("DEPTH=5", "unknown-variable"),
    "a variable of the main program in a subprogram": (
        "DEF REAL DEPTH=5\nSUB\nM30\n%_N_SUB_SPF\nG0 X=DEPTH\nM17", "unknown-variable"),
    "a second definition": ("DEF REAL AA\nDEF REAL AA", "definition"),
    "an element beyond its table": ("DEF REAL TT[3]\nR1=TT[3]", "parameter-number"),
    "more elements of REP than there are": ("DEF REAL TT[4]\nTT[1]=REP(5,9)", "assignment"),
    "REP of nothing": ("DEF REAL TT[4]=REP()", "assignment"),
    "several values for one variable": ("DEF REAL AA=SET(1,2)", "assignment"),
    "a number compared with a text": ('R1=1\nIF R1=="A"\nENDIF', "text-value"),
    "an index that is missing": ("$TC_DP6[,1]=5", "parameter-number"),
    "a frame that turns, as a value": ("$P_UIFR[1]=CTRANS(X,1):CROT(Z,45)", "frame"),
    "the programmable frame as a value": ("$P_PFRAME=CTRANS(X,1)", "frame"),
    "a shift of no axis": ("$P_UIFR[1]=CTRANS(Q,1)", "no-such-axis"),
    "a jump into a structure": ("GOTOF IN\nIF 1\nIN: G0 X1\nENDIF", "jump-into-structure"),
    "GOTOF to a label behind": ("BACK: G0 X1\nGOTOF BACK", "unknown-label"),
    "a polar and a Cartesian end": ("G1 X5 RP=3 AP=0 F100", "polar-mixed"),
    "a full circle by its radius": ("G2 X0 Y0 CR=5 F100", "arc-full-by-radius"),
    "an arc that a scale makes an ellipse": ("SCALE X2\nG2 X10 Y0 I5 F100", "scale"),
    "DC of a linear axis": ("G0 X=DC(5)", "rotary-direction"),
    "an angle of DC beyond a turn": ("G0 C=DC(400)", "rotary-direction"),
    "ISO mode": ("G291", "unsupported-g"),
    "a transformation": ("TRAORI", "tool-center"),
    "a spline": ("BSPLINE", "unsupported-g"),
    "more values than PROC has": ("SUB(1,2)\nM30\n%_N_SUB_SPF\nPROC SUB(REAL AA)\nM17", "call-values"),
    "a number for a VAR": ("SUB(1)\nM30\n%_N_SUB_SPF\nPROC SUB(VAR REAL AA)\nM17", "call-values"),
    "a cycle that would go up": ("CYCLE81(10,0,2,5)", "cycle-depth"),
    "CYCLE63": ('CYCLE63("CONTOUR",10,0,2,-5)', "unsupported-statement"),
    "a synchronised action": ("WHEN TRUE DO M8", "unsupported-statement"),
    "a curve between arc and intersection": ("DISC=50", "unsupported-word"),
    "a number for a text": ("SUB(5)\nM30\n%_N_SUB_SPF\nPROC SUB(STRING[9] AA)\nM17", "text-value"),
    "a number for a table": ("SUB(5)\nM30\n%_N_SUB_SPF\nPROC SUB(REAL AA[3])\nM17", "call-values"),
    "a call of a variable that holds nothing": ("CALL NOPE", "call-values"),
    "the feed of one axis": ("FL[X]=500", "unsupported-statement"),
    "two spindles": ("S2=500", "expression"),
}  # fmt: skip


@pytest.mark.parametrize("what", LEADS)
def test_a_program_leads_where_the_manual_says(what: str) -> None:
    text, wanted = LEADS[what]
    position = good(f"{text}\nM30", "sinumerik", settings=WITH_TABLES).position
    assert {name: position[name] for name in wanted} == pytest.approx(wanted)


@pytest.mark.parametrize("what", REFUSED)
def test_what_the_control_or_the_twin_refuses(what: str) -> None:
    text, code = REFUSED[what]
    assert bad(f"{text}\nM30", "sinumerik", settings=WITH_TABLES).code == code


def test_pecks_become_less_deep_by_the_degression() -> None:
    """The example of the manual on deep drilling: the last two are equally deep."""
    assert pecks(20.0, 8.0, 3.0) == pytest.approx([8.0, 5.0, 3.0, 2.0, 2.0])
    assert pecks(10.0, 4.0, 0.0) == pytest.approx([4.0, 4.0, 2.0])
    assert pecks(10.0, 4.0, -0.5, 1.0) == pytest.approx([4.0, 2.0, 1.0, 1.0, 1.0, 1.0])


def test_corners_by_their_codes() -> None:
    moves = good("F100\nG1 X1\nG9 X2\nG64 X3\nG9 X4\nX5\nG60 X6\nM30", "sinumerik").moves
    stop, round_ = Corner.EXACT_STOP, Corner.CONTINUOUS
    assert moves.corner.tolist() == [stop, stop, round_, stop, round_, stop]


def test_disc_100_passes_corners_as_g451_does() -> None:
    text = "T1 M6\nG41 {} G1 X10 F100\nY20\nX30\nG40 X50\nM30"
    ends = {words: good(text.format(words), "sinumerik", settings=WITH_TABLES).moves
            for words in ("G450", "G451", "G450 DISC=100", "G450 DISC=0")}  # fmt: skip
    assert ends["G450 DISC=100"].end.tolist() == ends["G451"].end.tolist()
    assert ends["G450 DISC=0"].end.tolist() == ends["G450"].end.tolist()
    assert len(ends["G450"].end) == len(ends["G451"].end) + 1


def test_d_of_the_block_gives_g41_its_radius() -> None:
    moves = good(
        "T1 M6 D0\nG41 D1 OFFN=1 G1 X10 F100\nY20\nG40 X0\nM30", "sinumerik", settings=WITH_TABLES
    ).moves
    assert moves.end[1, 0] == pytest.approx(10.0 - 2.0 - 1.0)


def test_turns_are_further_ones() -> None:
    moves = good("G2 X0 Y0 Z-6 I5 TURN=2 F100\nM30", "sinumerik").moves
    assert moves.sweep.tolist() == [-1080.0]


def test_a_modal_call_runs_behind_moves_alone() -> None:
    text = "S500 M3\nG0 X1\nMCALL CYCLE81(10,0,2,-3)\nM8\nX5\nF200\nMCALL\nX9\nM30"
    moves = good(text, "sinumerik").moves
    assert (moves.end[:, 2] == -3.0).sum() == 1


def test_save_puts_back_codes_and_frames() -> None:
    sub = "\nM30\n%_N_SUB_SPF\nPROC SUB SAVE\nG91 TRANS X50\nM17"
    assert good(f"G0 X1\nSUB\nX2{sub}", "sinumerik").position["X"] == 2.0


def test_var_gives_a_value_back() -> None:
    sub = "\nM30\n%_N_SUB_SPF\nPROC SUB(REAL AA, VAR REAL BB)\nBB=AA*2\nRET"
    assert good(f"DEF REAL CC\nSUB(4,CC)\nG0 X=CC{sub}", "sinumerik").position["X"] == 8.0


def test_a_tool_by_its_name_is_that_of_the_job() -> None:
    from twin.nc.control.settings import ToolData

    tools = {7: ToolData(2.0, 60.0, "ROUGHING"), 9: ToolData(3.0, 72.0, "finishing")}
    outcome = good('T="FINISHING" M6\nG0 Z0\nM30', "sinumerik", tools=tools)
    words = [event.word for event in outcome.events if isinstance(event, Function)]
    assert words == ["T9", "M6", "M30"]
    assert outcome.position["Z"] == 12.0


# --- random expressions and frames beside closed forms

_LEVELS: list[dict[str, Callable[[float, float], float]]] = [
    {"==": lambda a, b: float(a == b), "<": lambda a, b: float(a < b), ">=": lambda a, b: float(a >= b)},
    {" OR ": lambda a, b: float(bool(a) or bool(b))},
    {" XOR ": lambda a, b: float(bool(a) != bool(b))},
    {" AND ": lambda a, b: float(bool(a) and bool(b))},
    {" B_OR ": lambda a, b: float(int(a) | int(b))},
    {" B_XOR ": lambda a, b: float(int(a) ^ int(b))},
    {" B_AND ": lambda a, b: float(int(a) & int(b))},
    {"+": lambda a, b: a + b, "-": lambda a, b: a - b},
    {"*": lambda a, b: a * b, " DIV ": lambda a, b: float(math.trunc(a / b))},
]  # fmt: skip
"""Operators by their priority in the manual, the lowest first."""


def _expression(chance: random.Random, level: int, depth: int) -> tuple[str, float]:
    """A random expression of operators from a level on, with no bracket that is not needed, and its value."""
    if depth == 0 or level == len(_LEVELS):
        if depth and chance.random() < 0.3:
            text, value = _expression(chance, 0, depth - 1)
            return f"({text})", value
        number = chance.randrange(1, 20)
        return str(number), float(number)
    text, value = _expression(chance, level + 1, depth - 1)
    for _ in range(chance.randrange(3)):
        symbol = chance.choice(list(_LEVELS[level]))
        right, other = _expression(chance, level + 1, depth - 1)
        text, value = f"{text}{symbol}{right}", _LEVELS[level][symbol](value, other)
    return text, value


@given(seed=st.integers(0, 2**32))
def test_random_expressions_by_the_table_of_priorities(seed: int) -> None:
    chance = random.Random(seed)  # noqa: S311 (expressions need no cryptography)
    try:
        text, value = _expression(chance, 0, len(_LEVELS) + 2)
    except ZeroDivisionError:
        return
    if not abs(value) <= 1e5 or text.count(" ") + len(text) > 300:
        return
    assert good(f"R1={text}\nG0 X=R1\nM30", "sinumerik").position["X"] == pytest.approx(value)


def _turn(axis: int, degrees: float) -> np.ndarray:
    cosine, sine = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    a, b = [(1, 2), (2, 0), (0, 1)][axis]
    turn = np.eye(4)
    turn[a, a], turn[a, b], turn[b, a], turn[b, b] = cosine, -sine, sine, cosine
    return turn


@given(seed=st.integers(0, 2**32))
def test_random_chains_of_frames_are_products_of_matrices(seed: int) -> None:
    chance, frame, lines = random.Random(seed), np.eye(4), list[str]()  # noqa: S311 (the same)
    for _ in range(chance.randrange(1, 7)):
        kind, x, y, z = (
            chance.choice(["TRANS", "ROT", "SCALE", "MIRROR"]),
            *(round(chance.uniform(0.5, 40.0), 3) for _ in range(3)),
        )
        if kind == "TRANS":
            change = np.eye(4)
            change[:3, 3] = x, y, z
        elif kind == "ROT":
            change = _turn(2, z) @ _turn(1, y) @ _turn(0, x)
        elif kind == "SCALE":
            change = np.diag([x / 10.0, y / 10.0, z / 10.0, 1.0])
            x, y, z = x / 10.0, y / 10.0, z / 10.0
        else:
            change = np.diag([-1.0, 1.0, -1.0, 1.0])
        adds = chance.random() < 0.7
        words = "X0 Z0" if kind == "MIRROR" else f"X{x:.6f} Y{y:.6f} Z{z:.6f}"
        lines.append(f"{'A' * adds}{kind} {words}")
        frame = frame @ change if adds else change
    place = [round(chance.uniform(-9.0, 9.0), 3) for _ in range(3)]
    lines.append("G0 X{:.3f} Y{:.3f} Z{:.3f}".format(*place))
    position = good("\n".join([*lines, "M30"]), "sinumerik").position
    wanted = frame @ np.array([*place, 1.0])
    assert [position[name] for name in "XYZ"] == pytest.approx(wanted[:3].tolist(), abs=1e-6)


def test_rndm_0_still_rounds_the_corner_before_its_block() -> None:
    text = "G1 X0 Y0 F100\nX20 RNDM=3\nY20\nX0 RNDM=0\nY0"
    moves = good(f"G54 G90\n{text}\nM30", "sinumerik").moves
    assert moves.sweep.tolist() == [0.0, 90.0, 0.0, 90.0, 0.0, 0.0]


def test_another_edge_is_that_of_the_tool_as_long_as_it_alone_is_called() -> None:
    """Posts write the tool's number as D; the job gives every tool one edge."""
    tools = {1: ToolData(4.0, 60.0), 2: ToolData(3.0, 72.5)}
    made = good("T2 D2\nM6\nG0 Z5\nT1 D1\nM6\nG0 Z9\nM30\n", "sinumerik", tools=tools)
    assert made.codes == ["tool-edge"]
    assert [made.end(row)["Z"] for row in range(len(made.moves))] == [17.5, 9.0]
    refused = bad("T2 D1\nM6\nD2\nM30\n", "sinumerik", tools=tools)
    assert (refused.code, refused.hint) == ("tool-offset", "write D1")
