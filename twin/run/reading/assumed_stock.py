"""The stock that is assumed for a raw program: of a comment in its head, or of its path."""

import re
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from twin.nc.canonical import FloatArray, Motion, Moves
from twin.nc.dialects.recognition import HEAD_LINES
from twin.run.reading.assumed_heights import (
    MARGIN,
    Cuts,
    aside,
    first_feed,
    heights,
    levels_of,
    over_the_cuts,
    turns_about_x,
)
from twin.run.reading.assumed_tools import BELOW

_LEAST_HEIGHT = 10.0
_CLAMPED = 50.0
"""How long a bar is between the table that turns it and the path, so that holder and table do not meet [mm]."""
_MOST_CLIPPED = 0.5
"""Share of the stock's area that may be taken from it so that no rapid plunges into it; beyond that there is none."""

_N = r"([0-9]+(?:\.[0-9]*)?)"
_NUMBER = rf"\s*[:=-]?\s*{_N}"
_STOCK_WORDS = (
    r"(?:STOCK(?:/BLOCK)?|BLOCK SIZE|BLANK|PART SIZE|MATERIAL(?: SIZE)?|WORKPIECE SIZE|ROHTEIL)"
)
_STOCKS = (
    re.compile(
        rf"{_STOCK_WORDS}\b[^XYZ]{{0,40}}\bX{_NUMBER}\D{{0,12}}?Y{_NUMBER}\D{{0,12}}?Z{_NUMBER}",
        re.DOTALL,
    ),
    re.compile(
        rf"{_STOCK_WORDS}\b[^0-9]{{0,20}}([0-9.]+)\s*(?:MM)?\s*[X*]\s*([0-9.]+)\s*(?:MM)?\s*[X*]\s*([0-9.]+)",
        re.DOTALL,
    ),
    re.compile(rf"\bQUADER:\s*QX{_N}\s*QY{_N}\s*QZ{_N}"),
)
_SIMULATED = re.compile(
    r"\bSTOCK/BLOCK\s*,\s*" + r"\s*,\s*".join([_N] * 3 + [rf"(-?{_N[1:-1]})"] * 3)
)
"""What Carbide Create and others write for CutViewer: the size, and where zero lies from the corner."""
_ROUND = re.compile(
    rf"(?:STOCK|BLANK|BAR|MATERIAL|ROHTEIL)\b[^0-9\n]{{0,20}}(?:[ØΦ⌀]|\bDIA(?:METER)?\b\.?|\bD)\s*[=:]?\s*{_N}\s*(?:MM)?\s*(?:[X*]|L(?:ENGTH)?|H(?:EIGHT)?)[ =:]*{_N}"
)
"""Diameter and length of a round blank."""


def assumed_stock(
    cuts: Cuts, comments: Sequence[tuple[int, str]], radius: float, *, inches: bool
) -> tuple[list[str], FloatArray | None, str]:
    """Lines of the stock, the centre of its top face, and how it came about."""
    moves = cuts.moves
    feeds = moves.motion == Motion.FEED
    points = np.concatenate([moves.start[feeds], moves.end[feeds]])[:, :3]
    if not len(points):
        return _under_rapids(cuts)
    low, high = points.min(axis=0), points.max(axis=0)
    stated = _stated(comments, inches=inches)
    if turns_about_x(moves):
        return _bar(cuts) if stated is None else _stated_bar(moves, stated)
    found = heights(cuts, low[2])
    if stated is not None:
        if stated.zero is not None:
            half = stated.size * np.array([0.5, 0.5, 1.0])
            return _placed(stated, half - stated.zero, _OF_HEAD)
        center = _center_of(stated.size, low, high)
        top = 0.0 if found is not None and found[0] == 0.0 else float(stated.size[2])
        return _placed(stated, np.array([*center, top]), _OF_HEAD)
    if found is None:
        return _no_stock("no feed goes below Z0")
    around = _around(moves, low, high, found, radius)
    begin, slopes = first_feed(moves)
    if found[0] == 0.0 and low[2] < begin < -BELOW and (slopes or around is None):
        found = (
            begin,
            found[1],
            f"; zero is above its top: the first feed goes down from Z{begin:g}",
        )
        around = _around(moves, low, high, found, radius)
    return around or _no_stock("rapids plunge wherever it could lie")


