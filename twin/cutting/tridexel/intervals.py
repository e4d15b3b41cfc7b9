"""Take an interval off the material along one line."""

import math
from typing import NamedTuple

from twin.compilation.compilable import inlined
from twin.compilation.kernel import arithmetic_kernel
from twin.cutting.tridexel.dexels import Dexels
from twin.cutting.tridexel.normals import squared_part

LEAST_MM = 1e-9
"""What is thinner is nothing [mm]."""


class Piece(NamedTuple):
    """What was taken off a line.

    Attributes:
        length: Of all of it [mm]; negative: there was no memory for what is left, and less was taken.
        volume: What that is worth in volume, over the area of a cell [mm]; see ``worth``.
        moment: Length times the middle, summed [mm²].
        low: Where the first piece began [mm].
        high: Where the last one ended.
        longest: The longest piece [mm].
    """

    length: float
    volume: float
    moment: float
    low: float
    high: float
    longest: float


class Node(NamedTuple):
    """Where the nodes along a line are.

    Attributes:
        direction: Of the line: 0, 1 or 2.
        first: The first node [mm].
        cell: Between neighbouring ones [mm].
    """

    direction: int
    first: float
    cell: float


@arithmetic_kernel
def worth(t: float, facet: int, node: Node) -> float:
    """What the material below a place on a line adds to the volume, over the area of a cell [mm].

    The volume is c³ N, with the number N of nodes in the material taken as the mean of what the lines of the
    three directions count, plus what each end of an interval lies beyond the middle between its nodes. A surface is crossed
    by lines of up to three directions, and each of them makes up for all of its steps: the squares of its
    normal's parts along the three, which add up to one, share it out. On faces along the axes this leaves
    errors of the second order, where the volume of lines of one direction has those of the first. What is
    removed piece by piece adds up.
    """
    below = math.floor((t - node.first) / node.cell)
    beyond = t - node.first - (below + 0.5) * node.cell
    return node.cell * below / 3.0 + squared_part(facet, node.direction) * beyond


@arithmetic_kernel
def total_worth(dexels: Dexels, line: int, end: int, node: Node) -> float:
    """What the material of some lines of one direction is worth in volume, over the area of a cell [mm]."""
    total = 0.0
    for each in range(line, end):
        for place in range(dexels.first[each], dexels.first[each] + dexels.filled[each]):
            total += worth(dexels.ends[place, 1], dexels.facet[place, 1], node)
            total -= worth(dexels.ends[place, 0], dexels.facet[place, 0], node)
    return total


MEETS, ENDS_BELOW, BEGINS_ABOVE = 1, 2, 4
"""What a line has between two places, as bits: material; some that goes on below the lower place, and some
that goes on above the upper one."""


@inlined
def meeting(dexels: Dexels, line: int, low: float, high: float) -> int:
    """What a line has between two places."""
    found = 0
    first = dexels.first[line]
    for place in range(first, first + dexels.filled[line]):
        begin, end = dexels.ends[place, 0], dexels.ends[place, 1]
        if begin < high and end > low + LEAST_MM:
            found |= MEETS
            if begin < low:
                found |= ENDS_BELOW
            if end > high:
                found |= BEGINS_ABOVE
    return found


@arithmetic_kernel
def overlap(dexels: Dexels, line: int, low: float, high: float) -> float:
    """The longest material of a line between two places [mm]."""
    longest = 0.0
    first = dexels.first[line]
    for place in range(first, first + dexels.filled[line]):
        begin, end = max(dexels.ends[place, 0], low), min(dexels.ends[place, 1], high)
        longest = max(longest, end - begin)
    return longest


@arithmetic_kernel
def subtract(
    dexels: Dexels,
    line: int,
    cut: tuple[float, float],
    facet: tuple[int, int],
    node: Node,
) -> Piece:
    """Take what lies between two places off a line.

    Args:
        cut: Lower and upper end [mm].
        facet: Surface that is left below the lower end, and above the upper.
    """
    low, high = cut
    length, volume, moment, longest = 0.0, 0.0, 0.0, 0.0
    lowest, highest = math.inf, -math.inf
    place = dexels.first[line]
    end = place + dexels.filled[line]
    kept = place
    while place < end:
        begin, stop = dexels.ends[place, 0], dexels.ends[place, 1]
        a, b = max(begin, low), min(stop, high)
        if b - a <= LEAST_MM:
            if kept != place:
                _move(dexels, place, kept)
            kept += 1
            place += 1
            continue
        below, above = a - begin > LEAST_MM, stop - b > LEAST_MM
        if below and above and dexels.filled[line] == dexels.capacity[line]:
            # The interval that is split is the only one that is cut: nothing was taken yet.
            if not _move_to_end(dexels, line):
                return Piece(-1.0, 0.0, 0.0, 0.0, 0.0, 0.0)
            shift = dexels.first[line] - (end - dexels.filled[line])
            place, kept, end = place + shift, kept + shift, end + shift
        length += b - a
        volume += worth(b, facet[1] if above else dexels.facet[place, 1], node)
        volume -= worth(a, facet[0] if below else dexels.facet[place, 0], node)
        moment += 0.5 * (b - a) * (a + b)
        longest = max(longest, b - a)
        lowest, highest = min(lowest, a), max(highest, b)
        if below and above:
            for other in range(end, place, -1):
                _move(dexels, other - 1, other)
            dexels.ends[place, 1], dexels.facet[place, 1] = a, facet[0]
            dexels.ends[place + 1, 0], dexels.facet[place + 1, 0] = b, facet[1]
            dexels.filled[line] += 1
            return Piece(length, volume, moment, lowest, highest, longest)
        if below:
            dexels.ends[place, 1], dexels.facet[place, 1] = a, facet[0]
        elif above:
            dexels.ends[place, 0], dexels.facet[place, 0] = b, facet[1]
        if below or above:
            if kept != place:
                _move(dexels, place, kept)
            kept += 1
        place += 1
    dexels.filled[line] = kept - dexels.first[line]
    return Piece(length, volume, moment, lowest, highest, longest)


@arithmetic_kernel
def _move(dexels: Dexels, source: int, target: int) -> None:
    for end in range(2):
        dexels.ends[target, end] = dexels.ends[source, end]
        dexels.facet[target, end] = dexels.facet[source, end]


@arithmetic_kernel
def _move_to_end(dexels: Dexels, line: int) -> bool:
    """Give a line twice the memory at the end of what is used; False: there is none."""
    capacity = 2 * dexels.capacity[line] + 1
    target = dexels.used[0]
    if target + capacity > len(dexels.ends):
        return False
    first = dexels.first[line]
    for i in range(dexels.filled[line]):
        _move(dexels, first + i, target + i)
    dexels.first[line] = target
    dexels.capacity[line] = capacity
    dexels.used[0] = target + capacity
    return True
