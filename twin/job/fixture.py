"""What is clamped to the table beside the part: jaws, clamps, stops."""

from pathlib import Path
from typing import Annotated

import numpy as np
import pydantic
from pydantic import Field

from twin.files.stl import read_stl
from twin.files.toml import Table
from twin.job.weight import Weight, upright_weight

Positive = Annotated[float, Field(gt=0)]


class FixtureTable(Table):
    """What is clamped to the work-holding surface: a box or an upright cylinder, such as the jaw of a vise, or an STL.

    A machine file lists what always stands on its table, a job file what holds its part.
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
    position: tuple[float, float, float] = (0.0, 0.0, 0.0)
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
        """This fixture with the whole path of its file.

        Args:
            folder: What the path is relative to.
        """
        if self.file is None:
            return self
        return self.model_copy(update={"file": str((folder / self.file).absolute())})

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
