"""How low a tool that moves straight comes over a place: the rule that sweep and overlap share."""

import math
from typing import NamedTuple

import numpy as np

from twin.compilation.kernel import array_kernel
from twin.nc.canonical import FloatArray

_MOST_STEPS = 60
"""Steps in search of the lowest point of a sweep at most; it takes some eight."""
_FOUND = 1e-9
"""A step of the search that is shorter than this share of the sweep is the last: what the height is off by
then falls with its square."""


class Profile(NamedTuple):
    """The surface that a turning cutter sweeps, from the axis outwards.

    A disc of ``flat`` radius, then a quarter round of ``corner`` radius or a cone of ``slope`` up
    to ``radius``: one form for flat, ball, bull-nose, drill and chamfer cutters. It is convex,
    which is what makes the lowest height over a straight sweep unique.

    Attributes:
        radius: Of the cutting edge [mm].
        flat: Radius of the disc at the tip [mm].
        corner: Radius of the rounding [mm]; 0 for none.
        slope: Rise of the cone over radius; 0 for none.
    """

    radius: float
    flat: float
    corner: float = 0.0
    slope: float = 0.0

    def height(self, radius: FloatArray) -> FloatArray:
        """Height of the edge above the tip at distances from the axis [mm]; inf beyond the edge."""
        beyond = np.maximum(np.asarray(radius, np.float64) - self.flat, 0.0)
        if self.corner:
            rise = self.corner - np.sqrt(np.maximum(self.corner**2 - beyond**2, 0.0))
        else:
            rise = self.slope * beyond
        return np.where(np.asarray(radius) <= self.radius, rise, np.inf)


@array_kernel
def lowest_height(x: float, y: float, a: FloatArray, b: FloatArray, profile: Profile) -> float:
    """Lowest height over (x, y) of a tool that moves straight from a to b; inf if it misses.

    With t from 0 to 1 the distance from the axis is convex in t, the profile is convex and rises
    with the distance, and the tip's height is linear: their sum is convex, so that its only
    minimum is an end of the stretch in reach or the place where its slope changes sign.
    """
    radius, flat, corner, slope = profile
    dx, dy, dz = b[0] - a[0], b[1] - a[1], b[2] - a[2]
    squared = dx * dx + dy * dy
    px, py = x - a[0], y - a[1]
    if squared == 0.0:
        return min(a[2], b[2]) + profile_height(math.hypot(px, py), radius, flat, corner, slope)
    nearest = (px * dx + py * dy) / squared
    across = px * dx + py * dy
    offset = max(px * px + py * py - across * across / squared, 0.0)
    reach = radius * radius - offset
    if reach < 0.0:
        return math.inf
    half = math.sqrt(reach / squared)
    first, last = max(0.0, nearest - half), min(1.0, nearest + half)
    if first > last:
        return math.inf
    if dz == 0.0:
        t = min(last, max(first, nearest))
    elif flat >= radius:
        t = last if dz < 0.0 else first
    elif flat == 0.0 and corner > 0.0:
        steepest = math.sqrt(reach / (squared * (squared + dz * dz)))
        t = min(last, max(first, nearest - dz * steepest))
    elif corner > 0.0:
        t = _turning_point(first, last, nearest, squared, offset, dz, profile)
    else:
        t = min(last, max(first, nearest + cone_turning_point(squared, offset, dz, flat, slope)))
    along = t - nearest
    distance = math.sqrt(offset + squared * along * along)
    return a[2] + t * dz + profile_height(min(distance, radius), radius, flat, corner, slope)


@array_kernel
def profile_height(
    distance: float, radius: float, flat: float, corner: float, slope: float
) -> float:
    """Height of the edge above the tip at a distance from the axis [mm]; inf beyond the edge."""
    if distance > radius:
        return math.inf
    beyond = max(distance - flat, 0.0)
    if corner > 0.0:
        return corner - math.sqrt(max(corner * corner - beyond * beyond, 0.0))
    return slope * beyond


@array_kernel
def cone_turning_point(
    squared: float, offset: float, dz: float, flat: float, slope: float
) -> float:
    """Where the height of a swept cone over a place stops falling.

    Outside of its flat the height rises by slope squared s / sqrt(offset + squared s²) + dz, which
    is zero at one s, or nowhere if the path is steeper than the cone; a flat ends where it does.

    Args:
        squared: Level length of the path, squared [mm²].
        offset: Squared distance of the place from the path's line [mm²].
        dz: How much the path rises [mm].
        flat: Radius of the cone's flat [mm].

    Returns:
        From where the path is nearest to the place, as a share of it; may be infinite.
    """
    rest = slope * slope * squared - dz * dz
    beyond = max(dz * dz * offset / rest if rest > 0.0 else math.inf, flat * flat - offset)
    return -math.copysign(math.sqrt(max(beyond, 0.0) / squared), dz)


@array_kernel
def _turning_point(
    first: float,
    last: float,
    nearest: float,
    squared: float,
    offset: float,
    dz: float,
    profile: Profile,
) -> float:
    """Where the height over a cell stops falling [share of the line].

    Most cells of a short line lie before or behind all of it, and their lowest height is that of an
    end. Else it is found by the secant that is halved at the end which stays (Illinois).
    """
    below = _rise(first, nearest, squared, offset, dz, profile)
    if below >= 0.0:
        return first
    above = _rise(last, nearest, squared, offset, dz, profile)
    if above <= 0.0:
        return last
    t, stays = first, 0
    for _ in range(_MOST_STEPS):
        before = t
        t = (first * above - last * below) / (above - below)
        rise = _rise(t, nearest, squared, offset, dz, profile)
        if abs(t - before) <= _FOUND or rise == 0.0:
            break
        if rise > 0.0:
            last, above = t, rise
            below = 0.5 * below if stays == 1 else below
            stays = 1
        else:
            first, below = t, rise
            above = 0.5 * above if stays == -1 else above
            stays = -1
    return t


@array_kernel
def _rise(
    t: float,
    nearest: float,
    squared: float,
    offset: float,
    dz: float,
    profile: Profile,
) -> float:
    """Has the sign with which the height of a rounded corner over a cell changes, and no pole."""
    _, flat, corner, _ = profile
    along = t - nearest
    distance = math.sqrt(offset + squared * along * along)
    beyond = distance - flat
    if beyond <= 0.0:
        return dz * corner * flat
    beyond = min(beyond, corner)
    side = math.sqrt(max(corner * corner - beyond * beyond, 0.0))
    return dz * distance * side + squared * along * beyond


@array_kernel
def steepness(distance: float, profile: Profile) -> float:
    """Slope of a cutter's lower end at a distance from its axis."""
    _, flat, corner, slope = profile
    if distance <= flat:
        return 0.0
    if corner > 0.0:
        beyond = min(distance - flat, corner)
        return beyond / math.sqrt(max(corner * corner - beyond * beyond, 1e-18))
    return slope
