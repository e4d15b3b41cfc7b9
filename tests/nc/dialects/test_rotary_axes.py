"""A, B and C are words of every control that has rotary axes, where the machine has them: the axes come from it."""

import math
import re
from pathlib import Path

import numpy as np
import pytest

from tests.nc.linuxcnc.marks import NEEDS_RS274
from tests.nc.linuxcnc.oracle import printed_by_rs274
from tests.nc.running import ControlSettings, bad, good
from twin.nc.canonical import Axes, FeedUnit

FIVE = Axes(("X", "Y", "Z", "A", "C"), ("linear",) * 3 + ("rotary",) * 2)
SIX = Axes(("X", "Y", "Z", "A", "B", "C"), ("linear",) * 3 + ("rotary",) * 3)
BLOCKS = "G0 X0 Y0 Z10 A0 {last}0\nG0 A-90 {last}45\nG1 X10 A-60 {last}90 F600\nG1 A0 F3600\n"
POINTED = re.sub(r"([XYZAF]|\{last\})(-?\d+)", r"\1\2.", BLOCKS)
"""Lengths and angles with their decimal points."""
KLARTEXT = (
    "0 BEGIN PGM T MM\n1 L X+0 Y+0 Z+10 A+0 {last}+0 R0 FMAX\n2 L A-90 {last}+45 R0 FMAX\n"
    "3 L X+10 A-60 {last}+90 F600\n4 L A+0 F3600\n5 END PGM T MM\n"
)
DIALECTS = {
    "linuxcnc": "G21 G90 G94\n" + BLOCKS + "M2\n",
    "fanuc": "G21 G90 G94\n" + POINTED + "M30\n",
    "haas": "G21 G90 G94\n" + POINTED + "M30\n",
    "sinumerik": "G71 G90 G94\n" + BLOCKS,
    "heidenhain": KLARTEXT,
    "fagor8070": "%T\nG71 G90 G94\n" + BLOCKS + "M30\n",
    "codesys": "%T\nG90\n" + BLOCKS,
    "mefi": "%T\nG90\n" + BLOCKS,
    "gost": "%T\nG90\n" + BLOCKS,
}
COUNTS_EVERY_AXIS = ("fanuc", "haas")
"""F in mixed motion is that of all axes together, a degree as a millimetre; elsewhere that of X, Y and Z."""


@pytest.mark.parametrize(("axes", "last"), [(FIVE, "C"), (SIX, "B"), (SIX, "C")])
@pytest.mark.parametrize("dialect", DIALECTS)
def test_positioning_and_simultaneous_motion(dialect: str, axes: Axes, last: str) -> None:
    done = good(DIALECTS[dialect].format(last=last), dialect, axes=axes, periodic=frozenset())
    a, b = axes.index("A"), axes.index(last)
    ends = done.moves.end[:, [0, 2, a, b]]
    np.testing.assert_allclose(
        ends[-4:], [[0, 10, 0, 0], [0, 10, -90, 45], [10, 10, -60, 90], [10, 10, 0, 90]]
    )
    feed = done.moves.feed[-2:] / (60.0 if dialect == "codesys" else 1.0)
    whole = math.hypot(10.0, 30.0, 45.0)
    mixed = 600.0 * 10.0 / whole if dialect in COUNTS_EVERY_AXIS else 600.0
    np.testing.assert_allclose(feed, [mixed, 3600.0])
    assert done.moves.feed_unit[-2:].tolist() == [FeedUnit.MM_PER_MIN, FeedUnit.DEG_PER_MIN]


@pytest.mark.parametrize("dialect", DIALECTS)
def test_an_axis_that_the_machine_lacks_is_refused_with_those_it_has(dialect: str) -> None:
    told = bad(DIALECTS[dialect].format(last="B"), dialect, axes=FIVE, periodic=frozenset())
    assert told.code == "no-such-axis"
    assert "X, Y, Z, A, C" in f"{told.message} {told.hint}"


@pytest.mark.parametrize(
    ("dialect", "text"),
    [
        ("sinumerik", "G0 A0\nG0 A=DC(350)\n"),
        ("sinumerik", "G0 A0\nG0 A=ACN(350)\n"),
        ("heidenhain", "0 BEGIN PGM T MM\n1 L A+0 R0 FMAX\n2 M126\n3 L A+350 R0 FMAX\n4 END PGM T MM\n"),
    ],
)  # fmt: skip
def test_the_way_of_an_a_axis_is_chosen_as_that_of_c(dialect: str, text: str) -> None:
    moves = good(text, dialect, axes=FIVE, periodic=frozenset({"A", "C"})).moves
    assert moves.end[-1, 3] - moves.start[-1, 3] == pytest.approx(-10.0)


@pytest.mark.parametrize(
    ("way", "ends"),
    [
        (None, [350.0, 10.0, -350.0, 180.0]),
        ("shorter", [-10.0, 10.0, 10.0, 180.0]),
        ("sign", [350.0, 370.0, 350.0, 540.0]),
    ],
)
def test_rotary_axes_of_a_fanuc_roll_over_as_parameter_1008_says(
    way: str | None, ends: list[float]
) -> None:
    text = "G21 G90 G94\nG0 A350.\nA10.\nA-350.\nG91 X1.\nG90 A180.\nM30\n"
    moves = good(text, "fanuc", axes=FIVE, periodic=frozenset({"A"}), rollover=way).moves
    reached = dict(zip(moves.line.tolist(), moves.end[:, 3].tolist(), strict=True))
    assert [reached.get(line, reached.get(line - 1)) for line in (2, 3, 4, 6)] == ends


WRAPPED = "G21 G90 G94 F500\nG1 X1 A90\nX2 A10\nX3 A-350\nX4 A350\nX5 A-0\nX6 A0\nX7 A-90\nX8 A270\nG91 X1 A400\nG90 X10 A5\nM2\n"


@pytest.mark.oracle
@NEEDS_RS274
def test_wrapped_axes_of_linuxcnc_are_those_of_linuxcnc_itself(tmp_path: Path) -> None:
    (tmp_path / "a.ini").write_text("[RS274NGC]\n[AXIS_A]\nTYPE=ANGULAR\nWRAPPED_ROTARY=1\n")
    (tmp_path / "a.ngc").write_text(WRAPPED)
    printed = printed_by_rs274(tmp_path, "-i", "a.ini", "-g", "a.ngc")
    expected = [float(each) for each in re.findall(r"FEED\((?:[-0-9.]+, ){3}([-0-9.]+)", printed)]
    moves = good(WRAPPED, "linuxcnc", axes=FIVE, module_rotary=True).moves
    assert moves.end[:, 3].tolist() == pytest.approx(expected)


def test_grbl_moves_three_axes() -> None:
    assert bad("G0 X1 A10\n", "grbl", axes=FIVE).code == "no-such-axis"


def test_settings_of_a_machine_name_its_axes() -> None:
    assert ControlSettings(axes=FIVE).axes.names == ("X", "Y", "Z", "A", "C")
