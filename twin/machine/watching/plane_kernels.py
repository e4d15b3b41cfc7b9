"""Which pairs their planes keep apart along samples."""

import math
from typing import NamedTuple

import numpy as np

from twin.compilation.kernel import array_kernel, kernel
from twin.machine.watching.track_kernels import Chain, Followed, follow_tracks
from twin.nc.canonical import FloatArray, IntArray


class PlaneColumns(NamedTuple):
    """The planes between the geoms of p pairs.

    Attributes:
        clearance: When it was measured [mm]; minus infinity: never. Shape (p,).
        normal: Towards the geom that is followed, in the frame of the other, shape (p, 3).
        place: Where that geom's track was when it was measured, shape (p, w).
        reach: Farthest that a point of the geom is displaced by turning [mm/rad], shape (p,).
        slack: 1 where there is no plane, and any displacement may bring the two together; else 0.
        track: Which track tells of each pair, shape (p,).
        near: As in ``least_clearance``, shape (p,).
        threshold: Likewise.
    """

    clearance: FloatArray
    normal: FloatArray
    place: FloatArray
    reach: FloatArray
    slack: FloatArray
    track: IntArray
    near: FloatArray
    threshold: FloatArray


@kernel
def least_clearance(near: float, threshold: float, touch: float) -> float:
    """Clearance below which a pair is measured [mm]; what was acknowledged always is.

    Args:
        near: Below which it is a near miss.
        threshold: Below which it is a collision.
        touch: What ``threshold`` is where nothing was acknowledged.
    """
    return math.inf if threshold < touch else max(near, threshold)


@array_kernel
def follow_suspects(
    planes: PlaneColumns, chain: Chain, followed: Followed, position: FloatArray, known: int,
    touch: float,
) -> tuple[FloatArray, IntArray]:  # fmt: skip
    """The tracks along samples, and the pairs that are not cleared of the box around all of them.

    Args:
        planes: Of all pairs.
        chain: What the axes carry.
        followed: What is followed.
        position: Of the axes, shape (n, k) [mm or deg].
        known: Rows that were looked at before.
        touch: As in ``least_clearance``.
    """
    tracks = follow_tracks(chain, followed, position)
    every = np.arange(len(planes.track))
    return tracks, find_suspects(planes, every, tracks, known, len(position), touch)


@array_kernel
def find_suspects(
    planes: PlaneColumns, pairs: IntArray, tracks: FloatArray, first: int, last: int, touch: float
) -> IntArray:
    """The pairs that their planes do not clear wherever their tracks go within boxes.

    Args:
        planes: Of all pairs.
        pairs: Numbers of m pairs.
        tracks: Shape (t, w, n).
        first: First sample; the boxes are those around it and what follows.
        last: Sample after the last.
        touch: As in ``least_clearance``.
    """
    width = tracks.shape[1]
    low, high = np.full(tracks.shape[:2], math.inf), np.full(tracks.shape[:2], -math.inf)
    for track in range(len(tracks)):
        for column in range(width):
            for row in range(first, last):
                low[track, column] = min(low[track, column], tracks[track, column, row])
                high[track, column] = max(high[track, column], tracks[track, column, row])
    suspects, count = np.zeros(len(pairs), np.int64), 0
    for i in range(len(pairs)):
        pair = pairs[i]
        track = planes.track[pair]
        displaced, turned, approach = 0.0, 0.0, 0.0
        for column in range(width):
            below = low[track, column] - planes.place[pair, column]
            above = high[track, column] - planes.place[pair, column]
            farthest = max(-below, above)
            if column < 3:
                normal = planes.normal[pair, column]
                approach += min(normal * below, normal * above)
                displaced += farthest
            else:
                turned += farthest
        left = planes.clearance[pair] + approach
        left -= planes.reach[pair] * turned + planes.slack[pair] * displaced
        least = least_clearance(float(planes.near[pair]), float(planes.threshold[pair]), touch)
        if left < least:
            suspects[count] = pair
            count += 1
    return suspects[:count]
