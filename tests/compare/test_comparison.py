import itertools

import numpy as np
import pytest
from examples import examples
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.compare.paths import AXES, UP, Row, arc, line, moves_of
from tests.compare.runs import FRAME, PART_ZERO, compare, late, samples, setpoints
from twin.compare.comparison import REACH_S, Comparison
from twin.errors import RecordingError
from twin.nc.canonical import Motion, Moves
from twin.toolpath.part_frame import PartFrame

ZERO = np.zeros(4)


def at(x: float, y: float, z: float = 0.0, c: float = 0.0) -> np.ndarray:
    return np.array([x, y, z, c])


def square(size: float = 50.0) -> Moves:
    corners = [at(0, 0), at(size, 0), at(size, size), at(0, size), at(0, 0)]
    return moves_of(*(line(a, b) for a, b in itertools.pairwise(corners)))


CIRCLE = arc(ZERO, np.array([-20.0, 0, 0]), UP, 360.0)
SMOOTH = {
    "line": line(ZERO, at(100, 30, -10)),
    "circle": CIRCLE,
    "arc in ZX": arc(ZERO, np.array([-20.0, 0, 0]), np.array([0, 1.0, 0]), -120.0),
    "helix": arc(ZERO, np.array([-20.0, 0, 0]), UP, 1080.0, lead=15.0),
    "table alone": line(ZERO, at(0, 0, 0, 720.0)),
    "spiral": line(ZERO, at(60, 10, -5, -270.0)),
    "helix on the table": arc(ZERO, np.array([-20.0, 0, 0]), UP, 400.0, lead=5.0, turn=90.0),
}


@pytest.mark.parametrize("name", SMOOTH)
def test_being_late_is_following_error_and_no_contour_error(name: str):
    moves = moves_of(SMOOTH[name])
    asked = setpoints(moves, per_move=2000, wait=100)
    figures, _ = compare(moves, asked, late(moves, asked, 0.01))
    assert figures.contour.max < 1e-3
    assert max(axis.max for axis in figures.tracking.values()) > 100.0


@pytest.mark.parametrize("name", SMOOTH)
def test_no_error_is_no_error(name: str):
    moves = moves_of(SMOOTH[name])
    asked = setpoints(moves)
    figures, errors = compare(moves, asked, asked.position)
    assert errors.max() < 1e-6
    assert all(axis.max == 0.0 for axis in figures.tracking.values())


def test_following_error_is_told_by_axis_line_and_time():
    moves = square()
    asked = setpoints(moves)
    joint = asked.position.copy()
    joint[700, 0] -= 0.012
    joint[1200, 3] += 0.034
    figures, _ = compare(moves, asked, joint)
    x, c = figures.tracking["X"], figures.tracking["C"]
    assert (x.max, x.line, x.time_s) == pytest.approx((12.0, 2, 0.7))
    assert (c.max, c.line, c.time_s) == pytest.approx((34.0, 3, 1.2))
    assert (x.kind, c.kind) == ("linear", "rotary")
    assert x.rms == pytest.approx(12.0 / np.sqrt(len(asked)))
    assert figures.tracking["Y"].max == 0.0


def test_an_offset_on_one_line_is_found_there():
    moves = square()
    asked = setpoints(moves)
    joint = asked.position.copy()
    joint[600:900, 0] += 0.0173
    figures, errors = compare(moves, asked, joint)
    assert figures.contour.max == pytest.approx(17.3, abs=0.01)
    assert figures.contour.worst_line == 2
    assert 0.6 <= figures.contour.worst_time_s < 0.9
    assert errors[600:900] == pytest.approx(17.3, abs=0.01)
    assert figures.contour.rms == pytest.approx(np.sqrt(np.mean(errors**2)))
    assert figures.contour.p99 == pytest.approx(17.3, rel=1e-3)
    assert figures.worst[0].line == 2


def test_a_corner_that_is_cut_is_found_with_its_size():
    moves = square()
    asked = setpoints(moves)
    joint = asked.position.copy()
    a, b = asked.position[450], asked.position[550]
    joint[450:551] = a + np.linspace(0, 1, 101)[:, None] * (b - a)
    figures, _ = compare(moves, asked, joint)
    assert figures.contour.max == pytest.approx(5.0 / 2 * 1e3, abs=0.1)
    assert figures.contour.worst_line in (1, 2)


