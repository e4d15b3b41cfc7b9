"""Velocity profiles along segments: phases of constant jerk, as fast as the limits allow.

Each phase lasts as long as its end is safe (``backward_pass_kernels``): first the jerk is positive,
then zero; when neither is safe any more, the brake that made the state safe is carried out. For one
move this gives the well-known seven phases of minimum time.
"""

from typing import NamedTuple

import numpy as np

from twin.compilation.kernel import array_kernel, kernel
from twin.motion.profile.backward_pass_kernels import ROUNDING, SLOWEST, find_brake
from twin.motion.profile.brake_kernels import after_jerk, brake_limits
from twin.motion.profile.next_phase_kernels import SAME, ease_off, next_phase
from twin.motion.profile.phase_kernels import PhaseRows, write_brake, write_phase
from twin.motion.profile.state import Brake, PathAhead, State
from twin.motion.ramp_kernels import brake_distance
from twin.nc.canonical import FloatArray, IntArray

STATE_AT_REST = np.array([0.0, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0, 0.0, 0.0])
"""Segment, x within it, v, a, time; the border to which the state can brake, -1: to be found, and
the velocity there; jerk and duration of the phase that has led to a stop, 0: none."""

MAX_PHASES = 256
"""Of one segment; where rounding asks for more, the brake that is known is carried out."""

ROWS_PER_STEP = 8
"""Rows that one step may write at most, and some to spare."""


class SegmentTimes(NamedTuple):
    """What happens where n segments are entered at rest.

    Attributes:
        overlap: How far from there the moves on both sides may overlap, 0: not at all, shape (n,)
            [mm or deg].
        pause: How long each segment waits, shape (n,) [s].
    """

    overlap: FloatArray
    pause: FloatArray


class ForwardPass(NamedTuple):
    """How far the forward pass has come.

    Attributes:
        now: When it is there [s].
        border: To which the state can brake; up to its segment: to be found.
        last_jerk: Of the phase that has led to a stop here; 0: none has.
        last_duration: Of that phase [s].
        rows: Rows of phases written so far.
    """

    state: State
    now: float
    border: int
    velocity: float
    last_jerk: float
    last_duration: float
    rows: int


@array_kernel
def forward_pass(
    limits: FloatArray, entry: FloatArray, brakes: FloatArray, times: SegmentTimes,
    stop: int, until: float, state: FloatArray,
) -> tuple[FloatArray, IntArray]:  # fmt: skip
    """Drive from ``state`` to a segment or a time, on to the end of a phase or brake.

    Where moves may overlap at a stop, the first phase of the second begins before the last phase of
    the first has ended; a drive does not end between them.

    However often the drive is broken off and gone on with, the phases are the same. With every
    state goes the brake that makes it safe, so that there is always something left to do.

    Args:
        limits: Of a ``PathAhead``.
        entry: Of a ``PathAhead``.
        brakes: From ``backward_pass``.
        until: Time at which to end [s].
        state: As ``STATE_AT_REST``; overwritten by the state at the end, shape (9,).

    Returns:
        Rows begin [s], duration [s], x, v, a, j, and the first and last segment of each phase.
    """
    count = limits.shape[1]
    course = PathAhead(limits, entry, brakes[0])
    rows = PhaseRows(np.zeros((256, 6)), np.zeros((256, 2), np.int64))
    here = State(int(state[0]), state[1], state[2], state[3])
    drive = ForwardPass(here, state[4], int(state[5]), state[6], state[7], state[8], 0)
    phases_here, last_segment = 0, drive.state.segment
    while drive.state.segment < stop and drive.state.segment < count:
        i = drive.state.segment
        overlaps = drive.last_jerk > 0.0 and times.overlap[i] > 0.0
        if drive.now >= until and not overlaps:
            break
        phases_here = phases_here + 1 if i == last_segment else 0
        last_segment = i
        if drive.rows + ROWS_PER_STEP > len(rows.segments):
            rows = PhaseRows(
                np.concatenate((rows.phases, np.zeros_like(rows.phases))),
                np.concatenate((rows.segments, np.zeros_like(rows.segments))),
            )
        if limits[0, i] == 0.0:
            drive = _wait(rows, drive, times.pause[i])
            continue
        _, x, v, _ = drive.state
        if v < SLOWEST and limits[0, i] - x <= ROUNDING * limits[0, i]:
            # All but arrived; what is left is too little to speed up for.
            arrived = State(i + 1, 0.0, min(v, brakes[0, i + 1]), 0.0)
            drive = ForwardPass(
                arrived, drive.now, -1, drive.velocity, drive.last_jerk, drive.last_duration,
                drive.rows,
            )  # fmt: skip
            continue
        if drive.border <= i:
            k, w = _known_brake(course, brakes, drive.state)
            drive = ForwardPass(
                drive.state, drive.now, k, w, drive.last_jerk, drive.last_duration, drive.rows
            )
        if v <= 0.0 or phases_here < MAX_PHASES:
            before = drive.rows
            drive = _extend(course, rows, drive, times.overlap[i] if overlaps else 0.0)
            if drive.rows > before:
                continue
        drive = _brake_on(course, rows, drive)
    state[0], state[1], state[2], state[3] = drive.state
    state[4], state[5], state[6] = drive.now, drive.border, drive.velocity
    state[7], state[8] = drive.last_jerk, drive.last_duration
    return rows.phases[: drive.rows], rows.segments[: drive.rows]


