"""Lags of first order; compiled."""

from twin.compilation.kernel import array_kernel


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
        keep: Share of the way that is left after a step, shape (m,).
        goal: Where they tend to on the way to each row, shape (n, m).

    Returns:
        Shape (n, m).
    """
    states = goal.copy()
    for i in range(len(goal)):
        for j in range(len(start)):
            before = start[j] if i == 0 else states[i - 1, j]
            states[i, j] = goal[i, j] + keep[j] * (before - goal[i, j])
    return states
