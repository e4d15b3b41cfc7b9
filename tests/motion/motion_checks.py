"""What must hold of any setpoints, written without the planner's formulas."""

import numpy as np

from twin.motion.limits import MotionLimits
from twin.motion.profile.phases import Phases
from twin.motion.setpoints.setpoints import Setpoints
from twin.nc.canonical import FloatArray, Motion, Moves, Shape
from twin.units import SECONDS_PER_MINUTE

TOLERANCE = 1.001
"""Acceleration and jerk may pass their limits by 0.1 %."""

NANOMETRE = 1e-6
"""[mm]."""


def points_on_path(moves: Moves, fraction: FloatArray) -> FloatArray:
    """The convention of ``twin.nc.canonical``, by Rodrigues' rotation; one fraction per move."""
    u = fraction[:, None]
    points = moves.start + u * (moves.end - moves.start)
    arc = moves.shape == Shape.ARC
    normal, center = moves.normal[arc], moves.center[arc]
    start, end = moves.start[arc, :3], moves.end[arc, :3]
    spoke = start - center
    angle = np.deg2rad(u[arc] * moves.sweep[arc, None])
    height = np.sum(normal * spoke, axis=1, keepdims=True)
    advance = np.sum(normal * (end - start), axis=1, keepdims=True)
    turned = spoke * np.cos(angle) + np.cross(normal, spoke) * np.sin(angle)
    turned += normal * height * (1.0 - np.cos(angle))
    points[arc, :3] = center + turned + u[arc] * advance * normal
    return points


def assert_on_path(setpoints: Setpoints, moves: Moves, part_zero: FloatArray) -> None:
    here = setpoints.move >= 0
    fraction = setpoints.fraction[here]
    assert np.all((fraction >= 0.0) & (fraction <= 1.0))
    expected = points_on_path(moves[setpoints.move[here]], fraction) + part_zero
    assert np.abs(setpoints.position[here] - expected).max(initial=0.0) < NANOMETRE


def assert_within_limits(
    setpoints: Setpoints, limits: MotionLimits, period_s: float, *, knees: bool = False
) -> None:
    """By the stated values, and by their differences from tick to tick.

    Args:
        setpoints: What to check.
        limits: What they must keep.
        period_s: Servo period.
        knees: Borders between moves may be knees, as large as the limits allow.
    """
    # A difference of positions loses the last digits of their size.
    grain = 1e-13 * (1.0 + np.abs(setpoints.position).max()) / period_s
    velocity = np.abs(setpoints.velocity).max(axis=0)
    assert np.all(velocity <= limits.velocity * (1.0 + 1e-9)), velocity / limits.velocity
    mean_velocity = np.abs(np.diff(setpoints.position, axis=0)).max(axis=0, initial=0.0) / period_s
    assert np.all(mean_velocity <= limits.velocity * (1.0 + 1e-9) + grain)
    acceleration = np.abs(setpoints.acceleration).max(axis=0)
    assert np.all(acceleration <= limits.acceleration * TOLERANCE), acceleration

    borders = np.diff(setpoints.move)[:, None] * int(knees)
    steps = np.abs(np.diff(setpoints.velocity, axis=0))
    allowed = limits.acceleration * period_s + borders * limits.junction_velocity_step
    assert np.all(steps <= allowed * TOLERANCE), (steps / allowed).max()
    steps = np.abs(np.diff(setpoints.acceleration, axis=0))
    within = borders[:, 0] == 0
    assert np.all(steps[within] <= limits.jerk * period_s * TOLERANCE), (
        steps[within] / limits.jerk / period_s
    ).max()


def assert_consistent(
    setpoints: Setpoints, limits: MotionLimits, period_s: float, *, knees: bool = False
) -> None:
    """Positions, velocities and accelerations are one another's derivatives.

    The trapezoidal rule over a tick errs by no more than h³/12 of the second derivative of what it
    integrates where that is smooth, and by h²/4 times the step of its first derivative at a kink.
    """
    h = period_s
    smooth = np.diff(setpoints.move) * int(knees) == 0
    mean = 0.5 * (setpoints.velocity[1:] + setpoints.velocity[:-1])
    moved = np.diff(setpoints.position, axis=0)
    allowed = limits.acceleration * h**2 / 2.0 + 1e-12 * (1.0 + np.abs(setpoints.position).max())
    allowed = np.minimum(allowed, limits.jerk * h**3 / 2.0 + 1e-11)
    wrong = np.abs(moved - mean * h) / allowed
    assert np.all(wrong[smooth] <= 1.0), wrong[smooth].max(axis=0)
    mean = 0.5 * (setpoints.acceleration[1:] + setpoints.acceleration[:-1])
    gained = np.diff(setpoints.velocity, axis=0)
    allowed = limits.jerk * h**2 / 2.0 * TOLERANCE + 1e-12
    wrong = np.abs(gained - mean * h) / allowed
    assert np.all(wrong[smooth] <= 1.0), wrong[smooth].max(axis=0)


def assert_feed_and_path_limits(setpoints: Setpoints, moves: Moves, limits: MotionLimits) -> None:
    """The speed that the feed counts, and the acceleration of X Y Z along and across the path."""
    velocity, acceleration = setpoints.velocity[:, :3], setpoints.acceleration[:, :3]
    speed = np.linalg.norm(velocity, axis=1)
    here = setpoints.move >= 0
    rows = setpoints.move[here]
    spatial = np.any(moves.start[rows, :3] != moves.end[rows, :3], axis=1)
    spatial |= moves.shape[rows] == Shape.ARC
    counted = np.where(spatial, speed[here], np.abs(setpoints.velocity[here, 3]))
    feed = np.where(moves.motion[rows] == Motion.RAPID, np.inf, moves.feed[rows])
    assert np.all(counted <= feed / SECONDS_PER_MINUTE * (1.0 + 1e-9) + 1e-9)

    moving = speed > 1e-6 * speed.max(initial=0.0)
    tangent = velocity[moving] / speed[moving, None]
    along = np.sum(acceleration[moving] * tangent, axis=1)
    across = np.linalg.norm(acceleration[moving] - along[:, None] * tangent, axis=1)
    highest = limits.path_acceleration * TOLERANCE
    assert np.abs(along).max(initial=0.0) <= highest
    assert across.max(initial=0.0) <= highest


def assert_phases_join(phases: Phases) -> None:
    """Each phase begins where the one before it ended, as fast as that did."""
    place = np.append(0.0, np.cumsum(phases.pieces.length))
    begin, t, x, v, a, j = phases.rows.T
    x = x + place[phases.rows_pieces[:, 0]]
    end_x = x + ((j / 6.0 * t + 0.5 * a) * t + v) * t
    end_v = v + (0.5 * j * t + a) * t
    assert np.abs(x[1:] - end_x[:-1]).max(initial=0.0) <= 1e-10 * (1.0 + place[-1])
    gaps = begin[1:] - (begin + t)[:-1]
    overlapping = np.append(False, gaps < -1e-9)
    assert np.all(gaps <= 1e-9)
    # Moves overlap at stops, by no more than one phase of each.
    assert np.all(v[overlapping] == 0.0)
    assert np.all((begin + t)[1:] >= (begin + t)[:-1] - 1e-9)
    assert np.abs(v[1:] - end_v[:-1]).max(initial=0.0) <= 1e-9 * (1.0 + v.max(initial=0.0))
