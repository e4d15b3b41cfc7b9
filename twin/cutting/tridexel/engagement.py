"""Bring a tool along its way through a tri-dexel stock: what each step took off, and what it met."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from twin.cutting.tridexel.dexels import DIRECTIONS, TriDexel
from twin.cutting.tridexel.intervals import Node, total_worth
from twin.cutting.tridexel.moving_solid import Poses
from twin.cutting.tridexel.poses import in_short_steps
from twin.cutting.tridexel.solids import Solid
from twin.cutting.tridexel.sweep import (
    COLUMNS,
    HIGHEST,
    LENGTH,
    LONGEST,
    LOWEST,
    MEASURE,
    MOMENT,
    VOLUME,
    sweep,
)
from twin.nc.canonical import BoolArray, FloatArray


class Engagement(NamedTuple):
    """What n steps took off.

    Attributes:
        volume: Material, exact to the second order of the cell; of a step that takes very little it may
            be below zero, shape (n,) [mm³].
        touched: Whether anything was taken off, shape (n,).
        depth: How far along the tool's axis it reaches, shape (n,) [mm].
        middle: Where it lay in the mean, shape (n, 3) [mm].
        longest: Longest piece of any line, shape (n,) [mm].
    """

    volume: FloatArray
    touched: BoolArray
    depth: FloatArray
    middle: FloatArray
    longest: FloatArray


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
        stock: It is cut.
        poses: Ends of n steps.
        edge: The bodies that cut.
        tool: Number that the cut surface remembers, from 1 to ``normals.MOST_TOOLS``.
    """
    tally = _swept(stock, poses, edge, tool)
    length = tally[:, LENGTH]
    touched = length > 0.0
    some = np.where(touched, length, 1.0)
    return Engagement(
        tally[:, VOLUME],
        touched,
        np.where(touched, tally[:, HIGHEST] - tally[:, LOWEST], 0.0),
        tally[:, MOMENT : MOMENT + 3] / some[:, None],
        tally[:, LONGEST : LONGEST + 3].max(axis=1, initial=0.0),
    )


def met(stock: TriDexel, poses: Poses, solid: Solid) -> FloatArray:
    """How deep a solid is in the material during each step, shape (n,) [mm]; 0: nowhere.

    The longest line of material within the solid is taken in each of the three directions in which there
    is any, and the shortest of these counts: on a face that looks along an axis it is the depth below the
    face, on one that looks between all three at most 1.73 times as much.
    """
    longest = _swept(stock, poses, (solid,), MEASURE)[:, LONGEST : LONGEST + 3]
    least = np.where(longest > 0.0, longest, np.inf).min(axis=1, initial=np.inf)
    return np.where(np.isfinite(least), least, 0.0)


def _swept(stock: TriDexel, poses: Poses, solids: Sequence[Solid], tool: int) -> FloatArray:
    """Bring solids along steps, in shorter ones where they are long; what each step did."""
    short, step = in_short_steps(poses, solids)
    tally = np.zeros((len(step), COLUMNS))
    tally[:, LOWEST], tally[:, HIGHEST] = np.inf, -np.inf
    bodies, done = np.array(solids, np.float64), 0
    while True:
        done = sweep(stock.dexels, stock.lattice, short, bodies, tally, tool, done)
        if done >= len(tally):
            break
        stock.dexels = stock.dexels.grown()
    if len(tally) < len(poses.tip):
        return tally
    first = np.flatnonzero(np.diff(step, prepend=-1))
    whole = np.add.reduceat(tally, first)
    whole[:, LOWEST] = np.minimum.reduceat(tally[:, LOWEST], first)
    whole[:, HIGHEST:] = np.maximum.reduceat(tally[:, HIGHEST:], first)
    return whole
