"""The tools in use: which one is in the spindle, which comes next, and what they measure."""

import math
from collections.abc import Mapping

from twin.nc.bytecode.registers import IN_SPINDLE, SELECTED, Cells
from twin.nc.control.settings import ToolData


class Tools:
    """The tool table with its state.

    Attributes:
        table: Tools by number.
        any: The tool that every other number means; None: there is none.
    """

    def __init__(
        self, table: Mapping[int, ToolData], registers: Cells, *, any_tool: bool = False
    ) -> None:
        """Put the first tool into the spindle; ``any_tool``: every number means this one."""
        self.table = table
        first = next(iter(table), None)
        self.any = table[first] if any_tool and first is not None else None
        self._reference = 0.0 if first is None else table[first].length
        self._registers = registers
        self.spindle = self.selected = first

    @property
    def spindle(self) -> int | None:
        """Number of the tool in the spindle."""
        return _number(self._registers[IN_SPINDLE])

    @spindle.setter
    def spindle(self, number: int | None) -> None:
        self._registers[IN_SPINDLE] = math.nan if number is None else number

    @property
    def selected(self) -> int | None:
        """Number of the tool that the next change brings."""
        return _number(self._registers[SELECTED])

    @selected.setter
    def selected(self, number: int | None) -> None:
        self._registers[SELECTED] = math.nan if number is None else number

    def change(self) -> None:
        """The selected tool goes into the spindle."""
        self._registers[IN_SPINDLE] = self._registers[SELECTED]

    def data(self, number: int | None) -> ToolData | None:
        """What a tool measures; None where the table lacks it."""
        return None if number is None else self.table.get(number, self.any)

    def longer(self, tool: ToolData) -> float:
        """How much longer a tool is than the one that the part zero was taken with [mm]."""
        return tool.length - self._reference


def _number(register: float) -> int | None:
    return None if math.isnan(register) else int(register)
