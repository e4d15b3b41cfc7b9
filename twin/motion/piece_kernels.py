"""Where blocks are cut into pieces, and how far the path's derivatives go along each."""

import math

import numba
import numpy as np

from twin.motion.corner_kernels import MOST_NEIGHBOURS, add_rounding
from twin.nc.canonical import FloatArray, IntArray

PIECE_ANGLE = math.radians(5.0)
"""Longest piece of an arc: the limits of X and Y change little over it [rad]."""

SHORTEST_PIECE = 1e-6
"""Cuts closer than this to another are left out [mm or deg]; a rounding that begins there has
grown by less than 1e-12 mm."""

POINTS = 5
"""Of each piece at which derivatives are looked at, ends included."""


@numba.njit(cache=True)
def cut_blocks(
    length: FloatArray, angle: FloatArray, width: FloatArray, knee: FloatArray, bend: FloatArray,
) -> tuple[IntArray, FloatArray, FloatArray, FloatArray]:  # fmt: skip
    """Cut blocks where a rounding begins or ends, and arcs into short angles.

    Args:
        length: Of all blocks, shape (n,).
        angle: Sweep of all blocks, 0 for lines, shape (n,) [rad].
        width: Of the rounding of the border before each block, shape (n,).
        knee: Step of dq/dx there, shape (n, k).
        bend: Step of d²q/dx² there, shape (n, k).

    Returns:
        Of each piece: its block, its begin from the block's begin, its length, and what its
        roundings add, shapes (m,), (m,), (m,), (m, k, 6).
    """
    count = len(length)
    place = np.zeros(count + 1)
    for i in range(count):
        place[i + 1] = place[i] + length[i]
    capacity = 0
    for i in range(count):
        capacity += 2 + 4 * MOST_NEIGHBOURS + int(abs(angle[i]) / PIECE_ANGLE)
    owner = np.zeros(capacity, np.int64)
    offset = np.zeros(capacity)
    extent = np.zeros(capacity)
    used = 0
    rounds = np.any(width > 0.0)
    cuts = np.zeros(math.ceil(np.abs(angle).max() / PIECE_ANGLE) + 1 + 4 * MOST_NEIGHBOURS)
    for i in range(count):
        parts = max(1, math.ceil(abs(angle[i]) / PIECE_ANGLE))
        for part in range(parts):
            cuts[part] = length[i] * part / parts
        found = parts
        low, high = max(0, i - MOST_NEIGHBOURS + 1), min(count, i + MOST_NEIGHBOURS + 1)
        for other in range(low, high if rounds else low):
            if width[other] > 0.0:
                for side in (-1.0, 1.0):
                    cut = place[other] - place[i] + side * width[other]
                    if SHORTEST_PIECE < cut < length[i] - SHORTEST_PIECE:
                        cuts[found] = cut
                        found += 1
        cuts[:found].sort()
        begin = 0.0
        for cut in range(1, found + 1):
            end = length[i] if cut == found else cuts[cut]
            if cut < found and (end - begin <= SHORTEST_PIECE or length[i] - end <= SHORTEST_PIECE):
                continue
            owner[used], offset[used], extent[used] = i, begin, end - begin
            used += 1
            begin = end
    rounding = np.zeros((used, knee.shape[1], 6))
    for piece in range(used if rounds else 0):
        i = owner[piece]
        begin = place[i] + offset[piece]
        middle = begin + 0.5 * extent[piece]
        low, high = max(0, i - MOST_NEIGHBOURS + 1), min(count, i + MOST_NEIGHBOURS + 1)
        for other in range(low, high):
            if abs(middle - place[other]) < width[other]:
                away = place[i] - place[other] + offset[piece]
                if other <= i:
                    away = max(0.0, away)
                add_rounding(rounding[piece], away, width[other], knee[other], bend[other])
    return owner[:used], offset[:used], extent[:used], rounding


