"""Velocity profiles along pieces: phases of constant jerk, as fast as the limits allow.

The state on the path is (piece, x within it, v, a). It is *safe* if from it one can brake to a
later border of pieces, arriving there with a = 0 and no faster than that border's ``reach``, within
all limits on the way. ``reach`` is the highest velocity that is itself safe at the border with
a = 0, so that a safe state has a safe way to the end of the window, where v = 0.

``reach`` is found backwards from the end. Forwards, each phase lasts as long as its end is safe:
first the jerk is positive, then zero; when neither is safe any more, the brake that made the state
safe is carried out. For one move this gives the well-known seven phases of minimum time.
"""

import math

import numba
import numpy as np

from twin.nc.canonical import FloatArray, IntArray

BISECTIONS = 52
"""Halvings of an interval: down to the rounding of a double."""

SHORTEST_PHASE = 1e-10
"""Phases below this are rounding [s]."""

ROUNDING = 1e-9
"""Relative slack for comparisons of quantities that are equal but for rounding."""

REACH_PRECISION = 1e-9
"""Of velocities at borders, relative: far finer than any loss of time."""

SLOWEST = 1e-6
"""A border that must be passed more slowly than this is passed from a stop [mm/s or deg/s]."""

MOST_PHASES = 4096
"""Of one piece; more would mean that rounding keeps the path from going on."""

SHORTEST_HOLD = 1e-7
"""Of an acceleration that is held: shorter ones only creep up to a limit [s]."""

FAILED_BRAKES = 4
"""Brakes that fit their distance but break a limit on the way before the search gives up."""


@numba.njit(cache=True)
def time_to(distance: float, v: float, a: float, j: float, latest: float) -> float:
    """When x = v t + a t²/2 + j t³/6 reaches ``distance``, within [0, latest], x rising [s]."""
    low, high = 0.0, latest
    t = latest
    if v > 0.0:
        t = min(latest, distance / v)
    for _ in range(100):
        miss = ((j / 6.0 * t + 0.5 * a) * t + v) * t - distance
        if miss > 0.0:
            high = t
        else:
            low = t
        slope = (0.5 * j * t + a) * t + v
        new = t - miss / slope if slope > 0.0 else 0.5 * (low + high)
        if not low < new < high:
            new = 0.5 * (low + high)
        if abs(new - t) <= 1e-16 * latest:
            return new
        t = new
    return t


@numba.njit(cache=True)
def brake_distance(v: float, w: float, deceleration: float, jerk: float) -> float:
    """Shortest way from v to w <= v, a = 0 at both ends [mm or deg]."""
    drop = v - w
    if drop * jerk <= deceleration * deceleration:
        duration = 2.0 * math.sqrt(drop / jerk)
    else:
        duration = drop / deceleration + deceleration / jerk
    return 0.5 * (v + w) * duration


@numba.njit(cache=True)
def brake_state(
    x: float, v: float, a: float, w: float, deceleration: float, jerk: float
) -> tuple[float, float]:
    """Velocity and acceleration after x on the brake from (v, a >= 0) to (w, 0)."""
    top = v + a * a / (2.0 * jerk)
    drop = top - w
    hardest = min(deceleration, math.sqrt(drop * jerk)) if drop > 0.0 else 0.0
    duration = (a + hardest) / jerk
    length = ((-jerk / 6.0 * duration + 0.5 * a) * duration + v) * duration
    if x < length:
        t = time_to(x, v, a, -jerk, duration)
        return v + (a - 0.5 * jerk * t) * t, a - jerk * t
    x -= length
    v += (a - 0.5 * jerk * duration) * duration
    ease = hardest / jerk
    low = w + 0.5 * hardest * ease
    if hardest > 0.0:
        duration = max(0.0, (v - low) / hardest)
        length = (v - 0.5 * hardest * duration) * duration
        if x < length:
            v = math.sqrt(max(0.0, v * v - 2.0 * hardest * x))
            return v, -hardest
        x -= length
        length = ((jerk / 6.0 * ease - 0.5 * hardest) * ease + low) * ease
        if x < length:
            t = time_to(x, low, -hardest, jerk, ease)
            return low + (-hardest + 0.5 * jerk * t) * t, -hardest + jerk * t
    return min(w, top), 0.0


