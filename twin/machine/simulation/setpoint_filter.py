"""Setpoints behind a lag of first order: the filter of a command, and half of a dead time.

A lag y of a signal p follows it as y' = (p - y)/T. What it is behind, e = p - y, obeys e' = p' - e/T, so
that over a step h

    e1 = exp(-h/T) e0 + ∫ exp(-(h - t)/T) p'(t) dt.

Between samples the velocity is the cubic through the velocities and accelerations at both ends, which
leaves a fraction (W h)⁴/720 of a sine's trail.
"""

import numpy as np

from twin.compilation.kernel import array_kernel
from twin.machine.simulation.drive_kernels import DriveSetpoints
from twin.nc.canonical import FloatArray


@array_kernel
def trail_behind(start, keeps, weights, velocity, acceleration):
    """How far lags of first order are behind what they follow, row by row.

    Args:
        start: At the first row, shape (k,).
        keeps: Share of the trail that is left after a step, shape (k,).
        weights: Of the velocities and accelerations at both ends of a step, shape (k, 4).
        velocity: Of what is followed, shape (n, k).
        acceleration: Likewise, shape (n, k).

    Returns:
        Shape (n, k).
    """
    trail = velocity.copy()
    trail[0] = start
    for i in range(1, len(velocity)):
        for a in range(len(start)):
            trail[i, a] = (
                keeps[a] * trail[i - 1, a]
                + weights[a, 0] * velocity[i - 1, a]
                + weights[a, 1] * velocity[i, a]
                + weights[a, 2] * acceleration[i - 1, a]
                + weights[a, 3] * acceleration[i, a]
            )
    return trail


@array_kernel
def relax(start, keep, goal):
    """States that tend to goals which stand still over each step.

    Args:
        start: Before the first row, shape (m,).
        keep: Share of the distance that is left after a step, shape (m,).
        goal: Where they tend to during the step to each row, shape (n, m).

    Returns:
        Shape (n, m).
    """
    states = goal.copy()
    for i in range(len(goal)):
        for j in range(len(start)):
            before = start[j] if i == 0 else states[i - 1, j]
            states[i, j] = goal[i, j] + keep[j] * (before - goal[i, j])
    return states


_SPENT = 40.0
"""Time constants after which nothing is left of a lag, in double precision."""
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(24)


class SetpointFilter:
    """Lags of first order in front of k axes, carried from chunk to chunk.

    Attributes:
        trail: How far each axis's lag is behind at the last row, shape (k,) [mm or deg].
    """

    def __init__(self, time_constants: FloatArray, period_s: float) -> None:
        """Begin at rest.

        Args:
            time_constants: Shape (k,) [s]; 0: the axis's setpoints pass as they are.
            period_s: Between setpoints [s].
        """
        self._lags = time_constants > 0.0
        self._time = time_constants[self._lags]
        self._keeps = np.exp(-period_s / self._time)
        self._weights = np.array([_step_weights(time, period_s) for time in self._time])
        self.trail: FloatArray = np.zeros(len(time_constants))
        self._trails = np.zeros((1, len(self._time)))

    def __bool__(self) -> bool:
        """Whether any axis has a lag."""
        return len(self._time) > 0

    def follow(self, points: DriveSetpoints) -> DriveSetpoints:
        """Setpoints behind the lags.

        Args:
            points: The last row of the chunk before, and what follows; the first of all stands.
        """
        if not self:
            return points
        position, velocity, acceleration = (column[:, self._lags] for column in points)
        self._trails = trail_behind(
            self.trail[self._lags], self._keeps, self._weights, velocity, acceleration
        )
        self.go_to(-1)
        rate = self._trails / self._time
        behind = (position - self._trails, rate, (velocity - rate) / self._time)
        filtered = DriveSetpoints(*(column.copy() for column in points))
        for column, values in zip(filtered, behind, strict=True):
            column[:, self._lags] = values
        return filtered

    def go_to(self, row: int) -> None:
        """Stand at a row of what was followed last."""
        if self:
            self.trail[self._lags] = self._trails[row]

    def stand(self, trail: FloatArray) -> None:
        """Set how far the lags are behind the setpoint, shape (k,) [mm or deg]; 0 for an axis without one."""
        self.trail[self._lags] = trail[self._lags]


def _step_weights(time_constant: float, period_s: float) -> list[float]:
    """What the velocities and accelerations at both ends of a step add to the trail, (4,)."""
    span = min(period_s, _SPENT * time_constant)
    before_end = span * (1.0 - _NODES) / 2.0
    left = _WEIGHTS * span / 2.0 * np.exp(-before_end / time_constant)
    part = 1.0 - before_end / period_s
    rest = 1.0 - part
    parts = (
        (1.0 + 2.0 * part) * rest**2,
        (3.0 - 2.0 * part) * part**2,
        part * rest**2 * period_s,
        -(part**2) * rest * period_s,
    )
    return [float(left @ share) for share in parts]