@numba.njit(cache=True)
def bound_derivatives(
    drift: FloatArray, cosine: FloatArray, sine: FloatArray, angle: FloatArray,
    begin: FloatArray, fraction_per_length: FloatArray, length: FloatArray, rounding: FloatArray,
) -> tuple[FloatArray, FloatArray, FloatArray]:  # fmt: skip
    """Bounds of the path's derivatives by x along pieces.

    Between two points a curve lies within h²/8 max(abs(f'')) of its chord, h being their distance.

    Args:
        drift: Columns of the pieces' ``Geometry``, and so on to ``angle``.
        cosine: See above.
        sine: See above.
        angle: See above.
        begin: Path fraction of each piece's begin, shape (n,).
        fraction_per_length: Shape (n,).
        length: Shape (n,).
        rounding: Shape (n, k, 6).

    Returns:
        Bounds of abs(q'), abs(q''), abs(q''') of each axis, shape (n, 3, k); of the length of q''
        of X Y Z together, shape (n,); and the least and greatest q' q'', shape (n, 2, k).
    """
    count, axes = drift.shape
    bounds = np.zeros((count, 3, axes))
    bend = np.zeros(count)
    product = np.zeros((count, 2, axes))
    slopes = np.zeros((POINTS, axes))
    for i in range(count):
        if angle[i] == 0.0 and not np.any(rounding[i]):
            bounds[i, 0] = np.abs(drift[i]) * fraction_per_length[i]
            continue
        h = length[i] / (POINTS - 1)
        turn = angle[i] * fraction_per_length[i]
        for order in range(1, 4):
            longest = 0.0
            for point in range(POINTS):
                x = h * point
                at = angle[i] * begin[i] + turn * x + order * (math.pi / 2.0)
                c, s = math.cos(at) * turn**order, math.sin(at) * turn**order
                total = 0.0
                for axis in range(axes):
                    value = 0.0
                    factor, raised = 1.0, 1.0
                    for n in range(1, order + 1):
                        factor *= n
                    for n in range(order, 6):
                        value += rounding[i, axis, n] * factor * raised
                        factor *= (n + 1.0) / (n + 1.0 - order)
                        raised *= x
                    if order == 1:
                        value += drift[i, axis] * fraction_per_length[i]
                    if axis < 3:
                        value += cosine[i, axis] * c + sine[i, axis] * s
                        total += value * value
                    if order == 1:
                        slopes[point, axis] = value
                    elif order == 2:
                        here = slopes[point, axis] * value
                        if point == 0:
                            product[i, :, axis] = here
                        product[i, 0, axis] = min(product[i, 0, axis], here)
                        product[i, 1, axis] = max(product[i, 1, axis], here)
                    bounds[i, order - 1, axis] = max(bounds[i, order - 1, axis], abs(value))
                longest = max(longest, math.sqrt(total))
            sags = 0.0
            for axis in range(axes):
                sag = 0.0
                factor, raised = 1.0, 1.0
                for n in range(1, order + 3):
                    factor *= n
                for n in range(order + 2, 6):
                    sag += abs(rounding[i, axis, n]) * factor * raised
                    factor *= (n + 1.0) / (n - 1.0 - order)
                    raised *= length[i]
                if axis < 3:
                    sag += math.hypot(cosine[i, axis], sine[i, axis]) * abs(turn) ** (order + 2)
                sag *= h * h / 8.0
                bounds[i, order - 1, axis] += sag
                if axis < 3:
                    sags += sag * sag
            if order == 2:
                bend[i] = longest + math.sqrt(sags)
    return bounds, bend, product


@numba.njit(cache=True)
def reachable_velocities(
    first: FloatArray, against_speeding: FloatArray, against_braking: FloatArray,
    curved: FloatArray, length: FloatArray, velocity: FloatArray,
    ceilings: FloatArray, axis_acceleration: FloatArray, speeding: FloatArray, braking: FloatArray,
    readiness: FloatArray,
) -> FloatArray:  # fmt: skip
    """The highest velocity that a curved piece sees when only velocity and acceleration count.

    With b = v²/2, so that db/dx = a, an axis's acceleration is 2 q'' b + q' a: a pass forwards and
    one backwards over b give the well-known bound. What is left of the acceleration beside this
    velocity may then be used for changing it.

    Args:
        first: Bounds of abs(q'), shape (n, k).
        against_speeding: The same of abs(q'') where its part of the acceleration adds to that of
            a > 0, else 0, shape (n, k).
        against_braking: The same for a < 0.
        curved: Whether any q'' is not 0, shape (n,).
        length: Shape (n,).
        velocity: Ceilings, shape (n,).
        ceilings: The same at the pieces' borders, shape (n + 1,).
        axis_acceleration: Shape (k,).
        speeding: Highest a of the path, shape (n,).
        braking: Highest -a of the path, shape (n,).
        readiness: Share of the acceleration that the jerk leaves on average, shape (n,).

    Returns:
        Shape (n,).
    """
    count = len(length)
    border = np.zeros(count + 1)
    for i in range(count + 1):
        highest = ceilings[i]
        if i < count:
            highest = min(highest, velocity[i])
        if i > 0:
            highest = min(highest, velocity[i - 1])
        border[i] = 0.5 * highest * highest
    for direction in range(2):
        for step in range(count):
            i = step if direction == 0 else count - 1 - step
            known, wanted = (i, i + 1) if direction == 0 else (i + 1, i)
            if border[known] >= border[wanted]:
                continue
            along = speeding[i] if direction == 0 else braking[i]
            highest = border[known] + length[i] * along * readiness[i]
            second = against_speeding if direction == 0 else against_braking
            for axis in range(len(axis_acceleration)):
                slope = first[i, axis]
                if slope > 0.0:
                    usable = axis_acceleration[axis] * readiness[i]
                    top = (slope * border[known] + length[i] * usable) / (
                        slope + 2.0 * length[i] * second[i, axis] * readiness[i]
                    )
                    highest = min(highest, top)
            border[wanted] = min(border[wanted], max(highest, border[known]))
    out = np.zeros(count)
    for i in range(count):
        # Along a straight piece velocity and acceleration do not compete.
        out[i] = velocity[i]
        if curved[i]:
            top = max(border[i], border[i + 1])
            gain = length[i] * min(speeding[i], braking[i])
            for axis in range(len(axis_acceleration)):
                if first[i, axis] > 0.0:
                    gain = min(gain, length[i] * axis_acceleration[axis] / first[i, axis])
            if top < 0.5 * gain:
                # So slow at both ends that the piece's own peak counts.
                top = 0.5 * (border[i] + border[i + 1] + gain)
            out[i] = min(out[i], math.sqrt(2.0 * top))
    return out
