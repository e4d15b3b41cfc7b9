"""The path of a tip in the part: where a move is at fractions of its length, parts of it, and curves through places of it."""

import dataclasses
import math
from typing import NamedTuple

import numpy as np

from twin.nc.canonical import Corner, FloatArray
from twin.nc.geometry.matrices import Matrix
from twin.nc.geometry.planes import Vector
from twin.nc.path.move_columns import Segment
from twin.nc.path.moves import arc_length, line_length


class PathMotion(NamedTuple):
    """Values at n places with their first and second derivatives by the path fraction, shape (n, m) each."""

    value: FloatArray
    first: FloatArray
    second: FloatArray


def tip_motion(move: Segment, fraction: FloatArray) -> PathMotion:
    """X, Y and Z of the tip at n fractions of a move, as ``canonical`` says it [mm]."""
    start, end = np.array(move.start[:3]), np.array(move.end[:3])
    u = fraction[:, None]
    if move.center is None:
        displacement = end - start
        value = start + u * displacement
        return PathMotion(value, np.tile(displacement, (len(u), 1)), np.zeros_like(value))
    center, normal, sweep = np.array(move.center), np.array(move.normal), math.radians(move.sweep)
    arm, lead = start - center, advance_of(move) * normal
    cosine, sine = np.cos(sweep * u), np.sin(sweep * u)
    across = np.cross(normal, arm)
    around, along = cosine * arm + sine * across, cosine * across - sine * arm
    # What rounding leaves between the arc's end and the move's is spread evenly, as in ``toolpath.geometry``.
    miss = end - (center + math.cos(sweep) * arm + math.sin(sweep) * across + lead)
    return PathMotion(
        center + around + u * (lead + miss), sweep * along + lead + miss, -sweep * sweep * around
    )


def part_of(move: Segment, begin: float, end: float) -> Segment:
    """A move between two fractions of it; all but X, Y and Z go evenly."""
    first, last = np.array(move.start), np.array(move.end)
    points = tip_motion(move, np.array([begin, end])).value
    places = [
        move.start
        if at == 0.0
        else move.end
        if at == 1.0
        else [*point, *(first + at * (last - first))[3:].tolist()]
        for at, point in zip((begin, end), points.tolist(), strict=True)
    ]
    center = move.center
    if center is not None:
        height = begin * advance_of(move)
        center = vector(np.array(center) + height * np.array(move.normal))
    left = last - np.array(places[1])
    left[:3] = screen_matrix(move) @ left[:3]
    return dataclasses.replace(
        move,
        start=places[0],
        end=places[1],
        display=(np.array(move.display) - left).tolist(),
        corner=move.corner if end == 1.0 else Corner.EXACT_PATH,
        center=None if begin == end else center,
        sweep=move.sweep * (end - begin),
    )


def hermite(motion: PathMotion, steps: FloatArray) -> FloatArray:
    """Polynomials of the fifth degree between n + 1 places, coefficients by powers 1 to 5, shape (n, m, 5).

    Args:
        steps: Of the path fraction between them, shape (n,).
    """
    value, first, second = motion
    change, step = np.diff(value, axis=0), steps[:, None]
    v, w = first[:-1] * step, first[1:] * step
    a, b = second[:-1] * step * step, second[1:] * step * step
    return np.stack(
        [
            v,
            0.5 * a,
            10.0 * change - 6.0 * v - 4.0 * w - 1.5 * a + 0.5 * b,
            -15.0 * change + 8.0 * v + 7.0 * w + 1.5 * a - b,
            6.0 * change - 3.0 * (v + w) - 0.5 * (a - b),
        ],
        axis=2,
    )


def advance_of(move: Segment) -> float:
    """What an arc goes along its axis [mm]."""
    if move.center is None:
        return 0.0
    return sum((move.end[axis] - move.start[axis]) * move.normal[axis] for axis in range(3))


def length_of(move: Segment) -> float:
    """Of the tip's path in the part [mm]."""
    if move.center is None:
        return line_length(move.start[:3], list(move.end[:3]))
    return arc_length(move.start, move.end, move.center, move.normal, move.sweep)


def screen_matrix(move: Segment) -> FloatArray:
    """What a millimetre of X, Y and Z adds to what the screen shows, as columns, shape (3, 3)."""
    return np.eye(3) if move.screen is None else np.array(move.screen)


def screen_from(move: Segment, frame: FloatArray) -> Matrix:
    """What a move whose X, Y and Z are given in another frame adds to what the screen shows (``Segment.screen``)."""
    rows = frame if move.screen is None else np.array(move.screen) @ frame
    return (vector(rows[0]), vector(rows[1]), vector(rows[2]))


def vector(values: FloatArray | list[float]) -> Vector:
    """The first three of some values."""
    x, y, z = (float(value) for value in values[:3])
    return (x, y, z)
