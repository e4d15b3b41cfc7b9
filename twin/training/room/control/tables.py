"""The control's tables: where it believes part zero to be, and what it believes of the tools."""

from collections.abc import Mapping

import numpy as np

from twin.errors import UsageError
from twin.job.job_file import ToolTable
from twin.nc.canonical import FloatArray

MAGAZINE_PLACES = 40
"""Tools that fit, in addition to the edge finder."""


class Tables:
    """Part zero and tool lengths, as the control has them and as they are.

    Machine coordinates count for the first tool; with a longer one the head is higher by the
    difference, which the control takes from its table and the material from the tool.

    Attributes:
        zero: Machine coordinates of part zero in the control's table, shape (k,) [mm or deg].
        true_zero: Where it is.
        lengths: Tool lengths in the control's table, by number [mm].
        radii: Tool radii in the control's table, by number [mm].
        offsets: Work offsets by name, each by axis, from part zero [mm or deg].
        first: Number of the tool that the job begins with.
        finder: Number of the edge finder; None: the magazine has none.
    """

    def __init__(
        self,
        true_zero: FloatArray,
        tools: tuple[ToolTable, ...],
        offsets: Mapping[str, Mapping[str, float]],
    ) -> None:
        self.true_zero = true_zero
        self.zero = true_zero.copy()
        self.tools = {tool.number: tool for tool in tools}
        self.lengths = {tool.number: tool.length for tool in tools}
        self.radii = {tool.number: tool.table_radius for tool in tools}
        self.offsets = {name: dict(values) for name, values in offsets.items()}
        self.spindle = self.first = tools[0].number
        self.finder: int | None = None
        self._reference = tools[0].length

    @property
    def tool(self) -> ToolTable:
        """The tool in the spindle."""
        return self.tools[self.spindle]

    @property
    def program_zero(self) -> FloatArray:
        """Machine coordinates of program zero with the tool in the spindle, shape (k,)."""
        return self.zero + self._along_z(self.lengths[self.spindle] - self._reference)

    def longer_by_table(self) -> dict[int, float]:
        """How much longer than the first each tool is in the control's table, by number [mm]."""
        return {number: length - self._reference for number, length in self.lengths.items()}

    @property
    def tip_zero(self) -> FloatArray:
        """Machine coordinates at which the tip is on the part's true zero, shape (k,)."""
        return self.true_zero + self.length_difference

    @property
    def length_difference(self) -> FloatArray:
        """How much higher the head is than with the first tool, shape (k,) [mm]."""
        return self._along_z(self.tool.length - self._reference)

    def mount(self, number: int) -> None:
        """Another tool is in the spindle."""
        self.spindle = number

    def set_zero(self, column: int, value: float) -> None:
        """Write part zero of an axis, machine coordinates [mm or deg]."""
        self.zero[column] = value

    def shift_zero(self, column: int, value: float) -> None:
        """Move part zero of an axis [mm or deg]."""
        self.zero[column] += value

    def set_tool(self, number: int, length: float | None, radius: float | None) -> None:
        """Write a tool's length and radius [mm]; None keeps the value.

        Raises:
            UsageError: There is no such tool.
        """
        if number not in self.lengths:
            known = ", ".join(str(each) for each in self.lengths)
            raise UsageError(f"no tool {number}: the table has {known}")
        if length is not None:
            self.lengths[number] = length
        if radius is not None:
            self.radii[number] = radius

    def add_tool(self, tool: ToolTable) -> None:
        """Put another tool into the magazine, with a row that says what it measures.

        Raises:
            UsageError: Its number is taken, or the magazine is full.
        """
        if tool.number in self.tools:
            raise UsageError(f"T{tool.number} is in the table already: choose another number")
        if len(self.tools) - (self.finder is not None) >= MAGAZINE_PLACES:
            raise UsageError(f"the magazine has {MAGAZINE_PLACES} places, and all are taken")
        self._enter(tool)

    def _enter(self, tool: ToolTable) -> None:
        self.tools[tool.number] = tool
        self.lengths[tool.number] = tool.length
        self.radii[tool.number] = tool.table_radius

    def add_finder(self, finder: ToolTable) -> None:
        """Put an edge finder into a place of its own, under a number that is free."""
        self._enter(finder)
        self.finder = finder.number

    def set_offset(self, name: str, axis: str, value: float) -> float:
        """Write a work offset of an axis [mm or deg].

        Returns:
            By how much it has changed.

        Raises:
            UsageError: The control has no such offset.
        """
        if name not in self.offsets:
            known = ", ".join(self.offsets) or "none"
            raise UsageError(f"no work offset {name}: the table has {known}")
        before = self.offsets[name].get(axis, 0.0)
        self.offsets[name][axis] = value
        return value - before

    def _along_z(self, value: float) -> FloatArray:
        shift = np.zeros(len(self.zero))
        shift[2] = value
        return shift
