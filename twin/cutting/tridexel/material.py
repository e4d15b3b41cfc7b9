"""A tri-dexel stock as the material of a cut."""

import math
from collections.abc import Mapping
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike

from twin.cutting.heights.part import export_glb
from twin.cutting.kernels.overlap import Overlap
from twin.cutting.kernels.simplify import simplify
from twin.cutting.kernels.sweep import Removal, settle
from twin.cutting.material import (
    AIR_MM,
    EDGE,
    LONGEST_SHARE,
    MOST_JOINED,
    STRAIGHT_MM,
    STRAIGHT_SHARE,
    Head,
    Points,
    Upright,
    runs_of,
)
from twin.cutting.tools import Profile
from twin.cutting.tridexel.boxes import Box, boxes_met
from twin.cutting.tridexel.dexels import TriDexel
from twin.cutting.tridexel.engagement import cut, met
from twin.cutting.tridexel.normals import MOST_TOOLS
from twin.cutting.tridexel.solids.moving_solid import Poses
from twin.cutting.tridexel.solids.solids import Solid, cutting_edge, cylinder, thinner
from twin.cutting.tridexel.surface.mesh import part_colours, part_mesh, surface
from twin.cutting.watching.events import SCRAPE_MM
from twin.cutting.watching.stock_contact import BRUSH_MM, above_edge
from twin.files.atomic import complete_or_absent
from twin.files.stl import stl_text
from twin.job.job_file import ToolTable
from twin.nc.canonical import BoolArray, FloatArray, IntArray

ABOVE_MM = 1000.0
"""How far holder and head reach up: beyond any part."""


class TriDexelMaterial:
    """Cuts a tri-dexel stock; see ``Material``.

    Attributes:
        changed: Whether anything was taken off since ``begin_chunk``.
    """

    def __init__(self, stock: TriDexel) -> None:
        self.stock = stock
        self._owed = 0.0
        self.changed = False

    @property
    def cell(self) -> float:
        """Between neighbouring lines [mm]."""
        return self.stock.cell

    @property
    def corners(self) -> FloatArray:
        """Two opposite corners of the box around the blank, shape (2, 3) [mm]."""
        return self.stock.corners

    def begin_chunk(self) -> None:
        """Forget what has changed so far."""
        self.changed = False

    def straight(self, points: Points, group: IntArray, edge: Profile) -> IntArray:
        """Choose samples between which tip and edge moved straight: a turning tool keeps no direction."""
        poses = _poses(points)
        reach = np.linalg.norm(np.diff(self.stock.corners, axis=0))
        return simplify(
            np.stack([poses.tip, poses.tip + reach * poses.axis]),
            group,
            min(STRAIGHT_SHARE * self.cell, STRAIGHT_MM),
            LONGEST_SHARE * edge.radius,
            MOST_JOINED,
        )

    def contact(self, tool: ToolTable, edge: Profile, head: Head | None) -> "TriDexelContact":
        """What measures a tool with what is round above it against the material."""
        return TriDexelContact(self.stock, tool, edge, head)

    def take_off(
        self, points: Points, tool: ToolTable, edge: Profile, travelled: FloatArray, *, stood: bool
    ) -> Removal:
        """Cut what a tool meets."""
        del travelled, stood
        poses = _poses(points)
        number = min(max(tool.number, 1), MOST_TOOLS)
        found = cut(self.stock, poses, cutting_edge(edge, tool.flute), number)
        self.changed = self.changed or bool(found.touched.any())
        travel = np.diff(poses.tip, axis=0)
        axis = poses.axis[1:]
        left = np.cross(axis, travel)
        length = np.linalg.norm(left, axis=1)
        middle = found.middle - 0.5 * (poses.tip[1:] + poses.tip[:-1])
        aside = (middle * left).sum(axis=1) / np.where(length > 0.0, length, 1.0)
        # A hair's breadth about a node counts for a part of its cell.
        cuts, volume = found.longest > AIR_MM, found.volume.copy()
        self._owed = settle(volume, cuts, -math.inf, self._owed)
        seen = cuts & (length > 0.0)
        depth, thickness = np.where(cuts, found.depth, 0.0), np.where(cuts, found.thickness, 0.0)
        return Removal(volume, depth, np.where(seen, aside, 0.0), thickness)

    def write_stl(self, path: Path, zero: ArrayLike) -> None:
        """Write the part as binary STL."""
        found = surface(self.stock)
        text = stl_text((found.points - np.asarray(zero))[found.faces])
        with complete_or_absent(path) as temporary:
            temporary.write_bytes(text)

    def write_glb(self, path: Path) -> None:
        """Write the part as binary glTF."""
        export_glb(part_mesh(self.stock, part_colours), path)

    def picture(self) -> bytes:
        """None: from above a part that was cut from several sides is not seen whole."""
        return b""


class TriDexelContact:
    """Measures one tool against the material; see ``Contact``.

    Each solid is held against it without the outer layer that may brush a wall.
    """

    def __init__(self, stock: TriDexel, tool: ToolTable, edge: Profile, head: Head | None) -> None:
        """Say what is above the edge; see ``StockContact``."""
        self._stock = stock
        self._edge = cutting_edge(edge, tool.flute)
        self._solids: dict[str, tuple[Solid, float]] = {}
        self._boxes: list[Upright] = []
        for each in above_edge(tool, head):
            if each.round and not any(each.offset) and not each.beyond:
                high = tool.below_holder if each.name in ("shank", "flute") else ABOVE_MM
                solid = cylinder(each.half[0], each.above, max(high, each.above))
                self._solids[each.name] = (solid, BRUSH_MM if each.name == "flute" else SCRAPE_MM)
            else:
                self._boxes.append(each)

    def measure(
        self, points: Points, suspect: BoolArray, *, provisional: bool = False
    ) -> Mapping[str, Overlap]:
        """What reaches into the material as it is, along each stretch."""
        del provisional
        poses, found = _poses(points), {}
        for name, (solid, layer) in self._solids.items():
            found[name] = self._depth(poses, solid, layer)
        for solid in self._boxes:
            places = points.carrying(solid)
            depth = boxes_met(self._stock, _poses(places), places.turn, _box_around(solid))
            found[solid.name] = np.where(depth > SCRAPE_MM, depth, 0.0)
        if suspect.any():
            found[EDGE] = np.zeros(len(suspect))
        for run in runs_of(suspect):
            here = slice(run.start, run.stop + 1)
            part = Poses(poses.tip[here], poses.axis[here])
            found[EDGE][run] = np.max(
                [self._depth(part, solid, BRUSH_MM) for solid in self._edge], axis=0
            )
        return {name: Overlap(depth, depth) for name, depth in found.items() if depth.any()}

    def _depth(self, poses: Poses, solid: Solid, layer: float) -> FloatArray:
        depth = met(self._stock, poses, thinner(solid, layer))
        return np.where(depth > 0.0, depth + layer, 0.0)


def _box_around(solid: Upright) -> Box:
    (x, y), (half_x, half_y) = solid.offset, solid.half
    low = (x - half_x, y - half_y, solid.above)
    return Box(low, (x + half_x, y + half_y, solid.above + solid.height))


def _poses(points: Points) -> Poses:
    assert points.axis is not None
    return Poses(points.tip, points.axis)
