import math

import hypothesis
import numpy as np
import pytest
from examples import examples
from hypothesis import given
from hypothesis import strategies as st
from motion_checks import assert_consistent, assert_on_path, assert_within_limits
from motion_programs import AXES, PERIOD, SETTINGS, ZERO, Program, limits, mill, programs, run

from twin.columns import join
from twin.motion.limits import MotionLimits
from twin.motion.live.live_motion import LiveMotion
from twin.motion.setpoints.setpoints import Setpoints
from twin.nc.canonical import Chunk, Corner, Moves

FEWER = hypothesis.settings(SETTINGS, max_examples=examples(40))


def live(program: Program, machine: MotionLimits, largest_override: float = 1.5) -> LiveMotion:
    return LiveMotion(
        program.chunks(), machine, period_s=PERIOD, part_zero=ZERO, start=program.start + ZERO,
        largest_override=largest_override,
    )  # fmt: skip


def to_the_end(motion: LiveMotion, slice_of: int = 500, most: int = 10_000_000) -> list[Setpoints]:
    parts: list[Setpoints] = []
    while not motion.finished:
        parts.append(motion.advance(slice_of))
        most -= slice_of
        assert most > 0, "the program does not end"
    return parts


def press(motion: LiveMotion, button: str, value: float) -> None:
    if button == "feed":
        motion.feed_override = value
    elif button == "rapid":
        motion.rapid_override = min(1.0, value)
    elif button == "hold":
        motion.hold()
    elif button == "start":
        motion.start()
    else:
        motion.single_block = value > 0.75


BUTTONS = st.lists(
    st.tuples(
        st.integers(1, 150),
        st.sampled_from(["feed", "feed", "rapid", "hold", "start", "single"]),
        st.sampled_from([0.0, 0.01, 0.1, 0.5, 0.99, 1.0, 1.2, 1.5]),
    ),
    max_size=8,
)


def operate(
    motion: LiveMotion, buttons: list[tuple[int, str, float]], slice_of: int = 10**6
) -> Setpoints:
    """Press the buttons, each some periods after the one before; then everything back to normal."""
    parts: list[Setpoints] = []
    for wait, button, value in buttons:
        while wait > 0:
            step = min(wait, slice_of)
            parts.append(motion.advance(step))
            wait -= step
        press(motion, button, value)
    motion.feed_override, motion.rapid_override = 1.0, 1.0
    motion.single_block = False
    motion.start()
    return join(parts + to_the_end(motion))


@FEWER
@given(programs(most=8, corners=tuple(Corner)), limits(), st.integers(1, 3000))
def test_untouched_it_is_the_plan(program: Program, machine: MotionLimits, slice_of: int) -> None:
    planned = run(program, machine)
    setpoints = join(to_the_end(live(program, machine, largest_override=1.0), slice_of))
    for name in ("time", "line", "move", "fraction", "position", "velocity", "acceleration"):
        assert np.array_equal(getattr(planned, name), getattr(setpoints, name)), name


@FEWER
@given(
    programs(most=8, corners=(Corner.EXACT_STOP, Corner.EXACT_PATH)), limits(), BUTTONS,
)  # fmt: skip
def test_any_operator_keeps_path_and_limits(
    program: Program, machine: MotionLimits, buttons: list[tuple[int, str, float]]
) -> None:
    setpoints = operate(live(program, machine), buttons)
    assert_on_path(setpoints, program.moves, ZERO)
    assert_within_limits(setpoints, machine, PERIOD, knees=True)
    assert_consistent(setpoints, machine, PERIOD, knees=True)
    assert np.array_equal(setpoints.position[-1], program.position + ZERO)
    assert np.array_equal(setpoints.time, np.arange(len(setpoints)) * PERIOD)


