"""What a turning tool's lower end looks like: its lowest height over every radius."""

import bisect
import dataclasses
import itertools
import math
from collections.abc import Iterable
from typing import NamedTuple

import numpy as np

from twin.job.job_file import StockTable, ToolTable
from twin.nc.canonical import FloatArray, IntArray

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


class ToolChange(NamedTuple):
    """A tool that comes into the spindle.

    Attributes:
        move: Number of the next move.
        line: Source line of the change.
        tool: The tool that comes.
    """

    move: int
    line: int
    tool: ToolTable


@dataclasses.dataclass(frozen=True, slots=True)
class ToolPlan:
    """Which tool is in the spindle during which moves of a program.

    Attributes:
        tools: In the order in which they come into the spindle; the first is in it at the start.
            A tool whose speed changes stands there once for each speed.
        first_move: Number of the first move that each is in the spindle for, never falling from 0.
        changes: Those of the program, also where no move follows.
    """

    tools: tuple[ToolTable, ...]
    first_move: tuple[int, ...] = (0,)
    changes: tuple[ToolChange, ...] = ()

    def at(self, move: int) -> ToolTable:
        """The tool in the spindle during a move."""
        return self.tools[bisect.bisect_right(self.first_move, max(move, 0)) - 1]

    def before(self, tool: ToolTable) -> ToolTable | None:
        """The tool that was in the spindle before another came first; None: that one is the first."""
        numbers = [each.number for each in self.tools]
        place = numbers.index(tool.number) if tool.number in numbers else 0
        return self.tools[place - 1] if place else None

    def longer(self, tool: ToolTable) -> float:
        """How much lower a tool's tip is than that of the first, which positions count for [mm]."""
        return tool.length - self.tools[0].length

    def lower(self, move: IntArray) -> FloatArray:
        """How much lower the tip is than that of the first tool, by the moves of samples, shape (n,) [mm]."""
        lower = np.zeros(len(move))
        for run, tool in self.runs(move):
            lower[run] = self.longer(tool)
        return lower

    def runs(self, move: IntArray) -> list[tuple[slice, ToolTable]]:
        """Split samples where the tool changes.

        Args:
            move: Move number of each sample, never falling, shape (n,).
        """
        number = np.searchsorted(self.first_move, np.maximum(move, 0), side="right") - 1
        ends = [*(np.flatnonzero(np.diff(number)) + 1).tolist(), len(move)]
        return [
            (slice(first, end), self.tools[int(number[first])])
            for first, end in itertools.pairwise([0, *ends])
            if first < end
        ]


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
