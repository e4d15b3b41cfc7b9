"""How much margin a brake has: before the border where it is to end, and below the limits on the way.

The velocity along a brake rises to its peak (while a > 0 falls to zero) and then only falls, so a
limit of the velocity at a place is kept if the brake comes down to it before that place. Where it
does has a closed form, which the velocity at a place has not.
"""

import math

from twin.compilation.kernel import kernel
from twin.motion.profile.state import Brake, PathAhead, State

MAX_CHORDS = 16
"""Steps along chords, which are usually enough; the interval is halved from then on."""

MAX_STEPS = 64
"""In all: halving comes down to the rounding of a double by then."""


@kernel
def brake_margin(course: PathAhead, state: State, brake: Brake, wide: float) -> float:
    """By how much of the distance the brake that is shortest of room has any to spare.

    Args:
        course: The path; its controllable velocities are not looked at.
        wide: Factor by which velocities and accelerations may pass their limits.

    Returns:
        The least distance between where the brake meets a limit and where it has to, or between its
        end and its border; negative where it comes too late, minus infinity where it never meets
        one [mm or deg].
    """
    limits, entry, _ = course
    i, x, v, a = state
    k, w, deceleration, jerk = brake
    if a <= 0.0 and v > limits[1, i] * wide:
        return -math.inf
    top = v + a * a / (2.0 * jerk)
    lift = (v + a * a / (3.0 * jerk)) * a / jerk
    drop = max(0.0, top - w)
    hardest = min(deceleration, math.sqrt(drop * jerk))
    swing = hardest * hardest / (2.0 * jerk)
    # Velocities and places where the acceleration has become ``-hardest`` and where it leaves it.
    begin_v, end_v = top - swing, top - drop + swing
    begin_x = lift + (top - swing / 3.0) * hardest / jerk
    end_x = begin_x
    if hardest > 0.0:
        end_x += (begin_v - end_v) * (begin_v + end_v) / (2.0 * hardest)
    low = min(top, w)
    total = end_x + (low + swing / 3.0) * hardest / jerk

    room = math.inf
    here = 0.0
    ahead = limits[0, i] - x
    for segment in range(i, k):
        highest = limits[1, segment] * wide
        rising = a > 0.0 and here < lift
        if segment > i:
            passed = min(highest, entry[segment] * wide)
            if rising:
                if passed < top:
                    room = min(room, _distance_up(passed, top, lift, jerk) - here)
                softest = limits[2, segment] * wide
                if softest < a:
                    softened = top - softest * softest / (2.0 * jerk)
                    room = min(room, here - _distance_up(softened, top, lift, jerk))
            elif passed < low:
                return -math.inf
            elif passed < top:
                if passed >= begin_v:
                    down = top - passed
                    met = lift + (top - down / 3.0) * math.sqrt(2.0 * down / jerk)
                elif passed >= end_v:
                    met = begin_x + (begin_v - passed) * (begin_v + passed) / (2.0 * hardest)
                else:
                    left = passed - low
                    met = total - (low + left / 3.0) * math.sqrt(2.0 * left / jerk)
                room = min(room, here - met)
        if rising and highest < top:
            room = min(room, _distance_up(highest, top, lift, jerk) - min(ahead, lift))
        here = ahead
        if segment + 1 < k:
            ahead += limits[0, segment + 1]
    return min(room, here - total)


@kernel
def _distance_up(velocity: float, top: float, lift: float, jerk: float) -> float:
    """Where a velocity is reached before the peak."""
    below = top - velocity
    return lift - (top - below / 3.0) * math.sqrt(2.0 * below / jerk)


@kernel
def crossing(low: float, high: float, at_low: float, at_high: float) -> float:
    """Where the straight line between two points changes sign, or their middle if it does not."""
    if not (at_low >= 0.0 > at_high > -math.inf) or at_low == math.inf:
        return 0.5 * (low + high)
    return low + (high - low) * (at_low / (at_low - at_high))


@kernel
def _damped(kept: float, replaced: float, new: float) -> float:
    """The value of the end of an interval that was kept twice running (Anderson and Björck 1973).

    Args:
        replaced: Value at the other end before.
        new: Value there now, of the same sign.
    """
    share = 1.0 - new / replaced if replaced != 0.0 else 0.0
    return kept * (share if share > 0.0 else 0.5)


@kernel
def narrowed(
    low: float, high: float, at_low: float, at_high: float, side: int, new: float, room: float
) -> tuple[float, float, float, float, int]:
    """An interval of which the lower end has room, made smaller by one more value.

    Args:
        high: Its upper end.
        at_low: Room at the lower end, as the last step has left it.
        at_high: Room at the upper end, as the last step has left it.
        side: Which end was replaced last: 1 the lower one, -1 the upper one, 0 none.
        new: A place within it.

    Returns:
        The first five again.
    """
    if room >= 0.0:
        return new, high, room, _damped(at_high, at_low, room) if side > 0 else at_high, 1
    return low, new, _damped(at_low, at_high, room) if side < 0 else at_low, room, -1
