"""The commanded path in the part's frame, as columns that the nearest-point kernels read.

A move over its fraction u from 0 to 1 is, in machine axes measured from the table's centre,

    p(u) = origin + u along + cos(u sweep) first + sin(u sweep) second

(lines have no sweep and no radius vectors), and the part sees it turned by the table:

    P(u) = Rz(turn + u turn_rate) p(u)

Linear axes beyond X Y Z do not move the tool against the part; they have a following error but no
contour error.

On a machine that is more than a table about Z the moves are laid out as its chain of joints
(``twin.kinematics``) carries them: where the rotary axes stand still they are lines and arcs in the part;
where these move, every joint has its coordinate as a function of u. Curves are parts of lines and arcs of the
tip in the part.
"""

from typing import NamedTuple

import numpy as np

from twin.kinematics import Kinematics, with_rotary_at_rest
from twin.nc.canonical import SPATIAL_AXES, CodeArray, FloatArray, IntArray, Moves, Shape
from twin.toolpath.part_frame import PartFrame
from twin.toolpath.place_kernels import PathKind, derivatives
from twin.units import DEGREE


class PathColumns(NamedTuple):
    """The geometry of n moves in the part's frame; every column is C-contiguous.

    Attributes:
        kind: ``PathKind`` of each, shape (n,).
        origin: Start of a line, centre of an arc at its start, shape (n, 3) [mm].
        along: What is added linearly over the move, shape (n, 3) [mm].
        first: From the centre to the start, shape (n, 3) [mm]; 0 for lines.
        second: A quarter turn further about the normal, shape (n, 3) [mm]; 0 for lines.
        sweep: Signed angle of the arc, shape (n,) [rad].
        turn: How far the table has turned the part at the start, shape (n,) [rad].
        turn_rate: How far the table turns during the move, shape (n,) [rad].
        facing: Cosine and sine of ``turn``, shape (n, 2).
        tip: Of ``PathKind.CHAIN``: where the tip is with all axes at zero, shape (n, 3) [mm].
        begin: Where each of m joints begins; of X, Y and Z nothing, shape (n, m) [rad or mm].
        rate: How far it moves during the move, shape (n, m) [rad or mm].
        joint: What each joint does: the number of X, Y or Z, or -1; whether it turns; its axis; its anchor [mm];
            shape (n, m, 8).
    """

    kind: CodeArray
    origin: FloatArray
    along: FloatArray
    first: FloatArray
    second: FloatArray
    sweep: FloatArray
    turn: FloatArray
    turn_rate: FloatArray
    facing: FloatArray
    tip: FloatArray
    begin: FloatArray
    rate: FloatArray
    joint: FloatArray


def path_columns(
    moves: Moves,
    frame: PartFrame,
    part_zero: FloatArray,
    length_difference: FloatArray | float = 0.0,
) -> PathColumns:
    """Lay out canonical moves for the nearest-point kernels.

    Args:
        moves: Moves in part coordinates (program zero).
        part_zero: Machine coordinates of program zero, shape (k,) [mm or deg].
        length_difference: How much longer than the first the tool of each move is, shape (n,) [mm]; looked at where a
            chain tilts it.
    """
    if frame.chain is None:
        columns = _turntable_columns(moves, frame, part_zero)
    else:
        columns = _chain_columns(moves, frame, frame.chain, part_zero, length_difference)
    curves = np.flatnonzero(moves.shape == Shape.CURVE)
    if len(curves):
        by = (
            np.broadcast_to(length_difference, len(moves))[curves]
            if frame.chain is not None
            else 0.0
        )
        _follow_tips(columns, curves, moves[curves], frame, part_zero, by)
    return columns


