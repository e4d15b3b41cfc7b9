"""Where a line goes into a body of revolution and out of it, and the body's surface there."""

import math
from typing import NamedTuple

from twin.compilation.kernel import arithmetic_kernel
from twin.cutting.tridexel.solids.solids import Solid

_PARALLEL = 1e-12
"""Squared sine below which a line is parallel to the axis."""
_CLOSE_MM = 1e-8
"""How close Newton's method comes to a rounding [mm]."""
_NEWTON_STEPS = 24


class Ray(NamedTuple):
    """A line as it is seen from a tool, by its place t along it: what a body of revolution needs of it.

    Attributes:
        height: Above the tip at t = 0 [mm].
        squared: Squared distance from the axis at t = 0 [mm²].
        half_slope: Half of that square's slope there [mm].
        across: Squared sine of the angle to the axis.
    """

    height: float
    rise: float
    squared: float
    half_slope: float
    across: float


@arithmetic_kernel
def greatest_radius(solid: Solid) -> float:
    """How far a solid reaches from its axis [mm]."""
    return max(solid.low_radius, solid.high_radius) + solid.rounding


@arithmetic_kernel
def crossing(solid: Solid, ray: Ray) -> tuple[float, float]:
    """The places between which a line is within a solid; the second is below the first if nowhere.

    Of a frustum that is missed beyond its rim, they are as far from each other as there is still missing.
    """
    if solid.rounding > 0.0:
        if solid.low_radius == 0.0:
            return _through_ball(solid.rounding, solid.low + solid.rounding, ray)
        return _through_rounded_disc(solid, ray)
    return _through_frustum(solid, ray)


@arithmetic_kernel
def _through_ball(radius: float, center: float, ray: Ray) -> tuple[float, float]:
    off = ray.height - center
    half = ray.half_slope + ray.rise * off
    inside = half * half - (ray.squared + off * off - radius * radius)
    if inside <= 0.0:
        return math.inf, -math.inf
    root = math.sqrt(inside)
    return -half - root, -half + root


@arithmetic_kernel
def _between(low: float, high: float, ray: Ray) -> tuple[float, float]:
    """Where a line is between two heights."""
    if ray.rise * ray.rise < _PARALLEL:
        if low <= ray.height <= high:
            return -math.inf, math.inf
        return math.inf, -math.inf
    a, b = (low - ray.height) / ray.rise, (high - ray.height) / ray.rise
    return min(a, b), max(a, b)


@arithmetic_kernel
def _through_frustum(solid: Solid, ray: Ray) -> tuple[float, float]:
    """Solves |distance from the axis|² = (radius at that height)² between the ends."""
    low, high = _between(solid.low, solid.high, ray)
    slope = 0.0
    if solid.high_radius != solid.low_radius:
        slope = (solid.high_radius - solid.low_radius) / (solid.high - solid.low)
    radius = solid.low_radius + slope * (ray.height - solid.low)
    growth = slope * ray.rise
    a = ray.across - growth * growth
    b = ray.half_slope - radius * growth
    c = ray.squared - radius * radius
    if abs(a) < _PARALLEL:
        if abs(b) < _PARALLEL:
            return (low, high) if c <= 0.0 else (math.inf, -math.inf)
        place = -0.5 * c / b
        return (low, min(high, place)) if b > 0.0 else (max(low, place), high)
    inside = b * b - a * c
    if a > 0.0:
        if inside <= 0.0:
            return math.inf, -math.inf
        root = math.sqrt(inside)
        return max(low, (-b - root) / a), min(high, (-b + root) / a)
    # As steep as the cone or steeper: of both halves of the double cone the one with a radius.
    if inside <= 0.0:
        return low, high
    root = math.sqrt(inside)
    if growth > 0.0:
        return max(low, (-b - root) / a), high
    return low, min(high, (-b + root) / a)


@arithmetic_kernel
def _through_rounded_disc(solid: Solid, ray: Ray) -> tuple[float, float]:
    """Newton's method from outside on the distance from the disc, which is convex along a line."""
    outer = solid.low_radius + solid.rounding
    low, high = _through_frustum(Solid(solid.low, solid.high, outer, outer, 0.0), ray)
    if low >= high:
        return math.inf, -math.inf
    low = _towards(solid, ray, low, 1.0)
    if low == math.inf:
        return math.inf, -math.inf
    return low, _towards(solid, ray, high, -1.0)


@arithmetic_kernel
def _towards(solid: Solid, ray: Ray, t: float, side: float) -> float:
    """From outside to the rounding's surface, up along the line or down; infinite if it is missed."""
    center = solid.low + solid.rounding
    for _ in range(_NEWTON_STEPS):
        distance = math.sqrt(max(ray.squared + t * (2.0 * ray.half_slope + t * ray.across), 1e-30))
        beyond, off = distance - solid.low_radius, ray.height + t * ray.rise - center
        growth = (ray.half_slope + t * ray.across) / distance
        if beyond <= 0.0:
            beyond = growth = 0.0
        away = math.hypot(beyond, off)
        excess = away - solid.rounding
        if excess <= _CLOSE_MM:
            return t
        slope = (beyond * growth + off * ray.rise) / away
        if slope * side >= -1e-9:
            return math.inf
        t -= excess / slope
    return t


@arithmetic_kernel
def outwards(solid: Solid, distance: float, height: float) -> tuple[float, float]:
    """Normal of a solid at a point of its surface: away from the axis and along it.

    Args:
        distance: Of the point from the axis [mm].
        height: Of the point above the tip [mm].
    """
    if solid.rounding > 0.0:
        beyond = max(distance - solid.low_radius, 0.0)
        off = height - solid.low - solid.rounding
        away = max(math.hypot(beyond, off), 1e-30)
        return beyond / away, off / away
    slope = 0.0
    if solid.high_radius != solid.low_radius:
        slope = (solid.high_radius - solid.low_radius) / (solid.high - solid.low)
    scale = 1.0 / math.sqrt(1.0 + slope * slope)
    side = abs(distance - solid.low_radius - slope * (height - solid.low)) * scale
    below, above = abs(height - solid.low), abs(height - solid.high)
    if side <= below and side <= above:
        return scale, -slope * scale
    return (0.0, -1.0) if below < above else (0.0, 1.0)
