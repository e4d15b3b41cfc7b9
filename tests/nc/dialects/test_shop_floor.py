"""Programs as operators and post-processors write them, with results worked out by hand.

Each states where the axes end, the length cut with a feed, and how many arcs there are; further
facts stand in tests of their own below.
"""

import dataclasses
import math

import numpy as np
import pytest

from tests.nc.running import good
from twin.nc.canonical import Function, Shape
from twin.nc.control.settings import ToolData

PI, ROOT2 = math.pi, math.sqrt(2.0)
TOOLS = {1: ToolData(5.0, 60.0), 2: ToolData(3.0, 75.0)}
OFFSETS = {"G55": {"X": 100.0}, "G56": {"X": 100.0, "Y": 50.0}}


@dataclasses.dataclass(frozen=True)
class Job:
    """A program and what it must come to."""

    text: str
    end: tuple[float, float, float, float]
    cut: float
    arcs: int = 0
    warnings: tuple[str, ...] = ()


GOST = {
    "outline by hand": Job(
        "%\nN10 G90 G17 G71\nN20 T1 M6\nN30 S1200 M3\nN40 G0 X0 Y0 Z5\nN50 G1 Z-2 F100\n"
        "N60 X80 F300\nN70 Y60\nN80 X0\nN90 Y0\nN100 G0 Z50 M5\nN110 M30\n",
        (0, 0, 50, 0), 7 + 280,
    ),
    "slot with round ends": Job(
        "G0 X-20 Y-5 Z2\nG1 Z-3 F80\nX20 F200\nG3 X20 Y5 R5\nG1 X-20\nG3 X-20 Y-5 I0 J-5\nG0 Z10\nM2",
        (-20, -5, 10, 0), 5 + 80 + 10 * PI, 2,
    ),
    "spiral down by G91": Job(
        "G0 X30 Y0 Z0\nG91 F250\n" + "G2 X0 Y0 Z-1.5 I-30 J0\n" * 3 + "G90 G0 Z5",
        (30, 0, 5, 0), 3 * math.hypot(60 * PI, 1.5), 3,
    ),
    "face with subroutine-free zigzag": Job(
        "G0 X-5 Y0 Z0\nG91 G1 F800\n" + "X110\nY8\nX-110\nY8\n" * 4 + "G90 G0 Z20",
        (-5, 64, 20, 0), 8 * 118,
    ),
    "plate of holes in two vices": Job(
        "G54 G0 X0 Y0 Z20\nG98 G81 X10 Y10 Z-12 R2 F120\nX40\nG80\n"
        "G55\nG81 X10 Y10 Z-12 R2\nX40\nG80\nG54 G0 X0 Y0",
        (0, 0, 20, 0), 4 * 14,
    ),
    "indexing on the table": Job(
        "G102 C360 $ period\nG0 X20 Z2\nG1 Z-1 F100 $ plunge\nC90 F1800\nZ2\nC360\nZ-1\nC450\nG0 Z20\n"
        "G102 C0",
        # 360 is relabelled 0 at the next block, so that 450 is a turn and a quarter more.
        (20, 0, 20, 810), 3 * 3 + 90 + 270 + 450,
    ),
    "thread-like helix around a boss": Job(
        "G102 C360\nG0 X25 Z1\nG1 X20 F200\nG91 Z-4 C1440 F600\nG90 G0 X40",
        (40, 0, -3, 1440), 5 + 4,
    ),
    "inch program from an old tape": Job(
        "G70 G90\nG0 X1. Y.5 Z.1\nG1 Z-.05 F4.\nX2.5\nG2 X3. Y0. I0 J-.5\nG0 Z1.\nG71",
        (76.2, 0, 25.4, 0), 25.4 * (0.15 + 1.5 + 0.25 * PI), 1,
    ),
    "preset in the middle": Job(
        "G0 X100 Y40\nG92 X0 Y0\nG1 X10 Y10 F100\nG92 X100 Y100\nG1 X90 Y90", (100, 40, 0, 0),
        20 * ROOT2,
    ),
    "second tool is longer": Job(
        "T1 M6\nG43 H1 G0 Z10\nG1 Z0 F50\nG0 Z10\nG49 T2 M6\nG43 H2 Z10\nG1 Z0\nG49 G0 Z50",
        (0, 0, 50, 0), 20,
    ),
    "exact stops at corners": Job("G61 G1 X30 F600\nY30\nG64 X0\nY0", (0, 0, 0, 0), 120),
    "quarter arcs in G18 and G19": Job(
        "G18 G0 X10 Z0\nG3 X0 Z10 K10 I0 F100\nG19 G0 Y10\nG2 Y20 Z0 R10\n", (0, 20, 0, 0),
        # G18 turns from Z to X: about (X10, Z10) from -Z to -X, a quarter; then one of G19.
        5 * PI + 5 * PI, 2,
    ),
}  # fmt: skip

