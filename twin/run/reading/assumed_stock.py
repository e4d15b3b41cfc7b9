"""The stock that is assumed for a raw program: of a comment in its head, or of its path."""

import re

import numpy as np

from twin.nc.canonical import BoolArray, FloatArray, Motion, Moves
from twin.nc.dialects.recognition import HEAD_LINES
from twin.run.reading.assumed_tools import BELOW

MARGIN = 10.0
"""Stock beyond the feed moves, on each side [mm]."""
_LEAST_HEIGHT = 10.0
_CLAMPED = 50.0
"""How long a bar is between the table that turns it and the path, so that holder and table do not meet [mm]."""
_ONLY_CUT = 1.0
"""How deep the only cut is taken to be [mm]."""
_LEAST_CLEARANCE = 1.0
"""Rapids in the plane pass the stock at least so high above it [mm]."""
_MOST_ABOVE = 0.5
"""Program zero lies on the stock's top, unless this share of the path of its cuts lies above it."""
_MOST_CLIPPED = 0.5
"""Share of the stock's area that may be taken from it so that no rapid plunges into it; beyond that there is none."""

_NUMBER = r"\s*[:=-]?\s*([0-9]+(?:\.[0-9]*)?)"
_STOCK_WORDS = r"(?:STOCK(?:/BLOCK)?|BLOCK SIZE|BLANK|MATERIAL(?: SIZE)?|WORKPIECE SIZE|ROHTEIL)"
_STOCKS = (
    re.compile(
        rf"{_STOCK_WORDS}\b[^XYZ]{{0,40}}\bX{_NUMBER}\D{{0,12}}?Y{_NUMBER}\D{{0,12}}?Z{_NUMBER}",
        re.DOTALL,
    ),
    re.compile(
        rf"{_STOCK_WORDS}\b[^0-9]{{0,20}}([0-9.]+)\s*(?:MM)?\s*[X*]\s*([0-9.]+)\s*(?:MM)?\s*[X*]\s*([0-9.]+)",
        re.DOTALL,
    ),
)


def assumed_stock(
    moves: Moves, comments: list[tuple[int, str]], radius: float, *, inches: bool
) -> tuple[list[str], FloatArray | None, str]:
    """Lines of the stock, the centre of its top face, and how it came about."""
    feeds = moves.motion == Motion.FEED
    points = np.concatenate([moves.start[feeds], moves.end[feeds]])[:, :3]
    if not len(points):
        return _no_stock("the program feeds nowhere")
    low, high = points.min(axis=0), points.max(axis=0)
    head = "\n".join(text for line, text in comments if line <= HEAD_LINES).upper()
    told = next((match for pattern in _STOCKS if (match := pattern.search(head))), None)
    if turns_about_x(moves):
        return _bar(moves)
    found = _heights(moves, low[2])
    if told is not None:
        size = np.array([float(value) for value in told.groups()]) * (25.4 if inches else 1.0)
        if (size > 0.0).all():
            center = _center_of(size, low, high)
            top = 0.0 if found is not None and found[0] == 0.0 else float(size[2])
            return _box(size, np.array([*center, top]), "a comment in the program's head")
    if found is None:
        return _no_stock("no feed goes below Z0")
    top, bottom, height_from = found
    corner, far, plunges = _clipped(moves, low[:2] - MARGIN, high[:2] + MARGIN, top, radius)
    whole = np.prod(high[:2] - low[:2] + 2.0 * MARGIN)
    if (far <= corner).any() or np.prod(far - corner) < (1.0 - _MOST_CLIPPED) * whole:
        return _no_stock("rapids plunge wherever it could lie")
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


def top_of_stock(moves: Moves) -> float:
    """Height of the stock's top, as far as the path shows it [mm]."""
    feeds = moves.motion == Motion.FEED
    levels, lengths = _levels(moves)
    if turns_about_x(moves) and len(levels):
        return _over_the_cuts(moves, levels, lengths)
    found = _heights(moves, float(moves.end[feeds, 2].min())) if feeds.any() else None
    return 0.0 if found is None else found[0]


def turns_about_x(moves: Moves) -> bool:
    """Whether axis A goes anywhere."""
    if "A" not in moves.axes.names:
        return False
    column = moves.axes.index("A")
    return bool((moves.start[:, column] != moves.end[:, column]).any())


def bar_ends(moves: Moves) -> tuple[float, float]:
    """From where to where along X a bar reaches that axis A turns; its beginning is clamped [mm]."""
    feeds = moves.motion == Motion.FEED
    feeds |= not feeds.any()
    places = np.concatenate([moves.start[feeds, 0], moves.end[feeds, 0]])
    return float(places.min()) - _CLAMPED, float(places.max()) + MARGIN