_OF_HEAD = "a comment in the program's head"


class _StatedStock(NamedTuple):
    """A blank of a comment.

    Attributes:
        size: Along X, Y, Z, shape (3,) [mm].
        axis: Along which of these it is round; None: it is a box.
        zero: Where program zero lies from its lower left corner, shape (3,) [mm]; None: that is not stated.
    """

    size: FloatArray
    axis: int | None = None
    zero: FloatArray | None = None


def _stated(comments: Sequence[tuple[int, str]], *, inches: bool) -> _StatedStock | None:
    """What comments in the program's head say of the blank."""
    unit = 25.4 if inches else 1.0
    head = "\n".join(text for line, text in comments if line <= HEAD_LINES).upper()
    simulated = _SIMULATED.search(head)
    if simulated is not None:
        values = np.array([float(value) for value in simulated.groups()]) * unit
        return _StatedStock(values[:3], None, values[3:]) if (values[:3] > 0.0).all() else None
    box = next((match for pattern in _STOCKS if (match := pattern.search(head))), None)
    cylinder = _ROUND.search(head) if box is None else None
    if box is not None:
        size = np.array([float(value) for value in box.groups()]) * unit
        return _StatedStock(size) if (size > 0.0).all() else None
    if cylinder is not None:
        across, along = (float(value) * unit for value in cylinder.groups())
        size = np.array([across, across, along])
        return _StatedStock(size, 2) if (size > 0.0).all() else None
    return None


def _stated_bar(moves: Moves, stated: _StatedStock) -> tuple[list[str], FloatArray, str]:
    """A bar of a comment that axis A turns about program zero: the one side that differs lies along X."""
    size = stated.size
    if stated.axis is not None or size[0] == size[1] != size[2]:
        size = size[[2, 0, 1]]
    elif size[0] == size[2] != size[1]:
        size = size[[1, 0, 2]]
    clamped, last = bar_ends(moves)
    top = np.array([last - size[0] / 2.0, 0.0, size[2] / 2.0])
    before_table = last - float(size[0]) - clamped
    held = f", held {before_table:g} mm before the table" if before_table > BELOW else ""
    blank = _StatedStock(size, None if stated.axis is None else 0)
    return _placed(blank, top, _OF_HEAD + held)


def _placed(blank: _StatedStock, top: FloatArray, source: str) -> tuple[list[str], FloatArray, str]:
    """A blank by the centre of its top face."""
    if blank.axis is None:
        return _box(blank.size, top, source)
    across, along = blank.size[1], blank.size[blank.axis]
    lines = [
        "[stock]",
        'shape = "cylinder"',
        f"diameter = {across:.1f}  # mm: from {source}",
        f"height = {along:.1f}  # mm",
        *(['axis = "X"  # axis A turns it'] if blank.axis == 0 else []),
        f"position = [{top[0]:.3f}, {top[1]:.3f}, {top[2]:.3f}]  # centre of its top face, mm",
        "",
    ]
    return lines, top, f"stock ⌀ {across:g} x {along:g} mm, top at Z{top[2]:g}: from {source}"


def _under_rapids(cuts: Cuts) -> tuple[list[str], FloatArray | None, str]:
    """A box where the rapids of a program that feeds nowhere go below zero with its spindle on: G0 may have been left in force."""
    moves = cuts.moves
    deep = moves.end[moves.end[:, 2] < -BELOW, :3]
    if not (cuts.spindle and len(deep)):
        return _no_stock("the program feeds nowhere")
    low, high = deep.min(axis=0) - MARGIN, deep.max(axis=0) + MARGIN
    top = np.array([*((low + high) / 2.0)[:2], 0.0])
    around = f"where the program, which feeds nowhere, goes below Z0 by rapids, and {MARGIN:g} mm around it"
    return _box(np.array([*(high - low)[:2], -low[2]]), top, around)


