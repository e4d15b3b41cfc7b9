"""Where blocks are cut into pieces, and what roundings add to each.

Along the path the polynomials that are added change where a rounding begins, at its border, and
where it ends. One sum of them is carried along; it is made again before what rounding errors of a
narrow rounding have left in its highest powers can grow.
"""

import math

import numpy as np

from twin.compilation.kernel import array_kernel, kernel
from twin.motion.pieces.rounding_kernels import Roundings, add_roundings
from twin.nc.canonical import FloatArray, IntArray
from twin.toolpath.geometry_kernels import is_curve

PIECE_ANGLE = math.radians(5.0)
"""Longest piece of an arc: the limits of X and Y change little over it [rad]."""

SHORTEST_PIECE = 1e-8
"""Cuts closer than this to another are left out [mm or deg]; a rounding that begins there has
grown by less than 1e-16 mm."""


@array_kernel
def cut_blocks(
    length: FloatArray, angle: FloatArray, bend: FloatArray,
    width: FloatArray, tangent_step: FloatArray, curvature_step: FloatArray,
) -> tuple[IntArray, FloatArray, FloatArray, FloatArray]:  # fmt: skip
    """Cut blocks where a rounding begins or ends, and arcs into short angles.

    Args:
        length: Of all blocks, shape (n,).
        angle: Sweep of all blocks, 0 for lines, shape (n,) [rad].
        bend: Of all blocks, as in ``Geometry``, shape (n, k, 4).
        width: Of the rounding of the border before each block, shape (n,).
        tangent_step: Step of dq/dx there, shape (n, k).
        curvature_step: Step of d²q/dx² there, shape (n, k).

    Returns:
        Of each piece: its block, its begin from the block's begin, its length, and what its
        roundings and its curve add, shapes (m,), (m,), (m,), (m, k, 6).
    """
    count = len(length)
    place = np.zeros(count + 1)
    for i in range(count):
        place[i + 1] = place[i] + length[i]
    capacity = 0
    for i in range(count):
        capacity += max(1, math.ceil(abs(angle[i]) / PIECE_ANGLE)) + 2 * int(width[i] > 0.0)
    owner = np.zeros(capacity, np.int64)
    offset = np.zeros(capacity)
    extent = np.zeros(capacity)
    first_end, ends, sources = _ends_by_block(place, width)
    used = 0
    for i in range(count):
        parts = max(1, math.ceil(abs(angle[i]) / PIECE_ANGLE))
        part, at, begin = 1, first_end[i], 0.0
        by_angle = length[i] / parts
        while True:
            # The next cut of the two kinds.
            if at < first_end[i + 1] and ends[at] - place[i] < by_angle:
                cut = ends[at] - place[i]
                at += 1
            elif part < parts:
                cut = by_angle
                part += 1
                by_angle = length[i] * part / parts
            else:
                break
            if cut - begin > SHORTEST_PIECE and length[i] - cut > SHORTEST_PIECE:
                owner[used], offset[used], extent[used] = i, begin, cut - begin
                used += 1
                begin = cut
        owner[used], offset[used], extent[used] = i, begin, length[i] - begin
        used += 1
    owner, offset, extent = owner[:used], offset[:used], extent[:used]
    rounding = np.empty((used, tangent_step.shape[1], 6))
    if len(ends) == 0:
        rounding[:] = 0.0
    else:
        roundings = Roundings(place, width, tangent_step, curvature_step)
        add_roundings(roundings, owner, offset, extent, ends, sources, rounding)
    for piece in range(used):
        i = owner[piece]
        if is_curve(bend, i):
            scale = 1.0 / float(length[i])
            _add_curve(bend[i], offset[piece] * scale, scale, rounding[piece])
    return owner, offset, extent, rounding


@kernel
def _add_curve(bend: FloatArray, begin: float, scale: float, added: FloatArray) -> None:
    """Add the polynomials of a curve, by powers of x from a piece's begin.

    Args:
        bend: Coefficients by powers 2 to 5 of u, shape (k, 4).
        begin: u at the piece's begin.
        scale: u per x.
        added: Coefficients by powers of x, shape (k, 6).
    """
    for axis in range(len(bend)):
        for power in range(2, 6):
            # The terms of (begin + scale x)^power.
            binomial = 1.0
            for x_power in range(power + 1):
                term = binomial * begin ** (power - x_power) * scale**x_power
                added[axis, x_power] += bend[axis, power - 2] * term
                binomial = binomial * (power - x_power) / (x_power + 1)


@array_kernel
def place_pieces(
    length: FloatArray, move: IntArray, entry: FloatArray, overlap: FloatArray,
    owner: IntArray, offset: FloatArray,
) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:  # fmt: skip
    """Where pieces lie in their moves, and how they may be entered.

    Args:
        length: Of all blocks, 0 for dwells, shape (n,).
        move: Of all blocks, -1 for dwells before the first, shape (n,).
        entry: Highest v at the borders before blocks, shape (n,).
        overlap: How far from a stop there moves may overlap, shape (n,).
        owner: From ``cut_blocks``, shape (m,).
        offset: From ``cut_blocks``, shape (m,).

    Returns:
        Path fraction per x, path fraction at the begin, highest v there, overlap there; shape (m,)
        each. A dwell is at the end of the move before it.
    """
    count = len(owner)
    scale, begin, highest = np.zeros(count), np.zeros(count), np.full(count, math.inf)
    overlapping = np.zeros(count)
    for piece in range(count):
        i = owner[piece]
        if length[i] > 0.0:
            scale[piece] = 1.0 / length[i]
            begin[piece] = offset[piece] * scale[piece]
        elif move[i] >= 0:
            begin[piece] = 1.0
        if offset[piece] == 0.0:
            highest[piece], overlapping[piece] = entry[i], overlap[i]
    return scale, begin, highest, overlapping


@array_kernel
def _ends_by_block(place: FloatArray, width: FloatArray) -> tuple[IntArray, FloatArray, IntArray]:
    """Where roundings begin and end, in order.

    Args:
        place: Where each block begins and, last, where the last one ends, shape (n + 1,).
        width: Shape (n,).

    Returns:
        Number of the first end within each block and, last, of all, shape (n + 1,); of m ends their
        places and the borders whose roundings they end, shape (m,) each.
    """
    count = len(width)
    first = np.zeros(count + 1, np.int64)
    inside = np.full((count, 2), -1)
    before, after = 0, 0
    for i in range(count):
        if width[i] > 0.0:
            # From where those of the border before were found: there it is not far.
            begin, end = place[i] - width[i], place[i] + width[i]
            before, after = min(before, i - 1), max(after, i)
            while before > 0 and place[before] > begin:
                before -= 1
            while before < i - 1 and place[before + 1] <= begin:
                before += 1
            while after > i and place[after] > end:
                after -= 1
            while after < count - 1 and place[after + 1] <= end:
                after += 1
            inside[i, 0], inside[i, 1] = before, after
            first[before + 1] += 1
            first[after + 1] += 1
    for i in range(count):
        first[i + 1] += first[i]
    filled = first[:-1].copy()
    ends, sources = np.zeros(first[count]), np.zeros(first[count], np.int64)
    for i in range(count):
        for side in range(2):
            block = inside[i, side]
            if block < 0:
                continue
            end = place[i] - width[i] if side == 0 else place[i] + width[i]
            row = filled[block]
            while row > first[block] and ends[row - 1] > end:
                ends[row], sources[row] = ends[row - 1], sources[row - 1]
                row -= 1
            ends[row], sources[row] = end, i
            filled[block] += 1
    return first, ends, sources
