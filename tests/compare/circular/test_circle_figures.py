import numpy as np
import pytest

from tests.compare.paths import UP, arc, line, moves_of
from tests.compare.runs import compare, setpoints
from twin.compare.circular.arcs import POLAR_ARCS, plane_axes
from twin.compare.circular.circle import BINS_PER_TURN, ActualCircle, circle_figures, hysteresis_um
from twin.nc.canonical import FloatArray

RADIUS = 25.0


def path_of(deviation: FloatArray, angle: FloatArray, center: tuple[float, float]) -> ActualCircle:
    path = ActualCircle(RADIUS)
    distance = RADIUS + deviation
    path.add(center + distance[:, None] * np.column_stack([np.cos(angle), np.sin(angle)]))
    return path


TURN = np.linspace(0.0, 2.0 * np.pi, 20_000, endpoint=False)


def test_a_centre_that_is_off_is_radial_but_not_circular_deviation():
    found = circle_figures(path_of(np.full(len(TURN), -0.010), TURN, (0.003, 0.004)))
    assert found.circular_deviation_um == pytest.approx(0.0, abs=0.01)
    assert found.radial_max_um == pytest.approx(-5.0, abs=0.01)
    assert found.radial_min_um == pytest.approx(-15.0, abs=0.01)
    assert found.mean_radius_error_um == pytest.approx(-10.0, abs=0.01)


def test_an_ellipse_has_the_difference_of_its_half_axes():
    found = circle_figures(path_of(0.012 * np.cos(2.0 * TURN), TURN, (0.0, 0.0)))
    assert found.circular_deviation_um == pytest.approx(24.0, abs=0.01)
    assert found.mean_radius_error_um == pytest.approx(0.0, abs=0.01)


def test_a_narrow_peak_is_not_lost_however_long_the_path():
    path = ActualCircle(RADIUS)
    for _ in range(10):
        path.add(RADIUS * np.column_stack([np.cos(TURN), np.sin(TURN)]))
    path.add(np.array([[0.0, RADIUS + 0.007]]))
    assert circle_figures(path).circular_deviation_um == pytest.approx(7.0, abs=0.02)


def test_dwelling_somewhere_does_not_move_the_least_squares_circle():
    angle = np.concatenate([TURN, np.zeros(500_000)])
    found = circle_figures(path_of(np.zeros(len(angle)), angle, (0.005, 0.0)))
    assert found.circular_deviation_um == pytest.approx(0.0, abs=0.01)