def test_a_table_that_is_late_while_the_tool_moves_straight_cuts_aside():
    """The table 10 mdeg off, 100 mm from its centre, is 17.5 µm; the tool alone is on its line."""
    moves = moves_of(line(at(0, 0), at(60, 0)))
    frame = PartFrame(rotary=3, center=(PART_ZERO[0], PART_ZERO[1]), turn_zero=PART_ZERO[3])
    asked = setpoints(moves)
    joint = asked.position.copy()
    joint[:, 3] += 0.010
    figures, _ = compare(moves, asked, joint, frame=frame)
    assert figures.contour.max == pytest.approx(60e3 * np.sin(np.deg2rad(0.01)), abs=1e-3)


def test_a_path_that_crosses_itself_is_not_mistaken():
    """Over the crossing, 30 µm beside its own leg, the other leg would be nearer."""
    corners = [at(-20, 0), at(20, 0), at(20, 20), at(0, 20), at(0, -20)]
    moves = moves_of(*(line(a, b) for a, b in itertools.pairwise(corners)))
    asked = setpoints(moves, per_move=4000)
    joint = late(moves, asked, 0.02)
    own = asked.move + asked.fraction - 0.02 > 3.01
    joint[own, 0] += 0.03
    _, errors = compare(moves, asked, joint)
    assert errors[own] == pytest.approx(30.0, abs=1e-3)


def test_the_next_pass_of_a_raster_is_not_mistaken_for_its_own():
    corners = [at(0, 0), at(10, 0), at(10, 0.05), at(0, 0.05)]
    moves = moves_of(*(line(a, b) for a, b in itertools.pairwise(corners)))
    asked = setpoints(moves)
    joint = asked.position.copy()
    joint[200:300, 1] += 0.04
    _, errors = compare(moves, asked, joint)
    assert errors[200:300] == pytest.approx(40.0, abs=1e-3)


def test_a_sharp_reversal_holds_no_contour_error_for_a_late_tool():
    tip, end = at(10, 0), at(0, 0.5)
    moves = moves_of(line(ZERO, tip), line(tip, end))
    asked = setpoints(moves, per_move=1000, wait=100)
    figures, _ = compare(moves, asked, late(moves, asked, 0.05))
    assert figures.contour.max < 1e-3


@pytest.mark.parametrize("angle", [5.0, 15.0, 30.0])
def test_in_an_acute_corner_of_the_table_the_nearer_leg_counts(angle: float):
    """The first leg is a circle, by C alone, the second a straight line inside of it.

    A tool between them has |r - R| to the circle and |a cos(d) - b sin(d)| to the line, and goes from the
    one to the other and back.
    """
    radius, turn = 50.0, 30.0
    slant = np.deg2rad(angle)
    corner = at(40.0 + radius, -30.0, c=15.0 + turn) - PART_ZERO
    back = np.array([-np.sin(slant), -np.cos(slant), 0.0, 0.0])
    moves = moves_of(
        line(corner - [0.0, 0.0, 0.0, turn], corner), line(corner, corner + 20.0 * back)
    )
    setpoint = setpoints(moves, per_move=200)
    # In the tool's frame at the end of C the circle leaves the corner downwards.
    below, inside = 5.0, np.zeros(len(setpoint))
    legs = np.array([radius - np.sqrt(radius**2 - below**2), below * np.tan(slant)])
    across = 0.5 + 0.3 * np.sin(np.linspace(0.0, 6.0 * np.pi, 140))
    inside[-140:] = legs[0] + across * (legs[1] - legs[0])
    joint = setpoint.position.copy()
    joint[-140:] = corner + PART_ZERO
    joint[-140:, 0] -= inside[-140:]
    joint[-140:, 1] -= below
    _, error = compare(moves, setpoint, joint)
    x, y = radius - inside[-140:], -below
    to_circle = np.abs(np.hypot(x, y) - radius)
    to_line = np.abs((radius - x) * np.cos(slant) + y * np.sin(slant))
    assert error[-140:] == pytest.approx(1000.0 * np.minimum(to_circle, to_line), abs=1e-3)


def test_going_back_over_the_same_line_does_not_hold_the_tool():
    rows: list[Row] = []
    for _ in range(20):
        rows += [line(ZERO, at(10, 0)), line(at(10, 0), ZERO)]
    moves = moves_of(*rows)
    asked = setpoints(moves, per_move=400)
    joint = late(moves, asked, 0.03)
    joint[:, 1] += 0.001 * np.sin(np.arange(len(joint)))
    figures, _ = compare(moves, asked, joint)
    assert figures.contour.max == pytest.approx(1.0, abs=1e-2)


