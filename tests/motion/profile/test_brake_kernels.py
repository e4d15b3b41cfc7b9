"""The braking kernels against plain NumPy twins that integrate the acceleration over time."""

import itertools
import math

import hypothesis
import numpy as np
import pytest
from examples import examples
from hypothesis import example, given
from hypothesis import strategies as st
from motion_programs import SETTINGS

from twin.motion.live.transition_kernels import find_transition
from twin.motion.profile.backward_pass_kernels import backward_pass, find_brake
from twin.motion.profile.brake_kernels import brake_distance_from, time_to
from twin.motion.profile.brake_margin_kernels import brake_margin
from twin.motion.profile.phase_kernels import PhaseRows, write_brake
from twin.motion.profile.segment_kernels import find_segments, merge_limits, place_phases
from twin.motion.profile.state import Brake, PathAhead, State
from twin.motion.ramp_kernels import brake_distance, brake_time
from twin.nc.canonical import FloatArray

FEWER = hypothesis.settings(SETTINGS, max_examples=examples(40))
LARGE = st.floats(1.0, 1000.0)
DECELERATION, JERK = st.floats(50.0, 2e4), st.floats(500.0, 1e6)


def plain_brake(
    v: float, a: float, w: float, deceleration: float, jerk: float
) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """Time, way, velocity, acceleration of the brake, by summing up its acceleration."""
    hardest, reached = 0.0, math.inf
    low, high = 0.0, deceleration
    for _ in range(100):
        # Without a hold: from a down to -hardest and back to 0.
        middle = 0.5 * (low + high)
        reached = v + a * a / (2.0 * jerk) - middle * middle / jerk
        low, high = (middle, high) if reached > w else (low, middle)
    hardest = low
    hold = max(0.0, v + a * a / (2.0 * jerk) - hardest * hardest / jerk - w)
    hold = hold / hardest if hardest > 0.0 else 0.0
    corners = np.cumsum([0.0, (a + hardest) / jerk, hold, hardest / jerk])
    t = np.unique(np.concatenate([np.linspace(p, q, 801) for p, q in itertools.pairwise(corners)]))
    acceleration = np.interp(t, corners, [a, -hardest, -hardest, 0.0])
    h = np.diff(t)
    velocity = v + np.append(0.0, np.cumsum(0.5 * (acceleration[1:] + acceleration[:-1]) * h))
    # Exact for a acceleration that is linear over each step.
    steps = velocity[:-1] * h + (2.0 * acceleration[:-1] + acceleration[1:]) * h * h / 6.0
    return t, np.append(0.0, np.cumsum(steps)), velocity, acceleration


@SETTINGS
@given(LARGE, st.floats(0.0, 1.0), st.floats(0.0, 1.0), DECELERATION, JERK)
def test_brakes_agree_with_the_sum_of_their_acceleration(
    v: float, lower: float, rising: float, deceleration: float, jerk: float
) -> None:
    a, w = rising * deceleration, lower * v
    t, x, velocity, _ = plain_brake(v, a, w, deceleration, jerk)
    assert brake_distance_from(v, a, w, deceleration, jerk) == pytest.approx(
        x[-1], rel=1e-6, abs=1e-9
    )
    assert velocity[-1] == pytest.approx(w, rel=1e-6, abs=1e-6)
    if a == 0.0:
        assert brake_distance(v, w, deceleration, jerk) == pytest.approx(x[-1], rel=1e-6, abs=1e-9)
        assert brake_time(v, w, deceleration, jerk) == pytest.approx(t[-1], rel=1e-6, abs=1e-9)


@SETTINGS
@given(LARGE, st.floats(0.05, 0.95), DECELERATION, JERK)
def test_a_brake_goes_on_from_any_state_on_it(
    v: float, share: float, deceleration: float, jerk: float
) -> None:
    """From a state with a < 0 the rest of the way and the rows are those of the whole brake."""
    t, x, velocity, acceleration = plain_brake(v, 0.0, 0.0, deceleration, jerk)
    row = int(share * (len(t) - 1))
    rest = brake_distance_from(velocity[row], acceleration[row], 0.0, deceleration, jerk)
    assert rest == pytest.approx(x[-1] - x[row], rel=1e-3, abs=1e-4 * x[-1])
    rows = PhaseRows(np.zeros((3, 6)), np.zeros((3, 2), np.int64))
    lengths = np.array([10.0 * x[-1] + 1.0])
    here = State(0, 0.0, velocity[row], acceleration[row])
    count, end, _, _ = write_brake(rows, 0, lengths, 0.0, here, Brake(1, 0.0, deceleration, jerk))
    assert end == pytest.approx(t[-1] - t[row], rel=1e-2, abs=1e-3 * t[-1])
    _, duration, _, begin_v, begin_a, j = rows.phases[count - 1]
    assert begin_v + (begin_a + 0.5 * j * duration) * duration == pytest.approx(0.0, abs=1e-6 * v)


