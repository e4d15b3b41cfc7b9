"""The tools that are assumed for a raw program: of the lists and comments of posts, and of what they do."""

import numpy as np

from twin.nc.canonical import Motion, Moves
from twin.nc.dialects.recognition import HEAD_LINES
from twin.run.tool_comments import ToolComment, numbered_tool, tool_of_comment

_USUAL_DIAMETER = 10.0
_USUAL_LENGTH, _USUAL_FLUTE = 60.0, 25.0
_NEAR_LINES = 3
"""So far from the call of a tool a comment may stand that describes it."""
BELOW = 1e-6
"""Ways and depths that are less are none [mm]."""


def tool_lines(
    calls: list[tuple[int, int, int]],
    comments: list[tuple[int, str]],
    moves: Moves,
    *,
    inches: bool,
) -> tuple[list[str], list[str], float]:
    """Lines of the tools that the program calls, how each came about, and the largest diameter [mm]."""
    numbers = list(dict.fromkeys(number for number, _, _ in calls if number)) or [1]
    listed: dict[int, ToolComment] = {}
    for _, comment in comments:
        found = numbered_tool(comment)
        if found is not None and found[0] in numbers:
            tool = tool_of_comment(found[1], inches=inches)
            if tool.diameter is not None or tool.kind:
                listed.setdefault(found[0], tool)
    lines: list[str] = []
    told: list[str] = []
    largest = 0.0
    for number in numbers:
        tool = listed.get(number) or _near_comment(number, calls, comments, inches=inches)
        rows = _rows_of(number, calls, len(moves))
        more, said, diameter = _tool_table(number, tool, moves, rows)
        lines += more
        told.append(said)
        largest = max(largest, diameter)
    return lines, told, largest


def _near_comment(
    number: int,
    calls: list[tuple[int, int, int]],
    comments: list[tuple[int, str]],
    *,
    inches: bool,
) -> ToolComment | None:
    """What a comment beside a tool's call tells of it; without a list, and one tool alone, any comment of the head."""
    lines = [line for each, line, _ in calls if each == number]
    near = [
        (abs(line - call), text)
        for line, text in comments
        for call in lines
        if abs(line - call) <= _NEAR_LINES
    ]
    if not lines:
        near = [(line, text) for line, text in comments if line <= HEAD_LINES]
    for _, text in sorted(near):
        tool = tool_of_comment(text, inches=inches)
        if tool.diameter is not None and tool.kind:
            return tool
    return None


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


def _tool_table(
    number: int, tool: ToolComment | None, moves: Moves, rows: list[int]
) -> tuple[list[str], str, float]:
    """A tool's lines, how it came about, and its diameter [mm]."""
    feeds = [row for row in rows if moves.motion[row] == Motion.FEED]
    ways = moves.end[feeds, :2] - moves.start[feeds, :2]
    drills = bool(feeds) and bool((np.abs(ways) < BELOW).all())
    depth = max(0.0, -float(moves.end[feeds, 2].min())) if feeds else 0.0
    kind = (tool.kind if tool else "") or ("drill" if drills else "flat")
    diameter = (tool.diameter if tool else None) or _USUAL_DIAMETER
    flute = max(_USUAL_FLUTE, np.ceil(depth + 5.0))
    length = max(_USUAL_LENGTH, np.ceil(flute * 1.6 + 20.0))
    guesses = [] if tool and tool.diameter else ["diameter"]
    kind_from = "its comment" if tool and tool.kind else "what it does"
    size_from = "its comment" if tool and tool.diameter else "a guess"
    lines = [
        "[[tools]]",
        f"number = {number}" + (f"  # {_plain(tool.text)}" if tool else ""),
        f'kind = "{kind}"  # flat, ball, bull, drill, chamfer: from {kind_from}',
        f"diameter = {round(float(diameter), 4)}  # mm: {size_from}",
        *([f"corner = {tool.corner}  # mm"] if tool and tool.corner and kind == "bull" else []),
        f"flute = {flute:.1f}  # mm: a guess",
        f"length = {length:.1f}  # from the spindle nose to the tip, mm: a guess",
        "",
    ]
    said = f"T{number} {kind} of {diameter:g} mm: " + (
        f"from its comment ({_plain(tool.text)})"
        if tool and tool.diameter
        else f"{' and '.join(guesses)} is a guess"
    )
    return lines, said, diameter


def _plain(text: str) -> str:
    """A comment of a program as one of a job file."""
    return "".join(each for each in text if each.isprintable())[:80]