@SETTINGS
@given(
    programs(most=8, corners=(Corner.CONTINUOUS,)),
    st.one_of(limits(), limits(most_knee=0.0)),
    BUTTONS,
)
def test_any_operator_keeps_the_limits_of_a_continuous_path(
    program: Program, machine: MotionLimits, buttons: list[tuple[int, str, float]]
) -> None:
    knees = bool(np.any(machine.junction_velocity_step))
    setpoints = operate(live(program, machine), buttons)
    assert_within_limits(setpoints, machine, PERIOD, knees=knees)
    assert_consistent(setpoints, machine, PERIOD, knees=knees)
    assert np.array_equal(setpoints.position[-1], program.position + ZERO)


@FEWER
@given(programs(most=8, corners=tuple(Corner)), limits(), BUTTONS, st.integers(1, 40))
def test_slices_do_not_matter(
    program: Program, machine: MotionLimits, buttons: list[tuple[int, str, float]], slice_of: int
) -> None:
    whole = operate(live(program, machine), buttons)
    sliced = operate(live(program, machine), buttons, slice_of)
    for name in ("time", "line", "move", "fraction", "position", "velocity", "acceleration"):
        assert np.array_equal(getattr(whole, name), getattr(sliced, name)), name


@FEWER
@given(programs(most=8, corners=tuple(Corner)), limits())
def test_what_is_planned_ahead_is_what_is_planned_when_needed(
    program: Program, machine: MotionLimits
) -> None:
    ahead, parts = live(program, machine), list[Setpoints]()
    while not ahead.finished:
        ahead.work()
        parts.append(ahead.advance(500))
    assert np.array_equal(join(parts).position, join(to_the_end(live(program, machine))).position)


def speed(setpoints: Setpoints) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
    return np.linalg.norm(setpoints.velocity[:, :3], axis=1)


LONG = Program().line(200.0, 0.0, 0.0, 0.0, feed=3000.0)


@pytest.mark.parametrize("factor", [0.01, 0.5, 1.0, 1.37, 1.5])
def test_override_scales_the_feed(factor: float) -> None:
    motion = live(LONG, mill())
    motion.advance(1000)
    motion.feed_override = factor
    motion.advance(300)
    assert speed(motion.advance(1))[0] == pytest.approx(50.0 * factor, rel=1e-9)


@pytest.mark.parametrize("corner", list(Corner))
def test_change_is_felt_within_a_few_periods(corner: Corner) -> None:
    program = Program()
    program.corner = corner
    for i in range(400):
        program.line(0.25 * (i + 1), 0.01 * (i % 2), 0.0, 0.0, feed=3000.0)
    motion = live(program, mill(junction_velocity_step=2.0, corner_tolerance=0.02))
    before = speed(motion.advance(1000))[-1]
    motion.feed_override = 0.2
    after = speed(motion.advance(100))
    if corner != Corner.EXACT_STOP:
        assert after[5] < before
    assert after[-1] < 0.21 * 50.0
    motion.feed_override = 1.2
    after = speed(motion.advance(100))
    assert after[5] > 0.2 * 50.0 or corner == Corner.EXACT_STOP


def test_hold_takes_the_shortest_way_and_start_goes_on() -> None:
    motion = live(LONG, mill())
    motion.advance(1000)
    motion.hold()
    stopping = motion.advance(500)
    # From 50 mm/s with j 40000 and a 2000: a peak of 1414 mm/s², 70.7 ms.
    resting = np.flatnonzero(speed(stopping) == 0.0)
    assert resting[0] == math.ceil(2.0 * math.sqrt(50.0 / 40000.0) / PERIOD)
    assert motion.held
    assert motion.standing
    assert np.ptp(stopping.position[resting[0] :], axis=0).max() == 0.0
    motion.start()
    assert speed(motion.advance(3))[-1] > 0.0
    rest = to_the_end(motion)
    assert rest[-1].position[-1, 0] == 200.0 + ZERO[0]


def test_hold_within_a_brake_and_change_of_mind() -> None:
    """A brake to a lower override that is no longer wanted is eased off at once."""
    motion = live(Program().line(300.0, 0.0, 0.0, 0.0, feed=18000.0), mill())
    motion.advance(500)
    fast = speed(motion.advance(1))[0]
    motion.hold()
    motion.advance(30)
    motion.start()
    after = speed(motion.advance(200))
    assert after.min() > 0.7 * fast
    assert after[-1] == pytest.approx(300.0)


