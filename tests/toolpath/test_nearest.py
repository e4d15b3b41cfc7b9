import math

import numpy as np
import pytest
from examples import examples
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.compare.paths import arc, line, moves_of
from twin.nc.canonical import FloatArray, Moves
from twin.toolpath.nearest import drop_moves, join_paths, path_columns
from twin.toolpath.nearest_kernels import nearest_between, nearest_on_move
from twin.toolpath.part_frame import PartFrame
from twin.toolpath.place_kernels import PathKind, derivatives, moved_along

FRAME = PartFrame(rotary=3, center=(3.0, -2.0), turn_zero=10.0)
PART_ZERO = np.array([20.0, -5.0, 7.0, 25.0])


def move_position(moves: Moves, row: int, u: FloatArray) -> FloatArray:
    """The convention of ``twin.nc.canonical``, written out with a rotation matrix."""
    start, end = moves.start[row], moves.end[row]
    points = start + u[:, None] * (end - start)
    if moves.shape[row] == 1:
        n, r = moves.normal[row], start[:3] - moves.center[row]
        cross = np.array([[0, -n[2], n[1]], [n[2], 0, -n[0]], [-n[1], n[0], 0]])
        advance = (end - start)[:3] @ n
        for i, value in enumerate(u):
            angle = math.radians(value * moves.sweep[row])
            turn = np.eye(3) + math.sin(angle) * cross + (1 - math.cos(angle)) * cross @ cross
            points[i, :3] = moves.center[row] + turn @ r + value * advance * n
    return points


def brute_force(moves: Moves, row: int, low: float, high: float, point: FloatArray) -> float:
    """Shortest distance by dense sampling, refined around the best sample until it settles."""
    best = math.inf
    for _ in range(12):
        u = np.linspace(low, high, 801)
        path = FRAME.position(move_position(moves, row, u) + PART_ZERO)
        distance = np.linalg.norm(path - point, axis=1)
        best = min(best, float(distance.min()))
        middle, width = u[int(distance.argmin())], (high - low) / 800
        low, high = max(low, middle - width), min(high, middle + width)
    return best


length = st.floats(-60.0, 60.0, allow_nan=False).map(lambda value: round(value, 3))
point3 = st.tuples(length, length, length).map(np.array)
fractions = st.tuples(st.floats(0, 1), st.floats(0, 1)).map(sorted)


@st.composite
def any_move(draw: st.DrawFn) -> Moves:
    turn = draw(st.sampled_from([0.0, 0.0, 30.0, -90.0, 400.0]))
    start = np.append(draw(point3), draw(st.floats(-400, 400)))
    if draw(st.booleans()):
        end = np.append(draw(point3), start[3] + turn)
        return moves_of(line(start, end))
    normal = np.array(draw(st.sampled_from([(0, 0, 1.0), (0, 1.0, 0), (0.6, 0, 0.8)])))
    outward = np.cross(normal, [0.36, 0.48, 0.8])
    center = start[:3] - outward / np.linalg.norm(outward) * draw(st.floats(0.5, 80.0))
    sweep = draw(st.sampled_from([45.0, -90.0, 200.0, -360.0, 900.0]))
    lead = draw(st.sampled_from([0.0, 5.0, -30.0]))
    return moves_of(arc(start, center, normal, sweep, lead=lead, turn=turn))


@pytest.mark.seconds("every point of a path is tried")
@settings(max_examples=examples(60), derandomize=True, deadline=None)
@given(any_move(), point3, fractions, st.floats(0, 1))
def test_nearest_point_agrees_with_brute_force(
    moves: Moves, point: FloatArray, window: list[float], guess: float
):
    path = path_columns(moves, FRAME, PART_ZERO)
    found, u = nearest_on_move(path, 0, window[0], window[1], guess, *point)
    assert window[0] <= u <= window[1]
    here = FRAME.position(move_position(moves, 0, np.array([u])) + PART_ZERO)[0]
    assert np.linalg.norm(here - point) == pytest.approx(found, abs=1e-9)
    assert found == pytest.approx(brute_force(moves, 0, window[0], window[1], point), abs=1e-6)


@settings(max_examples=examples(50), derandomize=True, deadline=None)
@given(any_move(), st.floats(0.01, 0.99))
def test_derivatives_agree_with_differences(moves: Moves, u: float):
    path = path_columns(moves, FRAME, PART_ZERO)
    values = np.array(derivatives(path, 0, u)).reshape(3, 3)
    step = 1e-4
    around = FRAME.position(move_position(moves, 0, u + step * np.array([-1, 0, 1])) + PART_ZERO)
    scale = 1.0 + np.abs(values).max()
    assert values[0] == pytest.approx(around[1], abs=1e-9)
    assert values[1] == pytest.approx((around[2] - around[0]) / (2 * step), abs=2e-5 * scale)
    second = (around[0] - 2 * around[1] + around[2]) / step**2
    assert values[2] == pytest.approx(second, abs=1e-3 * scale)