def _follow_tips(
    columns: PathColumns,
    rows: IntArray,
    curves: Moves,
    frame: PartFrame,
    part_zero: FloatArray,
    length_difference: FloatArray | float,
) -> None:
    """Put in what the tip does in the part along m curves: lines and arcs that no table turns any more."""
    start, end = (
        frame.position(place + part_zero, length_difference) for place in (curves.start, curves.end)
    )
    arc = ~np.isnan(curves.radius)[:, None]
    normal, spoke = (np.where(arc, each, 0.0) for each in (curves.normal, -curves.center))
    lead = np.einsum("ij,ij->i", end - start, normal)[:, None] * normal
    columns.along[rows] = np.where(arc, lead, end - start)
    columns.origin[rows] = start - spoke
    columns.first[rows], columns.second[rows] = spoke, np.cross(normal, spoke)
    columns.sweep[rows] = np.where(arc[:, 0], np.deg2rad(curves.sweep), 0.0)
    level = np.all(np.abs(lead) < _LEVEL, axis=1)
    columns.kind[rows] = np.where(
        arc[:, 0], np.where(level, PathKind.CIRCLE, PathKind.CURVE), PathKind.LINE
    )
    columns.along[rows] = np.where(arc & level[:, None], 0.0, columns.along[rows])
    columns.turn[rows], columns.turn_rate[rows], columns.facing[rows] = 0.0, 0.0, (1.0, 0.0)


_LEVEL = 1e-9
"""What an arc of a tip advances less is rounding [mm]."""


def _turntable_columns(moves: Moves, frame: PartFrame, part_zero: FloatArray) -> PathColumns:
    """The columns of a machine whose part turns about Z alone, or not at all."""
    shift = part_zero[:3] - np.array([*frame.center, 0.0])
    arc = moves.shape == Shape.ARC
    delta = moves.end[:, :3] - moves.start[:, :3]
    normal = np.where(arc[:, None], moves.normal, 0.0)
    first = np.where(arc[:, None], moves.start[:, :3] - moves.center, 0.0)
    lead = np.einsum("ij,ij->i", delta, normal)
    along = np.where(arc[:, None], lead[:, None] * normal, delta)
    turn, turn_rate = np.zeros(len(moves)), np.zeros(len(moves))
    if frame.rotary is not None:
        zero = part_zero[frame.rotary] - frame.turn_zero
        turn = np.deg2rad(moves.start[:, frame.rotary] + zero)
        turn_rate = np.deg2rad(moves.end[:, frame.rotary] - moves.start[:, frame.rotary])
    circle = arc & ~np.any(along, axis=1)
    kind = np.where(circle, PathKind.CIRCLE, np.where(arc, PathKind.CURVE, PathKind.LINE))
    return PathColumns(
        kind=np.where(turn_rate != 0.0, PathKind.CURVE, kind).astype(np.uint8),
        origin=np.where(arc[:, None], moves.center, moves.start[:, :3]) + shift,
        along=np.ascontiguousarray(along),
        first=first,
        second=np.cross(normal, first),
        sweep=np.where(arc, np.deg2rad(moves.sweep), 0.0),
        turn=turn,
        turn_rate=turn_rate,
        facing=np.column_stack([np.cos(turn), np.sin(turn)]),
        tip=np.zeros((len(moves), 3)),
        begin=np.zeros((len(moves), 0)),
        rate=np.zeros((len(moves), 0)),
        joint=np.zeros((len(moves), 0, 8)),
    )


