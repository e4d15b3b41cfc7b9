"""Blocks of LinuxCNC whose rules surprise: each was compared with ``rs274``, as it is again where that is installed."""

import pytest

from tests.nc.linuxcnc.marks import NEEDS_RS274
from tests.nc.linuxcnc.oracle import by_linuxcnc, by_twin, difference
from twin.nc.dialects.linuxcnc.curves import CHORDS_OF_A_PART

_COMPENSATED = "T2 M6\nF100\nG41 G1 X10\nX20\n{}\nX30\nG40 X40\nM2\n"
_NOT_COMPENSATED = (
    "G98", "G61", "G61.1", "G64 P0.1", "T1 M6", "M66 P1 L0", "M48", "M62 P1", "M68 E1 Q1", "#1=#5420",
    "G18", "M70\nG55\nM72",
)  # fmt: skip
"""What the control refuses while the radius is compensated."""
REFUSED = {
    **{_COMPENSATED.format(code): "compensation-change" for code in _NOT_COMPENSATED},
    "o1 if [1]\nG0 X1\no1 elseif [0]\no1 elseif [1/0]\no1 endif\nM2\n": "undefined-value",
    "o1 if [0]\no1 elseif [1]\nG0 X1\no1 elseif [#<x> GT 1]\no1 endif\nM2\n": "unknown-variable",
    "#1=#5602\nM2\n": "parameter-number",
    "F100\nG2\nM2\n": "arc-without-center",
    "F100\nG3\nG1 X1\nM2\n": "arc-without-center",
    "F100\nG2 F200\nM2\n": "arc-without-center",
    "G1\nM2\n": "no-feed",
    "S100 M3\nG33\nM2\n": "code-words",
    "S100 M3\nG33 K1\nM2\n": "code-words",
    "S100 M3\nG33.1\nM2\n": "code-words",
    "F100\nG38.3\nM2\n": "code-words",
    "G93\nG38.3 X5 F10\nM2\n": "code-words",
    "S100 M3\nG95\nG38.3 X5 F1\nM2\n": "code-words",
    "F100\nG5\nM2\n": "code-words",
    "F100\nG5.1 I5 X10 Y5\nM2\n": "code-words",
    "F100\nG5.1 X10 Y10 I2 J6\nX20 Y10 I1 J1\nM2\n": "no-motion-code",
    "F100\nG5.2 X1 Y1\nG5.2 X2 Y0\nG5.3\nM2\n": "code-words",
    "F100\nG5.2 P1\nG5.2 P1\nX5 Y5 P1\nX6 Y5 P1\nG5.3\nM2\n": "code-words",
    "F100\nG5.2 X10 P1 L3\nX5 Y5 P1\nG5.3\nM2\n": "code-words",
    "G80 X1\nM2\n": "no-motion-code",
    "G80 G0 G1 X1\nM2\n": "conflicting-codes",
    "F100\nG81 X1 Z1 R2 L0\nM2\n": "repeat-count",
    f"G0 X1{' ' * 248}\nM2\n": "line-too-long",
    "G43.1 G0 X1\nM2\n": "conflicting-codes",
    "G43.1 Z4\nG20\nG53 G0 Z1\nM2\n": "tool-offset",
    "G92 X3\nG10 L2 P1 R30\nM2\n": "preset",
    "M19 R455\nM2\n": "code-words",
    "o1 if [0]\no1 breYak\no1 endif\nM2\n": "o-word",
    "o<> if [0]\nM2\n": "o-word",
    "G43.2 H1 G0 X1\nM2\n": "conflicting-codes",
    "G10 L1 P1 F3\nM2\n": "code-words",
    "#-40=0\nM2\n": "parameter-number",
    "#[0-40]=0\nM2\n": "parameter-number",
    "G0 X#[0-3]\nM2\n": "parameter-number",
    "G0 X1 M98 P100\nM2\nO100\nG0 X5\nM99\n": "code-words",
    "M98 P100\nM2\nO100\nG0 X5\nM9 M99\n": "code-words",
    "G0 X1 (one (two)\nM2\n": "open-comment",
    "S100 M3\nM19 R45 P3\nM2\n": "code-words",
    "S100 M3\nM19 R45 P1.5\nM2\n": "code-words",
    "S100 M3\nM19 R45 Q0\nM2\n": "code-words",
    "o1.5 sub\no1.5 endsub\nM2\n": "o-word",
}
ENDS = {
    "F90\nM70\nG52 X5 Z2\nG1 X1\nM72\nG1 X3 Z1\nM2\n": [3.0, 0.0, 1.0],
    "F90\nG92 X10\nM70\nG92.2\nG1 X1\nM72\nG1 X12\nM2\n": [2.0, 0.0, 0.0],
    "F90\no1 sub\nM73\nG92 X7\nG1 X8\no1 endsub\no1 call\nG1 X4\nM2\n": [4.0, 0.0, 0.0],
    "F90\nG0 Z9\nG81 X1 Z-1 R2\nX2 R3\nX4 R1.5\nX5 R4 L2\nG91 X1 R-4 L2\nG80\nM2\n": [7.0, 0.0, 5.0],
    "F90\nG0 Z9\nG91 G83 X1 Z-3 R-7 Q1\nX2 R-6\nX4 R-8 L2\nG80\nM2\n": [11.0, 0.0, 1.0],
    "F90\nG0 Z9\nG81 X1 Z-1 R2\nG85 X2 Z-2 R3\nG98 X3 R12\nM2\n": [3.0, 0.0, 12.0],
    _COMPENSATED.format("M70\nG90.1\nM72"): [40.0, 0.0, 0.0],
    _COMPENSATED.format("M70\nX25\nM72"): [40.0, 0.0, 0.0],
    _COMPENSATED.format("G17\nG21"): [40.0, 0.0, 0.0],
    "G0 X#<_lathe_radius_mode>\nM2\n": [1.0, 0.0, 0.0],
    "M98 P100 L2\nM2\nO100\nG91 G0 X1\nM99\n": [2.0, 0.0, 0.0],
    "#1=3\nM98 P100 L3\nG0 Y#1\nM2\nO100\nG91 G0 X1\n#1=[#1+1]\nM98 P200\nM99\nO200\nG0 Z1\nM99\n": [3.0, 6.0, 3.0],
    "G80 G0 X3 Y5\nM2\n": [3.0, 5.0, 0.0],
    "G0 G80 X3\nM2\n": [3.0, 0.0, 0.0],
    "F100\nG81 X1 Y1 Z-1 R1\nG80 G0 X3\nM2\n": [3.0, 1.0, 1.0],
    "F100\nG81 X1 Y1 Z1 R2\nG80 G81 X3\nM2\n": [3.0, 1.0, 2.0],
    "G0 X7\nG80 G92 X0\nG0 X1\nM2\n": [8.0, 0.0, 0.0],
    "G0 X7\nG80 G28 X5\nM2\n": [0.0, 0.0, 0.0],
    "G 0 1 F 1 00 X 1 . 5\nM2\n": [1.5, 0.0, 0.0],
    "#1 = 1 0\nG0 X#1 Y[1 0 + 2] Z- . 5\nM 2\n": [10.0, 12.0, -0.5],
    "N 1 0 G0 X1 2 (X 1 3) Y3\nM2\n": [12.0, 3.0, 0.0],
    "o 1 0 0 sub\nG0 Z1\no100 endsub\no1 00 call\nM2\n": [0.0, 0.0, 1.0],
    "o1 . sub\nG0 Z1\no1.0 endsub\no1 call\no01. call\nM2\n": [0.0, 0.0, 1.0],
    "o<a> sub\no1 if [#1 GT 0]\no<a> call [#2Y]\no1 endif\nG0 Z1\no<a> endsub\no<a> call [0]\nM2\n":
        [0.0, 0.0, 1.0],
    "F100\nG38.5 X0.1\nM2\n": [0.1, 0.0, 0.0],
    "F100 G20\nG0 X[#<_feed>/100]\nG21\nG0 Y[#<_feed>]\nF5\nG0 Z[#<_feed>]\nM2\n": [25.4, 100.0, 5.0],
    "T1\nT2 M6\nM6\nG43\nG0 Z1\nM2\n": [0.0, 0.0, 21.0],
    "F100\nG73 X1 Y1 Z-3 R1 Q1\nG91 G83 X1 Z-3 R1 Q1 L3\nM2\n": [4.0, 1.0, 1.0],
    "F100\nG85 X1 Z-3 R-1\nG0 Z5\nG98 G82 X1 Z-4 R1 P1\nX6\nM2\n": [6.0, 0.0, 5.0],
    f"G0 X1{' ' * 247}\nM2\n": [1.0, 0.0, 0.0],
    "G43.1 Z5\nG43.1\nG0 Z1\nM2\n": [0.0, 0.0, 6.0],
    "T1 M6\nG43 H0\nG0 Z1\nM2\n": [0.0, 0.0, 11.0],
    "M61 Q2\nG43\nG0 Z1\nM2\n": [0.0, 0.0, 21.0],
    "G20\nG0 X1 Y2\nG0 Z#<_abs_y>\nM2\n": [25.4, 50.8, 50.8],
    "G43 H99\nG0 X1 Y#<_tool_offset>\nM2\n": [1.0, 0.0, 0.0],
    "T1 M6\nG43\nT2 M6\nG43\nG0 X5\nM2\n": [5.0, 0.0, 0.0],
    "#1=0\no1 while [#1 LT 0]\no1 break\no1 endwhile\no2 do\nG91 G0 X1\n#1=[#1+1]\no2 while [#1 LT 3]\nM2\n":
        [3.0, 0.0, 0.0],
    "F100\nG41.1 D6\nG1 X20 Y0\nG3 X30.3 Y9.7 I0.3 J10\nG1 X40 Y0\nG40\nM2\n": [42.1213203, 2.1213203, 0.0],
    "F100\nG41.1 D6\nG1 X20 Y0\nG1 X10 Y-1\nG2 X19 Y24 I17 J8\nG40\nM2\n": [17.7226089, 26.7144561, 0.0],
}  # fmt: skip