@numba.njit(cache=True)
def _holds_on_the_way(
    limits: FloatArray, entry: FloatArray, i: int, x: float, v: float, a: float,
    k: int, w: float, deceleration: float, jerk: float, wide: float,
) -> bool:  # fmt: skip
    """Whether the brake to border k keeps the velocities and accelerations of pieces i to k - 1."""
    top = v + a * a / (2.0 * jerk)
    distance = limits[0, i] - x
    now_v, now_a = brake_state(distance, v, a, w, deceleration, jerk)
    highest = now_v if now_a > 0.0 else top
    if highest > limits[1, i] * wide:
        return False
    for border in range(i + 1, k):
        if now_v > min(entry[border], limits[1, border]) * wide:
            return False
        if now_a > limits[2, border] * wide:
            return False
        was_a = now_a
        distance += limits[0, border]
        now_v, now_a = brake_state(distance, v, a, w, deceleration, jerk)
        if was_a > 0.0 and (now_v if now_a > 0.0 else top) > limits[1, border] * wide:
            return False
    return True


@numba.njit(cache=True)
def find_brake(
    limits: FloatArray, entry: FloatArray, reach: FloatArray,
    i: int, x: float, v: float, a: float, slack: float, nearest: int,
) -> int:  # fmt: skip
    """The border to which a safe state can brake; -1 if the state is not safe.

    Args:
        limits: Rows length, velocity, acceleration, deceleration, jerk of n pieces, shape (5, n).
        entry: Highest v at each border, shape (n + 1,).
        reach: As above; entries up to i are not looked at, shape (n + 1,).
        i: Piece of the state.
        x: Place within it.
        v: Velocity.
        a: Acceleration, not negative.
        slack: Relative slack of all comparisons.
        nearest: Borders before this one are not tried.
    """
    count = limits.shape[1]
    wide = 1.0 + slack
    if v > limits[1, i] * wide or a > limits[2, i] * wide:
        return -1
    deceleration, jerk = limits[3, i], limits[4, i]
    ceiling = limits[1, i]
    softest = math.inf
    distance = limits[0, i] - x
    own_distance = distance
    nearer = 0.0
    failed = 0
    lowest = math.inf
    for k in range(i + 1, count + 1):
        if k > i + 1:
            piece = k - 1
            if limits[0, piece] == 0.0:
                return -1
            nearer = distance
            distance += limits[0, piece]
            deceleration = min(deceleration, limits[3, piece])
            jerk = min(jerk, limits[4, piece])
            ceiling = min(ceiling, limits[1, piece], entry[piece])
            softest = min(softest, limits[2, piece])
        if k < nearest:
            continue
        w = reach[k]
        lift_time = a / jerk
        lift = (v + a * lift_time / 3.0) * lift_time
        top = v + 0.5 * a * lift_time
        need = lift
        if top > w:
            need += brake_distance(top, w, deceleration, jerk)
            if need * wide < nearer:
                # It would end before the last border but one, lower than that border asks for.
                continue
        if need <= distance * wide + slack * 1e-3 and w < lowest:
            if top <= ceiling * wide and (lift <= own_distance or a <= softest):
                return k
            if _holds_on_the_way(limits, entry, i, x, v, a, k, w, deceleration, jerk, wide):
                return k
            lowest = w
            failed += 1
            if failed >= FAILED_BRAKES:
                return -1
        if entry[k] < SLOWEST:
            return -1
    return -1


@numba.njit(cache=True)
def find_reach(limits: FloatArray, entry: FloatArray, known: FloatArray) -> FloatArray:
    """The highest safe velocity at every border, a = 0.

    Args:
        limits: As in ``find_brake``.
        entry: As in ``find_brake``; the last must be 0.
        known: Velocities that are known to be safe from a shorter window, shape (m <= n + 1,).
    """
    count = limits.shape[1]
    reach = np.zeros(count + 1)
    nearest = 0
    for i in range(count - 1, -1, -1):
        if entry[i] < SLOWEST or limits[0, i] == 0.0:
            nearest = 0
            continue
        highest = min(entry[i], limits[1, i])
        if i > 0:
            highest = min(highest, limits[1, i - 1])
        if find_brake(limits, entry, reach, i, 0.0, highest, 0.0, 0.0, 0) >= 0:
            reach[i] = highest
            nearest = 0
            continue
        # The border after this one says where to look: a little above what is safe there.
        low, step = 0.0, highest
        if i < len(known):
            low = known[i]
        if i + 2 <= count and reach[i + 1] > 0.0:
            step = max(abs(reach[i + 1] - reach[i + 2]), 1e-6 * highest)
            guess = min(reach[i + 1], highest)
            found = find_brake(limits, entry, reach, i, 0.0, guess, 0.0, 0.0, nearest - 3)
            if guess > low and found >= 0:
                low = guess
        high = min(highest, low + step)
        while high < highest:
            if find_brake(limits, entry, reach, i, 0.0, high, 0.0, 0.0, nearest - 3) < 0:
                break
            low = high
            step *= 4.0
            high = min(highest, low + step)
        for _ in range(BISECTIONS):
            if high - low <= REACH_PRECISION * high:
                break
            middle = 0.5 * (low + high)
            found = find_brake(limits, entry, reach, i, 0.0, middle, 0.0, 0.0, nearest - 3)
            if found >= 0:
                low, nearest = middle, found
            else:
                high = middle
        reach[i] = low if low >= SLOWEST else 0.0
    return reach


