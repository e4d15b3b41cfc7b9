"""What must not go into the stock: shank, holder and head at any time, the edge in a rapid."""

import dataclasses
import math

import numpy as np

from twin.cutting.heights.height_map import HeightMap
from twin.cutting.kernels.overlap import Overlap, Stood, box_overlap, round_overlap
from twin.cutting.material import EDGE, Head, Points, Upright, runs_of
from twin.cutting.tools import Profile
from twin.cutting.watching.events import SCRAPE_MM
from twin.job.job_file import ToolTable
from twin.nc.canonical import BoolArray

BRUSH_MM = 0.03
"""How far a cutter may reach into a wall beside it without being said to meet it [mm]: its path back
along a wall is off the path there by what the force bent, and cells of the wall go."""


@dataclasses.dataclass(frozen=True, slots=True)
class _Cylinder:
    """A cylinder about the tool's axis; see ``Upright``."""

    name: str
    radius: float
    above: float
    height: float = math.inf
    offset: tuple[float, float] = (0.0, 0.0)
    round: bool = True
    beyond: tuple[int, ...] = ()

    @property
    def half(self) -> tuple[float, float]:
        """Half of its size along machine X and Y [mm]."""
        return self.radius, self.radius


def above_edge(tool: ToolTable, head: Head | None) -> list[Upright]:
    """What is above a tool's edge: its shank, its holder, and the head."""
    shank = tool.diameter if tool.shank is None else tool.shank
    found: list[Upright] = [
        _Cylinder("holder", 0.5 * max(tool.holder, shank), tool.below_holder),
        *(() if head is None else head(tool)),
    ]
    if tool.flute < tool.below_holder:
        name = "shank" if shank > tool.diameter else "flute"
        found.append(_Cylinder(name, 0.5 * shank, tool.flute))
    return found


class StockContact:
    """Measures one tool against the material."""

    def __init__(
        self, material: HeightMap, tool: ToolTable, edge: Profile, head: Head | None
    ) -> None:
        """Say what is above the edge.

        Args:
            head: What is above its holder; None: nothing.
        """
        self._material = material
        self._edge = edge
        self._uprights = above_edge(tool, head)
        self._most = {
            solid.name: BRUSH_MM if solid.name == "flute" else SCRAPE_MM for solid in self._uprights
        } | {EDGE: BRUSH_MM}

    def measure(
        self, points: Points, suspect: BoolArray, *, provisional: bool = False
    ) -> dict[str, Overlap]:
        """What reaches into the material as it is, along each stretch; see ``Contact``."""
        material = self._material
        count = len(suspect)
        stood = Stood(material.heights, material.behind, material.grid, provisional)
        found = {}
        for solid in self._uprights:
            places = points.carrying(solid)
            if places.tip[:, 2].min() + solid.above < material.top:
                overlap = Overlap(*np.zeros((2, count)))
                self._hold(solid, stood, places, overlap)
                found[solid.name] = overlap
        if suspect.any() and points.tip[:, 2].min() < material.top:
            overlap = Overlap(*np.zeros((2, count)))
            for run in runs_of(suspect):
                tips = points.tip[run.start : run.stop + 1]
                round_overlap(stood, tips, self._edge, 0.0, overlap.part(run))
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
            profile = Profile(solid.half[0], solid.half[0])
            round_overlap(stood, middle, profile, solid.above, overlap)
        else:
            middle[:, 2] += solid.above
            box_overlap(stood, middle, turn, solid.half, overlap)
