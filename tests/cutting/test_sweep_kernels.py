import itertools

import hypothesis
import hypothesis.strategies as st
import numpy as np
import pytest
from examples import examples

from twin.cutting.heights.height_map import HeightMap
from twin.cutting.heights.outline import BlankOutline
from twin.cutting.heights.sweeping import Rectangle, sweep_lines
from twin.cutting.kernels.covered_cells import Marks
from twin.cutting.kernels.simplify import simplify
from twin.cutting.kernels.sweep import Removal
from twin.cutting.kernels.wall_distance import no_walls_known
from twin.cutting.tools import Profile
from twin.nc.canonical import FloatArray

PROFILES = (
    Profile(3.0, flat=3.0),
    Profile(3.0, flat=0.0, corner=3.0),
    Profile(3.0, flat=2.0, corner=1.0),
    Profile(3.0, flat=0.0, slope=0.6),
    Profile(3.0, flat=1.0, slope=1.0),
)
CELL = 0.37
BOTTOM = -4.0


def swept_by_small_steps(points: FloatArray, cutter: Profile, shape: tuple[int, int]) -> FloatArray:
    """The height map after many stamps of the cutter along each line."""
    y, x = CELL * np.indices(shape)
    heights = np.zeros(shape)
    for a, b in itertools.pairwise(points):
        for t in np.linspace(0.0, 1.0, 401):
            tip = a + t * (b - a)
            lower = tip[2] + cutter.height(np.hypot(x - tip[0], y - tip[1]))
            heights = np.maximum(np.minimum(heights, lower), BOTTOM)
    return heights


def board(shape: tuple[int, int]) -> HeightMap:
    """A map whose first cell is over X0 Y0, with its top at Z0."""
    heights, edge = np.zeros(shape), BlankOutline((0.0, 0.0), (1e3, 1e3), round=False)
    walls = no_walls_known(heights)
    return HeightMap((0.0, 0.0), CELL, BOTTOM, heights, 0.0, edge, np.zeros(shape), walls)


def swept(
    points: FloatArray, cutter: Profile, shape: tuple[int, int]
) -> tuple[FloatArray, Removal, Rectangle]:
    part, marked = board(shape), board(shape)
    removal, changed = sweep_lines(part, points, cutter)
    marks = np.zeros(shape)
    mark = np.arange(1, len(points), dtype=np.float64)
    sweep_lines(marked, points, cutter, Marks(marks, mark))
    np.testing.assert_array_equal(marks > 0, marked.heights < 0)
    np.testing.assert_array_equal(marked.heights, part.heights)
    return part.heights, removal, changed


coordinate = st.floats(-4.0, 12.0)
points = st.lists(st.tuples(coordinate, coordinate, st.floats(-5.0, 1.0)), min_size=2, max_size=4)


@hypothesis.settings(derandomize=True, max_examples=examples(40), deadline=None)
@hypothesis.given(points, st.sampled_from(PROFILES))
@hypothesis.example([(0.0, 0.0, 0.0), (0.0, 1.0, -1.0)], PROFILES[2])
def test_sweep_agrees_with_many_small_steps(
    corners: list[tuple[float, float, float]], cutter: Profile
) -> None:
    path = np.array(corners)
    shape = (19, 23)
    heights, (removed, depth, *_), changed = swept(path, cutter, shape)
    step = np.abs(np.diff(path, axis=0)).max() / 400
    stamped = swept_by_small_steps(path, cutter, shape)
    grown = cutter._replace(radius=cutter.radius + step, flat=cutter.flat + step)
    assert np.all(heights <= stamped + 1e-9)
    assert np.all(heights >= swept_by_small_steps(path, grown, shape) - 2 * step - 1e-9)
    assert removed.sum() == pytest.approx(-heights.sum() * CELL**2, abs=1e-9)
    assert depth.max() <= -BOTTOM
    rows, columns = np.nonzero(heights)
    if len(rows):
        assert changed[0] <= rows.min()
        assert changed[1] > rows.max()
        assert changed[2] <= columns.min()
        assert changed[3] > columns.max()
    else:
        assert changed[0] >= changed[1]


step = st.floats(-1.5, 1.5)
steps = st.lists(
    st.tuples(step, step, st.sampled_from([-0.4, 0.0, 0.0, 0.3])), min_size=2, max_size=12
)


