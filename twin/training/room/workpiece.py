"""The stock on the table while it is cut live, and the feeler that says when a tool touches it."""

import math

import numpy as np

from twin.columns import join
from twin.cutting.cut import Cutter
from twin.cutting.height_map import BoolArray, HeightMap
from twin.cutting.material import Head
from twin.cutting.sweeping import Rectangle, union
from twin.job.job_file import StockTable, ToolTable
from twin.machine.watching.alarms import Alarm
from twin.nc.canonical import FloatArray
from twin.recording.reader import Samples
from twin.run.machining import stock_alarm
from twin.toolpath.part_frame import PartFrame
from twin.training.room.touch import Touch, touch

CUT_AT_ONCE = 30
"""Samples of a feed that are cut together: most of what cutting costs is asked once for each call."""


class Workpiece:
    """The stock of a scene.

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
            stock: The blank.
            tool: What is in the spindle.
            part_frame: How the part turns under the tool.
            zero: Machine coordinates of program zero, shape (k,) [mm or deg].
            head: What is above a tool's holder; None: nothing.

        Raises:
            ConfigError: The stock is wrong.
        """
        self._stock = stock
        self._frame = part_frame
        self._zero = zero
        self._head = head
        self._cutter = Cutter(stock, tool, part_frame, zero, halts=True, head=head)
        self._uncut: list[tuple[Samples, BoolArray, BoolArray]] = []
        self.removed = 0.0
        self._changed: Rectangle = (0, 0, 0, 0)

    @property
    def map(self) -> HeightMap:
        """The height map as cut so far."""
        return self._cutter.map

    def mount(self, tool: ToolTable) -> None:
        """Go on with another tool."""
        self._uncut = []
        before = self._cutter.material
        self._cutter = Cutter(
            self._stock, tool, self._frame, self._zero, halts=True, head=self._head
        )
        before.begin_chunk()
        self._cutter.material = before

    def cut(
        self, tips: Samples, rapid: BoolArray, standing: BoolArray, *, at_once: bool
    ) -> Alarm | None:
        """Take samples of the tool's tip, and cut along them when there are enough.

        Args:
            tips: n samples, with positions as if the first tool were in the spindle.
            rapid: Which belong to rapids, shape (n,).
            standing: During which the spindle stands, shape (n,).
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
        if removed > 0.0:
            self._changed = union(self._changed, self._cutter.changed)
        halted = self._cutter.halted
        return None if halted is None else stock_alarm(halted, self._cutter.tool)

    def height_at(self, x: float, y: float) -> float:
        """How high the part stands at a place, program coordinates at C0 [mm]."""
        map_ = self._cutter.map
        corner = self._frame.program_zero(self._zero)
        column = round((x + corner[0] - map_.origin[0]) / map_.cell)
        row = round((y + corner[1] - map_.origin[1]) / map_.cell)
        rows, columns = map_.heights.shape
        inside = 0 <= row < rows and 0 <= column < columns
        return float(map_.heights[row, column] - corner[2]) if inside else -math.inf

    def program_place(self, row: int, column: int) -> tuple[float, float]:
        """X and Y of a cell of the map, program coordinates at C0 [mm]."""
        map_ = self._cutter.map
        corner = self._frame.program_zero(self._zero)
        x, y = map_.origin[0] + column * map_.cell, map_.origin[1] + row * map_.cell
        return float(x - corner[0]), float(y - corner[1])

    def take_changed(self) -> Rectangle:
        """Cells that have changed since the last call; none when the rows end before they begin."""
        changed, self._changed = self._changed, (0, 0, 0, 0)
        return changed

    def forgive(self) -> None:
        """An alarm has been cleared: only what comes from now on counts."""
        self.mount(self._cutter.tool)

    def touch(self, tip: FloatArray) -> Touch:
        """How the end of the tool stands to the part.

        Args:
            tip: Machine coordinates of the tip, shape (k,) [mm or deg].
        """
        place = self._frame.position(tip[None])[0]
        return touch(self._cutter.map, place, self._cutter.tool.diameter)

    def touches(self, tip: FloatArray) -> bool:
        """Whether the end of the tool touches the part; see ``touch``."""
        return self.touch(tip).meets
