"""Blended corners, splines and loops: tangents, distances and ends by closed forms."""

import itertools
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.nc.running import bad, good
from twin.nc.canonical import FloatArray, Moves, Shape
from twin.nc.geometry.arcs import distance
from twin.nc.geometry.curves import crossing_of, line

SPLINE_ERROR = 5e-4


def direction(moves: Moves, row: int, *, at_end: bool) -> FloatArray:
    """Unit direction of a move's plane path."""
    if moves.shape[row] == Shape.LINE:
        way = (moves.end[row] - moves.start[row])[:3]
    else:
        point = (moves.end if at_end else moves.start)[row, :3]
        arm = point - moves.center[row]
        way = np.sign(moves.sweep[row]) * np.cross(moves.normal[row], arm)
    return way / np.linalg.norm(way)


def assert_smooth(moves: Moves) -> None:
    for row in range(len(moves) - 1):
        before, behind = (direction(moves, row + i, at_end=i == 0) for i in (0, 1))
        np.testing.assert_allclose(before, behind, atol=1e-7)


angles = st.integers(-170, 170).filter(lambda angle: abs(angle) >= 5)


@settings(max_examples=60, derandomize=True, deadline=None)
@given(angle=angles, radius=st.floats(0.1, 3.0), heading=st.integers(0, 359))
def test_a_fillet_touches_both_lines(angle: int, radius: float, heading: int) -> None:
    first, second = math.radians(heading), math.radians(heading + angle)
    corner = (100.0 * math.cos(first), 100.0 * math.sin(first))
    end = (corner[0] + 100.0 * math.cos(second), corner[1] + 100.0 * math.sin(second))
    text = f"G01 X{corner[0]:.9f} Y{corner[1]:.9f} F100\nG36 I{radius:.6f}\nX{end[0]:.9f} Y{end[1]:.9f}"
    moves = good(f"{text}\nM30", "fagor8070").moves
    assert moves.shape.tolist() == [Shape.LINE, Shape.ARC, Shape.LINE]
    assert_smooth(moves)
    assert moves.radius[1] == pytest.approx(radius, abs=1e-5)
    assert moves.sweep[1] == pytest.approx(angle, abs=1e-4)
    # The tangent points lie R tan(turn / 2) from the corner.
    cut = radius * math.tan(math.radians(abs(angle)) / 2.0)
    assert distance(corner, (moves.end[0, 0], moves.end[0, 1])) == pytest.approx(cut, abs=1e-5)


@pytest.mark.parametrize(
    ("first", "second"),
    [
        ("G01 X20", "G03 X40 Y0 I10 J0"),
        ("G02 X20 Y0 I10 J0", "G01 X50"),
        ("G02 X20 Y0 I10 J0", "G02 X20 Y20 J10"),
        ("G03 X20 Y0 I10 J0", "G02 X20 Y40 I0 J20"),
    ],
)
def test_a_fillet_between_arcs_touches_both(first: str, second: str) -> None:
    moves = good(f"F100\n{first}\nG36 I2\n{second}\nM30", "fagor8070").moves
    assert len(moves) == 3
    assert_smooth(moves)
    assert moves.radius[1] == pytest.approx(2.0)


@settings(max_examples=40, derandomize=True, deadline=None)
@given(angle=angles, size=st.floats(0.5, 30.0))
def test_g52_cuts_both_lines_at_the_same_distance(angle: int, size: float) -> None:
    turn = math.radians(angle)
    x, y = 40.0 + 20.0 * math.cos(turn), 20.0 * math.sin(turn)
    moves = good(f"N10 G52 D{size:.6f} N20 G1 X40 F10 N30 X{x:.9f} Y{y:.9f}", "codesys").moves
    cut = min(round(size, 6), 10.0)  # half of the shorter move at most
    assert 40.0 - moves.end[0, 0] == pytest.approx(cut, abs=1e-6)
    assert_smooth(moves)


def test_g52_between_a_line_and_an_arc_is_smooth() -> None:
    moves = good("N10 G52 D2 N20 G1 X20 F10 N30 G2 X40 Y0 I10 N40 G1 X60", "codesys").moves
    assert_smooth(moves)
    assert moves.end[-1, 0] == 60.0


def test_g51_is_smooth_and_stays_inside_the_corner() -> None:
    moves = good("N10 G51 D5 N20 G1 X20 F10 N30 Y20", "codesys").moves
    middle = moves[1:-1]
    assert moves.end[0, 0] == 15.0
    assert moves.start[-1].tolist() == [20.0, 5.0, 0.0, 0.0]
    turns = np.diff(np.arctan2(*(middle.end - middle.start)[:, 1::-1].T))
    assert (turns > 0.0).all()  # it turns one way only
    assert turns.max() < 0.15


def test_m_functions_at_a_corner_come_behind_it() -> None:
    outcome = good("N10 G52 D2 N20 G1 X20 F10 N30 M7 N40 G1 Y20", "codesys")
    assert [event.before for event in outcome.events] == [2]


