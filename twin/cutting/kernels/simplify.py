"""Thin samples: choose those between which the tool moved straight."""

import numpy as np

from twin.compilation.kernel import array_kernel
from twin.nc.canonical import FloatArray, IntArray


@array_kernel
def simplify(
    points: FloatArray, group: IntArray, tolerance: float, longest: float, most: int
) -> IntArray:
    """Choose samples between which points of the tool moved straight.

    From each chosen sample on, samples are passed over while of each point all places that were passed lie
    within ``tolerance`` of the straight line between the chosen ones, the line is no longer than
    ``longest``, and the group stays the same.

    Args:
        points: Places of each of w points of the tool, shape (w, n, 3) [mm]: its tip, and where it turns
            another one.
        group: Samples of different groups are never joined, shape (n,).
        tolerance: Largest distance of a sample from the line that replaces it [mm].
        longest: Longest line [mm].
        most: Most samples that one line may replace.

    Returns:
        Indices of the chosen samples, rising; the first and the last sample are among them.
    """
    count = points.shape[1]
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
    for path in points:
        ax, ay, az = path[first]
        dx, dy, dz = path[last, 0] - ax, path[last, 1] - ay, path[last, 2] - az
        squared = dx * dx + dy * dy + dz * dz
        if squared > longest * longest:
            return False
        for between in range(first + 1, last):
            px, py, pz = path[between, 0] - ax, path[between, 1] - ay, path[between, 2] - az
            share = 0.0
            if squared > 0.0:
                share = min(1.0, max(0.0, (px * dx + py * dy + pz * dz) / squared))
            px, py, pz = px - share * dx, py - share * dy, pz - share * dz
            if px * px + py * py + pz * pz > tolerance * tolerance:
                return False
    return True