def test_part_of_a_turn_is_seen_from_the_commanded_centre():
    quarter = TURN[: len(TURN) // 4 + 1]
    found = circle_figures(path_of(np.zeros(len(quarter)), quarter, (0.010, 0.0)))
    assert found.circular_deviation_um == pytest.approx(10.0, abs=0.01)
    assert np.isnan(found.mean_radius_error_um)


@pytest.mark.parametrize("count", [70, 80, 7199, 7200, 7201, 20_000])
def test_a_path_is_evaluated_alike_point_by_point_and_by_angle(count: int):
    angle = np.linspace(0.0, 2.0 * np.pi, count, endpoint=False)
    short = path_of(0.012 * np.cos(2.0 * angle), angle, (0.003, 0.0))
    assert short.covers_full_turn() == (count >= 80)
    long = path_of(0.012 * np.cos(2.0 * angle), angle, (0.003, 0.0))
    long.by_angle()
    assert long.covers_full_turn() == short.covers_full_turn()
    assert circle_figures(long).circular_deviation_um == pytest.approx(
        circle_figures(short).circular_deviation_um
    )


def test_both_directions_together():
    one = path_of(np.full(len(TURN), 0.002), TURN, (0.0, 0.0))
    other = path_of(np.full(len(TURN), -0.006), -TURN, (0.0, 0.0))
    both = circle_figures(one, other)
    assert both.circular_deviation_um == pytest.approx(8.0, abs=0.01)
    assert both.mean_radius_error_um == pytest.approx(-2.0, abs=0.01)
    assert hysteresis_um(one, other) == pytest.approx(8.0, abs=0.01)


@pytest.mark.parametrize("apex_deg", [89.5, 90.0, 90.37, 90.73])
@pytest.mark.parametrize("count", [3000, 60_000])
def test_hysteresis_sees_a_peak_narrower_than_a_degree(apex_deg: float, count: int):
    """A peak of 15 µm that falls off over half a degree, as friction leaves it at a reversal."""
    angle = np.arange(count) * (2.0 * np.pi / count)
    beside = np.abs(np.rad2deg(angle) - apex_deg)
    peak = 0.015 * np.maximum(0.0, 1.0 - beside / 0.5)
    paths = []
    for deviation in (peak, np.zeros(count)):
        path = ActualCircle(50.0)
        radius = 50.0 + deviation
        path.add(np.column_stack([radius * np.cos(angle), radius * np.sin(angle)]))
        paths.append(path)
    # The nearest sample or bin lies at most half a step beside the apex.
    step = max(360.0 / count, 360.0 / BINS_PER_TURN)
    assert hysteresis_um(*paths) == pytest.approx(15.0, abs=15.0 * step / 0.5)
    assert hysteresis_um(*paths) == hysteresis_um(*reversed(paths))


def test_nothing_has_no_figures():
    with pytest.raises(ValueError, match="points"):
        circle_figures()
    with pytest.raises(ValueError, match="points"):
        circle_figures(ActualCircle(RADIUS))


START = np.array([RADIUS, 0.0, 0.0, 0.0])
CENTER = np.zeros(3)


def test_arcs_of_a_program_from_ninety_degrees_up_in_order():
    sweeps = [90.0, 89.0, -180.0, 360.0]
    moves = moves_of(*(arc(START, CENTER, UP, sweep) for sweep in sweeps))
    asked = setpoints(moves)
    figures, _ = compare(moves, asked, asked.position)
    assert [(a.line, a.sweep_deg) for a in figures.arcs] == [(1, 90.0), (3, -180.0), (4, 360.0)]
    assert all(a.radius_mm == RADIUS for a in figures.arcs)
    assert all(a.circular_deviation_um < 1e-3 for a in figures.arcs)


@pytest.mark.parametrize("normal", [UP, np.array([0, 1.0, 0]), np.array([1.0, 0, 0])])
def test_a_smaller_circle_and_an_ellipse_in_every_plane(normal: FloatArray):
    outward = np.roll(normal, 1)
    start = np.append(RADIUS * outward, 33.0)
    moves = moves_of(arc(start, CENTER, normal, 720.0), arc(start, CENTER, normal, -360.0))
    asked = setpoints(moves, per_move=20_000)
    first, scale = asked.move == 0, np.ones(4)
    machine_center = asked.position[0] - np.append(RADIUS * outward, 0.0)
    joint = machine_center + (asked.position - machine_center) * (1.0 - 0.009 / RADIUS)
    scale[:3] = 1.0 + 0.014 / RADIUS * outward
    joint[~first] = machine_center + (asked.position[~first] - machine_center) * scale
    small, oval = compare(moves, asked, joint)[0].arcs
    assert small.radial_deviation_um == pytest.approx(-9.0, abs=0.01)
    assert small.circular_deviation_um == pytest.approx(0.0, abs=0.1)
    assert oval.radial_max_um == pytest.approx(14.0, abs=0.01)
    assert oval.radial_min_um == pytest.approx(0.0, abs=0.01)
    assert oval.circular_deviation_um == pytest.approx(14.0, abs=0.05)


def test_a_backlash_step_is_the_circular_deviation():
    """X stays 6 µm short on the half where it runs negative."""
    moves = moves_of(arc(START, CENTER, UP, 360.0))
    asked = setpoints(moves, per_move=20_000)
    joint = asked.position.copy()
    joint[:, 0] += np.where(asked.velocity[:, 0] < 0.0, 0.006, 0.0)
    figures, _ = compare(moves, asked, joint)
    assert figures.contour.max == pytest.approx(6.0, abs=0.01)
    # Half circle moved by b: radial deviation b cos(angle), from -b to +b.
    assert figures.arcs[0].radial_max_um == pytest.approx(6.0, abs=0.01)
    assert figures.arcs[0].radial_min_um == pytest.approx(-6.0, abs=0.01)


def test_polar_plots_are_kept_for_the_worst():
    rows = [arc(START, CENTER, UP, 360.0) for _ in range(POLAR_ARCS + 5)]
    moves = moves_of(*rows)
    asked = setpoints(moves, per_move=400)
    joint = asked.position.copy()
    joint[:, 1] += 1e-4 * asked.move * np.sign(asked.velocity[:, 1])
    arcs = compare(moves, asked, joint)[0].arcs
    assert [len(a.polar) > 0 for a in arcs] == [False] * 5 + [True] * POLAR_ARCS


def test_an_arc_with_the_table_in_step_is_no_circle_on_the_part():
    moves = moves_of(arc(START, CENTER, UP, 360.0, turn=45.0), line(START, START))
    asked = setpoints(moves)
    assert compare(moves, asked, asked.position)[0].arcs == ()


def test_a_circle_run_both_ways_has_bidirectional_figures():
    """Counter-clockwise 2 µm outside, clockwise 6 µm inside, whatever the start points."""
    other_start = np.array([0.0, RADIUS, 0.0, 0.0])
    moves = moves_of(
        arc(START, CENTER, UP, 360.0),
        line(START, other_start),
        arc(other_start, CENTER, -UP, 360.0),
    )
    asked = setpoints(moves, per_move=8000)
    center = asked.position[0] - START
    grown = np.select([asked.move == 0, asked.move == 2], [0.002, -0.006], 0.0)
    joint = center + (asked.position - center) * (1.0 + grown / RADIUS)[:, None]
    (pair,) = compare(moves, asked, joint)[0].bidirectional
    assert (pair.counter_clockwise_line, pair.clockwise_line) == (1, 3)
    assert pair.circular_deviation_um == pytest.approx(8.0, abs=0.05)
    assert pair.mean_radial_deviation_um == pytest.approx(-2.0, abs=0.05)
    assert pair.hysteresis_um == pytest.approx(8.0, abs=0.05)


@pytest.mark.parametrize("normal", [UP, -UP, np.array([0, 1.0, 0]), np.array([0.6, 0.0, 0.8])])
def test_angles_are_the_planes_own(normal: FloatArray):
    first, second = (axes[0] for axes in plane_axes(normal[None]))
    assert first @ second == pytest.approx(0.0, abs=1e-15)
    assert abs(np.cross(first, second) @ normal) == pytest.approx(1.0)
    if abs(normal[2]) == 1.0:
        assert first == pytest.approx([1, 0, 0])
        assert second == pytest.approx([0, 1, 0])
    if normal[1] == 1.0:
        assert first == pytest.approx([0, 0, 1])
        assert second == pytest.approx([1, 0, 0])


@pytest.mark.parametrize("rows", [1000, 7000, 15_000])
def test_a_turn_is_full_however_its_points_come(rows: int):
    path, points = ActualCircle(RADIUS), RADIUS * np.column_stack([np.cos(TURN), np.sin(TURN)])
    for first in range(0, len(points), rows):
        path.add(points[first : first + rows])
    assert path.covers_full_turn()