def test_no_corner_next_to_g0_is_blended() -> None:
    assert len(good("N10 G52 D2 N20 G0 X20 N30 G1 Y20 F10", "codesys").moves) == 2


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("G01 X10 F100\nG36 I11\nY10", "too large"),
        ("G01 X10 F100\nG36 I1\nX0", "turns back"),
        ("G01 X10 F100\nG36 I1\nZ5", "working plane"),
        ("G01 X10 F100\nG36 I1\nG00 Y5", "rapid"),
        ("G01 X10 F100\nG39 I11\nY10", "longer than the shorter move"),
        ("G36 I5\nG01 X10 F100\nY5", "no move before"),
        ("G01 X10 F100\nG36\nY5", "needs I"),
    ],
)
def test_blends_that_do_not_fit_are_refused(text: str, says: str) -> None:
    error = bad(f"{text}\nM30", "fagor8070")
    assert error.code == "blend"
    assert says in error.message


# --- splines


def spline_points(moves: Moves) -> FloatArray:
    return np.vstack([moves.start[:1], moves.end])[:, :3]


def test_a_spline_passes_its_points_without_a_kink() -> None:
    text = (
        "N0 G0 X0 Y0 F100\nN5 G1 X5\nN10 G5 X20 Y0\nN20 G5 X20 Y20\nN30 G5 X40 Y20\nN40 G1 X50 Y20"
    )
    moves = good(text, "codesys").moves
    points = spline_points(moves)
    for point in [(5, 0), (20, 0), (20, 20), (40, 20), (50, 20)]:
        assert np.linalg.norm(points[:, :2] - point, axis=1).min() < 1e-9
    steps = np.diff(points[:, :2], axis=0)
    turns = np.diff(np.unwrap(np.arctan2(steps[:, 1], steps[:, 0])))
    assert np.abs(turns).max() < 0.1
    # At an inner point the tangent is parallel to the line between its neighbours: (5, 0), (20, 20).
    at = int(np.argmin(np.linalg.norm(points[:, :2] - [20, 0], axis=1)))
    tangent = points[at + 1] - points[at - 1]
    assert math.degrees(math.atan2(tangent[1], tangent[0])) == pytest.approx(
        math.degrees(math.atan2(20, 15)), abs=1.0
    )


def test_collinear_points_give_a_line() -> None:
    moves = good("N10 G1 X5 F10 N20 G5 X10 N30 G5 X15 N40 G1 X20", "codesys").moves
    np.testing.assert_allclose(moves.end[:, 1:], 0.0, atol=1e-12)
    assert moves.length.sum() == pytest.approx(20.0)


def test_chords_keep_to_the_cubic() -> None:
    moves = good("N10 G10 X10 Y10 Z5 F10 N20 G10 X20 Y0 Z0", "codesys").moves
    points = spline_points(moves)
    border = int(np.argmin(np.linalg.norm(points - [10, 10, 5], axis=1)))
    middle = np.array([10.0, 0.0, 0.0])  # half the way from (0, 0, 0) to (20, 0, 0)
    u = np.linspace(0.0, 1.0, 2001)[:, None]
    chord = np.array([10.0, 10.0, 5.0])
    cubic = u * (1 - u) ** 2 * chord + u * u * (3 - 2 * u) * chord + u * u * (u - 1) * middle
    pieces = points[: border + 1]
    for start, end in itertools.pairwise(pieces):
        inside = cubic[
            ((cubic - start) @ (end - start) >= 0) & ((cubic - end) @ (start - end) >= 0)
        ]
        near = inside[np.linalg.norm(inside - start, axis=1) <= np.linalg.norm(end - start)]
        away = np.linalg.norm(np.cross(near - start, end - start), axis=1)
        assert (away / np.linalg.norm(end - start)).max(initial=0.0) < SPLINE_ERROR


def test_z_goes_linearly_along_g5() -> None:
    moves = good("N10 G5 X10 Y10 Z6 F10 N20 G5 X20 Y0 Z0", "codesys").moves
    heights = np.diff(moves.end[moves.end[:, 0] <= 10.0][:, 2])
    np.testing.assert_allclose(heights, heights[0], atol=1e-9)


# --- loops


def test_a_loop_is_cut_out_where_it_crosses() -> None:
    text = "N10 G61 N20 G1 X20 F10 N30 Y10 N40 X{x} N50 Y-10 N60 G60"
    moves = good(text.format(x=8), "codesys").moves
    assert moves.end[:, :2].tolist() == [[8.0, 0.0], [8.0, -10.0]]


def test_a_second_g61_changes_nothing() -> None:
    text = "N10 G61 N20 G1 X20 F10 N30 Y10 N40 X8 {again} N50 Y-10 N60 G60"
    once, twice = (good(text.format(again=each), "codesys").moves for each in ("", "N45 G61"))
    assert twice.end.tolist() == once.end.tolist()


def test_loops_of_arcs_are_cut_too() -> None:
    text = "N10 G61 N20 G1 X20 F10 N30 G3 X10 Y0 I-5 J5 N40 G1 Y-20 N50 G60"
    moves = good("N10 G0 X0 Y5 N15 " + text[4:], "codesys").moves
    assert moves.end[-1, :2].tolist() == [10.0, -20.0]
    assert len(moves) <= 4


def test_elements_that_only_touch_do_not_cross() -> None:
    first = line((0.0, 0.0), (10.0, 0.0))
    assert not crossing_of(first, line((10.0, 0.0), (10.0, 5.0)))[0]
    assert not crossing_of(first, line((5.0, 0.0), (5.0, 5.0)))[0]
    assert crossing_of(first, line((5.0, -5.0), (5.0, 5.0))) == pytest.approx((True, 0.5, 0.5))