@hypothesis.settings(derandomize=True, max_examples=examples(60), deadline=None)
@hypothesis.given(steps, st.sampled_from(PROFILES))
def test_what_is_passed_over_was_cut_before(
    ways: list[tuple[float, float, float]], cutter: Profile
) -> None:
    """A path swept whole, where places that lie under the tool are passed over, and line by line."""
    path = np.cumsum(np.array([(4.0, 4.0, -1.0), *ways]), axis=0)
    shape = (25, 27)
    whole, (removed, depth, *_), _ = swept(path, cutter, shape)
    part, known = board(shape), board(shape)
    for i, line in enumerate(itertools.pairwise(path)):
        one, _ = sweep_lines(part, np.array(line), cutter)
        sweep_lines(known, np.array(line), cutter, stood=i > 0)
        assert removed[i] == pytest.approx(one.volume[0], abs=1e-9)
        assert depth[i] == pytest.approx(one.depth[0], abs=1e-9)
    np.testing.assert_allclose(whole, part.heights, atol=1e-12)
    np.testing.assert_array_equal(whole, known.heights)


def test_level_sweep_is_the_stadium() -> None:
    path = np.array([[2.0, 3.0, -1.0], [6.0, 4.0, -1.0]])
    heights, (removed, depth, *_), _ = swept(path, PROFILES[0], (25, 25))
    y, x = CELL * np.indices(heights.shape)
    way = path[1, :2] - path[0, :2]
    t = np.clip(((x - 2.0) * way[0] + (y - 3.0) * way[1]) / (way @ way), 0.0, 1.0)
    inside = np.hypot(x - 2.0 - t * way[0], y - 3.0 - t * way[1]) <= 3.0
    np.testing.assert_array_equal(heights, np.where(inside, -1.0, 0.0))
    assert removed[0] == pytest.approx(inside.sum() * CELL**2)
    assert depth[0] == 1.0


def thin_in_python(path: FloatArray, group: FloatArray, tolerance: float) -> list[int]:
    chosen = [0]
    while chosen[-1] < len(path) - 1:
        last = chosen[-1] + 1
        while last + 1 < len(path) and group[last + 1] == group[last]:
            a, b = path[chosen[-1]], path[last + 1]
            way = b - a
            between = path[chosen[-1] + 1 : last + 1] - a
            length = way @ way
            share = np.clip(between @ way / length, 0.0, 1.0) if length else np.zeros(len(between))
            if np.linalg.norm(between - share[:, None] * way, axis=1).max() > tolerance:
                break
            last += 1
        chosen.append(last)
    return chosen


@pytest.mark.parametrize("seed", range(5))
def test_thin_agrees_with_plain_python(seed: int) -> None:
    random = np.random.default_rng(seed)
    path = np.cumsum(np.repeat(random.normal(size=(12, 3)), 7, axis=0), axis=0)
    path += random.normal(scale=1e-3, size=path.shape)
    group = np.arange(len(path)) // 20
    chosen = simplify(path[None], group, 2e-3, 1e9, 10_000)
    assert chosen.tolist() == thin_in_python(path, group.astype(np.float64), 2e-3)
    assert len(chosen) < len(path)


def test_thin_keeps_standstill_reversal_and_limits() -> None:
    still = np.zeros((10, 3))
    group = np.zeros(10, np.int64)
    assert simplify(still[None], group, 1e-3, 1.0, 100).tolist() == [0, 9]
    there_and_back = np.array([[x, 0.0, 0.0] for x in (0, 1, 2, 3, 2, 1)])
    assert 3 in simplify(there_and_back[None], group[:6], 1e-3, 100.0, 100)
    ahead = np.array([[x, 0.0, 0.0] for x in range(10)], np.float64)
    assert simplify(ahead[None], group, 1e-3, 3.0, 100).tolist() == [0, 3, 6, 9]
    assert simplify(ahead[None], group, 1e-3, 100.0, 2).tolist() == [0, 2, 4, 6, 8, 9]
    assert simplify(ahead[None], group + (np.arange(10) > 4), 1e-3, 100.0, 100).tolist() == [
        0,
        4,
        9,
    ]
    assert simplify(still[:1][None], group[:1], 1e-3, 1.0, 100).tolist() == [0]
