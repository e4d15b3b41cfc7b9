"""Which pairs their planes keep apart along samples."""

import math
from typing import NamedTuple

import numpy as np

from twin.compilation.kernel import array_kernel, kernel
from twin.machine.watching.track_kernels import BodyChain, TrackedPoints, follow_tracks
from twin.nc.canonical import FloatArray, IntArray


class PlaneColumns(NamedTuple):
    """The planes between the geoms of p pairs.

    Attributes:
        clearance: When it was measured [mm]; minus infinity: never. Shape (p,).
        normal: Towards the geom that is followed, in the frame of the other, shape (p, 3).
        place: Where that geom's track was when it was measured, shape (p, w).
        reach: Farthest that a point of the geom is displaced by turning [mm/rad], shape (p,).
        slack: 1 where there is no plane, and any displacement may bring the two together; else 0.
        track: Number of the track of each pair, shape (p,).
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


class PlaneWatch(NamedTuple):
    """All that a look takes, in as few arrays as hold it: to hand one over takes half a microsecond.

    Attributes:
        sizes: Pairs, tracks, rotary axes, bodies, joints and axes.
        numbers: The columns of numbers, one after the other.
        places: The columns of places, likewise.
    """

    sizes: tuple[int, int, int, int, int, int]
    numbers: FloatArray
    places: IntArray


def watched(planes: PlaneColumns, chain: BodyChain, followed: TrackedPoints) -> PlaneWatch:
    """Lay the columns one after the other, in the order in which ``view_columns`` takes them."""
    clearance, normal, place, reach, slack, track, near, threshold = planes
    numbers = (
        clearance, normal, place, reach, slack, near, threshold, chain.place, chain.turn, chain.along,
        chain.anchor, chain.rest, chain.scale, followed.point,
    )  # fmt: skip
    places = (
        track, chain.parent, chain.first, chain.axis, chain.hinge, followed.frame, followed.body,
        followed.turning,
    )  # fmt: skip
    sizes = (
        len(track), *followed.turning.shape, len(chain.parent), len(chain.axis), len(chain.scale)
    )  # fmt: skip
    return PlaneWatch(
        sizes,
        np.concatenate([column.ravel() for column in numbers]),
        np.concatenate([column.ravel() for column in places]).astype(np.int64),
    )


def view_columns(watched: PlaneWatch) -> tuple[PlaneColumns, BodyChain, TrackedPoints]:
    """The columns as views: what is written into them is written into ``watched``."""
    pairs, tracks, rotary, bodies, joints, axes = watched.sizes
    width, many, few = 3 + rotary, watched.numbers, watched.places
    clearance, many = many[:pairs], many[pairs:]
    normal, many = many[: 3 * pairs].reshape((pairs, 3)), many[3 * pairs :]
    place, many = many[: width * pairs].reshape((pairs, width)), many[width * pairs :]
    reach, slack, near = many[:pairs], many[pairs : 2 * pairs], many[2 * pairs : 3 * pairs]
    threshold, many = many[3 * pairs : 4 * pairs], many[4 * pairs :]
    stand, many = many[: 3 * bodies].reshape((bodies, 3)), many[3 * bodies :]
    turn, many = many[: 9 * bodies].reshape((bodies, 3, 3)), many[9 * bodies :]
    along, many = many[: 3 * joints].reshape((joints, 3)), many[3 * joints :]
    anchor, many = many[: 3 * joints].reshape((joints, 3)), many[3 * joints :]
    rest, scale, many = many[:joints], many[joints : joints + axes], many[joints + axes :]
    point = many.reshape((tracks, 3))
    track, few = few[:pairs], few[pairs:]
    parent, first, few = few[:bodies], few[bodies : 2 * bodies + 1], few[2 * bodies + 1 :]
    axis, hinge, few = few[:joints], few[joints : 2 * joints], few[2 * joints :]
    frame, body, few = few[:tracks], few[tracks : 2 * tracks], few[2 * tracks :]
    return (
        PlaneColumns(clearance, normal, place, reach, slack, track, near, threshold),
        BodyChain(parent, stand, turn, first, axis, hinge, along, anchor, rest, scale),
        TrackedPoints(frame, body, point, few.reshape((tracks, rotary))),
    )


_columns_of = array_kernel(view_columns)
"""For kernels alone: views that compiled code gives to Python may not outlive the interpreter."""


@array_kernel
def follow_suspects(
    watched: PlaneWatch, position: FloatArray, known: int, touch: float
) -> tuple[FloatArray, IntArray]:
    """The tracks along samples, and the pairs that are not cleared of the box around all of them.

    Args:
        watched: The planes of all pairs, what the axes carry and what is followed.
        position: Of the axes, shape (n, k) [mm or deg].
        known: Rows that were looked at before.
        touch: As in ``least_clearance``.
    """
    planes, chain, followed = _columns_of(watched)
    tracks = follow_tracks(chain, followed, position)
    every = np.arange(len(planes.track))
    return tracks, find_suspects(planes, every, tracks, known, len(position), touch)


@array_kernel
def find_suspects(
    planes: PlaneColumns, pairs: IntArray, tracks: FloatArray, first: int, last: int, touch: float
) -> IntArray:
    """The pairs that their planes do not clear wherever their tracks go within boxes.

    Args:
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
