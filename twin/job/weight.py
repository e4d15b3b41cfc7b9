"""What blanks and fixtures weigh, and how that resists being turned."""

from typing import NamedTuple

from twin.units import MM

Triple = tuple[float, float, float]
Six = tuple[float, float, float, float, float, float]


class Weight(NamedTuple):
    """A rigid body on the table, its axes parallel to the machine's.

    Attributes:
        mass: [kg].
        center: Its centre of mass [mm].
        inertia: About that centre: xx, yy, zz, xy, xz, yz, as the elements of a tensor [kg m²].
    """

    mass: float
    center: Triple
    inertia: Six

    def moved(self, by: Triple) -> "Weight":
        """The same body elsewhere [mm]."""
        x, y, z = (here + way for here, way in zip(self.center, by, strict=True))
        return self._replace(center=(x, y, z))


def upright_weight(
    mass: float, size: Triple, center: Triple, *, is_round: bool, bore: float = 0.0
) -> Weight:
    """A box, or an upright cylinder or tube, evenly filled.

    Args:
        mass: [kg].
        size: Of the box around it [mm].
        center: Of that box [mm].
        is_round: A cylinder or a tube.
        bore: Diameter of a tube's hole [mm].
    """
    x, y, z = (value * MM for value in size)
    if is_round:
        radii = (0.5 * x) ** 2 + (0.5 * bore * MM) ** 2
        level = mass * (3.0 * radii + z * z) / 12.0
        return Weight(mass, center, (level, level, 0.5 * mass * radii, 0.0, 0.0, 0.0))
    xx, yy, zz = (mass * square / 12.0 for square in (y * y + z * z, x * x + z * z, x * x + y * y))
    return Weight(mass, center, (xx, yy, zz, 0.0, 0.0, 0.0))