@numba.njit(cache=True)
def _can_last(
    limits: FloatArray, entry: FloatArray, reach: FloatArray,
    i: int, x: float, v: float, a: float, j: float, t: float, to_border: bool,
) -> bool:  # fmt: skip
    """Whether the state after t of jerk j is safe; ``to_border``: t ends at the piece's end."""
    new_x = x + ((j / 6.0 * t + 0.5 * a) * t + v) * t
    new_v = v + (0.5 * j * t + a) * t
    new_a = a + j * t
    if not to_border:
        return find_brake(limits, entry, reach, i, new_x, new_v, new_a, 0.0, 0) >= 0
    if new_v > min(limits[1, i], entry[i + 1]) or i + 1 >= limits.shape[1]:
        return False
    if limits[0, i + 1] == 0.0:
        return False
    return find_brake(limits, entry, reach, i + 1, 0.0, new_v, new_a, 0.0, 0) >= 0


@numba.njit(cache=True)
def _longest(
    limits: FloatArray, entry: FloatArray, reach: FloatArray,
    i: int, x: float, v: float, a: float, j: float, latest: float,
) -> tuple[float, bool]:  # fmt: skip
    """How long jerk j may last, at most ``latest`` or to the piece's end; whether it gets there."""
    rest = limits[0, i] - x
    if ((j / 6.0 * latest + 0.5 * a) * latest + v) * latest >= rest:
        latest = time_to(rest, v, a, j, latest)
        if _can_last(limits, entry, reach, i, x, v, a, j, latest, True):
            return latest, True
    elif _can_last(limits, entry, reach, i, x, v, a, j, latest, False):
        return latest, False
    low, high = 0.0, latest
    for _ in range(BISECTIONS):
        middle = 0.5 * (low + high)
        if _can_last(limits, entry, reach, i, x, v, a, j, middle, False):
            low = middle
        else:
            high = middle
    return low, False


@numba.njit(cache=True)
def brake_time(v: float, w: float, deceleration: float, jerk: float) -> float:
    """Time of ``brake_distance`` [s]."""
    drop = v - w
    if drop * jerk <= deceleration * deceleration:
        return 2.0 * math.sqrt(drop / jerk)
    return drop / deceleration + deceleration / jerk


@numba.njit(cache=True)
def _need(v: float, a: float, w: float, deceleration: float, jerk: float) -> float:
    """Way from (v, a >= 0) to the first a = 0 at which the velocity is w or less."""
    lift_time = a / jerk
    top = v + 0.5 * a * lift_time
    lift = (v + a * lift_time / 3.0) * lift_time
    return lift + brake_distance(top, w, deceleration, jerk) if top > w else lift


