"""The compiled loops of the comparison against plain ones."""

import itertools

import numpy as np
import pytest
from examples import examples
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays

from tests.compare.paths import line, moves_of
from twin.compare.circular.circle_kernels import (
    AngleBins,
    ByAngle,
    collect_by_angle,
    into_planes,
    look_by_angle,
    radial_equations,
    radial_range,
    widest_gap,
)
from twin.compare.contour.blocks import BlockCollector
from twin.compare.contour.corners import MoveEnds, pass_corners
from twin.compare.statistics import LEAST_EXPONENT, RESOLUTION, Distribution
from twin.nc.canonical import FloatArray, IntArray

checked = settings(max_examples=examples(40), derandomize=True, deadline=None)


def nearest_rank(values: FloatArray, percent: float) -> float:
    return float(np.sort(values)[max(1, int(np.ceil(percent / 100.0 * len(values)))) - 1])


@checked
@given(
    arrays.arrays(np.float64, st.integers(1, 400), elements=st.floats(-1e6, 1e6)),
    st.integers(1, 50),
    st.sampled_from([50.0, 99.0, 100.0]),
)
def test_a_distribution_is_that_of_all_values(values: FloatArray, rows: int, percent: float):
    found = Distribution()
    for first in range(0, len(values), rows):
        found.add(values[first : first + rows])
    size = np.abs(values)
    assert found.count == len(values)
    assert found.greatest == size.max()
    assert found.rms == pytest.approx(np.sqrt(np.mean(values**2)))
    exact = nearest_rank(size, percent)
    assert exact <= found.percentile(percent) <= max(exact * (1 + RESOLUTION), 2.0**LEAST_EXPONENT)


def test_a_distribution_tells_where_a_new_greatest_is():
    found = Distribution()
    assert found.add(np.array([0.0, 0.0])) == 0
    assert found.add(np.array([1.0, -3.0, 2.0])) == 1
    assert found.add(np.array([3.0])) is None
    assert found.add(np.zeros(0)) is None
    assert found.copy().percentile(99.0) == found.percentile(99.0) == 3.0


def passages(row: IntArray, error: FloatArray) -> list[tuple[int, list[float]]]:
    """Every stay at a row with its errors; going back to the row before goes on with that stay."""
    every: list[tuple[int, list[float]]] = []
    latest: list[tuple[int, list[float]]] = []
    for r, e in zip(row.tolist(), error.tolist(), strict=True):
        here = next((stay for stay in latest if stay[0] == r), None)
        if here is None:
            here = (r, [])
            every.append(here)
        here[1].append(e)
        latest = [*(stay for stay in latest if stay is not here), here][-2:]
    return every


@checked
@given(
    st.lists(st.tuples(st.integers(0, 4), st.integers(1, 150)), min_size=1, max_size=8),
    st.integers(1, 90),
    st.integers(0, 2**31),
)
def test_blocks_are_what_their_samples_are(stays: list[tuple[int, int]], rows: int, seed: int):
    corners = [np.array([x, 0.0, 0.0, 0.0]) for x in range(6)]
    moves = moves_of(*(line(a, b) for a, b in itertools.pairwise(corners)))
    place = np.repeat([move for move, _ in stays], [count for _, count in stays])
    error = 10.0 ** np.random.default_rng(seed).uniform(-2, 4, len(place))
    time = np.float64(0.001) * np.arange(len(place))
    collector = BlockCollector()
    for first in range(0, len(place), rows):
        here = slice(first, first + rows)
        collector.add(moves, place[here], moves.line[place[here]], error[here], time[here])
    found = collector.figures()
    assert found.line.tolist() == sorted(set((place + 1).tolist()))
    for index, number in enumerate(found.line):
        own = error[place + 1 == number]
        p99 = max(
            nearest_rank(np.array(e), 99.0) for r, e in passages(place + 1, error) if r == number
        )
        assert found.samples[index] == len(own)
        assert found.max_um[index] == own.max()
        assert found.time_s[index] == time[error == own.max()][0]
        assert found.rms_um[index] == pytest.approx(np.sqrt(np.mean(own**2)))
        assert p99 <= found.p99_um[index] <= p99 * 1.008


