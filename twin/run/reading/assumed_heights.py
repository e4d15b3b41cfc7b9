"""At which heights a raw program's stock lies, as its path shows it: where its feeds go down and where they go level."""

from collections.abc import Collection, Sequence
from typing import NamedTuple

import numpy as np

from twin.nc.canonical import BoolArray, FloatArray, Motion, Moves
from twin.run.reading.assumed_tools import BELOW

MARGIN = 10.0
"""Stock beyond the feed moves, on each side [mm]."""
_ONLY_CUT = 1.0
"""How deep the only cut is taken to be [mm]."""
_RAMP_CLEARANCE = 3.0
"""Ramps and helixes begin no farther above the material: FreeCAD's safe height; Fusion's ramp clearance is 2.5 [mm]."""
_NEAR_TOP = 10.0
"""Drilling cycles begin to feed no farther above the material [mm]."""
_LEAST_CLEARANCE = 1.0
"""Rapids in the plane pass the stock at least so high above it [mm]."""
_MOST_ABOVE = 0.5
"""Program zero lies on the stock's top, unless this share of the path of its cuts lies above it."""
_ROUNDED = 1e-3
"""To so much heights are rounded [mm]."""


class Cuts(NamedTuple):
    """What a program does with the stock.

    Attributes:
        changes: The next move of every tool that comes.
        drilled: Lines that make a hole by a drilling cycle.
        spindle: The program starts it.
    """

    moves: Moves
    changes: Sequence[int]
    drilled: Collection[int]
    spindle: bool


def top_of_stock(cuts: Cuts) -> float:
    """Height of the stock's top, as far as the path shows it [mm]."""
    moves = cuts.moves
    feeds = moves.motion == Motion.FEED
    levels, _ = levels_of(moves)
    if turns_about_x(moves) and len(levels):
        return over_the_cuts(cuts)
    found = heights(cuts, float(moves.end[feeds, 2].min())) if feeds.any() else None
    return 0.0 if found is None else found[0]


def turns_about_x(moves: Moves) -> bool:
    """Whether axis A goes anywhere."""
    if "A" not in moves.axes.names:
        return False
    column = moves.axes.index("A")
    return bool((moves.start[:, column] != moves.end[:, column]).any())


def heights(cuts: Cuts, low: float) -> tuple[float, float, str] | None:
    """Top and bottom of the stock, and what shows them; None: nothing does.

    Program zero lies on its top, unless most of what is cut at one height lies above it, or drilling cycles begin
    high above it: then it lies on its bottom or on the table.
    """
    levels, lengths = levels_of(cuts.moves)
    above = levels > BELOW
    if above.any() and lengths[above].sum() >= _MOST_ABOVE * lengths.sum():
        said = f"; zero is not on its top: cuts lie at Z{levels[0]:g} to Z{levels[-1]:g}, which shows the top roughly"
        return over_the_cuts(cuts), min(0.0, low), said
    begin = _drilled_from(cuts)
    if not len(levels) and begin is not None and (begin > _NEAR_TOP or low >= -BELOW):
        top = begin - _LEAST_CLEARANCE
        said = f"; zero is not on its top: holes are fed from Z{begin:g} to Z{low:g}, and it is taken to be {_LEAST_CLEARANCE:g} mm lower"
        return (top, min(0.0, low), said) if top > max(0.0, low) else None
    return (0.0, low - MARGIN, "") if low < -BELOW else None


def _drilled_from(cuts: Cuts) -> float | None:
    """From which height the lowest of the drilling cycles begins to feed [mm]; None: there is none."""
    moves = cuts.moves
    rows = np.isin(moves.line, list(cuts.drilled)) & (moves.motion == Motion.FEED)
    if not rows.any():
        return None
    holes, hole = np.unique(moves.line[rows], return_inverse=True)
    begins = np.full(len(holes), -np.inf)
    np.maximum.at(begins, hole, moves.start[rows, 2])
    return float(begins.min())


