"""Changes of velocity under limits of acceleration and jerk, a = 0 at both ends."""

import math
from typing import NamedTuple

from twin.compilation.kernel import kernel

HALVINGS = 40
"""Of an interval in which a peak velocity is looked for."""


class RampLimits(NamedTuple):
    """What a ramp must keep.

    Attributes:
        jerk: Highest abs(j).
    """

    velocity: float
    acceleration: float
    deceleration: float
    jerk: float


@kernel
def brake_distance(v: float, w: float, deceleration: float, jerk: float) -> float:
    """Shortest distance from v to w <= v, a = 0 at both ends [mm or deg]."""
    drop = v - w
    if drop * jerk <= deceleration * deceleration:
        duration = 2.0 * math.sqrt(drop / jerk)
    else:
        duration = drop / deceleration + deceleration / jerk
    return 0.5 * (v + w) * duration


@kernel
def brake_time(v: float, w: float, deceleration: float, jerk: float) -> float:
    """Time of ``brake_distance`` [s]."""
    drop = v - w
    if drop * jerk <= deceleration * deceleration:
        return 2.0 * math.sqrt(drop / jerk)
    return drop / deceleration + deceleration / jerk


@kernel
def travel_time(distance: float, u: float, w: float, limits: RampLimits) -> float:
    """Shortest time over a distance, from velocity u to w; infinite where it is too short [s].

    Args:
        distance: [mm or deg]
        limits: The velocity is not below u and w.
    """
    velocity, acceleration, deceleration, jerk = limits
    ramps = brake_distance(velocity, u, acceleration, jerk)
    ramps += brake_distance(velocity, w, deceleration, jerk)
    peak = velocity
    if ramps > distance:
        low, high = max(u, w), velocity
        for _ in range(HALVINGS):
            peak = 0.5 * (low + high)
            ramps = brake_distance(peak, u, acceleration, jerk)
            ramps += brake_distance(peak, w, deceleration, jerk)
            if ramps > distance:
                high = peak
            else:
                low = peak
        peak = low
        ramps = brake_distance(peak, u, acceleration, jerk)
        ramps += brake_distance(peak, w, deceleration, jerk)
        if ramps > distance * (1.0 + 1e-9) or peak <= 0.0:
            return math.inf
    time = brake_time(peak, u, acceleration, jerk) + brake_time(peak, w, deceleration, jerk)
    return time + max(0.0, distance - ramps) / peak
