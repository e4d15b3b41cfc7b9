"""Braking along the path: the quickest change from (v, a) to a lower velocity at a = 0.

The acceleration falls by the full jerk, stays at the full deceleration while it must, and comes
back to zero by the full jerk. A state with a < 0 is one on a brake that began earlier, at a higher
velocity: the same formulas hold, as long as the new end leaves time to bring a back to zero.
"""

from twin.compilation.kernel import kernel
from twin.motion.profile.state import State
from twin.motion.ramp_kernels import brake_distance
from twin.nc.canonical import FloatArray


@kernel
def after_jerk(state: State, j: float, t: float) -> State:
    """The state after t of jerk j; x counts on from the same segment."""
    i, x, v, a = state
    return State(i, x + ((j / 6.0 * t + 0.5 * a) * t + v) * t, v + (0.5 * j * t + a) * t, a + j * t)


@kernel
def brake_limits(limits: FloatArray, i: int, k: int) -> tuple[float, float, float]:
    """Deceleration and jerk of a brake from segment i to border k, and the distance behind i.

    Args:
        limits: Of a ``Course``.
    """
    deceleration, jerk, behind = limits[3, i], limits[4, i], 0.0
    for last in range(i + 1, k):
        deceleration = min(deceleration, limits[3, last])
        jerk = min(jerk, limits[4, last])
        behind += limits[0, last]
    return deceleration, jerk, behind


@kernel
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
        if abs(new - t) <= 1e-15 * t:
            return min(new, latest)
        t = new if low < new < high else 0.5 * (low + high)
    return t


@kernel
def brake_distance_from(v: float, a: float, w: float, deceleration: float, jerk: float) -> float:
    """Distance from (v, a) to the first a = 0 at which the velocity is w or less."""
    lift_time = a / jerk
    top = v + 0.5 * a * lift_time
    lift = (v + a * lift_time / 3.0) * lift_time
    return lift + brake_distance(top, w, deceleration, jerk) if top > w else lift
