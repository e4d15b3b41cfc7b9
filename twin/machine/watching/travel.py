"""Soft limits: whether moves stay within the axes' travel, exactly and before anything moves."""

import numpy as np

from twin.machine.description.config import MachineConfig
from twin.nc.canonical import FloatArray, Moves, Shape
from twin.recording.alarms import Alarm

ROUNDING = 1e-6
"""What an axis may exceed its travel by before it counts [mm or deg]: far below any control's
resolution, far above what adding a part zero in double precision loses."""


def move_bounds(moves: Moves) -> tuple[FloatArray, FloatArray]:
    """Lowest and highest coordinate that each move reaches, arcs' extreme points included.

    Args:
        moves: n canonical moves over k axes.

    Returns:
        Two arrays of shape (n, k) [mm or deg], part coordinates.
    """
    low = np.minimum(moves.start, moves.end)
    high = np.maximum(moves.start, moves.end)
    arcs = np.flatnonzero(moves.shape == Shape.ARC)
    if len(arcs):
        points = _extreme_points(moves[arcs])
        low[arcs, :3] = np.fmin(low[arcs, :3], np.fmin.reduce(points, axis=0))
        high[arcs, :3] = np.fmax(high[arcs, :3], np.fmax.reduce(points, axis=0))
    curves = np.flatnonzero(moves.shape == Shape.CURVE)
    if len(curves):
        places = _turning_places(moves[curves])
        low[curves] = np.minimum(low[curves], places.min(axis=0))
        high[curves] = np.maximum(high[curves], places.max(axis=0))
    return low, high


def _turning_places(curves: Moves) -> FloatArray:
    """Coordinates at and near to where the axes of curves turn back, shape (m, n, k) [mm or deg].

    From the places of ``_LOOKED_AT`` where a slope changes its sign, Newton's method finds it.
    """
    assert curves.curve is not None
    slopes = curves.curve * np.arange(1, 6)
    bends = slopes[:, :, 1:] * np.arange(1, 5)
    found = []
    for u in _LOOKED_AT:
        place = np.full(slopes.shape[:2], u)
        for _ in range(3):
            slope, bend = _polynomial(slopes, place), _polynomial(bends, place)
            step = np.divide(slope, bend, out=np.zeros_like(slope), where=bend != 0.0)
            place = np.clip(place - np.clip(step, -_NEXT, _NEXT), 0.0, 1.0)
        found.append(curves.start + place * _polynomial(curves.curve, place))
    return np.array(found)


_LOOKED_AT = np.linspace(0.0, 1.0, 9)
_NEXT = 0.125
"""How far apart these are."""


def _polynomial(coefficients: FloatArray, at: FloatArray) -> FloatArray:
    """Polynomials of shape (n, k, powers from 0) at places of shape (n, k)."""
    total = np.zeros_like(at)
    for power in range(coefficients.shape[2] - 1, -1, -1):
        total = total * at + coefficients[:, :, power]
    return total


def _extreme_points(arcs: Moves) -> FloatArray:
    """Coordinates where an arc or helix turns back in X, Y or Z.

    With the angle t from 0 to ``sweep`` each coordinate is

        x(t) = center + A cos t + B sin t + k t,  A = start - center, B = normal x A,

    k = advance normal / sweep, and it turns back where sin(t - phi) = k/r with
    r = hypot(A, B), phi = atan2(B, A). Of the solutions that lie a turn apart the first and the
    last are the outermost, since only k t tells them apart.

    Returns:
        Shape (4, n, 3) [mm]; NaN where an arc does not come to such a point.
    """
    sweep = np.deg2rad(arcs.sweep)[:, None]
    arm = arcs.start[:, :3] - arcs.center
    across = np.cross(arcs.normal, arm)
    advance = np.sum((arcs.end[:, :3] - arcs.start[:, :3]) * arcs.normal, axis=1, keepdims=True)
    reach = np.hypot(arm, across)
    with np.errstate(divide="ignore", invalid="ignore"):
        slope = advance * arcs.normal / sweep
        lean = np.arcsin(slope / reach)
    peak = np.arctan2(across, arm)
    first, last = np.minimum(sweep, 0.0), np.maximum(sweep, 0.0)
    turn = 2.0 * np.pi
    points = []
    for angle in (peak + lean, peak + np.pi - lean):
        for at in (
            angle + turn * np.ceil((first - angle) / turn),
            angle + turn * np.floor((last - angle) / turn),
        ):
            value = arcs.center + arm * np.cos(at) + across * np.sin(at) + slope * at
            points.append(np.where((at >= first) & (at <= last), value, np.nan))
    return np.array(points)


def soft_limit_alarm(machine: MachineConfig, moves: Moves, part_zero: FloatArray) -> Alarm | None:
    """Find the first move of a chunk that leaves the travel.

    Args:
        moves: n canonical moves over the machine's k axes, part coordinates.
        part_zero: Machine coordinates of program zero, shape (k,) [mm or deg].

    Returns:
        The alarm of the first such move and, in it, of the axis that leaves furthest; None when
        all moves stay within the travel.
    """
    if not len(moves):
        return None
    low, high = (bound + part_zero for bound in move_bounds(moves))
    travel = [machine.axis(name).travel or (-np.inf, np.inf) for name in machine.axes.names]
    lowest, highest = np.array(travel).T
    excess = np.maximum(lowest - low, high - highest)
    outside = np.flatnonzero(np.any(excess > ROUNDING, axis=1))
    if not len(outside):
        return None
    move = int(outside[0])
    axis = int(np.argmax(excess[move]))
    name = machine.axes.names[axis]
    above = high[move, axis] - highest[axis] > ROUNDING
    reached = high[move, axis] if above else low[move, axis]
    unit = "mm" if machine.axes.kinds[axis] == "linear" else "deg"
    return Alarm(
        "soft-limit",
        int(moves.line[move]),
        0.0,
        name,
        f"{name} would go to {reached:.3f} {unit} in machine coordinates, outside its travel of "
        f"{lowest[axis]:g} to {highest[axis]:g} {unit} (part zero at {part_zero[axis]:.3f})",
    )