MEFI = {
    "page's helix with an own feed": Job(
        'N5 X0 Y0 Z0 G00\nN10 Z1.05 G10 "lead\nN50 G09 G02 X0 Y0 I100 G73 L50 Q20 F500\n'
        "N60 X200. Y0 I100\nN70 G98",
        (200, 0, 22.575, 0), 21.5 * math.hypot(200 * PI, 1.05), 22,
    ),
    "boring downwards": Job(
        "N1 G00 X15 Z0\nN2 Z-0.5 G10\nN3 G09 G03 X15 Y0 I-15 F300 G73 L3 Q9\nN4 G98\n"
        "N5 G03 X15 Y0 I-15\nN6 G00 X0\nN7 Z20",
        (0, 0, 20, 0), 10 * math.hypot(30 * PI, 0.5) + 30 * PI, 11,
    ),
    "comb by nested repeats": Job(
        "N10 G91 G00 X10\nN20 G01 Y5 F200\nN30 Y-5 G73 L20 Q1\nN40 G00 Z1 G73 L10 Q3",
        (40, 0, 4, 0), 4 * 20,
    ),
    "table dragged with the circle": Job(
        "N1 C36 G10\nN2 G09 G02 I20 F400 G73 L2 Q4\nN3 G98", (0, 0, 0, 180), 5 * 40 * PI, 5,
    ),
    "half pitch up, half pitch down": Job(
        "N1 Z2 G10\nN2 G09 G02 X20 I10 F100\nN3 Z-2 G10\nN4 G02 X0 I-10\nN5 G98", (0, 0, 0, 0),
        2 * math.hypot(10 * PI, 1.0), 2,
    ),
    "jump over what is not wanted": Job(
        "N1 G00 X5 G73 L3\nN2 X99\nN3 G01 Y5 F100", (5, 5, 0, 0), 5,
    ),
    "drilled row by repeat": Job(
        "N1 G00 Z10\nN2 G81 X0 Y0 Z-6 R1 F90\nN3 G91 X12 G73 L3 Q4\nN4 G90 G80\nN5 G00 X0",
        # In G91 a hole's X counts from the last hole; the heights stay as they were given.
        (0, 0, 10, 0), 6 * 7,
    ),
    "helix in G18": Job(
        "N1 G18\nN2 Y-1 G10\nN3 G09 G03 K8 F100 G73 L3 Q2\nN4 G98", (0, -3, 0, 0),
        3 * math.hypot(16 * PI, 1.0), 3,
    ),
    "rounded square, incremental": Job(
        "N1 G91 G01 X20 F300\nN2 G03 X5 Y5 R5\nN3 G01 Y20\nN4 G03 X-5 Y5 I-5\nN5 G01 X-20\n"
        "N6 G03 X-5 Y-5 J-5\nN7 G01 Y-20\nN8 G03 X5 Y-5 R5",
        (0, 0, 0, 0), 80 + 10 * PI, 4,
    ),
    "decimal points and spaces as they come": Job(
        "N 10 G 00 X 10. Y.5\nN20 g01 x-10.0 f1e2\n".replace("1e2", "100"), (-10, 0.5, 0, 0), 20,
    ),
}  # fmt: skip

