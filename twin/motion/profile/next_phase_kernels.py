"""The next phase of constant jerk: how long it may last before nothing is left but to brake."""

import math

from twin.compilation.kernel import kernel
from twin.motion.profile.backward_pass_kernels import ROUNDING, SLOWEST, find_brake
from twin.motion.profile.brake_kernels import (
    after_jerk,
    brake_distance_from,
    brake_limits,
    time_to,
)
from twin.motion.profile.brake_margin_kernels import (
    MAX_CHORDS,
    MAX_STEPS,
    brake_margin,
    crossing,
    narrowed,
)
from twin.motion.profile.state import Brake, PathAhead, State
from twin.motion.ramp_kernels import brake_time
from twin.nc.canonical import FloatArray

SHORTEST_PHASE = 1e-10
"""Phases below this are rounding [s]."""

SAME = 1e-12
"""Relative difference of velocities that rounding makes: the brake between them would be longer
than what is left of the distance."""

MAX_BRAKES = 64
"""That are looked at in turn for one phase."""

BRIEF = 1e-11
"""How far beyond the last chance of a brake another is looked for, relative to the time looked at."""

LATER = 1.02
"""Of two brakes the one to the farther border is preferred if it takes no longer, by this factor, than
the nearer one and the rest of the path at the controllable velocities."""

STRIDE = 8.0
"""By which the search goes on where a brake is possible for longer, but for its rounding."""

SHORTEST_HOLD = 1e-7
"""Of an acceleration that is held: shorter ones only creep up to a limit [s]."""

TIME_PRECISION = 1e-14
"""Of the end of a phase, relative to the time looked at."""


@kernel
def _brake_after(course: PathAhead, state: State, j: float, t: float, to_border: bool) -> int:
    """Border to which the state after t of jerk j can brake, -1: none.

    Args:
        state: Before.
        t: Time [s].
        to_border: Whether t ends at the segment's end.
    """
    limits, entry, _ = course
    new = after_jerk(state, j, t)
    if not to_border:
        return find_brake(course, new, SAME)
    i = new.segment
    if new.v > min(limits[1, i], entry[i + 1]) * (1.0 + SAME) or i + 1 >= limits.shape[1]:
        return -1
    if limits[0, i + 1] == 0.0:
        return -1
    return find_brake(course, State(i + 1, 0.0, new.v, new.a), SAME)


@kernel
def _longest_phase(
    course: PathAhead, state: State, j: float, latest: float, border: int
) -> tuple[float, bool, int]:
    """How long jerk j may last, at most ``latest`` or to the segment's end.

    Args:
        latest: [s]
        border: To which the state can brake.

    Returns:
        Time [s], whether it ends at the segment's end, border to which the state can brake then.
    """
    i, x, v, a = state
    rest = course.limits[0, i] - x
    at_border = ((j / 6.0 * latest + 0.5 * a) * latest + v) * latest >= rest
    if at_border:
        latest = time_to(rest, v, a, j, latest)
    found = _brake_after(course, state, j, latest, at_border)
    if found >= 0:
        return latest, at_border, found
    low, brief = 0.0, BRIEF * latest
    step = brief
    best, to, least = 0.0, border, math.inf
    for _ in range(MAX_BRAKES):
        if step == brief:
            low = _latest_brake(course, state, j, border, low, latest)
            cost = _time_to_border(course, state, j, low, border)
            between = _time_between(course, to, border)
            if cost == math.inf or cost <= least + LATER * between:
                best, to, least = low, border, cost
        # Another brake may be possible for longer.
        t = low + step
        if t >= latest:
            break
        found = _brake_after(course, state, j, t, False)
        if found < 0:
            break
        step = STRIDE * step if found == border else brief
        low, border = t, found
    return best, False, to