def test_rapid_override_is_apart() -> None:
    motion = live(Program().line(200.0, 0.0, 0.0, 0.0), mill())
    motion.feed_override, motion.rapid_override = 0.0, 0.25
    assert speed(join(to_the_end(motion))).max() == pytest.approx(125.0)


def test_zero_stands_and_goes_on() -> None:
    motion = live(Program().line(20.0, 0.0, 0.0, 0.0).line(0.0, 0.0, 0.0, 0.0, feed=600.0), mill())
    motion.feed_override = 0.0
    motion.advance(3000)
    assert motion.standing
    assert not motion.held
    assert motion.advance(1).position[0, 0] == 20.0 + ZERO[0]
    motion.feed_override = 1.0
    assert to_the_end(motion)[-1].position[-1, 0] == ZERO[0]


@pytest.mark.parametrize("before", [300, 301, 437, 700])
def test_zero_stands_within_a_chain_of_blocks(before: int) -> None:
    """The brake to it ends many blocks further on."""
    program = Program()
    program.corner = Corner.EXACT_PATH
    for i in range(1000):
        program.line(0.1 * (i + 1), 0.001 * (i % 2), 0.0, 0.0, feed=6000.0)
    motion = live(program, mill(junction_velocity_step=2.5))
    begun = motion.advance(before)
    motion.feed_override = 0.0
    standing = motion.advance(300)
    assert motion.standing
    assert np.ptp(standing[-10:].position, axis=0).max() == 0.0
    assert standing.move[-1] > begun.move[-1] + 10
    motion.feed_override = 1.0
    assert to_the_end(motion)[-1].position[-1, 0] == 100.0 + ZERO[0]


def test_hold_stops_the_clock_of_a_dwell() -> None:
    program = Program().dwell(0.2).line(1.0, 0.0, 0.0, 0.0, feed=600.0)
    untouched = len(run(program, mill()))
    motion = live(program, mill())
    parts = [motion.advance(50)]
    motion.hold()
    parts.append(motion.advance(1000))
    assert motion.standing
    motion.start()
    parts.append(motion.advance(10))
    motion.feed_override = 1.1
    motion.feed_override = 1.0
    parts += to_the_end(motion)
    assert len(join(parts)) == untouched + 1000


@pytest.mark.parametrize("corner", list(Corner))
def test_single_block_stops_at_every_end(corner: Corner) -> None:
    program = Program()
    program.corner = corner
    for i in range(4):
        program.line(10.0 * (i + 1), 2.0 * (i % 2), 0.0, 0.0, feed=3000.0)
    motion = live(program, mill(junction_velocity_step=1.0))
    motion.single_block = True
    ends = []
    while not motion.finished:
        setpoints = motion.advance(2000)
        ends.append(setpoints.move[-1])
        assert motion.held or motion.finished
        before = motion.advance(10)
        assert len(before) == 0 or np.ptp(before.position, axis=0).max() == 0.0
        motion.feed_override = 1.0 + 0.1 * len(ends)
        assert motion.finished or motion.advance(10).move[-1] == ends[-1]
        motion.start()
    assert ends == [0, 1, 2, 3]


def test_single_block_too_late_stops_at_the_next_end() -> None:
    program = Program()
    program.corner = Corner.EXACT_PATH
    for i in range(4):
        program.line(10.0 * (i + 1), 0.0, 0.0, 0.0, feed=6000.0)
    motion = live(program, mill())
    at_border = int(np.flatnonzero(motion.advance(10_000).move == 1)[0])
    motion = live(program, mill())
    motion.advance(at_border - 2)
    motion.single_block = True
    assert motion.advance(5000).move[-1] == 1
    assert motion.advance(1).position[0, 0] == 20.0 + ZERO[0]