def over_the_cuts(cuts: Cuts) -> float:
    """Top of a stock that is cut above zero [mm].

    Its first cut is as deep as the step to the next one of the same tool; a path that slopes down to the next cut
    longer than it goes level has no steps. Where ramps or helixes begin lower, or farther above that than they begin
    over the material, or where there is no next cut, the top is where they begin.
    """
    moves = cuts.moves
    highest = float(levels_of(moves)[0][0])
    begins = [height for height in _ramps(moves) if height > highest + BELOW]
    levels, lengths = levels_of(_with_the_tool_of(cuts, highest))
    step = highest - float(levels[1]) if len(levels) > 1 else None
    if step is not None and _sloping(moves, levels[1], highest) > lengths[0]:
        step = min(step, _ONLY_CUT)
    top = highest + (_ONLY_CUT if step is None else step)
    if begins and (step is None or not top <= min(begins) <= top + _RAMP_CLEARANCE):
        return min(begins)
    ends = moves.end[moves.motion == Motion.RAPID, 2]
    above = ends[ends > highest]
    room = float(above.min()) - _LEAST_CLEARANCE if len(above) else top
    return max(highest, min(top, room))


def _with_the_tool_of(cuts: Cuts, level: float) -> Moves:
    """The moves of the tool that first cuts at a height."""
    moves = cuts.moves
    at = np.flatnonzero(
        (moves.motion == Motion.FEED) & _level(moves) & (np.abs(moves.end[:, 2] - level) < _ROUNDED)
    )
    bounds = [0, *cuts.changes, len(moves)]
    place = int(np.searchsorted(bounds, at[0], side="right"))
    return moves[bounds[place - 1] : bounds[place]]


def _ramps(moves: Moves) -> list[float]:
    """Heights from which feeds begin to slope down, each once [mm]."""
    down = _down(moves)
    sloped = down & aside(moves)
    sloped[1:] &= ~down[:-1]
    return np.unique(moves.start[sloped, 2].round(3)).tolist()


def first_feed(moves: Moves) -> tuple[float, bool]:
    """From which height the first feed goes down, infinite where it does not, and whether it slopes [mm]."""
    row = int(np.argmax(moves.motion == Motion.FEED))
    begin, down = float(moves.start[row, 2]), bool(_down(moves)[row])
    return begin if down else np.inf, down and bool(aside(moves)[row])


def _down(moves: Moves) -> BoolArray:
    """Which moves are fed to a lower height, shape (n,)."""
    return (moves.motion == Motion.FEED) & (moves.end[:, 2] < moves.start[:, 2] - BELOW)


def aside(moves: Moves) -> BoolArray:
    """Which moves go along X or Y, shape (n,)."""
    travel = np.abs(moves.end[:, :2] - moves.start[:, :2])
    return (travel > BELOW).any(axis=1) | (moves.sweep != 0.0)


def _sloping(moves: Moves, low: float, high: float) -> float:
    """Length in the plane of feeds that rise or fall to a height between two [mm]."""
    travel, ends = moves.end[:, :3] - moves.start[:, :3], moves.end[:, 2]
    rows = (moves.motion == Motion.FEED) & (np.abs(travel[:, 2]) >= BELOW)
    rows &= (ends > low + BELOW) & (ends < high - BELOW)
    return float(np.hypot(travel[rows, 0], travel[rows, 1]).sum())


def _level(moves: Moves) -> BoolArray:
    """Which moves go in the plane at one height, shape (n,)."""
    return (np.abs(moves.end[:, 2] - moves.start[:, 2]) < BELOW) & aside(moves)


def levels_of(moves: Moves) -> tuple[FloatArray, FloatArray]:
    """Heights at which the tool feeds in the plane once it was fed down to them, the highest first, and how long the path at each is [mm]."""
    drop = moves.end[:, 2] - moves.start[:, 2]
    rows = np.arange(len(moves))
    last = np.maximum.accumulate(np.where(np.abs(drop) >= BELOW, rows, -1))
    feeds = moves.motion == Motion.FEED
    cuts = feeds & _level(moves) & (last >= 0) & feeds[last] & (drop[last] < 0.0)
    travelled = np.hypot(*(moves.end[cuts, :2] - moves.start[cuts, :2]).T)
    arcs = np.nan_to_num(moves.radius[cuts]) * np.radians(np.abs(moves.sweep[cuts]))
    travelled = np.maximum(travelled, arcs)
    levels, at = np.unique(moves.end[cuts, 2].round(3), return_inverse=True)
    lengths = np.bincount(at, travelled, minlength=len(levels)).astype(np.float64)
    return levels[::-1], lengths[::-1]