def test_a_tool_that_stays_behind_has_left_the_path():
    moves = moves_of(line(ZERO, at(100, 0)))
    asked = setpoints(moves, per_move=4000)
    joint = np.repeat(asked.position[:1], len(asked), axis=0)
    figures, errors = compare(moves, asked, joint)
    assert errors[int(REACH_S / 0.001) - 1] < 1e-3
    assert figures.contour.max == pytest.approx((4.0 - REACH_S) * 25e3)


@settings(max_examples=examples(15), derandomize=True, deadline=None)
@given(st.integers(1, 700), st.lists(st.integers(0, 6), min_size=2, max_size=6))
def test_chunks_make_no_difference(rows: int, cuts: list[int]):
    corners = [at(0, 0), at(5, 0), at(5, 5), at(0, 5), at(2, 1), at(7, 3, 2, 40), at(1, 1)]
    moves = moves_of(*(line(a, b) for a, b in itertools.pairwise(corners)))
    asked = setpoints(moves, per_move=300)
    joint = late(moves, asked, 0.05) + 0.01 * np.sin(np.arange(len(asked)) / 50.0)[:, None]
    whole, errors = compare(moves, asked, joint)
    edges = sorted({0, *cuts, len(moves)})
    pieces = [moves[first:last] for first, last in itertools.pairwise(edges)]
    chunked, chunk_errors = compare(pieces, asked, joint, rows=rows)
    assert chunk_errors == pytest.approx(errors, abs=1e-9)
    assert chunked.contour.worst_line == whole.contour.worst_line
    assert chunked.contour.p99 == pytest.approx(whole.contour.p99)
    assert chunked.tracking["X"].max == whole.tracking["X"].max
    assert [w.line for w in chunked.worst] == [w.line for w in whole.worst]


def test_moves_left_behind_are_let_go():
    comparison = Comparison(AXES, FRAME, PART_ZERO)
    for index in range(300):
        start, end = at(index, 0), at(index + 1.0, 0)
        moves = moves_of(line(start, end), first_line=index + 1)
        asked = setpoints(moves, per_move=100)[: 100 + (index == 299)]
        asked.move[:] = index
        asked.time[:] += 0.1 * index
        comparison.expect(moves)
        comparison.add(samples(asked, asked.position))
    assert len(comparison._moves) < 20
    assert comparison.result().contour.max < 1e-6
    assert comparison.result().samples == 30_001


def test_before_the_first_move_the_tool_is_held_to_the_start():
    moves = moves_of(line(ZERO, at(10, 0)))
    asked = setpoints(moves)
    asked.move[:5], asked.fraction[:5] = -1, 0.0
    joint = asked.position.copy()
    joint[2, 2] += 0.005
    figures, errors = compare(moves, asked, joint)
    assert errors[2] == pytest.approx(5.0)
    assert figures.contour.worst_time_s == pytest.approx(0.002)


def test_a_program_without_moves_is_held_to_where_it_stands():
    comparison = Comparison(AXES, FRAME, PART_ZERO)
    asked = setpoints(moves_of(line(ZERO, ZERO)), per_move=10)
    asked.move[:], asked.line[:] = -1, 0
    comparison.add(samples(asked, asked.position + np.array([0.003, 0.004, 0, 0])))
    assert comparison.result().contour.max == pytest.approx(5.0)


def test_no_samples_give_empty_figures():
    figures = Comparison(AXES, FRAME, PART_ZERO).result()
    assert (figures.samples, figures.contour.max, figures.arcs) == (0, 0.0, ())


def test_what_cannot_be_compared_is_refused():
    moves = moves_of(line(ZERO, at(1, 0)))
    asked = setpoints(moves, per_move=10)
    joint = asked.position.copy()
    joint[3, 1] = np.nan
    with pytest.raises(RecordingError, match="not numbers"):
        compare(moves, asked, joint)
    asked.move[-1] = 1
    with pytest.raises(RecordingError, match="only 1 moves"):
        compare(moves, asked, asked.position)