@numba.njit(cache=True)
def _better_to_brake(
    limits: FloatArray, entry: FloatArray, reach: FloatArray,
    i: int, x: float, v: float, a: float, j: float, latest: float,
) -> float:  # fmt: skip
    """Whether to end a phase early so as to brake to the next border, rather than later and longer.

    The latest brake may be a long one across pieces that brake badly. Going to the next border at
    its ``reach`` first may then be faster; the two are compared by their times to the border where
    the long brake ends.

    Returns:
        When to end the phase, or ``latest`` [s].
    """
    count = limits.shape[1]
    deceleration, jerk = limits[3, i], limits[4, i]
    w = reach[i + 1]
    rest = limits[0, i] - x
    if i + 2 > count or w <= 0.0 or v <= 0.0 or _need(v, a, w, deceleration, jerk) > rest:
        return latest
    low, high = 0.0, latest
    for step in range(BISECTIONS):
        t = latest if step == 0 else 0.5 * (low + high)
        gone = ((j / 6.0 * t + 0.5 * a) * t + v) * t
        new_v, new_a = v + (0.5 * j * t + a) * t, a + j * t
        if gone + _need(new_v, new_a, w, deceleration, jerk) <= rest:
            low = t
            if step == 0:
                return latest
        else:
            high = t
    t = latest
    x_then = x + ((j / 6.0 * t + 0.5 * a) * t + v) * t
    v_then, a_then = v + (0.5 * j * t + a) * t, a + j * t
    k = find_brake(limits, entry, reach, i, x_then, v_then, a_then, ROUNDING, i + 2)
    if k < i + 2:
        return latest
    t = low
    x += ((j / 6.0 * t + 0.5 * a) * t + v) * t
    v, a = v + (0.5 * j * t + a) * t, a + j * t
    top = v + 0.5 * a * a / jerk
    if top <= w:
        return latest
    early = a / jerk + brake_time(top, w, deceleration, jerk)
    between, soft, smooth = 0.0, math.inf, math.inf
    for piece in range(i + 1, k):
        between += limits[0, piece]
        soft = min(soft, limits[3, piece])
        smooth = min(smooth, limits[4, piece])
    spare = between
    if w > reach[k]:
        spare -= brake_distance(w, reach[k], soft, smooth)
        early += brake_time(w, reach[k], soft, smooth)
    if spare < 0.0:
        return latest
    early += spare / w
    soft, smooth = min(soft, deceleration), min(smooth, jerk)
    top = v + 0.5 * a * a / smooth
    late = a / smooth + (brake_time(top, reach[k], soft, smooth) if top > reach[k] else 0.0)
    late += max(0.0, limits[0, i] - x + between - _need(v, a, reach[k], soft, smooth)) / top
    return low if early < late * (1.0 - ROUNDING) else latest


@numba.njit(cache=True)
def _put(
    phases: FloatArray, pieces: IntArray, row: int,
    first: int, last: int, begin: float, duration: float, x: float, v: float, a: float, j: float,
) -> None:  # fmt: skip
    pieces[row, 0] = first
    pieces[row, 1] = last
    phases[row, 0] = begin
    phases[row, 1] = duration
    phases[row, 2] = x
    phases[row, 3] = v
    phases[row, 4] = a
    phases[row, 5] = j


