"""The tools that are assumed for a raw program: of the comments of posts, and of what they do."""

import json
import re
from collections.abc import Collection, Mapping, Sequence
from typing import NamedTuple

import numpy as np

from twin.nc.canonical import Motion, Moves
from twin.run.reading.tool_comments import ToolComment, listed_tools, near_comment, while_in_spindle

_USUAL_DIAMETER = 10.0
USUAL_LENGTH, _USUAL_FLUTE = 60.0, 25.0
SPEED_BY_HAND = 10_000.0
"""What a spindle turns at whose speed no program sets: the dials of trim routers reach from there to 30,000 [1/min]."""
_SPEED_LINE = f"speed = {SPEED_BY_HAND}  # 1/min: a guess"
_CENTERS = re.compile(r"SPOT|CENT(?:ER|RE) ?DRILL", re.IGNORECASE)
"""Tools of the kind chamfer that cut over their centre."""
BELOW = 1e-6
"""Ways and depths that are less are none [mm]."""


class ToolLines(NamedTuple):
    """The tools of a program.

    Attributes:
        lines: Of the job file.
        notes: How each came about, for people.
        largest: The largest diameter [mm].
        guessed: Numbers of those whose diameter nothing tells.
    """

    lines: list[str]
    notes: list[str]
    largest: float
    guessed: tuple[int, ...]


def tool_lines(
    calls: list[tuple[int, int, int]],
    comments: Sequence[tuple[int, str]],
    moves: Moves,
    declared: Mapping[int, ToolComment],
    *,
    inches: bool,
    top: float,
    least_length: float,
    worn: Collection[int] = (),
    by_hand: bool = False,
) -> ToolLines:
    """The tools that the program calls.

    Args:
        calls: Number, line and next move of every tool that comes.
        comments: Lines and texts.
        declared: Tools that the program itself gives their data.
        top: Of the stock [mm].
        least_length: So long is each tool at least [mm].
        worn: Tools of which the control's table holds the wear alone.
        by_hand: The spindle's speed is set by hand.
    """
    called = dict.fromkeys(number for number, _, _ in calls)
    numbers = [number for number in called if number or _feeds(0, calls, moves)] or [1]
    listed = listed_tools((comment for _, comment in comments), numbers, inches=inches)
    lines: list[str] = []
    notes: list[str] = []
    guessed: list[int] = []
    largest = 0.0
    for number in numbers:
        own = declared.get(number)
        tool = own if own and own.diameter else None
        tool = (
            tool
            or listed.get(number)
            or near_comment(number, calls, comments, inches=inches)
            or while_in_spindle(number, calls, comments, inches=inches)
            or own
        )
        if own and tool:
            tool = tool._replace(name=own.name, length=own.length or tool.length)
        rows = _rows_of(number, calls, len(moves))
        more, said, diameter = _tool_table(
            (number, tool), moves, rows, top=top, least_length=least_length, worn=number in worn
        )
        lines += [*more, *([_SPEED_LINE] if by_hand else []), ""]
        notes.append(said)
        guessed += [] if tool and tool.diameter else [number]
        largest = max(largest, diameter)
    return ToolLines(lines, notes, largest, tuple(guessed))


def _rows_of(number: int, calls: list[tuple[int, int, int]], count: int) -> list[int]:
    """Moves with a tool; all of them where no tool is called."""
    if not calls:
        return list(range(count))
    rows: list[int] = []
    for place, (each, _, begin) in enumerate(calls):
        end = calls[place + 1][2] if place + 1 < len(calls) else count
        if each == number:
            rows += range(begin, end)
    return rows


def _feeds(number: int, calls: list[tuple[int, int, int]], moves: Moves) -> bool:
    """Whether a tool is fed anywhere; T0 that is not means an empty spindle."""
    return bool((moves.motion[_rows_of(number, calls, len(moves))] == Motion.FEED).any())


def _tool_table(
    called: tuple[int, ToolComment | None],
    moves: Moves,
    rows: list[int],
    *,
    top: float,
    least_length: float,
    worn: bool,
) -> tuple[list[str], str, float]:
    """A tool's lines, how it came about, and its diameter [mm]."""
    number, tool = called
    at = np.array(rows, np.int64)
    feeds = at[moves.motion[at] == Motion.FEED]
    travel = moves.end[feeds, :2] - moves.start[feeds, :2]
    drills = len(feeds) > 0 and bool(
        (np.abs(travel) < BELOW).all() and not moves.sweep[feeds].any()
    )
    depth = max(0.0, top - float(moves.end[feeds, 2].min())) if len(feeds) else 0.0
    kind = (tool.kind if tool else "") or ("drill" if drills else "flat")
    diameter = (tool.diameter if tool else None) or _USUAL_DIAMETER
    flute = max(_USUAL_FLUTE, np.ceil(depth + 5.0))
    length = max(USUAL_LENGTH, np.ceil(flute * 1.6 + 20.0), np.ceil(least_length))
    length_from = "a guess"
    if tool and tool.length:
        length, length_from = tool.length, "the program's own"
        flute = min(flute, length)
    kind_from = "its comment" if tool and tool.kind else "what it does"
    size_from = tool.source if tool and tool.diameter else "a guess"
    lines = [
        "[[tools]]",
        f"number = {number}" + (f"  # {_plain(tool.text)}" if tool else ""),
        f'kind = "{kind}"  # flat, ball, bull, drill, chamfer: from {kind_from}',
        f"diameter = {round(float(diameter), 4)}  # mm: {size_from}",
        *([f"name = {json.dumps(tool.name)}"] if tool and tool.name else []),
        *(
            ["center_cutting = true"]
            if kind == "chamfer" and tool and _CENTERS.search(tool.text)
            else []
        ),
        *([f"corner = {tool.corner}  # mm"] if tool and tool.corner and kind == "bull" else []),
        *(["radius_offset = 0.0  # D has only its wear"] if worn else []),
        f"flute = {flute:.1f}  # mm: a guess",
        f"length = {round(float(length), 4)}  # from the spindle nose to the tip, mm: {length_from}",
    ]
    said = f"T{number} {kind} of {diameter:g} mm: " + (
        f"from {tool.source} ({_plain(tool.text)})"
        if tool and tool.diameter
        else "diameter is a guess"
    )
    if length > USUAL_LENGTH and length_from == "a guess":
        said += f"; {length:g} mm long, a guess: so far it must reach"
    said += "; D has only its wear, the contours are the path of its centre" if worn else ""
    return lines, said, diameter


def _plain(text: str) -> str:
    """A comment of a program as one of a job file."""
    return "".join(each for each in text if each.isprintable())[:80]