@SETTINGS
@given(st.floats(0.1, 100.0), st.floats(-100.0, 100.0), st.floats(-100.0, 100.0), LARGE)
def test_time_to_inverts_the_way(v: float, a: float, j: float, share: float) -> None:
    latest = 1.0
    t = np.linspace(0.0, latest, 2001)
    way = v * t + a * t**2 / 2.0 + j * t**3 / 6.0
    hypothesis.assume(np.all(np.diff(way) > 0.0))
    wanted = way[-1] * share / 1000.0
    assert time_to(wanted, v, a, j, latest) == pytest.approx(np.interp(wanted, way, t), abs=1e-4)


def test_time_is_found_from_all_but_standing() -> None:
    """At 6e-8 mm/s the way would take months without the acceleration."""
    v, a, distance = 5.847205949142e-8, 5.0, 1.0650219816634
    expected = (-v + math.sqrt(v * v + 2.0 * a * distance)) / a
    found = time_to(distance, v, a, 0.0, 2.0 * distance / v)
    assert found == pytest.approx(expected, rel=1e-13)


@SETTINGS
@given(
    LARGE, st.floats(0.0, 0.95), st.floats(0.0, 1.0), DECELERATION, JERK,
    st.lists(st.floats(0.01, 1.2), min_size=4, max_size=4),
    st.lists(st.floats(0.6, 1.4), min_size=4, max_size=4),
)  # fmt: skip
def test_a_brake_has_room_where_it_keeps_the_limits_on_its_way(
    v: float, lower: float, rising: float, deceleration: float, jerk: float,
    shares: list[float], caps: list[float],
) -> None:  # fmt: skip
    a, w = rising * deceleration, lower * v
    _, x, velocity, acceleration = plain_brake(v, a, w, deceleration, jerk)
    top = velocity.max()
    limits = np.array(
        [[share * x[-1] for share in shares], [1.01 * top, *(cap * v for cap in caps[1:])],
         [1.01 * deceleration, *(0.9 * deceleration for _ in caps[1:])],
         [deceleration] * 4, [jerk] * 4]
    )  # fmt: skip
    entry = np.array([math.inf, *(cap * v for cap in caps[:3]), 0.0])
    course, brake = PathAhead(limits, entry, entry), Brake(4, w, deceleration, jerk)
    room = brake_margin(course, State(0, 0.0, v, a), brake, 1.0)
    borders = np.append(0.0, np.cumsum(limits[0]))

    there = np.minimum(np.searchsorted(borders[1:4], x, "right"), 3)
    beyond = there > 0
    # The sum of accelerations ends beside w by its rounding.
    slower = velocity * (1.0 - 1e-9)
    holds = bool(
        np.all(slower <= limits[1, there])
        and np.all(acceleration[beyond] <= limits[2, there[beyond]])
        and np.all(np.interp(borders[1:4], x, slower) <= entry[1:4])
        # Where it ends early, it goes on at w to the last border.
        and np.all(w <= limits[1, 1:])
        and borders[4] >= x[-1]
    )
    if abs(room) > 1e-3 * x[-1]:
        assert holds == (room > 0.0)


@st.composite
def segments(draw: st.DrawFn) -> tuple[FloatArray, FloatArray]:
    count = draw(st.integers(1, 7))

    def row(low: float, high: float) -> list[float]:
        return draw(st.lists(st.floats(low, high), min_size=count, max_size=count))

    limits = np.array(
        [row(0.01, 5.0), row(1.0, 100.0), *(row(100.0, 5e3) for _ in range(2)), row(1e3, 1e5)]
    )
    entry = np.array([*row(0.0, 200.0), 0.0])
    return limits, entry