@numba.njit(cache=True)
def find_phases(
    limits: FloatArray, entry: FloatArray, reach: FloatArray, pause: FloatArray,
    stop: int, state: FloatArray,
) -> tuple[FloatArray, IntArray]:  # fmt: skip
    """Drive from ``state`` until the piece ``stop`` is reached, between two brakes at the latest.

    Args:
        limits: As in ``find_brake``.
        entry: As in ``find_brake``.
        reach: From ``find_reach``.
        pause: How long each piece waits, shape (n,) [s].
        stop: Piece at which to end.
        state: Piece, x, v, a, time; overwritten by the state at the end, shape (5,).

    Returns:
        Rows begin [s], duration [s], x, v, a, j, and the first and last piece of each phase.
    """
    count = limits.shape[1]
    phases = np.zeros((256, 6))
    pieces = np.zeros((256, 2), np.int64)
    used = 0
    i, x, v, a, now = int(state[0]), state[1], state[2], state[3], state[4]
    phases_here = 0
    brake_in, compared_in = -1, -1
    last_i = i
    while i < stop and i < count:
        phases_here = phases_here + 1 if i == last_i else 0
        last_i = i
        if phases_here > MOST_PHASES:
            raise RuntimeError("motion: the path does not go on")
        if used + 8 > len(pieces):
            phases = np.concatenate((phases, np.zeros_like(phases)))
            pieces = np.concatenate((pieces, np.zeros_like(pieces)))
        if limits[0, i] == 0.0:
            _put(phases, pieces, used, i, i, now, pause[i], 0.0, 0.0, 0.0, 0.0)
            used += 1
            now += pause[i]
            i += 1
            continue

        if v < SLOWEST and limits[0, i] - x <= ROUNDING * limits[0, i]:
            # All but arrived; what is left is too little to speed up for.
            i, x, v, a = i + 1, 0.0, min(v, reach[i + 1]), 0.0
            continue

        highest_v, highest_a, jerk = limits[1, i], limits[2, i], limits[4, i]
        j, duration, latest, at_border = 0.0, 0.0, 0.0, False
        gap = highest_v - (v + a * a / (2.0 * jerk))
        extend = brake_in != i or v <= 0.0
        if extend and a < highest_a * (1.0 - ROUNDING) and gap > ROUNDING * highest_v:
            j = jerk
            latest = (highest_a - a) / jerk
            duration, at_border = _longest(limits, entry, reach, i, x, v, a, j, latest)
        holds = a == 0.0 or gap > ROUNDING * highest_v
        if extend and holds and duration < SHORTEST_PHASE and v > 0.0:
            j = 0.0
            latest = 2.0 * (limits[0, i] - x) / v
            duration, at_border = _longest(limits, entry, reach, i, x, v, a, j, latest)
            if a > 0.0 and duration < SHORTEST_HOLD and not at_border:
                duration = 0.0
        if SHORTEST_PHASE <= duration < latest and not at_border and compared_in != i:
            sooner = _better_to_brake(limits, entry, reach, i, x, v, a, j, duration)
            if sooner < duration:
                duration, brake_in = sooner, i
                # Once per piece: what rounding leaves over must not be weighed again.
                compared_in = i
        if duration > 0.0 and (duration >= SHORTEST_PHASE or at_border):
            _put(phases, pieces, used, i, i, now, duration, x, v, a, j)
            used += 1
            now += duration
            x += ((j / 6.0 * duration + 0.5 * a) * duration + v) * duration
            v += (0.5 * j * duration + a) * duration
            a += j * duration
            if at_border:
                i, x = i + 1, 0.0
            continue

        k = find_brake(limits, entry, reach, i, x, v, a, ROUNDING, 0)
        if k < 0:
            raise RuntimeError("motion: no way to brake from a state that was safe")
        deceleration = limits[3, i]
        distance = limits[0, i] - x
        for piece in range(i + 1, k):
            deceleration = min(deceleration, limits[3, piece])
            jerk = min(jerk, limits[4, piece])
            distance += limits[0, piece]
        if a > 0.0:
            # Only down to a = 0, or to the next piece: there may be something better to do then.
            duration = a / jerk
            rest = limits[0, i] - x
            length = (v + a * duration / 3.0) * duration
            at_border = length >= rest
            if at_border:
                duration = time_to(rest, v, a, -jerk, duration)
            _put(phases, pieces, used, i, i, now, duration, x, v, a, -jerk)
            used += 1
            now += duration
            v += (a - 0.5 * jerk * duration) * duration
            a -= jerk * duration
            if at_border:
                i, x, a = i + 1, 0.0, max(0.0, a)
            else:
                x, a = x + length, 0.0
            continue

        w = reach[k]
        if v <= w and brake_in == i:
            brake_in = -1
            continue
        if v <= w:
            # Only rounding has kept the state from going on as it is.
            duration = (limits[0, i] - x) / v
            _put(phases, pieces, used, i, i, now, duration, x, v, 0.0, 0.0)
            used += 1
            now += duration
            i, x, v = i + 1, 0.0, min(v, entry[i + 1])
            continue
        spare = distance - brake_distance(v, w, deceleration, jerk)
        to_border = spare <= ROUNDING * distance
        hardest = min(deceleration, math.sqrt((v - w) * jerk))
        ramp = hardest / jerk
        hold = max(0.0, (v - w) / hardest - ramp)
        for step in range(4):
            duration, j = ramp, -jerk
            if step == 0:
                duration, j = (max(0.0, spare) / v if to_border else 0.0), 0.0
            elif step == 2:
                duration, j = hold, 0.0
            elif step == 3:
                j = jerk
            if duration > 0.0:
                _put(phases, pieces, used, i, k - 1, now, duration, x, v, a, j)
                used += 1
                now += duration
                x += ((j / 6.0 * duration + 0.5 * a) * duration + v) * duration
                v += (0.5 * j * duration + a) * duration
                a += j * duration
                while x >= limits[0, i] and i < k - 1:
                    x -= limits[0, i]
                    i += 1
        v, a = w, 0.0
        brake_in = -1
        if to_border:
            i, x = k, 0.0
    state[0], state[1], state[2], state[3], state[4] = i, x, v, a, now
    return phases[:used], pieces[:used]