CODESYS = {
    "seed's page in one go": Job(
        "N10 G1 X100 Y100 F100 N20 G2 X200 Y100 R50 N30 G98 N40 G2 X100 Y100 I150 J100 N50 G99 "
        "N60 G2 I50 J0 T720",
        (100, 100, 0, 0), 100 * ROOT2 + 50 * PI + 50 * PI + 4 * 50 * PI, 3,
    ),
    "plotter with a pen": Job(
        "N0 G0 X0 Y0 F50 E200 E-200\nN10 M10\nN20 G1 X100\nN30 Y50\nN40 M11\nN50 G0 X0 Y0",
        (0, 0, 0, 0), 150,
    ),
    "glue bead with switch points": Job(
        "N10 G1 X100 F20 H3 L10 H-3 L-10 N20 G3 X120 Y20 R20 N30 G1 Y80", (120, 80, 0, 0),
        100 + 10 * PI + 60, 1,
    ),
    "polygon by a loop": Job(
        "LET #n : LREAL := 0\nN10 G1 X20 F10\nN20 G36 O#n D0\nN30 G37 O#n D1\n"
        "N40 G1 X20*COS(PI/3*#n) Y20*SIN(PI/3*#n)\nN50 G20 L30 K#n<6",
        (20, 0, 0, 0), 20 + 6 * 20,
    ),
    "pocket wall by a subprogram": Job(
        "N10 G1 Z-1 F10\nWALL{30, 20}\nN20 G1 Z-2\nWALL{30, 20}\nN30 G0 Z5\nN40 G20 L99 K1\n"
        "SUBPROGRAM WALL{#l : LREAL, #w : LREAL} RESTORE\nN50 G91 G1 X#l\nN60 Y#w\nN70 X-#l\nN80 Y-#w\n"
        "END_SUBPROGRAM\nN99 G75",
        (0, 0, 5, 0), 2 + 200,
    ),
    "rounded corners by G52": Job(
        "N10 G52 D3\nN20 G1 X40 F10\nN30 Y30\nN40 X0\nN50 Y0\nN60 G50", (0, 0, 0, 0),
        140 - 3 * 6 + 3 * 1.5 * PI, 3,
    ),
    "compensated square": Job(
        "N10 G0 X-10 Y-10 N20 G41 D4 G1 X0 Y0 F10 N30 Y40 N40 X40 N50 Y0 N60 X0 N70 G40 X-10 Y-10",
        (-10, -10, 0, 0), math.hypot(6, 10) + 160 + 3 * 2 * PI + math.hypot(10, 6), 3,
    ),
    "shifted copies": Job(
        "N10 G54 X50 Y0\nN20 G0 X0 Y0\nN30 G2 I5 T360 F10\nN40 G55 Y30\nN50 G0 X0 Y0\nN60 G2 I5 T360\n"
        "N70 G53\nN80 G0 X0 Y0",
        (0, 0, 0, 0), 20 * PI, 2,
    ),
    "turntable the short way": Job(
        "N10 PC360\nN20 G1 C350 F30\nN30 C20\nN40 C200\nN50 C10", (0, 0, 0, 370),
        # -10 stands for 350; 20, 200 and 370, which stands for 10, follow forwards.
        10 + 30 + 180 + 170,
    ),
    "arc on a slope": Job(
        "N10 G16 I0 J-1 K1\nN20 G1 X-10 F10\nN30 G3 I10 J0 K0 T180", (10, 0, 0, 0), 10 + 10 * PI, 1,
    ),
    "ellipse half": Job(
        "N10 G0 X20 Y0 F10 N20 G9 X-20 Y0 I-20 J0 K0 R1", (-20, 0, 0, 0), 20 * PI,
    ),
    "conveyor value from the application": Job(
        "N10 G1 X$g_length$ F10 (from the PLC)\nN20 G1 X$g_length$/2 Y5", (20, 5, 0, 0),
        40 + math.hypot(20, 5),
    ),
}  # fmt: skip

