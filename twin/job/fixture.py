"""What is clamped to the table beside the part: jaws, clamps, stops."""

from typing import Annotated

import pydantic
from pydantic import Field

from twin.files.toml import Table
from twin.job.weight import Weight, upright_weight

Positive = Annotated[float, Field(gt=0)]


class FixtureTable(Table):
    """A box or an upright cylinder clamped to the work-holding surface, such as the jaw of a vise.

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
    position: tuple[float, float, float] = (0.0, 0.0, 0.0)
    """Centre of its lower face over the middle of the surface [mm], all axes at zero."""
    mass: Annotated[float, Field(ge=0)] = 0.0
    """What it weighs, evenly spread [kg]: the axes below it move that too."""

    @pydantic.model_validator(mode="after")
    def _one_shape(self) -> "FixtureTable":
        cylinder = (self.diameter is not None, self.height is not None)
        if cylinder != (self.size is None,) * 2:
            raise ValueError("a fixture needs either size, or diameter and height")
        return self

    @property
    def extent(self) -> tuple[float, float, float]:
        """Size of the box around it [mm]."""
        if self.size is not None:
            return self.size
        assert self.diameter is not None
        assert self.height is not None
        return (self.diameter, self.diameter, self.height)

    @property
    def weight(self) -> Weight:
        """What it adds to the table, about the centre of its lower face."""
        return upright_weight(
            self.mass, self.extent, (0.0, 0.0, 0.5 * self.extent[2]), is_round=self.size is None
        )
