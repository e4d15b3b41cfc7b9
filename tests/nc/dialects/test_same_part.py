"""The same part written for several controls gives the same path to a millionth of a millimetre."""

import math

import numpy as np
import pytest

from tests.nc.running import good
from twin.nc.canonical import Moves, Shape
from twin.nc.control.settings import ToolData

TOOLS = {1: ToolData(3.0, 60.0)}
SAMPLES = 997

HOLES = [
    (10.0 + 40.0 * math.cos(math.radians(a)), 20.0 + 40.0 * math.sin(math.radians(a)))
    for a in range(0, 360, 60)
]
DRILLED = "\n".join(f"X{x:.9f} Y{y:.9f}" for x, y in HOLES[1:])

PARTS = {
    "ring of holes": {
        "gost": f"G0 X0 Y0 Z2\nG99 G81 X50 Y20 Z-5 R2 F300\n{DRILLED}\nG80\nM30",
        "mefi": f'G0 X0 Y0 Z2 "start\nG81 X50 Y20 Z-5 R2 F300\n{DRILLED}\nG80\nM30',
        "codesys": "LET #a : LREAL := 0\nN1 G0 X0 Y0 Z2 F5\n"
        "N10 G0 X10+40*COS(#a*PI/180) Y20+40*SIN(#a*PI/180)\nN20 G1 Z-5\nN30 G0 Z2\n"
        "#a := #a + 60\nN40 G20 L10 K#a<360",
        "fagor8070": "G00 X0 Y0 Z2\nG30 I10 J20\nG99 G81 Z2 I-5 R40 Q0 F300\n"
        "G91 Q60 NR5\nG90 G80\nM30",
        "heidenhain": "L X+0 Y+0 Z+2 R0 FMAX\nCYCL DEF 200 DRILLING Q200=2 Q201=-5 Q206=300 Q202=5 Q210=0 Q203=0 "
        "Q204=2 Q211=0\nCC X+10 Y+20\nQ1 = 0\nLBL 1\nLP PR+40 PA+Q1 FMAX M99\nQ1 = Q1 + 60\n"
        "FN 12: IF +Q1 LT +360 GOTO LBL 1",
    },
    "pocket with rounded corners": {
        "gost": "G0 X0 Y-20 Z-2\nG1 X25 F600\nG3 X30 Y-15 R5\nG1 Y15\nG3 X25 Y20 I-5 J0\nG1 X-25\n"
        "G3 X-30 Y15 R5\nG1 Y-15\nG3 X-25 Y-20 R5\nG1 X0",
        "mefi": "G0 X0 Y-20 Z-2\nG91\nG1 X25 F600\nG3 X5 Y5 J5\nG1 Y30\nG3 X-5 Y5 I-5\nG1 X-50\n"
        "G3 X-5 Y-5 J-5\nG1 Y-30\nG3 X5 Y-5 R5\nG1 X25",
        "codesys": "N1 G0 X0 Y-20 Z-2 F10 N2 G1 X25 N3 G3 J5 T90 N4 G1 Y15 N5 G3 I-5 T90 N6 G1 X-25 "
        "N7 G98 N8 G3 X-30 Y15 I-25 J15 N9 G99 N10 G1 Y-15 N11 G3 X-25 Y-20 R5 N12 G1 X0",
        "fagor8070": "G00 X0 Y-20 Z-2\nG01 X25 F600\nG30 I25 J-15\nG03 R5 Q0\nG01 Y15\n"
        "G31 G03 Q90 I-5 J0\nG01 X-25\nG08 X-30 Y15\nG01 Y-15\nG263=5\nG03 X-25 Y-20\n"
        "G01 X0\nM30",
        "heidenhain": "L X+0 Y-20 Z-2 R0 FMAX\nL X+30 F600\nRND R5\nL Y+20\nRND R5\nL X-30\nRND R5\nL Y-20\n"
        "RND R5\nL X+0",
    },
    "helix bore": {
        "gost": "G0 X20 Y0 Z0\nG91 F900\n" + "G3 X0 Y0 Z-2 I-20\n" * 4,
        "mefi": "N1 G0 X20 Y0 Z0\nN2 Z-2 G10\nN3 G09 G03 X20 Y0 I-20 F900 G73 L3 Q3\nN4 G98",
        "codesys": "N1 G0 X20 Y0 Z0 F15 N2 G3 I-20 J0 T1080 Z-6 N3 G3 I-20 J0 T360 Z-8",
        "fagor8070": "G00 X20 Y0 Z0\nG03 X20 Y0 I-20 J0 Z-8 K2 F900\nM30",
        "heidenhain": "L X+20 Y+0 Z+0 R0 FMAX\nCC X+0 Y+0\nCP IPA+1440 IZ-8 DR+ F900",
    },
    "scroll with C": {
        "gost": "G102 C360\nG0 X10\nG1 X15 C180 F500\nX20 C360\nX25 C180\nX30 C360\nG102 C0",
        "mefi": "N1 G0 X10\nN2 G91\nN3 G1 X5 C180 F500 G73 L3 Q3",
        "codesys": "N1 G0 X10 F500/60 N2 G1 X15 C180 N3 X20 C360 N4 X25 C540 N5 X30 C720",
        "fagor8070": "P1=0\nG00 X10\n$WHILE P1<4\nP1+=1\nG01 X[10+5*P1] C[180*P1] F500\n$ENDWHILE\nM30",
        "heidenhain": "L X+10 R0 FMAX\nLBL 1\nL IX+5 IC+180 F500\nCALL LBL 1 REP 3",
    },
    "compensated contour": {
        "gost": "G0 X-20 Y-20 Z-1\nG41 D1 G1 X0 Y0 F300\nY30\nG2 X10 Y40 R10\nG1 X40\nY20\n"
        "G3 X50 Y10 R10\nG1 Y0\nX0\nG40 X-20 Y-20",
        "mefi": "G0 X-20 Y-20 Z-1\nG41 D1 G1 X0 Y0 F300\nY30\nG2 X10 Y40 I10\nG1 X40\nY20\n"
        "G3 X50 Y10 I10\nG1 Y0\nX0\nG40 X-20 Y-20",
        "codesys": "N1 G0 X-20 Y-20 Z-1 F5 N2 G41 D3 G1 X0 Y0 N3 Y30 N4 G2 I10 T90 N5 G1 X40 "
        "N6 Y20 N7 G3 X50 Y10 I10 J0 N8 G1 Y0 N9 X0 N10 G40 G1 X-20 Y-20",
        "fagor8070": "G136 G00 X-20 Y-20 Z-1\nG41 G01 X0 Y0 F300\nY30\nG02 X10 Y40 R10\nG01 X40\n"
        "Y20\nG30 I50 J20\nG03 Q-90\nG01 Y0\nX0\nG40 X-20 Y-20\nM30",
        "heidenhain": "L X-20 Y-20 Z-1 R0 FMAX\nL X+0 Y+0 RL F300\nL Y+30\nCR X+10 Y+40 R+10 DR-\nL X+40\nL Y+20\n"
        "CC X+50 Y+20\nC X+50 Y+10 DR+\nL Y+0\nL X+0\nL X-20 Y-20 R0",
    },
}  # fmt: skip


