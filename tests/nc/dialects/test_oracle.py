"""Where a rule is common ISO, LinuxCNC's interpreter must make the same moves.

Needs its ``rs274`` (Debian: linuxcnc-uspace) on the path.
"""

import math
import random
import re
from pathlib import Path

import numpy as np
import pytest

from tests.nc.linuxcnc.marks import NEEDS_RS274
from tests.nc.linuxcnc.oracle import printed_by_rs274
from tests.nc.running import good
from twin.nc.canonical import Moves, Shape
from twin.nc.control.settings import ToolData

pytestmark = NEEDS_RS274

PRINTED = 2e-4
"""LinuxCNC prints four decimals, and computes arcs from what it reads."""

CENTERED = 2e-3
"""The twin moves a centre so that it fits two points that are rounded to four decimals."""

_CALL = re.compile(r"(STRAIGHT_TRAVERSE|STRAIGHT_FEED|ARC_FEED|SELECT_PLANE)\(([^)]*)\)")
_PLANES = {"XY": (0, 1, 2), "XZ": (2, 0, 1), "YZ": (1, 2, 0)}
Made = list[tuple[str, list[float], list[float], float]]
"""Kind, end (X Y Z C), centre of an arc in its plane, sense and turns of an arc."""


def by_linuxcnc(text: str, folder: Path, tools: str = "") -> Made:
    program, table = folder / "program.ngc", folder / "tools.tbl"
    program.write_text(f"G21 G64\n{text}\nM2\n")
    table.write_text(tools)
    printed = printed_by_rs274(folder, "-g", "-t", table, program)
    made: Made = []
    plane, here = "XY", [0.0, 0.0, 0.0, 0.0]
    for name, given in _CALL.findall(printed):
        if name == "SELECT_PLANE":
            plane = given.removeprefix("CANON_PLANE_")
            continue
        v = [float(each) for each in given.split(",")]
        if name == "ARC_FEED":
            first, second, across = _PLANES[plane]
            end = [0.0, 0.0, 0.0, v[8]]
            end[first], end[second], end[across] = v[0], v[1], v[5]
            made.append(("arc", end, v[2:4], v[4]))
        else:
            end = [*v[:3], v[5]]
            if math.dist(end, here) > PRINTED:
                made.append(("rapid" if "TRAVERSE" in name else "feed", end, [], 0.0))
        here = end
    return made


def compare(moves: Moves, wanted: Made) -> None:
    assert len(moves) == len(wanted)
    for row, (kind, end, center, turns) in enumerate(wanted):
        np.testing.assert_allclose(moves.end[row], end, atol=PRINTED)
        assert (moves.shape[row] == Shape.ARC) == (kind == "arc")
        if kind == "arc":
            first, second, _ = _PLANES[
                ("YZ", "XZ", "XY")[int(np.argmax(np.abs(moves.normal[row])))]
            ]
            np.testing.assert_allclose(moves.center[row, [first, second]], center, atol=CENTERED)
            assert math.copysign(1.0, moves.sweep[row]) == math.copysign(1.0, turns)
        else:
            assert ("rapid", "feed")[moves.motion[row]] == kind


