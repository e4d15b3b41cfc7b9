"""Thin samples: choose those between which the tool moved straight."""

import numpy as np

from twin.compilation.kernel import array_kernel
from twin.nc.canonical import FloatArray, IntArray


@array_kernel
def thin(
    points: FloatArray, group: IntArray, tolerance: float, longest: float, most: int
) -> IntArray:
    """Choose samples between which the tool moved straight.

    From each chosen sample on, samples are passed over while all that were passed lie within
    ``tolerance`` of the straight line between the chosen ones, the line is no longer than
    ``longest``, and the group stays the same.

    Args:
        points: Tool positions, shape (n, 3) [mm].
        group: Samples of different groups are never joined, shape (n,).
        tolerance: Largest distance of a sample from the line that replaces it [mm].
        longest: Longest line [mm].
        most: Most samples that one line may replace.

    Returns:
        Indices of the chosen samples, rising; the first and the last sample are among them.
    """
    count = len(points)
    chosen = np.zeros(count, np.int64)
    kept = 1
    anchor = 0
    while anchor < count - 1:
        last = anchor + 1
        while last + 1 < count and last + 1 - anchor <= most:
            following = last + 1
            if group[following] != group[last]:
                break
            if not _straight(points, anchor, following, tolerance, longest):
                break
            last = following
        chosen[kept] = last
        kept += 1
        anchor = last
    return chosen[:kept]


@array_kernel
def _straight(points: FloatArray, first: int, last: int, tolerance: float, longest: float) -> bool:
    ax, ay, az = points[first]
    dx, dy, dz = points[last, 0] - ax, points[last, 1] - ay, points[last, 2] - az
    squared = dx * dx + dy * dy + dz * dz
    if squared > longest * longest:
        return False
    for between in range(first + 1, last):
        px, py, pz = points[between, 0] - ax, points[between, 1] - ay, points[between, 2] - az
        share = 0.0
        if squared > 0.0:
            share = min(1.0, max(0.0, (px * dx + py * dy + pz * dz) / squared))
        px, py, pz = px - share * dx, py - share * dy, pz - share * dz
        if px * px + py * py + pz * pz > tolerance * tolerance:
            return False
    return True


@array_kernel
def thin_poses(
    tips: FloatArray, tops: FloatArray, group: IntArray, tolerance: float, longest: float, most: int
) -> IntArray:
    """Choose samples between which two points of a tool moved straight; see ``thin``.

    Args:
        tips: One of them, shape (n, 3) [mm].
        tops: The other.
        group: As for ``thin``.
        tolerance: As for ``thin``.
        longest: As for ``thin``.
        most: As for ``thin``.
    """
    count = len(tips)
    chosen = np.zeros(count, np.int64)
    kept, anchor = 1, 0
    while anchor < count - 1:
        last = anchor + 1
        while last + 1 < count and last + 1 - anchor <= most:
            following = last + 1
            if group[following] != group[last]:
                break
            if not _straight(tips, anchor, following, tolerance, longest):
                break
            if not _straight(tops, anchor, following, tolerance, longest):
                break
            last = following
        chosen[kept] = last
        kept += 1
        anchor = last
    return chosen[:kept]