FAGOR = {
    "flange by polar coordinates": Job(
        "%FLANGE\nG90 G17 G54 F400 S1500 T1 D1 M06\nM03\nG00 X0 Y0 Z20\nG30 I50 J40\nG00 R30 Q0\n"
        "G01 Z-2\nG03 Q90\nQ180\nQ270\nQ360\nG00 Z20\nM30",
        (80, 40, 20, 0), 22 + 60 * PI, 4,
    ),
    "bolt circle with a loop": Job(
        "P1=0\nG00 Z20\nG81 Z2 I-10 F200\nG30 I0 J0\n$WHILE P1<6\nG00 R25 Q[60*P1]\nG81 Z2 I-10\n"
        "P1+=1\n$ENDWHILE\nG80\nG00 X0 Y0\nM30",
        # The first G81 drills where the tool is.
        (0, 0, 20, 0), 7 * 12,
    ),
    "keyway with a local subroutine": Job(
        "%L KEY\nG91 G01 X20\nY8\nX-20\nY-8\nG90\nM17\n%MAIN\nG00 X5 Y5 Z1\nG01 Z-1 F100\nLL KEY\n"
        "Z-2\nLL KEY\nG00 Z10\nM30",
        (5, 5, 10, 0), 2 + 1 + 2 * 56,
    ),
    "corners rounded and chamfered": Job(
        "G00 X0 Y0\nG01 X50 F300\nG36 I10\nY40\nG39 I5\nX0\nG36 I8\nY0\nM30", (0, 0, 0, 0),
        180 - 20 + 5 * PI - 10 + 5 * ROOT2 - 16 + 4 * PI, 2,
    ),
    "helical plunge by pitch": Job(
        "G00 X10 Y0 Z0\nG03 I-10 J0 Z-6 K2 F150\nG03 I-10 J0\nG01 X0\nM30", (0, 0, -6, 0),
        3 * math.hypot(20 * PI, 2) + 20 * PI + 10, 2,
    ),
    "tangent arcs": Job(
        "G01 X20 F100\nG08 X40 Y20\nG08 X20 Y40\nG01 X0\nM30", (0, 40, 0, 0), 40 + 20 * PI, 2,
    ),
    "mirrored half": Job(
        "%L HALF\nG01 X0 Y0\nX20\nG03 X30 Y10 R10\nG01 Y30\nM17\n%MAIN\nF200\nLL HALF\nG11\nLL HALF\n"
        "G10\nM30",
        (-30, 30, 0, 0),
        # From the first half's end back to the middle, then the mirrored half.
        2 * (20 + 5 * PI + 20) + math.hypot(30, 30), 2,
    ),
    "rotated slots": Job(
        "%L SLOT\nG00 X10 Y0\nG01 X30\nM17\n%MAIN\nF100\nP1=0\n$DO\nG73 Q[P1*90]\nLL SLOT\nG73\n"
        "P1=P1+1\n$ENDDO P1<4\nM30",
        (0, -30, 0, 0), 80,
    ),
    "incremental letters": Job(
        "G00 X10 Y10\nG01 X5I F100\nY5I\nX1=0 Y1=0\nG91 X3\nG90 X3\nM30", (3, 0, 0, 0),
        5 + 5 + math.hypot(15, 15) + 3,
    ),
    "switch by part number": Job(
        "P100=2\n$SWITCH P100\n$CASE 1\nG01 X10 F100\n$BREAK\n$CASE 2\nG01 Y20 F100\n$BREAK\n"
        "$DEFAULT\nG01 Z5 F100\n$ENDSWITCH\nM30",
        (0, 20, 0, 0), 20,
    ),
    "scaled square repeated": Job(
        "G72 S0.5\nN10 G91 G01 X40 F100\nY40\nX-40\nY-40\nN20\n#RPT[N10,N20]\nG90 G72\nM30",
        (0, 0, 0, 0), 160,
    ),
    "circular pocket cycle": Job(
        "G00 X0 Y0 Z10\nG88 X30 Y0 Z2 I-3 J10 B5 F400 V100\nG80\nM30",
        (30, 0, 10, 0), 5 + 5 + 10 * PI, 1,
    ),
    "radius kept by G263": Job(
        "G263=10\nG01 X0 F100\nG03 X20\nG02 X40\nG03 X60\nM30", (60, 0, 0, 0), 30 * PI, 3,
    ),
}  # fmt: skip
ALL = [
    (dialect, name, job)
    for dialect, jobs in [
        ("gost", GOST), ("mefi", MEFI), ("codesys", CODESYS), ("fagor8070", FAGOR),
    ]
    for name, job in jobs.items()
]  # fmt: skip


@pytest.mark.parametrize(
    ("dialect", "job"), [(d, j) for d, _, j in ALL], ids=[f"{d}: {n}" for d, n, _ in ALL]
)
def test_ends_lengths_and_arcs(dialect: str, job: Job) -> None:
    outcome = good(job.text, dialect, tools=TOOLS, offsets=OFFSETS, variables={"g_length": 40.0})
    moves = outcome.moves
    assert list(outcome.position.values()) == pytest.approx(job.end, abs=1e-9)
    assert float(moves.length[moves.motion == 1].sum()) == pytest.approx(job.cut, abs=1e-3)
    assert int((moves.shape == Shape.ARC).sum()) == job.arcs
    assert tuple(outcome.codes) == job.warnings
    np.testing.assert_array_equal(moves.start[1:], moves.end[:-1])


def test_there_are_programs_enough() -> None:
    assert len(ALL) >= 40


def test_spindle_and_tools_come_out_in_order() -> None:
    outcome = good(GOST["outline by hand"].text, "gost", tools=TOOLS)
    words = [event.word for event in outcome.events if isinstance(event, Function)]
    assert words == ["T1", "M6", "M3", "M5", "M30"]


def test_glue_is_switched_on_the_path() -> None:
    outcome = good(CODESYS["glue bead with switch points"].text, "codesys")
    found = [
        (e.word, dict(e.arguments)["on"], e.at) for e in outcome.events if isinstance(e, Function)
    ]
    assert found == [("H3", 1.0, 0.1), ("H3", 0.0, 0.9)]