def test_single_block_taken_back_while_braking_for_it() -> None:
    """However late: the machine goes on, from the block's end if it cannot at once."""
    program = Program().arc((10.0, 0.0, 0.0), (0.0, 0.0, 1.0), 90.0, feed=3000.0)
    program.line(10.0, 10.0, 0.0, 0.0, feed=3000.0)
    motion = live(program, mill())
    motion.single_block = True
    stop = int(np.argmin(speed(motion.advance(5000))[1:] > 0.0))
    for sooner in range(1, 80):
        motion = live(program, mill())
        motion.single_block = True
        motion.advance(stop - sooner)
        motion.single_block = False
        assert to_the_end(motion, most=20_000)[-1].move[-1] == 1, sooner


def test_reset_stops_and_drops_the_rest() -> None:
    motion = live(LONG, mill())
    motion.advance(1000)
    motion.reset()
    motion.start()
    rest = motion.advance(1000)
    assert motion.finished
    assert len(rest) == 72
    assert speed(rest)[-1] == 0.0
    assert rest.position[-1, 0] < 199.0 + ZERO[0]
    assert len(motion.advance(10)) == 0


@pytest.mark.parametrize("before", [0, 1])
def test_reset_at_rest_or_in_a_dwell(before: int) -> None:
    motion = live(Program().dwell(1.0).line(1.0, 0.0, 0.0, 0.0, feed=600.0), mill())
    motion.advance(before * 20)
    motion.reset()
    assert len(motion.advance(100)) == 1
    assert motion.finished


def test_program_without_moves() -> None:
    empty = Chunk(Moves.empty(AXES))
    for chunks in ([], [empty]):
        motion = LiveMotion(chunks, mill(), period_s=PERIOD, part_zero=ZERO, start=ZERO)
        motion.hold()
        motion.start()
        assert len(motion.advance(10)) == 1
        assert motion.finished


class Late:
    """Chunks that come one by one: each is not there yet when it is asked for first."""

    def __init__(self, chunks: list[Chunk]) -> None:
        self._chunks, self._there = chunks, False

    def __iter__(self) -> "Late":
        return self

    def __next__(self) -> Chunk:
        self._there = not self._there
        if self._chunks and self._there:
            raise BlockingIOError
        if not self._chunks:
            raise StopIteration
        return self._chunks.pop(0)


def test_a_program_that_comes_late_is_begun_when_it_is_there() -> None:
    chunks = list(LONG.chunks())
    start = LONG.start + ZERO
    motion = LiveMotion(Late(chunks.copy()), mill(), period_s=PERIOD, part_zero=ZERO, start=start)
    for _ in chunks:
        with pytest.raises(BlockingIOError):
            motion.begin()
    motion.begin()
    late, known = join(to_the_end(motion)), join(to_the_end(live(LONG, mill())))
    assert np.array_equal(late.position, known.position)


def test_values_off_the_panel_are_refused() -> None:
    motion = live(LONG, mill())
    with pytest.raises(ValueError, match=r"feed override 1\.6: use 0 to 1\.5"):
        motion.feed_override = 1.6
    with pytest.raises(ValueError, match=r"rapid override nan: use 0 to 1"):
        motion.rapid_override = math.nan
    with pytest.raises(ValueError, match="largest_override"):
        live(LONG, mill(), largest_override=0.5)


def test_long_program_under_many_wishes() -> None:
    """Many windows, parted by single blocks, with changes at odd places."""
    program = Program()
    program.corner = Corner.EXACT_PATH
    for i in range(1, 9001):
        program.line(0.01 * i, 1e-5 * (i // 50 % 2), 0.0, 0.0, feed=6000.0)
    machine = mill(junction_velocity_step=0.5)
    motion = live(program, machine)
    rng = np.random.default_rng(2)
    parts: list[Setpoints] = []
    while not motion.finished:
        parts.append(motion.advance(int(rng.integers(1, 60))))
        motion.feed_override = float(rng.choice([0.1, 0.5, 1.0, 1.5]))
        motion.single_block = bool(rng.integers(0, 2))
        if rng.integers(0, 4) == 0:
            motion.hold()
        else:
            motion.start()
    setpoints = join(parts)
    assert_on_path(setpoints, program.moves, ZERO)
    assert_within_limits(setpoints, machine, PERIOD, knees=True)
    assert np.array_equal(setpoints.position[-1], program.position + ZERO)
