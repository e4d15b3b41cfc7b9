"""What a raw program writes itself into the tables of its control: its zero, lengths and radii of its tools."""

import dataclasses
from collections.abc import Mapping, Sequence

import numpy as np

from twin.nc.canonical import Chunk, Function, Moves
from twin.nc.control.settings import ToolData
from twin.nc.functions import TOOL_CHANGE
from twin.run.preparing.preparation import Preparation


def tool_calls(chunks: list[Chunk]) -> list[tuple[int, int, int]]:
    """Number, line and next move of every tool that comes: by M6, in a program without it by T alone."""
    selected: list[tuple[int, int, int]] = []
    changed: list[tuple[int, int, int]] = []
    done = 0
    for chunk in chunks:
        for event in chunk.events:
            if not isinstance(event, Function):
                continue
            if event.word[:1] == "T" and event.word[1:].isdigit():
                selected.append((int(event.word[1:]), event.line, done + event.before))
            elif event.word == TOOL_CHANGE and selected:
                changed.append((selected[-1][0], event.line, done + event.before))
        done += len(chunk.moves)
    return changed or selected


def with_written(
    preparation: Preparation,
    zero: Mapping[str, float],
    tools: Mapping[int, Mapping[str, float]],
    called: Sequence[int],
) -> Preparation:
    """A control that has in its tables what the program writes there: its zero lies at part zero, lengths count from its first tool's."""
    settings = preparation.settings
    usual = next(iter(settings.tools.values()))
    table = {
        number: dataclasses.replace(settings.tools.get(number, usual), **tools.get(number, {}))
        for number in (*called, *settings.tools, *tools)
    }
    settings = dataclasses.replace(settings, written_zero=zero or None, tools=table)
    return dataclasses.replace(preparation, settings=settings)


def at_the_tips(
    moves: Moves, calls: list[tuple[int, int, int]], tools: Mapping[int, ToolData]
) -> Moves:
    """Moves of each tool's own tip: those of an interpreter are of the first tool's."""
    reference = next(iter(tools.values())).length
    longer = np.zeros(len(moves))
    for number, _, begin in calls:
        longer[begin:] = tools[number].length - reference if number in tools else 0.0
    if not longer.any():
        return moves
    start, end = moves.start.copy(), moves.end.copy()
    start[:, 2] -= longer
    end[:, 2] -= longer
    return dataclasses.replace(moves, start=start, end=end)


def written_zero_lines(written: Mapping[str, float]) -> list[str]:
    """The job's line of the zero that the program writes."""
    values = ", ".join(f"{axis} = {value:g}" for axis, value in written.items())
    return [f"written_zero = {{ {values} }}  # what the program writes itself"] if written else []
