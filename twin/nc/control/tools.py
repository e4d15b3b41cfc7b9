"""The tools in use: which one is in the spindle, which comes next, and what they measure."""

from collections.abc import Mapping

from twin.nc.control.settings import ToolData

LENGTH_ENDED = 0
"""What a block calls that ends the tool's length."""


class Tools:
    """The tool table with its state.

    Attributes:
        any: The tool that every other number means; None: there is none.
        names: Numbers of tools that the program has called by names which the job does not give.
        written: Radius and length that the program has written into the control's table, by number [mm].
        selected: Number of the tool that the next change brings.
        length_call: Number of the tool whose length the block that runs calls, or ``LENGTH_ENDED``; None: it calls none.
        rigid: Tapping cycles start the spindle themselves, where it stands, and stop it behind each hole.
        drills: The block that runs makes a hole by a drilling cycle, which neither bores, reams, taps nor counterbores.
    """

    def __init__(self, table: Mapping[int, ToolData], *, any_tool: bool = False) -> None:
        """Put the first tool into the spindle; ``any_tool``: every number means this one."""
        self.table = table
        self.names: dict[str, int] = {}
        self.written: dict[int, dict[str, float]] = {}
        first = next(iter(table), None)
        self.any = table[first] if any_tool and first is not None else None
        self._reference = 0.0 if first is None else table[first].length
        self.spindle = self.selected = first
        self.length_call: int | None = None
        self.rigid = False
        self.drills = False

    def note_written(self, number: int, field: str, value: float) -> None:
        """The program writes ``radius`` or ``length`` of a tool into the control's table [mm]."""
        self.written.setdefault(number, {})[field] = value

    def change(self) -> None:
        """The selected tool goes into the spindle."""
        self.spindle = self.selected

    def data(self, number: int | None) -> ToolData | None:
        """What a tool measures; None where the table lacks it."""
        return None if number is None else self.table.get(number, self.any)

    def length_difference(self, tool: ToolData) -> float:
        """How much longer a tool is than the one that the part zero was taken with [mm]."""
        return tool.length - self._reference
