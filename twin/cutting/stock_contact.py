"""What must not go into the stock: shank, holder and head at any time, the edge in a rapid."""

import dataclasses
from collections.abc import Callable, Iterable
from typing import Protocol

import numpy as np

from twin.cutting.events import SCRAPE_MM
from twin.cutting.height_map import BoolArray, HeightMap
from twin.cutting.kernels.overlap import Overlap, Stood, box_overlap, round_overlap
from twin.cutting.tools import Profile
from twin.job.job_file import ToolTable
from twin.nc.canonical import FloatArray

BRUSH_MM = 0.03
"""How far a cutter may reach into a wall beside it without being said to meet it [mm]: its way back
along a wall is off the way there by what the force bent, and cells of the wall go."""

EDGE = "edge"
"""The cutting edge, which may be in the material in a feed alone."""


class Upright(Protocol):
    """A solid above the tool's tip that goes where the tool goes and does not tilt."""

    @property
    def name(self) -> str:
        """As an alarm calls it."""
        ...

    @property
    def round(self) -> bool:
        """A cylinder; else a box."""
        ...

    @property
    def half(self) -> tuple[float, float]:
        """Half of its size along machine X and Y [mm]."""
        ...

    @property
    def offset(self) -> tuple[float, float]:
        """Its middle off the tool's axis along machine X and Y [mm]."""
        ...

    @property
    def above(self) -> float:
        """Height of its lower end above the tip [mm]."""
        ...


Head = Callable[[ToolTable], Iterable[Upright]]
"""What is above a tool's holder."""


@dataclasses.dataclass(frozen=True, slots=True)
class _Cylinder:
    """A cylinder about the tool's axis; see ``Upright``."""

    name: str
    radius: float
    above: float
    offset: tuple[float, float] = (0.0, 0.0)
    round: bool = True

    @property
    def half(self) -> tuple[float, float]:
        """Half of its size along machine X and Y [mm]."""
        return self.radius, self.radius


@dataclasses.dataclass(frozen=True, slots=True)
class Points:
    """The ends of n stretches.

    Attributes:
        tip: Places of the tool's tip in the part's frame, shape (n + 1, 3) [mm].
        turn: Direction of machine X there, shape (n + 1, 2).
    """

    tip: FloatArray
    turn: FloatArray

    def __getitem__(self, rows: slice) -> "Points":
        return Points(self.tip[rows], self.turn[rows])


class StockContact:
    """Measures one tool against the material."""

    def __init__(self, tool: ToolTable, edge: Profile, head: Head | None) -> None:
        """Say what is above the edge.

        Args:
            tool: The tool.
            edge: Its cutting edge.
            head: What is above its holder; None: nothing.
        """
        self._edge = dataclasses.astuple(edge)
        shank = tool.diameter if tool.shank is None else tool.shank
        self._uprights: list[Upright] = [
            _Cylinder("holder", 0.5 * max(tool.holder, shank), tool.below_holder),
            *(() if head is None else head(tool)),
        ]
        if tool.flute < tool.below_holder:
            name = "shank" if shank > tool.diameter else "flute"
            self._uprights.append(_Cylinder(name, 0.5 * shank, tool.flute))
        self._most = {
            solid.name: BRUSH_MM if solid.name == "flute" else SCRAPE_MM for solid in self._uprights
        } | {EDGE: BRUSH_MM}

    def measure(
        self, material: HeightMap, points: Points, suspect: BoolArray, *, doubtful: bool = False
    ) -> dict[str, Overlap]:
        """What reaches into the material as it is, along each stretch.

        Args:
            material: The material.
            points: Ends of n stretches.
            suspect: In which of them the edge must not cut, shape (n,).
            doubtful: Whether they cut walls of their own that later ones meet: nothing that these may
                meet is left out then.

        Returns:
            By name; zero where something reaches no further than it may.
        """
        count = len(suspect)
        lowest = points.tip[:, 2].min()
        stood = Stood(material.heights, material.behind, material.grid, doubtful)
        found = {}
        for solid in self._uprights:
            if lowest + solid.above < material.top:
                overlap = Overlap(*np.zeros((2, count)))
                self._hold(solid, stood, points, overlap)
                found[solid.name] = overlap
        if suspect.any() and lowest < material.top:
            overlap = Overlap(*np.zeros((2, count)))
            round_overlap(stood, points.tip, self._edge, 0.0, overlap)
            overlap.reach[~suspect] = 0.0
            found[EDGE] = overlap
        for name, overlap in found.items():
            overlap.depth[overlap.reach <= self._most[name]] = 0.0
        return {name: overlap for name, overlap in found.items() if overlap.depth.any()}

    def _hold(self, solid: Upright, stood: Stood, points: Points, overlap: Overlap) -> None:
        (x, y), turn = solid.offset, points.turn
        middle = points.tip.copy()
        if x or y:
            middle[:, 0] += x * turn[:, 0] - y * turn[:, 1]
            middle[:, 1] += x * turn[:, 1] + y * turn[:, 0]
        if solid.round:
            profile = (solid.half[0], solid.half[0], 0.0, 0.0)
            round_overlap(stood, middle, profile, solid.above, overlap)
        else:
            middle[:, 2] += solid.above
            box_overlap(stood, middle, turn, solid.half, overlap)
