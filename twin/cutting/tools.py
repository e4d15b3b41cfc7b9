"""What a turning tool's lower end looks like: its lowest height over every radius."""

import dataclasses

import numpy as np

from twin.job import ToolTable
from twin.nc.canonical import FloatArray

FINEST_CELL_MM = 0.1
"""The finest grid that is chosen without being asked for [mm]."""


@dataclasses.dataclass(frozen=True, slots=True)
class Profile:
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


def profile(tool: ToolTable) -> Profile:
    """The profile of a tool of the job."""
    radius = 0.5 * tool.diameter
    if tool.kind == "ball":
        return Profile(radius, flat=0.0, corner=radius)
    return Profile(radius, flat=radius)


def default_cell(tool: ToolTable) -> float:
    """Grid for a job that names none: a tenth of the tool's radius, 0.1 mm at the finest [mm]."""
    return max(FINEST_CELL_MM, 0.05 * tool.diameter)
