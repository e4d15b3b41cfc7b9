"""The time that tool changes and the spindle take, as dwells of the program."""

import dataclasses
from collections.abc import Iterable, Iterator, Mapping

from twin.job.job_file import JobFile
from twin.machine.description.machine_file import SpindleTable
from twin.nc.canonical import Chunk, Dwell, Event, Function
from twin.nc.functions import PROGRAM_ENDS, TOOL_CHANGE, SpindleState


def with_spindle_dwells(
    chunks: Iterable[Chunk], spindle: SpindleTable, job: JobFile, state: SpindleState
) -> Iterator[Chunk]:
    """A program with a dwell behind every function that a machine takes time for.

    A tool change takes ``tool_change_s`` behind the spindle's stop; one that brings the tool that
    is in the spindle takes only the stop. Whatever changes the spindle's speed takes the change over
    ``acceleration``, if the machine ``waits`` for it; a speed that neither program nor job says
    takes none. The program's end is not waited for, nor is what happens in the middle of a path that
    goes on.

    Args:
        job: Says the first tool, and the speeds of tools for programs that say none.
    """
    if not spindle.tool_change_s and not spindle.acceleration:
        yield from chunks
        return
    speeds = {tool.number: tool.speed for tool in job.tools}
    spindle_dwells = SpindleDwells(spindle, speeds, job.tools[0].number, state)
    for chunk in chunks:
        yield dataclasses.replace(chunk, events=tuple(spindle_dwells.among(chunk.events)))


class SpindleDwells:
    """Follows the tool in the spindle and its speed."""

    def __init__(
        self,
        spindle: SpindleTable,
        speeds: Mapping[int, float | None],
        tool: int,
        state: SpindleState,
        selected: int | None = None,
    ) -> None:
        """Begin with what is in the spindle.

        Args:
            speeds: Of the tools, for programs that say none [1/min].
            selected: Number of the tool that the next change brings; None: the one in the spindle.
        """
        self._spindle = spindle
        self._speeds = speeds
        self._tool = tool
        self._selected = tool if selected is None else selected
        self._state = state
        self._turns = state.turning or 0.0

    def among(self, events: Iterable[Event]) -> Iterator[Event]:
        """The events with their dwells."""
        for event in events:
            yield event
            if isinstance(event, Function):
                seconds = self._seconds_for(event)
                if seconds > 0.0 and event.at == 0.0:
                    yield Dwell(event.before, event.line, seconds)

    def _seconds_for(self, event: Function) -> float:
        """How long the machine takes for a function [s]."""
        word = event.word
        if word[:1] == "T" and word[1:].isdigit():
            self._selected = int(word[1:])
        if word not in PROGRAM_ENDS:
            self._state = self._state.after(event)
        change = 0.0
        if word == TOOL_CHANGE and self._selected != self._tool:
            self._tool, change = self._selected, self._spindle.tool_change_s
            self._state = dataclasses.replace(self._state, tool_speed=self._speeds.get(self._tool))
        return change + self._turn(self._state.turning or 0.0)

    def _turn(self, turns: float) -> float:
        """How long the spindle takes to another speed [s], negative counter-clockwise [1/min]."""
        change, self._turns = abs(turns - self._turns), turns
        spindle_dwells = self._spindle.waits and self._spindle.acceleration > 0.0
        return change / self._spindle.acceleration if spindle_dwells else 0.0
