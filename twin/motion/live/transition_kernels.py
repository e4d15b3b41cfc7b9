"""From a plan to one under lower ceilings: the brake that leads from the one to the other."""

import math

from twin.compilation.kernel import array_kernel
from twin.motion.profile.backward_pass_kernels import BISECTIONS, ROUNDING, SLOWEST, find_brake
from twin.motion.profile.brake_kernels import brake_distance_from
from twin.motion.profile.brake_margin_kernels import brake_margin
from twin.motion.profile.state import Brake, PathAhead, State
from twin.nc.canonical import FloatArray


@array_kernel
def _slowest_within(
    v: float, a: float, highest: float, deceleration: float, jerk: float, distance: float
) -> float:
    """The lowest w up to ``highest`` whose brake takes no more than ``distance``."""
    if brake_distance_from(v, a, 0.0, deceleration, jerk) <= distance:
        return 0.0
    low, high = 0.0, highest
    for _ in range(BISECTIONS):
        middle = 0.5 * (low + high)
        if brake_distance_from(v, a, middle, deceleration, jerk) <= distance:
            high = middle
        else:
            low = middle
    return high


@array_kernel
def find_transition(limits: FloatArray, wanted: PathAhead, state: State) -> tuple[Brake, float]:
    """The brake that begins at once and ends in a state that is safe under the wanted ceilings.

    Of all segments the nearest one in which such a brake can end is taken, and in it the highest
    velocity. The brake keeps the limits of all segments that it passes.

    Args:
        limits: Of a ``PathAhead``, with the velocities that must not be passed.
        wanted: The path with the velocities that are wanted.
        state: Where the brake begins; its acceleration may have either sign.

    Returns:
        The brake, which ends in the segment before its border, and x there; a border of -1 where
        there is none.
    """
    i, x, v, a = state
    if a > limits[2, i] * (1.0 + ROUNDING):
        # As in a run with a time law of its own: the jerk of a brake allows for no more than that.
        return Brake(-1, 0.0, 0.0, 0.0), 0.0
    allowed = PathAhead(limits, wanted.entry, wanted.controllable)
    before = -x
    deceleration, jerk, softest = math.inf, math.inf, math.inf
    for p in range(i, limits.shape[1]):
        if limits[0, p] == 0.0 or (p > i and wanted.entry[p] < SLOWEST):
            break
        deceleration = min(deceleration, limits[3, p])
        jerk = min(jerk, limits[4, p])
        softest = min(softest, limits[2, p])
        after = before + limits[0, p]
        # A brake that is under way must at least be eased off.
        change = 0.5 * a * a / jerk
        highest = min(wanted.limits[1, p], v + change if a >= 0.0 else v - change)
        if a < -deceleration * (1.0 + ROUNDING) or highest < 0.0:
            break
        if brake_distance_from(v, a, 0.0, deceleration, jerk) < before:
            break
        if brake_distance_from(v, a, highest, deceleration, jerk) <= after:
            low = _slowest_within(v, a, highest, deceleration, jerk, after)
            if brake_distance_from(v, a, highest, deceleration, jerk) < before:
                highest = _slowest_within(v, a, highest, deceleration, jerk, before)
            w, slack = highest, ROUNDING * (after + 1e-3)
            for step in range(BISECTIONS):
                need = brake_distance_from(v, a, w, deceleration, jerk)
                end = min(max(0.0, need - before), limits[0, p])
                # Between a stop and a third of the velocity the distance grows with w.
                fits = need <= after
                safe = fits and find_brake(wanted, State(p, end, w, 0.0), 0.0) >= 0
                if safe and -slack <= brake_margin(
                    allowed, state, Brake(p + 1, w, deceleration, jerk), 1.0 + ROUNDING
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
                end = brake_distance_from(v, a, low, deceleration, jerk) - before
                end = min(max(0.0, end), limits[0, p])
                return Brake(p + 1, low, deceleration, jerk), end
        before = after
    return Brake(-1, 0.0, 0.0, 0.0), 0.0