def a_program(random_: random.Random, *, larger: bool) -> str:
    """Lines, arcs by centre and radius in three planes, helices, presets, G90 and G91."""
    lines = ["G17 G90 F100", "G0 X0 Y0 Z0 C0"]
    here = [0.0, 0.0, 0.0]
    plane, absolute = (0, 1, 2), True

    def words(target: list[float]) -> str:
        values = target if absolute else [t - h for t, h in zip(target, here, strict=True)]
        return " ".join(f"{name}{value:.4f}" for name, value in zip("XYZ", values, strict=True))

    for _ in range(25):
        choice = random_.randrange(8)
        target = [round(random_.uniform(-50, 50), 3) for _ in range(3)]
        if choice == 0:
            code = random_.choice([17, 18, 19])
            plane = {17: (0, 1, 2), 18: (2, 0, 1), 19: (1, 2, 0)}[code]
            lines.append(f"G{code}")
            continue
        if choice == 1:
            absolute = not absolute
            lines.append("G90" if absolute else "G91")
            continue
        if choice == 2:
            lines.append(f"G0 {words(target)} C{random_.randrange(-90, 90)}")
        elif choice in (3, 4):
            lines.append(f"G1 {words(target)}")
        elif choice in (5, 6):
            first, second, _across = plane
            arm = [round(random_.uniform(2, 30), 3), round(random_.uniform(-30, 30), 3)]
            angle = math.radians(random_.randrange(20, 340))
            target[first] = here[first] + arm[0] - math.hypot(*arm) * math.cos(angle)
            target[second] = here[second] + arm[1] + math.hypot(*arm) * math.sin(angle)
            target = [round(value, 4) for value in target]
            center = f"{'IJK'[first]}{arm[0]} {'IJK'[second]}{arm[1]}"
            lines.append(f"G{random_.choice([2, 3])} {words(target)} {center}")
        else:
            first, second, _across = plane
            chord = math.hypot(target[first] - here[first], target[second] - here[second])
            radius = round(chord * random_.uniform(0.55, 2.0), 3) * random_.choice(
                [1, -1 if larger else 1]
            )
            lines.append(f"G{random_.choice([2, 3])} {words(target)} R{radius}")
        here = target
    return "\n".join(lines)


@pytest.mark.parametrize("dialect", ["gost", "mefi"])
@pytest.mark.parametrize("seed", range(12))
def test_lines_and_arcs(seed: int, dialect: str, tmp_path: Path) -> None:
    random_ = random.Random(seed)  # noqa: S311 (programs need no cryptography)
    text = a_program(random_, larger=dialect == "gost")
    compare(good(text, dialect).moves, by_linuxcnc(text, tmp_path))


@pytest.mark.parametrize(
    "text",
    [
        "G0 Z10\nG98 G81 X5 Y5 Z-4 R2 F100\nX15\nY20\nG80",
        "G0 Z10\nG99 G82 X5 Z-4 R2 P0.5 F100\nX15\nG80",
        "G0 Z1\nG98 G85 X5 Z-4 R2 F100\nX15\nG80\nG0 X0",
        "G0 Z10\nG99 G89 X5 Z-4 R2 P1 F100\nX15\nG80",
        "G0 Z10\nG91 G98 G81 X5 R-8 Z-4 F100\nX5\nX5\nG90 G80",
        "G18 G0 Y10\nG98 G81 X5 Z5 Y-4 R2 F100\nX15\nG80",
    ],
)
def test_drilling(text: str, tmp_path: Path) -> None:
    compare(good(text, "gost").moves, by_linuxcnc(text, tmp_path))


def test_peck_drilling_reaches_the_same_depths(tmp_path: Path) -> None:
    text = "G0 Z10\nG98 G83 X5 Y5 Z-7.5 R2 Q3 F100\nX15\nG80"
    moves = good(text, "gost").moves
    wanted = [end for kind, end, _, _ in by_linuxcnc(text, tmp_path) if kind == "feed"]
    np.testing.assert_allclose(moves.end[moves.motion == 1], wanted, atol=PRINTED)


def test_compensated_corners(tmp_path: Path) -> None:
    """Behind the lead-in, whose way differs among controls."""
    text = (
        "G0 X-20 Y-20\n{} G1 X0 Y0 F100\nY40\nX30 Y50\nX60\nG2 X80 Y30 R20\nG1 Y20\nX60\nY10\n"
        "G3 X50 Y0 R10\nG1 X20\nG40 X20 Y-30"
    )
    ours = good(text.format("G41 D1"), "gost", tools={1: ToolData(3.0, 60.0)}).moves
    theirs = by_linuxcnc(text.format("G41.1 D6"), tmp_path)
    last = slice(-12, -2)
    assert len(ours) >= 14
    np.testing.assert_allclose(
        ours.end[last], [end for _, end, _, _ in theirs][last], atol=5 * PRINTED
    )
