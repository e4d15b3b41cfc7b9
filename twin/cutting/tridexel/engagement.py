"""Move a tool along its path through a tri-dexel stock: what each step took off, and what it met."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from twin.cutting.tridexel.dexels import DIRECTIONS, TriDexel
from twin.cutting.tridexel.intervals import Node, total_worth
from twin.cutting.tridexel.solids.moving_solid import Poses
from twin.cutting.tridexel.solids.solids import Solid
from twin.cutting.tridexel.sweep import MEASURE, StepColumn, sweep
from twin.nc.canonical import BoolArray, FloatArray, IntArray

STEP_SHARE = 0.1
"""Longest step as a share of a solid's radius: what rims leave between their places is of that size squared."""
STEP_DEGREES = 2.0
"""Largest turn of the axis in a step [deg]."""
FINEST_STEP_MM = 0.05
"""Steps need not be shorter than this [mm]: of a pointed tool its whole radius counts, of a stub nothing."""


def longest_step(solids: Sequence[Solid]) -> float:
    """How far what moves may go in a step [mm]."""
    radius = max(max(solid.low_radius, solid.high_radius) + solid.rounding for solid in solids)
    return max(STEP_SHARE * radius, FINEST_STEP_MM)


def in_short_steps(poses: Poses, solids: Sequence[Solid]) -> tuple[Poses, IntArray]:
    """Put poses between those that are far from each other.

    Args:
        poses: Ends of n steps.

    Returns:
        Poses of m short steps, and which of the n steps each of them is part of, shape (m,).
    """
    tip, axis = poses
    longest = longest_step(solids)
    travel = np.zeros(len(tip) - 1)
    for height in (solids[0].low, max(solid.high for solid in solids)):
        travel = np.maximum(travel, np.linalg.norm(np.diff(tip + height * axis, axis=0), axis=1))
    turn = np.linalg.norm(np.diff(axis, axis=0), axis=1) / np.deg2rad(STEP_DEGREES)
    parts = np.maximum(np.ceil(np.maximum(travel / longest, turn)), 1.0).astype(np.int64)
    if (parts == 1).all():
        return poses, np.arange(len(parts))
    step = np.repeat(np.arange(len(parts)), parts)
    place = np.arange(len(step)) - np.repeat(np.cumsum(parts) - parts, parts)
    share = ((place + 1.0) / parts[step])[:, None]
    between = [
        np.concatenate([ends[:1], (1.0 - share) * ends[step] + share * ends[step + 1]])
        for ends in (tip, axis)
    ]
    direction: FloatArray = between[1] / np.linalg.norm(between[1], axis=1, keepdims=True)
    return Poses(between[0], direction), step


class Engagement(NamedTuple):
    """What n steps took off.

    Attributes:
        volume: Material, exact to the second order of the cell; of a step that takes very little it may
            be below zero, shape (n,) [mm³].
        touched: Whether anything was taken off, shape (n,).
        depth: How far along the tool's axis it reaches, shape (n,) [mm].
        middle: Where it lay in the mean, shape (n, 3) [mm].
        longest: Longest piece of any line, shape (n,) [mm].
        thickness: The shortest of the longest pieces along X, Y and Z, shape (n,) [mm].
    """

    volume: FloatArray
    touched: BoolArray
    depth: FloatArray
    middle: FloatArray
    longest: FloatArray
    thickness: FloatArray


def volume(stock: TriDexel) -> float:
    """Material that is left [mm³]; see ``intervals.worth``."""
    lattice = stock.lattice
    ends = [*lattice.base.tolist(), lattice.lines]
    return stock.cell**2 * sum(
        total_worth(
            stock.dexels, ends[d], ends[d + 1], Node(d, float(lattice.origin[d]), stock.cell)
        )
        for d in range(DIRECTIONS)
    )


def cut(stock: TriDexel, poses: Poses, edge: Sequence[Solid], tool: int) -> Engagement:
    """Take off what a tool's edge goes through.

    Args:
        poses: Ends of n steps.
        tool: Number that the cut surface remembers, from 1 to ``normals.MOST_TOOLS``.
    """
    sums = _swept(stock, poses, edge, tool)
    length = sums[:, StepColumn.LENGTH]
    touched = length > 0.0
    some = np.where(touched, length, 1.0)
    return Engagement(
        sums[:, StepColumn.VOLUME],
        touched,
        np.where(touched, sums[:, StepColumn.HIGHEST] - sums[:, StepColumn.LOWEST], 0.0),
        sums[:, StepColumn.MOMENT : StepColumn.MOMENT + 3] / some[:, None],
        sums[:, StepColumn.LONGEST : StepColumn.LONGEST + 3].max(axis=1, initial=0.0),
        _shortest(sums),
    )


def met(stock: TriDexel, poses: Poses, solid: Solid) -> FloatArray:
    """How deep a solid is in the material during each step, shape (n,) [mm]; 0: nowhere.

    The longest line of material within the solid is taken in each of the three directions in which there
    is any, and the shortest of these counts: on a face that looks along an axis it is the depth below the
    face, on one that looks between all three at most 1.73 times as much.
    """
    return _shortest(_swept(stock, poses, (solid,), MEASURE))


def _shortest(sums: FloatArray) -> FloatArray:
    """The shortest of the longest pieces along X, Y and Z, of those of which there are any, shape (n,) [mm]."""
    longest = sums[:, StepColumn.LONGEST : StepColumn.LONGEST + 3]
    least = np.where(longest > 0.0, longest, np.inf).min(axis=1, initial=np.inf)
    return np.where(np.isfinite(least), least, 0.0)


def _swept(stock: TriDexel, poses: Poses, solids: Sequence[Solid], tool: int) -> FloatArray:
    """Bring solids along steps, in shorter ones where they are long; what each step did."""
    short, step = in_short_steps(poses, solids)
    sums = np.zeros((len(step), StepColumn.COLUMNS))
    sums[:, StepColumn.LOWEST], sums[:, StepColumn.HIGHEST] = np.inf, -np.inf
    bodies, done = np.array(solids, np.float64), 0
    while True:
        done = sweep(stock.dexels, stock.lattice, short, bodies, sums, tool, done)
        if done >= len(sums):
            break
        stock.dexels = stock.dexels.grown()
    if len(sums) < len(poses.tip):
        return sums
    first = np.flatnonzero(np.diff(step, prepend=-1))
    whole = np.add.reduceat(sums, first)
    whole[:, StepColumn.LOWEST] = np.minimum.reduceat(sums[:, StepColumn.LOWEST], first)
    whole[:, StepColumn.HIGHEST :] = np.maximum.reduceat(sums[:, StepColumn.HIGHEST :], first)
    return whole