def _chain_columns(
    moves: Moves,
    frame: PartFrame,
    chain: Kinematics,
    part_zero: FloatArray,
    length_difference: FloatArray | float,
) -> PathColumns:
    """The columns of a machine that is more than a table about Z."""
    count, arc = len(moves), moves.shape == Shape.ARC
    start = frame.counted(moves.start + part_zero)
    delta = moves.end - moves.start
    shift = frame.counted(part_zero[None])[0, :3]
    normal = np.where(arc[:, None], moves.normal, 0.0)
    first = np.where(arc[:, None], moves.start[:, :3] - moves.center, 0.0)
    lead = np.einsum("ij,ij->i", delta[:, :3], normal)
    origin = np.where(arc[:, None], moves.center + shift, start[:, :3])
    along = np.where(arc[:, None], lead[:, None] * normal, delta[:, :3])
    second = np.cross(normal, first)
    turning = chain.column[chain.rotary]
    turns = np.any(delta[:, turning] != 0.0, axis=1)
    at_zero, steps = with_rotary_at_rest(chain, start, length_difference)
    still, carried = ~turns[:, None], np.where(turns[:, None, None], np.eye(3), steps)

    def seen(vectors: FloatArray) -> FloatArray:
        return np.ascontiguousarray(np.einsum("nij,nj->ni", carried, vectors))

    circle = arc & ~np.any(along, axis=1)
    kind = np.where(
        turns,
        PathKind.CHAIN,
        np.where(circle, PathKind.CIRCLE, np.where(arc, PathKind.CURVE, PathKind.LINE)),
    )
    unit = np.where(chain.rotary, DEGREE, np.where(chain.column < len(SPATIAL_AXES), 0.0, 1.0))
    coordinate = np.where(chain.rotary | (chain.column >= len(SPATIAL_AXES)), -1, chain.column)
    turns_or_not = chain.rotary.astype(np.float64)
    joint = np.column_stack([coordinate, turns_or_not, chain.axis, chain.anchor])
    zeros = np.zeros(count)
    return PathColumns(
        kind=kind.astype(np.uint8),
        origin=seen(origin) + np.where(still, at_zero, 0.0),
        along=seen(along),
        first=seen(first),
        second=seen(second),
        sweep=np.where(arc, np.deg2rad(moves.sweep), 0.0),
        turn=zeros,
        turn_rate=zeros,
        facing=np.tile([1.0, 0.0], (count, 1)),
        tip=-chain.tool * np.broadcast_to(length_difference, count)[:, None],
        begin=start[:, chain.column] * unit,
        rate=delta[:, chain.column] * unit,
        joint=np.tile(joint, (count, 1, 1)),
    )


def join_paths(before: PathColumns, after: PathColumns) -> PathColumns:
    """Join consecutive paths into one."""
    return PathColumns._make(map(np.concatenate, zip(before, after, strict=True)))


def drop_moves(path: PathColumns, count: int) -> PathColumns:
    """The path without its first ``count`` moves; their memory is given back."""
    return PathColumns._make(column[count:].copy() for column in path)


class PathEnds(NamedTuple):
    """The ends of n moves in the part's frame.

    Attributes:
        point: Where each move ends, shape (n, 3) [mm].
        arriving: Unit direction at its start, shape (n, 3); 0 where the tool stands still.
        leaving: Unit direction at its end, shape (n, 3).
        speed: How fast the place moves with the fraction at start and end, shape (n, 2) [mm]; the
            length of a line or circle.
    """

    point: FloatArray
    arriving: FloatArray
    leaving: FloatArray
    speed: FloatArray


def ends_of(path: PathColumns) -> PathEnds:
    """End points and end directions of every move."""
    _, arriving, first = _at(path, 0.0)
    point, leaving, last = _at(path, 1.0)
    return PathEnds(point, arriving, leaving, np.column_stack([first, last]))


def _at(path: PathColumns, u: float) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Point, unit direction and speed at one fraction of every move."""
    cosine, sine = np.cos(u * path.sweep)[:, None], np.sin(u * path.sweep)[:, None]
    point = path.origin + u * path.along + cosine * path.first + sine * path.second
    slope = path.along + path.sweep[:, None] * (cosine * path.second - sine * path.first)
    slope[:, 0] -= path.turn_rate * point[:, 1]
    slope[:, 1] += path.turn_rate * point[:, 0]
    angle = path.turn + u * path.turn_rate
    for move in np.flatnonzero(path.kind == PathKind.CHAIN):
        seen = derivatives(path, move, u)
        point[move], slope[move] = seen[:3], seen[3:6]
    speed = np.linalg.norm(slope, axis=1)
    still = np.zeros_like(slope)
    unit = np.divide(slope, speed[:, None], out=still, where=speed[:, None] > 0.0)
    return _turned(point, angle), _turned(unit, angle), speed


def _turned(vector: FloatArray, angle: FloatArray) -> FloatArray:
    cosine, sine = np.cos(angle), np.sin(angle)
    return np.column_stack(
        [
            cosine * vector[:, 0] - sine * vector[:, 1],
            sine * vector[:, 0] + cosine * vector[:, 1],
            vector[:, 2],
        ]
    )