def sampled(moves: Moves) -> np.ndarray:
    """Positions at equal steps of the path's length, all axes."""
    ends = np.cumsum(moves.length)
    at = np.linspace(0.0, ends[-1], SAMPLES)
    rows = np.minimum(np.searchsorted(ends, at), len(moves) - 1)
    share = (at - (ends[rows] - moves.length[rows])) / moves.length[rows]
    return np.array([point(moves, row, u) for row, u in zip(rows, share, strict=True)])


def point(moves: Moves, row: int, u: float) -> np.ndarray:
    start, end = moves.start[row], moves.end[row]
    position = start + u * (end - start)
    if moves.shape[row] == Shape.ARC:
        angle, normal = math.radians(u * moves.sweep[row]), moves.normal[row]
        spoke = start[:3] - moves.center[row]
        advance = (end - start)[:3] @ normal
        turned = spoke * math.cos(angle) + np.cross(normal, spoke) * math.sin(angle)
        position[:3] = moves.center[row] + turned + u * advance * normal
    return position


@pytest.mark.parametrize("part", PARTS)
@pytest.mark.parametrize("dialect", ["mefi", "codesys", "fagor8070", "heidenhain"])
def test_the_path_is_that_of_the_first_dialect(part: str, dialect: str) -> None:
    wanted = good(PARTS[part]["gost"], "gost", tools=TOOLS).moves
    made = good(PARTS[part][dialect], dialect, tools=TOOLS).moves
    np.testing.assert_allclose(sampled(made), sampled(wanted), atol=1e-6)
    assert feeds(made) == pytest.approx(feeds(wanted))


def feeds(moves: Moves) -> list[float]:
    return sorted({round(feed, 9) for feed in moves.feed if not math.isnan(feed)})


def test_the_ring_has_six_holes() -> None:
    moves = good(PARTS["ring of holes"]["gost"], "gost").moves
    bottoms = moves.end[moves.end[:, 2] == -5.0]
    np.testing.assert_allclose(bottoms[:, :2], HOLES, atol=1e-9)


def test_the_contour_keeps_the_tools_radius() -> None:
    """Every point of the compensated path is 3 mm from the nearest point of the contour."""
    text = PARTS["compensated contour"]["gost"]
    contour = sampled(good(text.replace("G41 D1", ""), "gost").moves[2:-1])
    path = sampled(good(text, "gost", tools=TOOLS).moves[2:-1])
    away = np.linalg.norm(path[:, None, :2] - contour[None, :, :2], axis=2).min(axis=1)
    assert away.min() > 3.0 - 1e-9
    assert away.max() < 3.0 + 0.1  # the samples of the contour lie 0.15 mm apart
