"""The stock on the table while it is cut live, and the feeler that says when a tool touches it."""

import math

import numpy as np

from twin.columns import join
from twin.cutting.cut import Cutter
from twin.cutting.heights.height_map import BoolArray, HeightMap
from twin.cutting.heights.sweeping import Rectangle, union
from twin.cutting.material import Head
from twin.cutting.tridexel.dexels import TriDexel
from twin.cutting.tridexel.material import TriDexelMaterial
from twin.job.job_file import StockTable, ToolTable
from twin.nc.canonical import FloatArray
from twin.recording.alarms import Alarm
from twin.recording.reader import Samples
from twin.run.machining import stock_alarm
from twin.toolpath.part_frame import PartFrame
from twin.training.room.setup.any_side import seen_from_above, surface_off, touch_any_side
from twin.training.room.setup.touch import Touch, touch

CUT_AT_ONCE = 30
"""Samples of a feed that are cut together: most of what cutting costs is asked once for each call."""


class Workpiece:
    """The stock of a scene: a height map, or, where the machine tilts it, intervals along three directions.

    Attributes:
        removed: Material taken off so far [mm³].
    """

    def __init__(
        self,
        stock: StockTable,
        tool: ToolTable,
        part_frame: PartFrame,
        zero: FloatArray,
        head: Head | None = None,
    ) -> None:
        """Clamp the blank.

        Args:
            zero: Machine coordinates of program zero, shape (k,) [mm or deg].
            head: What is above a tool's holder; None: nothing.

        Raises:
            ConfigError: The stock is wrong.
        """
        self._stock = stock
        self._frame = part_frame
        self._zero = zero
        self._head = head
        self._cutter = self._cutter_with(tool)
        self._uncut: list[tuple[Samples, BoolArray, BoolArray]] = []
        self.removed = 0.0
        self._changed: Rectangle = (0, 0, 0, 0)

    def _cutter_with(self, tool: ToolTable) -> Cutter:
        return Cutter(
            self._stock,
            tool,
            self._frame,
            self._zero,
            halts=True,
            head=self._head,
            tilts=self._frame.chain is not None,
        )

    @property
    def map(self) -> HeightMap | None:
        """The height map as cut so far; None: the part can be cut from any side."""
        return None if self._cutter.tilts else self._cutter.map

    @property
    def dexels(self) -> TriDexel | None:
        """The part as cut so far, where it can be cut from any side."""
        material = self._cutter.material
        return material.stock if isinstance(material, TriDexelMaterial) else None

    def mount(self, tool: ToolTable) -> None:
        """Go on with another tool."""
        self._uncut = []
        before = self._cutter.material
        self._cutter = self._cutter_with(tool)
        before.begin_chunk()
        self._cutter.material = before

    def cut(
        self, tips: Samples, rapid: BoolArray, standing: BoolArray, *, at_once: bool
    ) -> Alarm | None:
        """Take samples of the tool's tip, and cut along them when there are enough.

        Args:
            tips: n samples, with positions as if the first tool were in the spindle.
            rapid: Which belong to rapids, shape (n,).
            standing: During which the spindle is stopped, shape (n,).
            at_once: Whether to cut along all of them now.

        Returns:
            The alarm of a cut that must not be.
        """
        self._uncut.append((tips, rapid, standing))
        if not at_once and sum(len(one) for one, _, _ in self._uncut) < CUT_AT_ONCE:
            return None
        return self.catch_up()

    def catch_up(self) -> Alarm | None:
        """Cut along the samples that wait; the alarm of a cut that must not be."""
        if not self._uncut:
            return None
        tips, rapid, standing = zip(*self._uncut, strict=True)
        self._uncut = []
        removed = self._cutter.add(join(tips), np.concatenate(rapid), np.concatenate(standing))
        self.removed += removed
        if removed > 0.0 and not self._cutter.tilts:
            self._changed = union(self._changed, self._cutter.changed)
        halted = self._cutter.halted
        return None if halted is None else stock_alarm(halted, self._cutter.tool)

    def measured(self, x: float, y: float, z: float) -> float:
        """Z of the part at a place, program coordinates at C0 [mm].

        Of a part that can be cut from any side it is ``z`` and how far the surface is off along X, Y or Z, where it
        is nearest.
        """
        map_, corner = self.map, self._frame.program_zero(self._zero)
        if map_ is None:
            assert self.dexels is not None
            return z + surface_off(self.dexels, np.array([x, y, z]) + corner)
        column = round((x + corner[0] - map_.origin[0]) / map_.cell)
        row = round((y + corner[1] - map_.origin[1]) / map_.cell)
        rows, columns = map_.heights.shape
        inside = 0 <= row < rows and 0 <= column < columns
        return float(map_.heights[row, column] - corner[2]) if inside else -math.inf

    def view_from_above(self) -> tuple[FloatArray, tuple[float, float], float]:
        """Heights of the part, shape (ny, nx) [mm], X and Y of the first cell and its side [mm]."""
        if self.dexels is None:
            return self._cutter.map.heights, self._cutter.map.origin, self._cutter.map.cell
        x, y = self.dexels.lattice.origin[:2].tolist()
        return seen_from_above(self.dexels), (x, y), self.dexels.cell

    @property
    def ends(self) -> tuple[float, float]:
        """Underside and top of the blank [mm]."""
        low, high = self._cutter.material.corners[:, 2].tolist()
        return low, high

    def program_place(self, row: int, column: int) -> tuple[float, float]:
        """X and Y of a cell of the view from above, program coordinates at C0 [mm]."""
        _, origin, cell = self.view_from_above()
        corner = self._frame.program_zero(self._zero)
        x, y = origin[0] + column * cell, origin[1] + row * cell
        return float(x - corner[0]), float(y - corner[1])

    def take_changed(self) -> Rectangle:
        """Cells that have changed since the last call; none when the rows end before they begin."""
        changed, self._changed = self._changed, (0, 0, 0, 0)
        return changed

    def forgive(self) -> None:
        """An alarm has been cleared: only what comes from now on counts."""
        self.mount(self._cutter.tool)

    def touch(self, tip: FloatArray) -> Touch:
        """Where the end of the tool is relative to the part.

        Args:
            tip: Machine coordinates of the tip, shape (k,) [mm or deg].
        """
        place, tool = self._frame.position(tip[None])[0], self._cutter.tool
        if self.dexels is not None:
            axis = self._frame.tool_direction(tip[None])[0]
            return touch_any_side(self.dexels, place, axis, tool)
        return touch(self._cutter.map, place, tool.diameter)

    def touches(self, tip: FloatArray) -> bool:
        """Whether the end of the tool touches the part; see ``touch``."""
        return self.touch(tip).meets