def test_blocks_features_and_axes_have_figures_of_their_own():
    corner = at(50, 0)
    moves = moves_of(
        line(ZERO, corner, motion=Motion.RAPID),
        arc(corner, np.array([50.0, 20.0, 0]), UP, 360.0),
        line(corner, at(50, -30)),
    )
    asked = setpoints(moves)
    joint = asked.position.copy()
    joint[100:200, 2] += 0.005
    joint[700:800, 2] -= 0.007
    joint[1300, 2] += 0.002
    figures, errors = compare(moves, asked, joint)
    blocks = figures.blocks
    assert blocks.line.tolist() == [1, 2, 3]
    assert blocks.rapid.tolist() == [True, False, False]
    assert blocks.arc.tolist() == [False, True, False]
    assert blocks.max_um == pytest.approx([5.0, 7.0, 2.0])
    assert blocks.time_s == pytest.approx([0.1, 0.7, 1.3], abs=0.1)
    assert blocks.samples.sum() == len(errors)
    assert blocks.rms_um[0] == pytest.approx(5.0 * np.sqrt(100 / blocks.samples[0]), rel=1e-6)
    straight, circle = figures.features["line"], figures.features["arc"]
    assert (straight.max, straight.worst_line) == pytest.approx((5.0, 1))
    assert (circle.max, circle.p99, circle.worst_line) == pytest.approx((7.0, 7.0, 2), rel=1e-3)
    assert figures.tracking["Z"].p99 == pytest.approx(7.0, rel=1e-3)
    assert figures.tracking["X"].p99 == 0.0


@pytest.mark.parametrize("rows", [90, 100_000])
def test_a_rounded_corner_is_measured_from_its_point(rows: int):
    """A chord across a right angle, 2 mm before to 2 mm behind, passes it at sqrt(2) mm."""
    moves = square()
    asked = setpoints(moves)
    joint = asked.position.copy()
    a, b = asked.position[980], asked.position[1020]
    joint[980:1021] = a + np.linspace(0, 1, 41)[:, None] * (b - a)
    corners = compare(moves, asked, joint, rows=rows)[0].corners
    assert corners.count == 3
    assert corners.rounding_um == pytest.approx(np.sqrt(2.0) * 1e3, abs=0.1)
    assert (corners.line, corners.time_s) == (2, pytest.approx(1.0, abs=0.002))
    assert corners.rms_um == pytest.approx(np.sqrt(2.0 / 3.0) * 1e3, abs=0.1)
    assert corners.p99_um == corners.rounding_um


@pytest.mark.parametrize("rows", [90, 700, 100_000])
def test_a_corner_that_one_move_comes_back_to_is_passed_once(rows: int):
    """Two turns from the corner on: the first time it is cut off, the two later times hit."""
    moves = moves_of(line(ZERO, at(50, 0)), arc(at(50, 0), np.array([70.0, 0, 0]), UP, 720.0))
    asked = setpoints(moves, per_move=2000)
    joint = asked.position.copy()
    a, b = asked.position[1960], asked.position[2010]
    joint[1960:2011] = a + np.linspace(0, 1, 51)[:, None] * (b - a)
    (ax, ay), (bx, by) = (point[:2] - PART_ZERO[:2] - [50.0, 0.0] for point in (a, b))
    rounding = abs(ax * by - ay * bx) / np.hypot(bx - ax, by - ay)
    corners = compare(moves, asked, joint, rows=rows)[0].corners
    assert corners.count == 1
    assert corners.rounding_um == pytest.approx(rounding * 1e3, abs=1e-3)
    assert corners.time_s == pytest.approx(2.0, abs=0.04)


@pytest.mark.parametrize("rows", [90, 100_000])
def test_what_happens_at_a_corner_is_not_counted_for_the_straights(rows: int):
    """0.1 mm a sample: the corner reaches ten samples to either side."""
    moves = square()
    asked = setpoints(moves)
    joint = asked.position.copy()
    joint[992:1009, 2] += 0.009
    joint[1200, 2] += 0.004
    features = compare(moves, asked, joint, rows=rows)[0].features
    corner, straight = features["corner"], features["line"]
    assert (corner.max, corner.worst_time_s) == (pytest.approx(9.0), pytest.approx(1.0, abs=0.01))
    assert corner.rms == pytest.approx(np.sqrt(17.0 * 81.0 / (3 * 21)), rel=0.03)
    assert (straight.max, straight.worst_line) == (pytest.approx(4.0), 3)
    assert "arc" not in features


def test_smooth_joints_are_no_corners_and_sharp_ones_on_the_table_are():
    half = arc(at(50, 0), np.array([50.0, 20.0, 0]), UP, 180.0)
    moves = moves_of(line(ZERO, at(50, 0)), half, line(half["end"], at(0, 40)))
    asked = setpoints(moves)
    assert compare(moves, asked, asked.position)[0].corners.count == 0
    turning = moves_of(line(ZERO, at(50, 0)), line(at(50, 0), at(50, 0, 0, 90)))
    asked = setpoints(turning)
    corners = compare(turning, asked, late(turning, asked, 0.01))[0].corners
    assert corners.count == 1
    assert corners.rounding_um < 1e-6
