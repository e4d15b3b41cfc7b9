"""Bodies about the tool's axis that go through the material: edges of every form, shank, holder."""

from typing import NamedTuple

from twin.cutting.tools import Profile


class Solid(NamedTuple):
    """A frustum about the tool's axis, or a disc with a rounding all around.

    Attributes:
        low: Height of its lower end above the tip [mm].
        high: Height of its upper end.
        low_radius: Radius at the lower end; of the disc its flat part [mm].
        high_radius: Radius at the upper end; of the disc as much as at the lower.
        rounding: Radius of the rounding [mm]; 0 for a frustum. A ball is a rounding alone.
    """

    low: float
    high: float
    low_radius: float
    high_radius: float
    rounding: float


def cutting_edge(profile: Profile, flute: float) -> tuple[Solid, ...]:
    """The convex bodies that a turning cutter is made of.

    Args:
        flute: Length of its cutting part [mm].
    """
    radius, flat, corner = profile.radius, profile.flat, profile.corner
    if corner:
        shoulder = corner
        lower = (Solid(0.0, 2.0 * corner, flat, flat, corner),)
    else:
        shoulder = profile.slope * (radius - flat)
        lower = (Solid(0.0, shoulder, flat, radius, 0.0),) if shoulder else ()
    if flute <= shoulder:
        return lower
    return (*lower, Solid(shoulder, flute, radius, radius, 0.0))


def cylinder(radius: float, low: float, high: float) -> Solid:
    """A cylinder between two heights above the tip [mm]."""
    return Solid(low, high, radius, radius, 0.0)


def thinner(solid: Solid, by: float) -> Solid:
    """A solid without an outer layer, which may brush a surface [mm]."""
    if solid.rounding:
        less = min(by, solid.rounding)
        flat = max(solid.low_radius - (by - less), 0.0)
        return Solid(solid.low + less, solid.high - less, flat, flat, solid.rounding - less)
    return Solid(
        solid.low + by,
        max(solid.high - by, solid.low + by),
        max(solid.low_radius - by, 0.0),
        max(solid.high_radius - by, 0.0),
        0.0,
    )
