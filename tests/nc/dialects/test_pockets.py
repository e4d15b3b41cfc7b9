"""Pocket cycles: every point of the pocket is cut, and none outside it."""

import math

import numpy as np
import pytest

from tests.nc.running import bad, good
from twin.nc.canonical import FloatArray, Moves, Shape
from twin.nc.control.settings import ToolData

TOOLS = {1: ToolData(5.0, 60.0)}


def cutting_points(moves: Moves, below: float) -> FloatArray:
    """Points of the path under a height, half a millimetre apart."""
    points = []
    for row in range(len(moves)):
        start, end = moves.start[row, :3], moves.end[row, :3]
        for u in np.linspace(0.0, 1.0, max(2, math.ceil(2.0 * moves.length[row]))):
            point = start + u * (end - start)
            if moves.shape[row] == Shape.ARC:
                angle = math.radians(moves.sweep[row] * u)
                x, y = (start - moves.center[row])[:2]
                point[0] = moves.center[row, 0] + x * math.cos(angle) - y * math.sin(angle)
                point[1] = moves.center[row, 1] + x * math.sin(angle) + y * math.cos(angle)
            points.append(point)
    found = np.array(points)
    return found[found[:, 2] <= below + 1e-9][:, :2]


def uncut(moves: Moves, bottom: float, inside: FloatArray, radius: float) -> float:
    """Distance of the worst grid point of the pocket from what the tool has cut."""
    path = cutting_points(moves, bottom)
    away = np.linalg.norm(inside[:, None] - path[None], axis=2).min(axis=1)
    return float(away.max() - radius)


@pytest.mark.parametrize("words", ["C6 L0.5", "C10", "", "L1", "J12", "J-40 K8 C7"])
def test_rectangular_pocket_is_cleared_to_its_walls(words: str) -> None:
    size = {"J": 25.0, "K": 15.0}
    size |= {w[0]: abs(float(w[1:])) for w in words.split() if w[0] in "JK"}
    given = " ".join(f"{k}{v:g}" for k, v in size.items() if k not in words)
    text = f"G00 Z10 F200\nG87 X20 Y10 Z2 I-4 {given} B3 {words}\nG80\nM30"
    moves = good(text, "fagor8070", tools=TOOLS).moves
    x, y = size["J"], size["K"]
    reach = cutting_points(moves, -4.0) - [20.0, 10.0]
    assert np.abs(reach).max(axis=0) == pytest.approx([x - 5.0, y - 5.0])
    grid = np.stack(np.meshgrid(np.linspace(-x, x, 60), np.linspace(-y, y, 60)), -1).reshape(-1, 2)
    corner = np.maximum(np.abs(grid) - [x - 5.0, y - 5.0], 0.0)
    inside = grid[np.hypot(*corner.T) <= 5.0] + [20.0, 10.0]
    assert uncut(moves, -4.0, inside, 5.0) < 0.05


def test_circular_pocket_is_cleared_to_its_wall() -> None:
    text = "G00 Z10 F200\nG88 X20 Y10 Z2 I-4 J-17 B3 L0.3\nG80\nM30"
    moves = good(text, "fagor8070", tools=TOOLS).moves
    assert (moves.sweep[moves.shape == Shape.ARC] == 360.0).all()
    radii = moves.radius[moves.shape == Shape.ARC]
    assert radii.max() == pytest.approx(12.0)
    assert np.diff(np.unique(radii.round(9))).max() <= 7.5
    assert moves.end[moves.motion == 1][:, 2].min() == -4.0


def test_a_turned_pocket_is_the_pocket_turned() -> None:
    text = "G00 Z10 F200\nG87 X0 Y0 Z2 I-4 J20 K10 B6{}\nG80\nM30"
    straight = good(text.format(""), "fagor8070", tools=TOOLS).moves.end
    turned = good(text.format(" A90"), "fagor8070", tools=TOOLS).moves.end
    np.testing.assert_allclose(turned[:, :2], straight[:, [1, 0]] * [-1.0, 1.0], atol=1e-12)


def test_depths_and_feeds_of_the_passes() -> None:
    text = "G00 Z10 F200\nG88 X0 Y0 Z2 D1 I-4 J10 B2 H50 L0.5\nG80\nM30"
    moves = good(text, "fagor8070", tools=TOOLS).moves
    plunges = moves[(moves.motion == 1) & (moves.end[:, 2] < moves.start[:, 2])]
    assert plunges.end[:, 2].tolist() == [-1.0, -3.0, -4.0]
    assert plunges.feed.tolist() == [100.0] * 3
    assert moves.feed[moves.shape == Shape.ARC][-1] == 50.0


@pytest.mark.parametrize(
    ("words", "code"),
    [
        ("Z2 I-4 J10 B2 C11", "cycle-size"),
        ("Z2 I-4 J4 B2", "cycle-size"),
        ("Z2 I-4 J10 B0.00001", "cycle-size"),
        ("Z2 I4 J10 B2", "cycle-depth"),
        ("Z2 I-4 B2", "cycle-word"),
    ],
)
def test_pockets_that_cannot_be_milled(words: str, code: str) -> None:
    assert bad(f"G00 Z10\nG88 X0 Y0 {words} F100", "fagor8070", tools=TOOLS).code == code


@pytest.mark.parametrize(("kind", "size"), [(1, 8.0), (2, 6.0), (1, 15.0), (2, 12.5), (1, 2.0)])
@pytest.mark.parametrize("direction", [1.0, -1.0])
def test_corners_are_rounded_or_cut_off(kind: int, size: float, direction: float) -> None:
    x, y, radius = 25.0, 15.0, 5.0
    words = f"J{direction * x:g} K{y:g} B3 C6 M{kind} Q{size:g}"
    text = f"G00 Z10 F200\nG87 X20 Y10 Z2 I-3 D2 {words}\nG80\nM30"
    moves = good(text, "fagor8070", tools=TOOLS).moves
    beyond = np.abs(cutting_points(moves, -3.0) - [20.0, 10.0]) - [x, y]
    assert beyond.max(axis=0) == pytest.approx([-radius, -radius])
    if kind == 2:
        assert (beyond.sum(axis=1) + size).max() == pytest.approx(-radius * math.sqrt(2.0))
    else:
        corner = np.maximum(beyond + max(size, radius), 0.0)
        assert np.hypot(*corner.T).max() == pytest.approx(max(size, radius) - radius, abs=1e-9)
    grid = np.stack(np.meshgrid(np.linspace(-x, x, 60), np.linspace(-y, y, 60)), -1).reshape(-1, 2)
    left = np.abs(grid) - [x, y]
    room = left.sum(axis=1) + size <= 0.0 if kind == 2 else True
    round_off = np.maximum(left + max(size if kind == 1 else radius, radius), 0.0)
    rounded = np.hypot(*round_off.T) <= max(size if kind == 1 else radius, radius)
    inside = grid[room & (rounded if kind == 1 else np.ones(len(grid), bool))] + [20.0, 10.0]
    slack = radius * (math.sqrt(2.0) - 1.0) if kind == 2 else 0.0
    assert uncut(moves, -3.0, inside, radius) < 0.05 + slack


@pytest.mark.parametrize("words", ["M1", "M2 Q0", "M1 Q11", "M2 Q9", "M3 Q2"])
def test_corners_that_do_not_fit_are_refused(words: str) -> None:
    text = f"G00 Z10\nG87 X0 Y0 Z2 I-4 J20 K10 B2 {words} F100"
    assert bad(text, "fagor8070", tools=TOOLS).code in ("cycle-size", "cycle-word")