def plain_is_safe(
    limits: FloatArray,
    entry: FloatArray,
    controllable: FloatArray,
    i: int,
    v: float,
    slack: float,
    *,
    onward: bool = False,
) -> bool:
    """Whether some brake from border i with a = 0 keeps every limit, by looking at all of it.

    ``onward``: it must not stop before the segment that it is meant to end in. From v to a small w
    it takes longer than to a stop, but nobody wants to stop where the path goes on.
    """
    count = limits.shape[1]
    for k in range(i + 1, count + 1):
        deceleration, jerk = limits[3, i:k].min(), limits[4, i:k].min()
        w = min(v, controllable[k])
        _, x, velocity, _ = plain_brake(v, 0.0, w, deceleration, jerk)
        borders = np.cumsum(limits[0, i:k])
        if x[-1] > borders[-1] * (1.0 + slack) + 1e-12:
            continue
        if onward and k > i + 1 and x[-1] <= borders[-2]:
            continue
        within = np.minimum(np.searchsorted(borders, x), k - i - 1)
        caps = limits[1, i:k][within]
        passed = np.interp(borders[:-1], x, velocity)
        inner = np.minimum(entry[i + 1 : k], np.minimum(limits[1, i + 1 : k], limits[1, i : k - 1]))
        if np.all(velocity <= caps * (1.0 + slack)) and np.all(passed <= inner * (1.0 + slack)):
            return True
    return False


A_STOP_WOULD_BE_SHORTER = (
    np.array(
        [
            [1.0, 3.0, 1.0],
            [80.0, 100.0, 4.0],
            [200.0, 100.0, 440.0],
            [4200.0, 2500.0, 600.0],
            [7130.0, 23000.0, 97000.0],
        ]
    ),
    np.array([30.0, 1.5, 190.0, 0.0]),
)
A_BRAKE_IS_LONGER_THAN_A_STOP = (
    np.array(
        [
            [3.66, 2.148, 0.5, 1.875],
            [22.609, 99.0, 91.66, 68.0],
            [361.8, 3306.0, 1490.0, 779.8],
            [290.9, 4219.0, 3148.0, 411.8],
            [91312.0, 2606.6, 2000.0, 22000.0],
        ]
    ),
    np.array([85.8, 85.7, 12.54, 6.7, 0.0]),
)


@FEWER
@example(A_STOP_WOULD_BE_SHORTER)
@example(A_BRAKE_IS_LONGER_THAN_A_STOP)
@given(segments())
def test_reach_is_safe_and_nearly_the_most_that_is(case: tuple[FloatArray, FloatArray]) -> None:
    limits, entry = case
    controllable, to, at, _ = backward_pass(limits, entry, np.zeros((4, 0)))
    assert controllable[-1] == 0.0
    for i in range(limits.shape[1]):
        if controllable[i] == 0.0:
            continue
        assert at[i] <= controllable[int(to[i])] * (1.0 + 1e-12)
        assert plain_is_safe(limits, entry, controllable, i, controllable[i], 1e-3)
        highest = min(entry[i], limits[1, i], limits[1, i - 1] if i > 0 else math.inf)
        if controllable[i] < 0.98 * highest:
            faster = min(highest, 1.02 * controllable[i])
            assert not plain_is_safe(limits, entry, controllable, i, faster, 0.0, onward=True)
        slower, end = 0.999 * controllable[i], int(to[i])
        stop = brake_distance(slower, 0.0, limits[3, i:end].min(), limits[4, i:end].min())
        # Slower is as safe, unless it is so slow that it would stop before that brake's last segment.
        if stop > limits[0, i : end - 1].sum():
            course = PathAhead(limits, entry, controllable)
            assert find_brake(course, State(i, 0.0, slower, 0.0), 1e-9) > i


