"""Segments: runs of pieces that are driven as one, under the strictest of their limits.

The jerk limit keeps a path from following limits that change faster than it can; so pieces that
differ little, or that are together too short for their differences to be used, may be one.
"""

import numpy as np

from twin.compilation.kernel import array_kernel
from twin.motion.profile.backward_pass_kernels import SLOWEST
from twin.motion.ramp_kernels import brake_distance
from twin.nc.canonical import FloatArray, IntArray

ALIKE = 0.995
"""Ratio from which on limits count as the same: what a cycle may lose by it is half of that."""

SHORT_RAMP = 0.25
"""Share of the distance that a change between the velocities of a segment would take, which the segment
may be as long as."""

SHORT_DELAY = 0.25
"""Share of the time from zero to full acceleration that passing a segment may take."""


@array_kernel
def find_segments(limits: FloatArray, entry: FloatArray, feed: FloatArray) -> IntArray:
    """Where segments begin.

    Args:
        limits: Rows length, velocity, acceleration, deceleration, jerk of n pieces, shape (5, n).
        entry: Highest v at the begin of each piece, shape (n,).
        feed: What the program asks for; it is the same all along a segment, shape (n,).

    Returns:
        First piece of each of m segments and, last, n; shape (m + 1,).
    """
    count = limits.shape[1]
    begins = np.zeros(count + 1, np.int64)
    used = 0
    length = 0.0
    least, most = np.zeros(4), np.zeros(4)
    for piece in range(count):
        here = limits[0, piece]
        joins = length > 0.0 and here > 0.0 and entry[piece] >= SLOWEST
        if joins and feed[piece] != feed[piece - 1]:
            joins = False
        if joins:
            alike = True
            for row in range(4):
                value = limits[row + 1, piece]
                if row == 0:
                    value = min(value, entry[piece])
                low, high = min(least[row], value), max(most[row], limits[row + 1, piece])
                alike = alike and low >= ALIKE * high
            if not alike:
                slow = min(least[0], limits[1, piece], entry[piece])
                fast = max(most[0], limits[1, piece])
                gentle = min(least[1], least[2], limits[2, piece], limits[3, piece])
                jerk = min(least[3], limits[4, piece])
                joins = length + here <= min(
                    SHORT_DELAY * slow * gentle / jerk,
                    SHORT_RAMP * brake_distance(fast, slow, gentle, jerk),
                ) or (fast <= slow / ALIKE and length + here <= SHORT_DELAY * slow * gentle / jerk)
        if not joins:
            begins[used] = piece
            used += 1
            length = 0.0
            least[:] = limits[1:, piece]
            most[:] = limits[1:, piece]
        length += here
        for row in range(4):
            least[row] = min(least[row], limits[row + 1, piece])
            most[row] = max(most[row], limits[row + 1, piece])
        if joins:
            least[0] = min(least[0], entry[piece])
    begins[used] = count
    return begins[: used + 1]


@array_kernel
def merge_limits(limits: FloatArray, entry: FloatArray, begins: IntArray) -> FloatArray:
    """Limits of segments.

    Args:
        limits: As in ``find_segments``.
        entry: As in ``find_segments``.
        begins: From ``find_segments``, shape (m + 1,).

    Returns:
        As ``limits``, shape (5, m).
    """
    count = len(begins) - 1
    out = np.zeros((5, count))
    for segment in range(count):
        first = begins[segment]
        out[:, segment] = limits[:, first]
        for piece in range(first + 1, begins[segment + 1]):
            out[0, segment] += limits[0, piece]
            out[1, segment] = min(out[1, segment], limits[1, piece], entry[piece])
            for row in range(2, 5):
                out[row, segment] = min(out[row, segment], limits[row, piece])
    return out


@array_kernel
def place_phases(
    phases: FloatArray, segments: IntArray, begins: IntArray, lengths: FloatArray
) -> IntArray:
    """Tell in which pieces phases begin and end, and count their x from the begin of the first.

    Args:
        phases: Rows begin [s], duration [s], x within the segment, v, a, j; x is overwritten by
            that within the piece; shape (m, 6).
        segments: First and last segment of each phase, shape (m, 2).
        begins: From ``find_segments``.

    Returns:
        First and last piece of each phase, shape (m, 2).
    """
    out = np.zeros_like(segments)
    segment, piece, behind = -1, 0, 0.0
    for row in range(len(segments)):
        if segments[row, 0] != segment:
            segment = segments[row, 0]
            piece, behind = begins[segment], 0.0
        last = begins[segment + 1] - 1
        while piece < last and phases[row, 2] - behind >= lengths[piece]:
            behind += lengths[piece]
            piece += 1
        out[row, 0] = piece
        out[row, 1] = begins[segments[row, 1] + 1] - 1
        phases[row, 2] = max(0.0, phases[row, 2] - behind)
    return out