def test_kinds_are_told_apart():
    up = np.array([0.0, 0.0, 1.0])
    zero = np.zeros(4)
    rows = [
        line(zero, np.array([1.0, 0, 0, 0])),
        arc(zero, np.array([5.0, 0, 0]), up, 90.0),
        arc(zero, np.array([5.0, 0, 0]), up, 90.0, lead=2.0),
        line(zero, np.array([1.0, 0, 0, 30.0])),
    ]
    path = path_columns(moves_of(*rows), FRAME, PART_ZERO)
    assert path.kind.tolist() == [PathKind.LINE, PathKind.CIRCLE, PathKind.CURVE, PathKind.CURVE]


def test_walking_measures_the_path_over_its_moves():
    first = line(np.zeros(4), np.array([10.0, 0, 0, 0]))
    second = arc(first["end"], np.array([10.0, 5.0, 0]), np.array([0, 0, 1.0]), 180.0)
    path = path_columns(moves_of(first, second), FRAME, PART_ZERO)
    assert moved_along(path, 0, 0.5, 5.0 + 2.5 * math.pi) == pytest.approx((1, 0.5))
    assert moved_along(path, 1, 0.5, -5.0 - 2.5 * math.pi) == pytest.approx((0, 0.5))
    assert moved_along(path, 0, 0.5, 1e3) == (1, 1.0)
    assert moved_along(path, 1, 0.5, -1e3) == (0, 0.0)


def test_only_the_window_is_searched():
    out = line(np.zeros(4), np.array([10.0, 0, 0, 0]))
    aside = line(out["end"], np.array([10.0, 1.0, 0, 0]))
    back = line(aside["end"], np.array([0.0, 1.0, 0, 0]))
    frame = PartFrame(rotary=None, center=(0.0, 0.0))
    path = path_columns(moves_of(out, aside, back), frame, np.zeros(4))
    point = (2.0, 0.1, 0.0)
    assert nearest_between(path, (0, 0.0), (2, 1.0), (1, 0.5), *point, 0.0) == pytest.approx(
        (0.1, 0, 0.2)
    )
    assert nearest_between(path, (2, 0.0), (2, 1.0), (1, 0.5), *point, 0.0) == pytest.approx(
        (0.9, 2, 0.8)
    )


def test_of_equal_places_the_last_is_taken():
    out = line(np.zeros(4), np.array([10.0, 0, 0, 0]))
    back = line(out["end"], np.zeros(4))
    frame = PartFrame(rotary=None, center=(0.0, 0.0))
    path = path_columns(moves_of(out, back), frame, np.zeros(4))
    assert nearest_between(
        path, (0, 0.0), (1, 1.0), (0, 0.5), 4.0, 1.0, 0.0, 1e-9
    ) == pytest.approx((1, 1, 0.6))


def test_points_without_a_direction_have_a_distance():
    zero = np.zeros(4)
    still = line(zero, zero)
    circle = arc(zero, np.array([5.0, 0, 0]), np.array([0, 0, 1.0]), 360.0)
    frame = PartFrame(rotary=3, center=(0.0, 0.0))
    turning = line(zero, np.array([0.0, 0, 0, 360.0]))
    path = path_columns(moves_of(still, circle, turning), frame, np.zeros(4))
    assert nearest_on_move(path, 0, 0.0, 1.0, 0.5, 3.0, 4.0, 0.0)[0] == pytest.approx(5.0)
    assert nearest_on_move(path, 1, 0.0, 1.0, 0.5, 5.0, 0.0, 12.0)[0] == pytest.approx(13.0)
    assert nearest_on_move(path, 2, 0.0, 1.0, 0.5, 3.0, 4.0, 0.0)[0] == pytest.approx(5.0)


def test_joining_and_dropping_keep_the_rest():
    rows = [line(np.full(4, i), np.full(4, i + 1.0)) for i in range(3)]
    whole = path_columns(moves_of(*rows), FRAME, PART_ZERO)
    parts = [path_columns(moves_of(row), FRAME, PART_ZERO) for row in rows]
    joined = join_paths(join_paths(parts[0], parts[1]), parts[2])
    for column, whole_column, rest in zip(joined, whole, drop_moves(whole, 1), strict=True):
        assert np.array_equal(column, whole_column)
        assert np.array_equal(rest, whole_column[1:])
