"""What a turning tool's lower end looks like: its lowest height over every radius."""

import dataclasses
import math
from collections.abc import Iterable

import numpy as np

from twin.job.job_file import StockTable, ToolTable
from twin.nc.canonical import FloatArray

FINEST_CELL_MM = 0.1
"""The finest grid that is chosen without being asked for [mm]."""
FEWEST_CELLS = 40


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
    if tool.kind == "bull":
        assert tool.corner is not None
        return Profile(radius, flat=radius - tool.corner, corner=tool.corner)
    if tool.point_angle is not None:
        return Profile(radius, flat=0.5 * tool.tip, slope=_cone_slope(tool.point_angle))
    return Profile(radius, flat=radius)


def _cone_slope(angle: float) -> float:
    return 1.0 / math.tan(math.radians(0.5 * angle))


EMPTY_SPINDLE = ToolTable(
    number=0, diameter=1.0, length=0.001, flute=0.001, free_length=0.001, holder=0.001
)
"""What stands for no tool: a stub of a micrometre at the spindle nose, which reaches nothing first."""


def default_cell(tools: Iterable[ToolTable], stock: StockTable) -> float:
    """Grid for a job that names none: a tenth of the smallest tool's radius, 0.1 mm at least [mm].

    A stock that is small beside its tools still gets ``FEWEST_CELLS`` along its shorter side.
    """
    width, depth, _ = stock.extent
    tenth = 0.05 * min(tool.diameter for tool in tools if tool.length != EMPTY_SPINDLE.length)
    return max(FINEST_CELL_MM, min(tenth, min(width, depth) / FEWEST_CELLS))
