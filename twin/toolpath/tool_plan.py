"""Which tool is in the spindle during which moves of a program."""

import bisect
import dataclasses
import itertools
from typing import NamedTuple

import numpy as np

from twin.job.job_file import ToolTable
from twin.nc.canonical import FloatArray, IntArray


class ToolChange(NamedTuple):
    """A tool that comes into the spindle."""

    move: int
    line: int
    tool: ToolTable


@dataclasses.dataclass(frozen=True, slots=True)
class ToolPlan:
    """Which tool is in the spindle during which moves of a program.

    Attributes:
        tools: In the order in which they come into the spindle; the first is in it at the start.
            A tool whose speed changes is there once for each speed.
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

    def length_difference(self, tool: ToolTable) -> float:
        """How much lower a tool's tip is than that of the first, which positions count for [mm]."""
        return tool.length - self.tools[0].length

    def lower(self, move: IntArray) -> FloatArray:
        """How much lower the tip is than that of the first tool, by the moves of samples, shape (n,) [mm]."""
        lower = np.zeros(len(move))
        for run, tool in self.runs(move):
            lower[run] = self.length_difference(tool)
        return lower

    def runs(self, move: IntArray) -> list[tuple[slice, ToolTable]]:
        """Split samples where the tool changes.

        Args:
            move: Move number of each sample, never falling, shape (n,).
        """
        if not len(move):
            return []
        first, last = (
            bisect.bisect_right(self.first_move, max(int(end), 0)) for end in move[[0, -1]]
        )
        begins = np.searchsorted(move, self.first_move[first:last]).tolist()
        ends = itertools.pairwise([0, *begins, len(move)])
        tools = self.tools[first - 1 : last]
        return [
            (slice(*run), tool) for run, tool in zip(ends, tools, strict=True) if run[0] < run[1]
        ]
