"""Where what hangs on the axes goes, sample by sample."""

import math
from typing import NamedTuple

import numpy as np

from twin.compilation.kernel import array_kernel, kernel
from twin.nc.canonical import FloatArray, IntArray
from twin.units import MM


class BodyChain(NamedTuple):
    """b bodies, each after the one that carries it, the world first; they turn and slide on j joints.

    Attributes:
        parent: Row of the body that carries each, shape (b,).
        place: Where it is on it, shape (b, 3) [m].
        turn: How it is turned on it, shape (b, 3, 3).
        first: First joint of each body and, last, j; shape (b + 1,).
        axis: Axis of each joint, shape (j,).
        hinge: 1 where it turns, 0 where it slides, shape (j,).
        along: Direction in which it slides or about which it turns, shape (j, 3).
        anchor: A point that stays where it is when it turns, shape (j, 3) [m].
        rest: Where the model says that it stands, shape (j,) [m or rad].
        scale: What each axis moves per unit, shape (k,) [m/mm or rad/deg].
    """

    parent: IntArray
    place: FloatArray
    turn: FloatArray
    first: IntArray
    axis: IntArray
    hinge: IntArray
    along: FloatArray
    anchor: FloatArray
    rest: FloatArray
    scale: FloatArray


class TrackedPoints(NamedTuple):
    """t points, each as seen from a body.

    Attributes:
        frame: Row of the body that each is seen from, shape (t,).
        body: Row of the body that it belongs to, shape (t,).
        point: Where it is in that body's frame, shape (t, 3) [m].
        turning: Columns of the rotary axes that turn the two against each other, shape (t, r);
            -1: that rotary axis does not.
    """

    frame: IntArray
    body: IntArray
    point: FloatArray
    turning: IntArray


@array_kernel
def follow_tracks(chain: BodyChain, followed: TrackedPoints, position: FloatArray) -> FloatArray:
    """Follow points along samples.

    Args:
        position: Of the axes, shape (n, k) [mm or deg].

    Returns:
        Each point in its frame [mm], and where each rotary axis is [rad] if it turns the two
        against each other, else 0; shape (t, 3 + r, n).
    """
    joint = position * chain.scale
    count, bodies = len(joint), len(chain.parent)
    tracks = np.zeros((len(followed.frame), 3 + followed.turning.shape[1], count))
    place, turn = np.zeros((bodies, 3)), np.zeros((bodies, 3, 3))
    scratch, moved = np.zeros((3, 3)), np.zeros(3)
    for i in range(3):
        turn[0, i, i] = 1.0
    for row in range(count):
        for body in range(1, bodies):
            _place_body(chain, joint[row], body, place, turn, scratch)
        for track in range(len(followed.frame)):
            frame, body = followed.frame[track], followed.body[track]
            for i in range(3):
                moved[i] = place[body, i] + _component(turn[body], followed.point[track], i)
                moved[i] -= place[frame, i]
            for i in range(3):
                seen = 0.0
                for k in range(3):
                    seen += turn[frame, k, i] * moved[k]
                tracks[track, i, row] = seen / MM
            for rotary in range(followed.turning.shape[1]):
                axis = followed.turning[track, rotary]
                if axis >= 0:
                    tracks[track, 3 + rotary, row] = joint[row, axis]
    return tracks


@kernel
def _place_body(
    chain: BodyChain, joint: FloatArray, body: int, place: FloatArray, turn: FloatArray,
    scratch: FloatArray,
) -> None:  # fmt: skip
    """Write place and orientation of a body whose carrier has its own.

    Args:
        joint: Of the axes, shape (k,).
        body: Row of the body.
        place: Of the bodies, shape (b, 3).
        turn: Of the bodies, shape (b, 3, 3).
        scratch: Shape (3, 3).
    """
    carrier, own = chain.parent[body], turn[body]
    for i in range(3):
        place[body, i] = place[carrier, i] + _component(turn[carrier], chain.place[body], i)
    _multiply(turn[carrier], chain.turn[body], own)
    for number in range(chain.first[body], chain.first[body + 1]):
        moved = joint[chain.axis[number]] - chain.rest[number]
        if not chain.hinge[number]:
            for i in range(3):
                place[body, i] += _component(own, chain.along[number], i) * moved
            continue
        for i in range(3):
            place[body, i] += _component(own, chain.anchor[number], i)
        _write_turn(chain.along[number], moved, scratch)
        _multiply(own, scratch, own)
        for i in range(3):
            place[body, i] -= _component(own, chain.anchor[number], i)


@kernel
def _component(turn: FloatArray, vector: FloatArray, i: int) -> float:
    """One component of a turned vector."""
    return turn[i, 0] * vector[0] + turn[i, 1] * vector[1] + turn[i, 2] * vector[2]


@kernel
def _multiply(one: FloatArray, two: FloatArray, result: FloatArray) -> None:
    """Rotations one after another; the result may take the place of the first."""
    for i in range(3):
        x, y, z = one[i, 0], one[i, 1], one[i, 2]
        for k in range(3):
            result[i, k] = x * two[0, k] + y * two[1, k] + z * two[2, k]


@kernel
def _write_turn(axis: FloatArray, angle: float, result: FloatArray) -> None:
    """A rotation about an axis (Rodrigues)."""
    c, s = math.cos(angle), math.sin(angle)
    x, y, z = axis[0], axis[1], axis[2]
    rest = 1.0 - c
    result[0, 0], result[0, 1], result[0, 2] = (
        c + rest * x * x,
        rest * x * y - s * z,
        rest * x * z + s * y,
    )
    result[1, 0], result[1, 1], result[1, 2] = (
        rest * x * y + s * z,
        c + rest * y * y,
        rest * y * z - s * x,
    )
    result[2, 0], result[2, 1], result[2, 2] = (
        rest * x * z - s * y,
        rest * y * z + s * x,
        c + rest * z * z,
    )