def _bar(moves: Moves) -> tuple[list[str], FloatArray | None, str]:
    """A bar along X that axis A turns about program zero."""
    levels, lengths = _levels(moves)
    if not len(levels) or levels[0] <= BELOW:
        return _no_stock("axis A turns, and the cuts do not lie above its centre at Z0")
    radius = float(np.ceil(_over_the_cuts(moves, levels, lengths) * 10.0) / 10.0)
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


def _heights(moves: Moves, low: float) -> tuple[float, float, str] | None:
    """Top and bottom of the stock, and what shows them; None: nothing does.

    Program zero lies on its top, unless most of what is cut at one height lies above it: then it lies on its
    bottom or on the table, and the first of the cuts is as deep as the step to the next.
    """
    levels, lengths = _levels(moves)
    above = levels > BELOW
    if not above.any() or lengths[above].sum() < _MOST_ABOVE * lengths.sum():
        return (0.0, low - MARGIN, "") if low < -BELOW else None
    said = f"; zero is not on its top: cuts lie at Z{levels[0]:g} to Z{levels[-1]:g}, the first taken as deep as the next"
    return _over_the_cuts(moves, levels, lengths), min(0.0, low), said


def _over_the_cuts(moves: Moves, levels: FloatArray, lengths: FloatArray) -> float:
    """Top of a stock whose first cut is as deep as the step to the next, or a guess where that is no step [mm].

    It is none where there is but one cut, or where the path slopes down to the next longer than it goes level.
    """
    highest = float(levels[0])
    step = highest - float(levels[1]) if len(levels) > 1 else _ONLY_CUT
    if len(levels) > 1 and _sloping(moves, levels[1], highest) > lengths[0]:
        step = min(step, _ONLY_CUT)
    ends = moves.end[moves.motion == Motion.RAPID, 2]
    above = ends[ends > highest]
    room = float(above.min()) - _LEAST_CLEARANCE - highest if len(above) else step
    return highest + max(0.0, min(step, room))


def _sloping(moves: Moves, low: float, high: float) -> float:
    """Length in the plane of feeds that rise or fall to a height between two [mm]."""
    travel, ends = moves.end[:, :3] - moves.start[:, :3], moves.end[:, 2]
    rows = (moves.motion == Motion.FEED) & (np.abs(travel[:, 2]) >= BELOW)
    rows &= (ends > low + BELOW) & (ends < high - BELOW)
    return float(np.hypot(travel[rows, 0], travel[rows, 1]).sum())


def _level(moves: Moves) -> BoolArray:
    """Which moves go in the plane at one height, shape (n,)."""
    travel = np.abs(moves.end[:, :3] - moves.start[:, :3])
    return (travel[:, 2] < BELOW) & ((travel[:, :2] > BELOW).any(axis=1) | (moves.sweep != 0.0))


def _levels(moves: Moves) -> tuple[FloatArray, FloatArray]:
    """Heights at which the tool feeds in the plane once it was fed down to them, the highest first, and how long the path at each is [mm]."""
    drop = moves.end[:, 2] - moves.start[:, 2]
    rows = np.arange(len(moves))
    last = np.maximum.accumulate(np.where(np.abs(drop) >= BELOW, rows, -1))
    feeds = moves.motion == Motion.FEED
    cuts = feeds & _level(moves) & (last >= 0) & feeds[last] & (drop[last] < 0.0)
    ways = np.hypot(*(moves.end[cuts, :2] - moves.start[cuts, :2]).T)
    levels, at = np.unique(moves.end[cuts, 2].round(3), return_inverse=True)
    lengths = np.bincount(at, ways, minlength=len(levels)).astype(np.float64)
    return levels[::-1], lengths[::-1]


def _clipped(
    moves: Moves, corner: FloatArray, far: FloatArray, top: float, radius: float
) -> tuple[FloatArray, FloatArray, list[int]]:
    """The box without what rapids would plunge into or meet at its edge, and their lines; where the tool fed before is none of that."""
    lines: list[int] = []
    fed: dict[tuple[float, float], float] = {}
    rapid, drop = moves.motion == Motion.RAPID, moves.start[:, 2] - moves.end[:, 2]
    for row in np.flatnonzero(moves.end[:, 2] < top - BELOW):
        x, y, z = moves.end[row, :3].round(3).tolist()
        if not rapid[row]:
            fed[x, y] = min(z, fed.get((x, y), z))
            continue
        plunges = drop[row] > BELOW
        if plunges and fed.get((x, y), top) <= z + _CLEARED:
            continue
        ways = moves.end[row : row + 1, :2] if plunges else _along(moves, int(row))
        ways = np.array(
            [each for each in ways if not _fed_before(moves, int(row), each, z, radius)]
        )
        if not len(ways):
            continue
        low, high = ways.min(axis=0) - radius, ways.max(axis=0) + radius
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