@SETTINGS
@given(
    segments(), st.floats(0.0, 0.99), st.floats(0.1, 1.0), st.floats(-0.99, 0.99),
    st.lists(st.floats(0.0, 1.0), min_size=7, max_size=7),
)  # fmt: skip
def test_transition_ends_where_its_brake_does(
    case: tuple[FloatArray, FloatArray], place: float, share: float, rising: float,
    lower: list[float],
) -> None:  # fmt: skip
    limits, _ = case
    entry = np.full(limits.shape[1] + 1, math.inf)
    entry[-1] = 0.0
    wanted = limits.copy()
    wanted[1] *= lower[: limits.shape[1]]
    controllable = backward_pass(wanted, entry, np.zeros((4, 0)))[0]
    x, v = place * limits[0, 0], share * limits[1, 0]
    a = rising * (limits[2, 0] if rising > 0.0 else limits[3, 0])
    brake, x_end = find_transition(
        limits, PathAhead(wanted, entry, controllable), State(0, x, v, a)
    )
    border, w, deceleration, jerk = brake
    if border >= 0:
        end = border - 1
        way = limits[0, :end].sum() + x_end - x
        assert way == pytest.approx(
            brake_distance_from(v, a, w, deceleration, jerk), rel=1e-9, abs=1e-9
        )
        assert w <= wanted[1, end] * (1.0 + 1e-9)


@pytest.mark.parametrize("then", [0.1, 0.2, 0.3, 0.4])
def test_transition_to_a_third_of_the_velocity(then: float) -> None:
    """The way from v to w is longest for w = v / 3, longer than the one to a stop."""
    v, jerk = 100.0, 1e4
    length = 1.04 * brake_distance(v, 0.0, 1e6, jerk)
    limits = np.array([[length, 50.0], [v, v], [1e6, 1e6], [1e6, 1e6], [jerk, jerk]])
    wanted, entry = limits.copy(), np.array([math.inf, math.inf, 0.0])
    wanted[1] = 0.6 * v, then * v
    controllable = backward_pass(wanted, entry, np.zeros((4, 0)))[0]
    here = State(0, 0.0, v, 0.0)
    (border, w, deceleration, j), x_end = find_transition(
        limits, PathAhead(wanted, entry, controllable), here
    )
    end = border - 1
    way = limits[0, :end].sum() + x_end
    assert way == pytest.approx(brake_distance_from(v, 0.0, w, deceleration, j), rel=1e-9)


@SETTINGS
@given(segments(), st.lists(st.booleans(), min_size=7, max_size=7))
def test_segments_are_the_strictest_of_their_pieces(
    case: tuple[FloatArray, FloatArray], dwells: list[bool]
) -> None:
    limits, entry = case
    count = limits.shape[1]
    limits = np.repeat(limits, 4, axis=1)
    limits[0] *= 0.01
    limits[0, np.repeat(dwells[:count], 4)] = 0.0
    entry = np.where(np.arange(4 * count) % 4 == 0, np.repeat(entry[:-1], 4), np.inf)
    begins = find_segments(limits, entry, limits[1])
    merged = merge_limits(limits, entry, begins)
    assert begins[0] == 0
    assert begins[-1] == 4 * count
    for number, (first, last) in enumerate(itertools.pairwise(begins)):
        assert last == first + 1 or np.all(limits[0, first:last] > 0.0)
        assert len(set(limits[1, first:last])) == 1
        assert np.all(entry[first + 1 : last] > 0.0)
        assert merged[0, number] == pytest.approx(limits[0, first:last].sum())
        slowest = min(limits[1, first:last].min(), entry[first + 1 : last].min(initial=math.inf))
        assert merged[1, number] == slowest
        assert np.array_equal(merged[2:, number], limits[2:, first:last].min(axis=1))


@SETTINGS
@given(
    st.lists(st.floats(0.1, 2.0), min_size=1, max_size=12),
    st.lists(st.floats(0.0, 1.0), max_size=9),
)
def test_phases_are_placed_in_the_pieces_of_their_segment(
    lengths: list[float], shares: list[float]
) -> None:
    begins = np.array([0, len(lengths)])
    rows = np.zeros((len(shares), 6))
    rows[:, 2] = np.sort(shares) * sum(lengths)
    x = rows[:, 2].copy()
    pieces = place_phases(rows, np.zeros((len(shares), 2), np.int64), begins, np.array(lengths))
    borders = np.append(0.0, np.cumsum(lengths))
    for row, wanted in enumerate(x):
        assert borders[pieces[row, 0]] + rows[row, 2] == pytest.approx(wanted)
        assert rows[row, 2] <= lengths[pieces[row, 0]] * (1.0 + 1e-12) + 1e-12
        assert pieces[row, 1] == len(lengths) - 1
