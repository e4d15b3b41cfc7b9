"""Fixtures on the table and their weight: jaws, clamps, stops."""

from pathlib import Path
from typing import Annotated, NamedTuple

import numpy as np
import numpy.typing as npt
import pydantic
from pydantic import Field

from twin.files.looked_at import look_at
from twin.files.stl import read_stl
from twin.files.toml import Table
from twin.job.builder import Positive, Triple
from twin.units import MM

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
        x, y, z = (here + shift for here, shift in zip(self.center, by, strict=True))
        return self._replace(center=(x, y, z))

    def turned(self, rotation: npt.NDArray[np.float64]) -> "Weight":
        """The same body seen in other axes: a rotation into these, shape (3, 3)."""
        xx, yy, zz, xy, xz, yz = self.inertia
        tensor = rotation @ [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]] @ rotation.T
        x, y, z = (rotation @ self.center).tolist()
        (xx, xy, xz), (_, yy, yz), (_, _, zz) = tensor.tolist()
        return Weight(self.mass, (x, y, z), (xx, yy, zz, xy, xz, yz))


def upright_weight(
    mass: float, size: Triple, center: Triple, *, is_round: bool, bore: float = 0.0
) -> Weight:
    """A box, or an upright cylinder or tube, evenly filled.

    Args:
        mass: [kg].
        size: Of the box around it [mm].
        center: Of that box [mm].
        bore: Diameter of a tube's hole [mm].
    """
    x, y, z = (value * MM for value in size)
    if is_round:
        radii = (0.5 * x) ** 2 + (0.5 * bore * MM) ** 2
        level = mass * (3.0 * radii + z * z) / 12.0
        return Weight(mass, center, (level, level, 0.5 * mass * radii, 0.0, 0.0, 0.0))
    xx, yy, zz = (mass * square / 12.0 for square in (y * y + z * z, x * x + z * z, x * x + y * y))
    return Weight(mass, center, (xx, yy, zz, 0.0, 0.0, 0.0))


class FixtureTable(Table):
    """What is clamped to the work-holding surface: a box or an upright cylinder, such as the jaw of a vise, or an STL.

    A machine file lists what always is on its table, a job file what holds its part.
    """

    name: str
    """What messages call it; no two have the same."""
    size: tuple[Positive, Positive, Positive] | None = None
    """Box: along X, Y, Z [mm]."""
    diameter: Positive | None = None
    """Cylinder [mm]."""
    height: Positive | None = None
    """Cylinder [mm]."""
    file: str | None = None
    """STL [mm], relative to the file that names it, in coordinates of the surface: their zero lies in its middle, Z
    points up. Its hollows count."""
    position: Triple = (0.0, 0.0, 0.0)
    """Centre of its lower face over the middle of the surface [mm], all axes at zero; an STL is moved by it."""
    mass: Annotated[float, Field(ge=0)] = 0.0
    """What it weighs, evenly spread [kg]: the axes below it move that too."""

    @pydantic.model_validator(mode="after")
    def _one_shape(self) -> "FixtureTable":
        given = {name for name in _MEASURES if getattr(self, name) is not None}
        if given not in _SHAPES:
            raise ValueError("a fixture needs either size, or diameter and height, or file")
        return self

    def in_folder(self, folder: Path) -> "FixtureTable":
        """This fixture with the whole path of its file."""
        if self.file is None:
            return self
        return self.model_copy(update={"file": str(look_at(folder / self.file).absolute())})

    @property
    def box(self) -> tuple[tuple[float, float, float], tuple[float, float, float]]:
        """Size of the box around it, and the centre of that, seen from ``position`` [mm].

        Raises:
            ConfigError: The STL file cannot be read, or holds no solid.
        """
        if self.file is not None:
            low, high = read_stl(Path(self.file)).bounds
            (x, y, z), (u, v, w) = (high - low).tolist(), np.mean([low, high], axis=0).tolist()
            return (x, y, z), (u, v, w)
        if self.size is not None:
            return self.size, (0.0, 0.0, 0.5 * self.size[2])
        assert self.diameter is not None
        assert self.height is not None
        return (self.diameter, self.diameter, self.height), (0.0, 0.0, 0.5 * self.height)

    @property
    def weight(self) -> Weight:
        """What it adds to the table, seen from ``position``; of an STL, that of the box around it."""
        size, center = self.box
        return upright_weight(self.mass, size, center, is_round=self.diameter is not None)


_MEASURES = ("size", "diameter", "height", "file")
_SHAPES = ({"size"}, {"diameter", "height"}, {"file"})