@pytest.mark.parametrize("text", REFUSED)
def test_refused(text: str) -> None:
    assert f"error {REFUSED[text]}:" in by_twin(text).error


@pytest.mark.parametrize("text", ENDS)
def test_moved(text: str) -> None:
    made = by_twin(text)
    assert not made.error
    assert made.moves[-1].end[:3] == pytest.approx(ENDS[text])


@pytest.mark.oracle
@NEEDS_RS274
@pytest.mark.parametrize("text", [*REFUSED, *ENDS])
def test_as_rs274(text: str) -> None:
    assert not difference(text)


@pytest.mark.oracle
@NEEDS_RS274
@pytest.mark.parametrize(
    "begin", ["G5.2", "G5.2 P2", "G5.2 P2 L4", "G5.2 L2", "G5.2 X1 Y-1 P3", "G5.2 P2\n(and)\n"]
)
def test_a_nurbs_has_the_control_points_that_rs274_counts(begin: str) -> None:
    text = f"F100\n{begin}\nX1 Y1 P1\nX2 Y2 P1\nX3 Y0 P2\nG5.3\nM2\n"
    (points,) = by_linuxcnc(text).curves
    assert len(by_twin(text).moves) == CHORDS_OF_A_PART * points


@pytest.mark.parametrize(
    ("begin", "middle"),
    [("G5.2 L2", [1.0, 0.5]), ("G5.2 P2", [0.8, 0.4]), ("G5.2 P1", [1.0, 0.5])],
)
def test_the_middle_of_a_nurbs_of_three_points(begin: str, middle: list[float]) -> None:
    """A quarter of both ends and half of the corner, by their weights; L below 3 counts as 3 (``rs274``)."""
    moves = by_twin(f"F100\n{begin}\nX1 Y1 P1\nX2 Y0 P1\nG5.3\nM2\n").moves
    assert moves[len(moves) // 2 - 1].end[:2] == pytest.approx(middle)


def test_a_probe_is_told_in_the_unit_of_the_program() -> None:
    """The probe that ``rs274`` brings along stops a hundredth of an inch before the end of its path."""
    made = by_twin("G20 F9\nG38.3 X2\nG21\nG0 Y#5061\nM2\n")
    assert made.moves[-1].end[:2] == pytest.approx([50.8, 2.0])