def _around(
    moves: Moves,
    low: FloatArray,
    high: FloatArray,
    heights: tuple[float, float, str],
    radius: float,
) -> tuple[list[str], FloatArray, str] | None:
    """A box around the path, less where rapids plunge; None: little of it would be left."""
    top, bottom, height_from = heights
    corner, far, plunges = _clipped(moves, low[:2] - MARGIN, high[:2] + MARGIN, top, radius)
    whole = np.prod(high[:2] - low[:2] + 2.0 * MARGIN)
    if (far <= corner).any() or np.prod(far - corner) < (1.0 - _MOST_CLIPPED) * whole:
        return None
    size = np.array([*(far - corner), max(np.ceil(top - bottom), _LEAST_HEIGHT)])
    size[:2] = np.floor(size[:2] * 10.0) / 10.0
    around = f"the path and {MARGIN:g} mm around it{height_from}"
    if plunges:
        several = "lines" if len(plunges) > 1 else "line"
        around += (
            f", less where the rapids of {several} {', '.join(map(str, plunges[:5]))}"
            f"{' ...' if len(plunges) > 5 else ''} go below its top: what they would hit there is not judged"
        )
    return _box(size, np.array([*((corner + far) / 2.0), top]), around)


def bar_ends(moves: Moves) -> tuple[float, float]:
    """From where to where along X a bar reaches that axis A turns; its beginning is clamped [mm]."""
    feeds = moves.motion == Motion.FEED
    feeds |= not feeds.any()
    places = np.concatenate([moves.start[feeds, 0], moves.end[feeds, 0]])
    return float(places.min()) - _CLAMPED, float(places.max()) + MARGIN


def _bar(cuts: Cuts) -> tuple[list[str], FloatArray | None, str]:
    """A bar along X that axis A turns about program zero."""
    moves = cuts.moves
    levels, _ = levels_of(moves)
    if not len(levels) or levels[0] <= BELOW:
        return _no_stock("axis A turns, and the cuts do not lie above its centre at Z0")
    radius = float(np.ceil(over_the_cuts(cuts) * 10.0) / 10.0)
    first, last = bar_ends(moves)
    top = np.array([(first + last) / 2.0, 0.0, radius])
    lines = [
        "[stock]",
        'shape = "cylinder"',
        f"diameter = {2.0 * radius:.1f}  # mm: a guess, from the highest cut",
        f"height = {last - first:.1f}  # mm: {_CLAMPED:g} mm before the path, for the chuck, and {MARGIN:g} mm behind it",
        'axis = "X"  # axis A turns it',
        f"position = [{top[0]:.3f}, 0.0, {radius:.3f}]  # centre of the top of the box around it, mm",
        "",
    ]
    said = f"stock a bar along X, ⌀ {2.0 * radius:g} mm and {last - first:g} mm long about Y0 Z0: axis A turns it, and its highest cut lies at Z{levels[0]:g}"
    return lines, top, said


def _clipped(
    moves: Moves, corner: FloatArray, far: FloatArray, top: float, radius: float
) -> tuple[FloatArray, FloatArray, list[int]]:
    """The box without what rapids would plunge into or meet at its edge, and their lines; where the tool fed before is none of that."""
    lines: list[int] = []
    fed: dict[tuple[float, float], float] = {}
    rapid, drop = moves.motion == Motion.RAPID, moves.start[:, 2] - moves.end[:, 2]
    retracts = (drop < 0.0) & ~aside(moves)
    deep = np.flatnonzero(moves.end[:, 2] < top - BELOW)
    for row, (x, y, z) in zip(deep, moves.end[deep, :3].round(3).tolist(), strict=True):
        if not rapid[row]:
            fed[x, y] = min(z, fed.get((x, y), z))
            continue
        plunges = drop[row] > BELOW
        if retracts[row] or (plunges and fed.get((x, y), top) <= z + _CLEARED):
            continue
        places = moves.end[row : row + 1, :2] if plunges else _along(moves, int(row))
        places = np.array(
            [each for each in places if not _fed_before(moves, int(row), each, z, radius)]
        )
        if not len(places):
            continue
        low, high = places.min(axis=0) - radius, places.max(axis=0) + radius
        if not ((corner < high).all() and (far > low).all()):
            continue
        clipped, share = _cut_away(corner, far, low, high)
        if plunges or share <= _MOST_AT_EDGE:
            (corner, far), _ = clipped, lines.append(int(moves.line[row]))
    return corner, far, list(dict.fromkeys(lines))