@checked
@given(st.integers(1, 60), st.integers(0, 2**31))
def test_points_around_a_circle_are_sorted_by_angle(count: int, seed: int):
    random = np.random.default_rng(seed)
    angle = random.uniform(0.0, 2.0 * np.pi, count)
    deviation = random.normal(0.0, 0.01, count)
    (angles, deviations), (least, greatest) = np.zeros((2, 12)), np.zeros((2, 12, 3))
    bins = AngleBins(np.zeros(12, np.int64), angles, deviations, least, greatest)
    points = (25.0 + deviation)[:, None] * np.column_stack([np.cos(angle), np.sin(angle)])
    for part in (points[: count // 2], points[count // 2 :]):
        collect_by_angle(part, 25.0, bins)
    filled = np.unique((angle * 12 / (2.0 * np.pi)).astype(int))
    mean, place = np.zeros((2, len(filled), 2))
    found = ByAngle(mean, place, np.zeros((2 * len(filled), 2)))
    look_by_angle(bins, 25.0, found)
    for row, index in enumerate(filled):
        own = (angle * 12 / (2.0 * np.pi)).astype(int) == index
        toward, away = angle[own].mean(), deviation[own].mean()
        assert bins.samples[index] == own.sum()
        assert found.mean[row] == pytest.approx([toward, away], abs=1e-12)
        there = (25.0 + away) * np.array([np.cos(toward), np.sin(toward)])
        assert found.place[row] == pytest.approx(there)
        ends = points[own][[deviation[own].argmin(), deviation[own].argmax()]]
        assert found.extremes[2 * row : 2 * row + 2] == pytest.approx(ends)
    assert bins.samples.sum() == count


@checked
@given(st.integers(1, 40), st.integers(0, 2**31))
def test_the_way_past_a_corner_is_that_to_the_nearest_stretch(count: int, seed: int):
    random = np.random.default_rng(seed)
    corner = random.normal(size=(4, 3))
    sharp = np.array([True, False, True, True])
    nearest, when = np.full(4, np.inf), np.zeros(4)
    ends = MoveEnds(corner, sharp, np.zeros((4, 2)), nearest, when)
    point, time = random.normal(size=(count, 3)), 0.001 * np.arange(count)
    place = random.integers(0, 4, count)
    pass_corners(ends, point[0], point, place, np.zeros(count), time)
    asked, asked_when = np.full(4, np.inf), np.zeros(4)
    before = np.concatenate([point[:1], point[:-1]])
    for i in range(count):
        for end in {max(int(place[i]) - 1, 0), int(place[i])}:
            along = point[i] - before[i]
            share = (corner[end] - before[i]) @ along / max(along @ along, 1e-300)
            way = float(np.linalg.norm(before[i] + np.clip(share, 0, 1) * along - corner[end]))
            if sharp[end] and way < asked[end]:
                asked[end], asked_when[end] = way, time[i]
    assert nearest == pytest.approx(asked)
    # Two stretches share the sample between them.
    assert when == pytest.approx(asked_when, abs=1.1e-3)


@checked
@given(st.integers(3, 60), st.integers(0, 2**31))
def test_the_equations_of_a_circle_are_those_of_least_squares(count: int, seed: int):
    random = np.random.default_rng(seed)
    angle = random.uniform(0.0, 2.0 * np.pi, count)
    points = np.column_stack([np.cos(angle), np.sin(angle)]) * random.uniform(9, 11, (count, 1))
    center = random.normal(0.0, 0.1, 2)
    matrix, right = np.zeros((3, 3)), np.zeros(3)
    radial_equations(points, center, 10.0, matrix, right)
    away = points - center
    distance = np.linalg.norm(away, axis=1)
    slope = np.column_stack([away / distance[:, None], np.ones(count)])
    assert matrix == pytest.approx(slope.T @ slope)
    assert right == pytest.approx(slope.T @ (distance - 10.0), abs=1e-12)
    assert radial_range(away, 10.0) == pytest.approx((distance.min() - 10, distance.max() - 10))


@pytest.mark.parametrize(
    ("filled", "gap"), [([], 12), ([4], 12), ([0, 6], 6), ([2, 3, 4], 10), (range(12), 1)]
)
def test_the_widest_gap_is_looked_for_around_the_turn(filled: list[int], gap: int):
    count = np.zeros(12, np.int64)
    count[list(filled)] = 1
    assert widest_gap(count) == gap


def test_points_are_seen_in_the_plane_of_their_own_arc():
    random = np.random.default_rng(3)
    point, center = random.normal(size=(20, 3)), random.normal(size=(2, 3))
    across, run = random.normal(size=(2, 3, 2)), random.integers(0, 2, 20)
    seen = np.zeros((20, 2))
    into_planes(point, run, center, across, seen)
    for row in range(20):
        assert seen[row] == pytest.approx((point[row] - center[run[row]]) @ across[run[row]])
