"""From a plan to one under lower ceilings: the brake that leads from the one to the other."""

import math

from twin.compilation.kernel import array_kernel
from twin.motion.profile.brake_kernels import brake_need
from twin.motion.profile.reach_kernels import BISECTIONS, ROUNDING, SLOWEST, find_brake
from twin.motion.profile.way_kernels import room_for_brake
from twin.nc.canonical import FloatArray


@array_kernel
def _slowest_within(
    v: float, a: float, highest: float, deceleration: float, jerk: float, distance: float
) -> float:
    """The lowest w up to ``highest`` whose brake takes no more than ``distance``."""
    if brake_need(v, a, 0.0, deceleration, jerk) <= distance:
        return 0.0
    low, high = 0.0, highest
    for _ in range(BISECTIONS):
        middle = 0.5 * (low + high)
        if brake_need(v, a, middle, deceleration, jerk) <= distance:
            high = middle
        else:
            low = middle
    return high


@array_kernel
def find_transition(
    limits: FloatArray, wanted: FloatArray, entry: FloatArray, reach: FloatArray,
    i: int, x: float, v: float, a: float,
) -> tuple[int, float, float, float, float]:  # fmt: skip
    """The brake that begins at once and ends in a state that is safe under the wanted ceilings.

    Of all pieces the nearest one in which such a brake can end is taken, and in it the highest
    velocity. The brake keeps the limits of all pieces that it passes.

    Args:
        limits: As in ``find_brake``, with the velocities that must not be passed.
        wanted: The same with the velocities that are wanted.
        entry: As in ``find_brake``.
        reach: Of ``wanted``.
        i: Piece of the state.
        x: Place within it.
        v: Velocity.
        a: Acceleration of either sign.

    Returns:
        Piece in which the brake ends, x there, velocity there, deceleration and jerk of the brake;
        a piece of -1 where there is none.
    """
    before = -x
    deceleration, jerk, softest = math.inf, math.inf, math.inf
    for p in range(i, limits.shape[1]):
        if limits[0, p] == 0.0 or (p > i and entry[p] < SLOWEST):
            break
        deceleration = min(deceleration, limits[3, p])
        jerk = min(jerk, limits[4, p])
        softest = min(softest, limits[2, p])
        after = before + limits[0, p]
        # A brake that is under way must at least be eased off.
        change = 0.5 * a * a / jerk
        highest = min(wanted[1, p], v + change if a >= 0.0 else v - change)
        if a < -deceleration * (1.0 + ROUNDING) or highest < 0.0:
            break
        if brake_need(v, a, 0.0, deceleration, jerk) < before:
            break
        if brake_need(v, a, highest, deceleration, jerk) <= after:
            low = _slowest_within(v, a, highest, deceleration, jerk, after)
            if brake_need(v, a, highest, deceleration, jerk) < before:
                highest = _slowest_within(v, a, highest, deceleration, jerk, before)
            w, slack = highest, ROUNDING * (after + 1e-3)
            for step in range(BISECTIONS):
                need = brake_need(v, a, w, deceleration, jerk)
                end = min(max(0.0, need - before), limits[0, p])
                # Between a stop and a third of the velocity the way grows with w.
                fits = need <= after
                safe = fits and find_brake(wanted, entry, reach, p, end, w, 0.0, 0.0, 0) >= 0
                if safe and -slack <= room_for_brake(
                    limits, entry, i, x, v, a, p + 1, w, deceleration, jerk, 1.0 + ROUNDING
                ):
                    low = w
                    if step == 0:
                        break
                elif step == 1:
                    # Not even the slowest.
                    low = -1.0
                    break
                else:
                    highest = w
                if step == 0:
                    w = low
                elif highest - low <= ROUNDING * highest:
                    break
                else:
                    w = 0.5 * (low + highest)
            if low >= 0.0:
                end = brake_need(v, a, low, deceleration, jerk) - before
                return p, min(max(0.0, end), limits[0, p]), low, deceleration, jerk
        before = after
    return -1, 0.0, 0.0, 0.0, 0.0