def _along(moves: Moves, row: int) -> FloatArray:
    """Places along a move in the plane, shape (n, 2) [mm]."""
    shares = np.linspace(0.0, 1.0, _PLACES)[:, None]
    start, end = moves.start[row, :2], moves.end[row, :2]
    return (start + shares * (end - start)).astype(np.float64)


def _cut_away(
    corner: FloatArray, far: FloatArray, low: FloatArray, high: FloatArray
) -> tuple[tuple[FloatArray, FloatArray], float]:
    """The box without a strip along the side where that costs least, so that it is clear of a place, and the share lost."""
    size = far - corner
    losses = {
        **{(axis, "low"): (high[axis] - corner[axis]) / size[axis] for axis in (0, 1)},
        **{(axis, "high"): (far[axis] - low[axis]) / size[axis] for axis in (0, 1)},
    }
    (axis, side), share = min(losses.items(), key=lambda pair: pair[1])
    corner, far = corner.copy(), far.copy()
    if side == "low":
        corner[axis] = high[axis] + _CLEAR
    else:
        far[axis] = low[axis] - _CLEAR
    return (corner, far), float(share)


def _fed_before(moves: Moves, row: int, place: FloatArray, height: float, radius: float) -> bool:
    """Whether the tool's centre was fed past a place before a move, as near as the radius and hardly higher than a height."""
    height += _CLEARED
    feeds = moves.motion[:row] == Motion.FEED
    feeds &= (moves.start[:row, 2] <= height) & (moves.end[:row, 2] <= height)
    begin, travel = moves.start[:row][feeds, :2], (moves.end - moves.start)[:row][feeds, :2]
    to = place - begin
    length = np.maximum((travel * travel).sum(axis=1), BELOW)
    share = np.clip((to * travel).sum(axis=1) / length, 0.0, 1.0)
    return bool((np.hypot(*(to - share[:, None] * travel).T) <= radius).any())


_MOST_AT_EDGE = 0.2
"""Share of the stock that may be taken from it so that a rapid in the plane passes beside it; more is for the run to judge."""
_PLACES = 9
"""At so many places of a rapid in the plane it is looked whether the tool was fed there before."""
_CLEARED = 1.0
"""So much deeper than it was fed a rapid may go: the rest is for the run to judge [mm]."""
_CLEAR = 0.5
"""Between the stock and a tool that plunges beside it [mm]."""


def _center_of(size: FloatArray, low: FloatArray, high: FloatArray) -> tuple[float, float]:
    """Where stock of a known size lies: from a corner at zero, around zero, or around the path."""
    slack = MARGIN
    if (low[:2] >= -slack).all() and (high[:2] <= size[:2] + slack).all():
        return float(size[0]) / 2.0, float(size[1]) / 2.0
    if (np.abs(low[:2]) <= size[:2] / 2.0 + slack).all() and (
        np.abs(high[:2]) <= size[:2] / 2.0 + slack
    ).all():
        return 0.0, 0.0
    return float(low[0] + high[0]) / 2.0, float(low[1] + high[1]) / 2.0


def _box(size: FloatArray, top: FloatArray, source: str) -> tuple[list[str], FloatArray, str]:
    measures = ", ".join(f"{value:.1f}" for value in size)
    lines = [
        "[stock]",
        'shape = "box"',
        f"size = [{measures}]  # mm: from {source}",
        f"position = [{top[0]:.3f}, {top[1]:.3f}, {top[2]:.3f}]  # centre of its top face, mm",
        "",
    ]
    return (
        lines,
        top,
        f"stock {' x '.join(f'{value:g}' for value in size.round(1))} mm, top at Z{top[2]:g}: from {source}",
    )


def _no_stock(reason: str) -> tuple[list[str], None, str]:
    lines = [
        f"# No stock: {reason}. With one it would read:",
        "# [stock]",
        '# shape = "box"',
        "# size = [100.0, 100.0, 20.0]  # mm; its top face lies at program Z0",
        "",
    ]
    return lines, None, f"no stock: {reason}, so that nothing is cut"