@array_kernel
def _wait(rows: PhaseRows, drive: ForwardPass, pause: float) -> ForwardPass:
    """Wait at a dwell."""
    i = drive.state.segment
    write_phase(rows, drive.rows, i, drive.now, pause, State(i, 0.0, 0.0, 0.0), 0.0)
    after = State(i + 1, 0.0, 0.0, 0.0)
    return ForwardPass(after, drive.now + pause, -1, drive.velocity, 0.0, 0.0, drive.rows + 1)


@array_kernel
def _known_brake(course: PathAhead, brakes: FloatArray, state: State) -> tuple[int, float]:
    """Border to which a state can brake, and the velocity there."""
    k = find_brake(course, state, ROUNDING)
    if k >= 0:
        return k, brakes[0, k]
    # At a border that was reached by a brake: as it was found.
    return int(brakes[1, state.segment]), brakes[2, state.segment]


@array_kernel
def _extend(course: PathAhead, rows: PhaseRows, drive: ForwardPass, away: float) -> ForwardPass:
    """Jerk up or hold for as long as there is a brake; nothing where there is none.

    Args:
        away: How far from a stop here the moves may overlap.
    """
    j, duration, at_border, k = next_phase(course, drive.state, drive.border)
    if duration <= 0.0:
        return drive
    i, begin = drive.state.segment, drive.now
    if away > 0.0 and j > 0.0:
        begin -= _overlap(away, drive.last_jerk, drive.last_duration, j, duration)
    write_phase(rows, drive.rows, i, begin, duration, drive.state, j)
    new = after_jerk(drive.state, j, duration)
    if at_border:
        new = State(i + 1, 0.0, new.v, new.a)
    w = course.controllable[k] if k >= 0 else drive.velocity
    return ForwardPass(new, begin + duration, k, w, 0.0, 0.0, drive.rows + 1)


@kernel
def _overlap(
    away: float, last_jerk: float, last_duration: float, jerk: float, duration: float
) -> float:
    """How long two moves overlap at a stop [s].

    Args:
        away: How far from it both may be.
        last_jerk: Of the phase that leads to the stop.
        last_duration: Of that phase [s].
        jerk: Of the phase that leads away from it.
        duration: Of that phase [s].
    """
    time = (6.0 * away / last_jerk) ** (1.0 / 3.0) + (6.0 * away / jerk) ** (1.0 / 3.0)
    return min(time, last_duration, duration)


@array_kernel
def _brake_on(course: PathAhead, rows: PhaseRows, drive: ForwardPass) -> ForwardPass:
    """Carry the known brake out: ease off while a > 0, else brake, after what is left before it."""
    (i, x, v, a), now, k, w, _, _, used = drive
    lengths = course.limits[0]
    deceleration, jerk, behind = brake_limits(course.limits, i, k)
    rest = lengths[i] - x
    distance = rest + behind
    if a > 0.0:
        duration, at_border, new = ease_off(course.limits, drive.state, jerk)
        write_phase(rows, used, i, now, duration, drive.state, -jerk)
        if at_border and (i + 1 == k or new.a <= 0.0):
            new = State(i + 1, new.x, new.v, 0.0)
        return ForwardPass(new, now + duration, k, w, 0.0, 0.0, used + 1)
    if v <= w * (1.0 + SAME):
        # Only rounding has kept the state from going on as it is.
        write_phase(rows, used, i, now, rest / v, State(i, x, v, 0.0), 0.0)
        return ForwardPass(
            State(i + 1, 0.0, min(v, w), a), now + rest / v, k, w, 0.0, 0.0, used + 1
        )
    spare = distance - brake_distance(v, w, deceleration, jerk)
    to_border = spare <= ROUNDING * distance
    if to_border and spare > 0.0:
        duration = spare / v
        write_phase(rows, used, k - 1, now, duration, State(i, x, v, 0.0), 0.0)
        used += 1
        now += duration
        x += v * duration
        while x >= lengths[i] and i < k - 1:
            x -= lengths[i]
            i += 1
    used, now, i, x = write_brake(
        rows, used, lengths, now, State(i, x, v, 0.0), Brake(k, w, deceleration, jerk)
    )
    last_jerk, last_duration = 0.0, 0.0
    if w == 0.0 and rows.phases[used - 1, 5] > 0.0:
        last_jerk, last_duration = jerk, rows.phases[used - 1, 1]
    if to_border:
        return ForwardPass(State(k, 0.0, w, 0.0), now, -1, w, last_jerk, last_duration, used)
    return ForwardPass(State(i, x, w, 0.0), now, k, w, last_jerk, last_duration, used)