@kernel
def next_phase(course: PathAhead, state: State, border: int) -> tuple[float, float, bool, int]:
    """Jerk up, or else hold, for as long as there is a brake.

    Args:
        border: To which the state can brake.

    Returns:
        Jerk, how long it lasts [s], whether it ends at the segment's end, border to which the state
        can brake then; a time of 0 where nothing is left but to brake.
    """
    i, x, v, a = state
    limits = course.limits
    rest = limits[0, i] - x
    highest_v, highest_a, jerk = limits[1, i], limits[2, i], limits[4, i]
    j, duration, latest, at_border, then = 0.0, 0.0, 0.0, False, border
    gap = highest_v - (v + a * a / (2.0 * jerk))
    if a < highest_a * (1.0 - ROUNDING) and gap > ROUNDING * highest_v:
        j = jerk
        latest = (highest_a - a) / jerk
        duration, at_border, then = _longest_phase(course, state, j, latest, border)
    holds = a == 0.0 or gap > ROUNDING * highest_v
    # With a huge jerk even the whole of a phase may be shorter than any that counts.
    short = duration < SHORTEST_PHASE and not 0.0 < latest <= duration
    if holds and short and v > 0.0:
        j = 0.0
        latest = 2.0 * rest / v
        duration, at_border, then = _longest_phase(course, state, j, latest, border)
        if a > 0.0 and duration < SHORTEST_HOLD and not at_border:
            duration = 0.0
    whole = at_border or duration >= latest or v <= 0.0
    if duration < SHORTEST_PHASE and not whole:
        duration = 0.0
    return j, duration, at_border, then


@kernel
def ease_off(limits: FloatArray, state: State, jerk: float) -> tuple[float, bool, State]:
    """Down to a = 0, or to the next border: there may be something better to do then.

    Args:
        limits: Of a ``PathAhead``.
        state: Its acceleration is above 0.
        jerk: Of the brake that begins.

    Returns:
        Time [s], whether it ends at the border, and the state then.
    """
    i, x, v, a = state
    highest_v, rest = limits[1, i], limits[0, i] - x
    duration = a / jerk
    length = (v + a * duration / 3.0) * duration
    at_border = length >= rest
    if at_border:
        duration = time_to(rest, v, a, -jerk, duration)
    v += (a - 0.5 * jerk * duration) * duration
    if at_border:
        return duration, True, State(i + 1, 0.0, v, a - jerk * duration)
    if v <= highest_v * (1.0 + ROUNDING):
        # Above the limit by rounding alone, it would never be held.
        v = min(v, highest_v)
    return duration, False, State(i, x + length, v, 0.0)


@kernel
def _latest_brake(
    course: PathAhead, state: State, j: float, k: int, low: float, high: float
) -> float:
    """How long jerk j may last, from ``low`` to ``high``, for the brake to border k to be possible.

    Args:
        low: The shortest time; it is the answer where the brake is not possible even then [s].
        high: The longest time [s].
    """
    precision = TIME_PRECISION * high
    deceleration, jerk, _ = brake_limits(course.limits, state.segment, k)
    brake = Brake(k, course.controllable[k], deceleration, jerk)
    at_low, at_high = math.inf, -math.inf
    side, t = 0, high
    for step in range(MAX_STEPS):
        margin = brake_margin(course, after_jerk(state, j, t), brake, 1.0)
        low, high, at_low, at_high, side = narrowed(low, high, at_low, at_high, side, t, margin)
        if high - low <= precision:
            break
        if step == 0:
            t = low
        elif step < MAX_CHORDS:
            t = crossing(low, high, at_low, at_high)
            t = min(max(t, low + 0.25 * precision), high - 0.25 * precision)
        else:
            t = 0.5 * (low + high)
    return low


@kernel
def _time_to_border(course: PathAhead, state: State, j: float, t: float, k: int) -> float:
    """Time to border k with jerk j for t and then the brake; the rest of the distance is crept."""
    limits = course.limits
    deceleration, jerk, behind = brake_limits(limits, state.segment, k)
    i, x, v, a = after_jerk(state, j, t)
    distance = limits[0, i] - x + behind
    top, w = v + 0.5 * a * a / jerk, course.controllable[k]
    if top <= w:
        return math.inf
    spare = distance - brake_distance_from(v, a, w, deceleration, jerk)
    time = t + a / jerk + brake_time(top, w, deceleration, jerk)
    return time + max(0.0, spare) / max(w, SLOWEST)


@kernel
def _time_between(course: PathAhead, k: int, other: int) -> float:
    """About how long it takes from border k to another, negative if that lies before it."""
    time = 0.0
    for segment in range(min(k, other), max(k, other)):
        mean = 0.5 * (course.controllable[segment] + course.controllable[segment + 1])
        time += course.limits[0, segment] / max(mean, SLOWEST)
    return time if other >= k else -time
