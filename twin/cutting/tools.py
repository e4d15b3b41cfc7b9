"""What a turning tool's lower end looks like: its lowest height over every radius."""

import math
from collections.abc import Iterable

from twin.cutting.kernels.tool_height import Profile
from twin.job.job_file import StockTable, ToolTable

FINEST_CELL_MM = 0.1
"""The finest grid that is chosen without being asked for [mm]."""
FEWEST_CELLS = 40


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

    A stock that is small compared with its tools still gets ``FEWEST_CELLS`` along its shorter side.
    """
    width, depth, _ = stock.extent
    tenth = 0.05 * min(tool.diameter for tool in tools if tool.length != EMPTY_SPINDLE.length)
    return max(FINEST_CELL_MM, min(tenth, min(width, depth) / FEWEST_CELLS))
