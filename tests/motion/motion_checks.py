"""What must hold of any setpoints, written without the planner's formulas."""

import numpy as np

from twin.motion.limits import MotionLimits
from twin.motion.setpoints import Setpoints
from twin.nc.canonical import FloatArray, Moves, Shape

TOLERANCE = 1.001
"""Acceleration and jerk may pass their limits by 0.1 %."""

NANOMETRE = 1e-6
"""[mm]."""


def position_on_path(moves: Moves, i: int, u: float) -> FloatArray:
    """The convention of ``twin.nc.canonical``, by Rodrigues' rotation."""
    point = moves.start[i] + u * (moves.end[i] - moves.start[i])
    if moves.shape[i] == Shape.ARC:
        normal, center = moves.normal[i], moves.center[i]
        spoke = moves.start[i, :3] - center
        angle = np.deg2rad(u * moves.sweep[i])
        turned = (
            spoke * np.cos(angle)
            + np.cross(normal, spoke) * np.sin(angle)
            + normal * (normal @ spoke) * (1.0 - np.cos(angle))
        )
        advance = normal @ (moves.end[i, :3] - moves.start[i, :3])
        point[:3] = center + turned + u * advance * normal
    return point


def assert_on_path(setpoints: Setpoints, moves: Moves, part_zero: FloatArray) -> None:
    for row in range(len(setpoints)):
        if setpoints.move[row] >= 0:
            i, u = int(setpoints.move[row]), float(setpoints.fraction[row])
            expected = position_on_path(moves, i, u) + part_zero
            assert np.abs(setpoints.position[row] - expected).max() < NANOMETRE
            assert 0.0 <= u <= 1.0


def assert_within_limits(setpoints: Setpoints, limits: MotionLimits, period_s: float) -> None:
    """By the stated values, and by their differences from tick to tick."""
    # A difference of positions loses the last digits of their size.
    grain = 1e-13 * (1.0 + np.abs(setpoints.position).max()) / period_s
    velocity = np.abs(setpoints.velocity).max(axis=0)
    assert np.all(velocity <= limits.velocity * (1.0 + 1e-9)), velocity / limits.velocity
    mean_velocity = np.abs(np.diff(setpoints.position, axis=0)).max(axis=0, initial=0.0) / period_s
    assert np.all(mean_velocity <= limits.velocity * (1.0 + 1e-9) + grain)
    acceleration = np.abs(setpoints.acceleration).max(axis=0)
    assert np.all(acceleration <= limits.acceleration * TOLERANCE), acceleration
    steps = np.abs(np.diff(setpoints.velocity, axis=0)).max(axis=0, initial=0.0) / period_s
    assert np.all(steps <= limits.acceleration * TOLERANCE)
    jerk = np.abs(np.diff(setpoints.acceleration, axis=0)).max(axis=0, initial=0.0) / period_s
    assert np.all(jerk <= limits.jerk * TOLERANCE)


def assert_consistent(setpoints: Setpoints, limits: MotionLimits, period_s: float) -> None:
    """Positions, velocities and accelerations are one another's derivatives.

    The trapezoidal rule over a tick errs by no more than h³/12 of the second derivative of what it
    integrates where that is smooth, and by h²/4 times the step of its first derivative at a kink.
    """
    h = period_s
    mean = 0.5 * (setpoints.velocity[1:] + setpoints.velocity[:-1])
    moved = np.diff(setpoints.position, axis=0)
    allowed = limits.acceleration * h**2 / 2.0 + 1e-12 * (1.0 + np.abs(setpoints.position).max())
    allowed = np.minimum(allowed, limits.jerk * h**3 / 2.0 + 1e-11)
    assert np.all(np.abs(moved - mean * h) <= allowed)
    mean = 0.5 * (setpoints.acceleration[1:] + setpoints.acceleration[:-1])
    gained = np.diff(setpoints.velocity, axis=0)
    assert np.all(np.abs(gained - mean * h) <= limits.jerk * h**2 / 2.0 * TOLERANCE + 1e-12)
