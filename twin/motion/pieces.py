"""Moves cut into pieces along which the limits of the path may be taken as constant.

Along a piece the path parameter x counts what the feed counts (mm, or degrees where only rotary
axes move). With v, a, j its time derivatives and q', q'', q''' those of an axis by x, the axis has

    velocity      q' v
    acceleration  q'' v² + q' a
    jerk          q''' v³ + 3 q'' v a + q' j

A piece is short enough for bounds of |q'|, |q''|, |q'''| to say nearly all there is to say.
"""

import dataclasses
from collections.abc import Iterable, Iterator

import numpy as np

from twin.motion.limits import MotionLimits
from twin.nc.canonical import Chunk, Dwell, FloatArray, IntArray, Motion, Moves
from twin.toolpath.geometry import Geometry, geometry, joined
from twin.units import SECONDS_PER_MINUTE

PIECE_ANGLE = np.deg2rad(10.0)
"""Longest piece of an arc: the limits of X and Y change little over it [rad]."""

SHORTEST = 1e-9
"""A shorter move takes no time [mm or deg]: a thousandth of the nanometre the path is kept to."""

CENTRIPETAL_SHARE = 0.8
"""Of an axis's acceleration that following a curve may use; the rest is left to change speed."""

CURVE_JERK_SHARE = 0.5
"""Of an axis's jerk that a curve may use at constant speed, and again at constant acceleration."""

JOIN_TOLERANCE = 1e-6
"""Largest gap between consecutive moves that is rounding, not a fault [mm or deg]."""


@dataclasses.dataclass(frozen=True, slots=True)
class Pieces:
    """A run of n pieces, as columns. A dwell is a piece without length.

    Attributes:
        move: Number of the move in the whole program, -1 before the first, shape (n,).
        line: Source line, shape (n,).
        begin: Path fraction of the move at which the piece begins, shape (n,).
        fraction_per_length: Path fraction per x, shape (n,) [1/mm or 1/deg].
        length: In x, shape (n,) [mm or deg]; 0 for dwells.
        velocity: Highest v, shape (n,) [mm/s or deg/s].
        acceleration: Highest a, shape (n,) [mm/s² or deg/s²].
        deceleration: Highest -a, shape (n,) [mm/s² or deg/s²].
        jerk: Highest abs(j), shape (n,) [mm/s³ or deg/s³].
        entry: Highest v at the begin, shape (n,) [mm/s or deg/s].
        pause: How long a dwell waits, shape (n,) [s].
        geometry: Of each piece's whole move, n rows.
    """

    move: IntArray
    line: IntArray
    begin: FloatArray
    fraction_per_length: FloatArray
    length: FloatArray
    velocity: FloatArray
    acceleration: FloatArray
    deceleration: FloatArray
    jerk: FloatArray
    entry: FloatArray
    pause: FloatArray
    geometry: Geometry

    def __len__(self) -> int:
        return len(self.line)

    def __getitem__(self, index: slice | IntArray) -> "Pieces":
        """A selection of the pieces, as columns again."""
        return Pieces(**{name: getattr(self, name)[index] for name in _NAMES})


_NAMES = tuple(field.name for field in dataclasses.fields(Pieces))


def join_pieces(parts: list[Pieces]) -> Pieces:
    """Consecutive runs of pieces as one.

    Raises:
        ValueError: There is nothing to join.
    """
    columns = {
        name: np.concatenate([getattr(part, name) for part in parts])
        for name in _NAMES
        if name != "geometry"
    }
    return Pieces(**columns, geometry=joined([part.geometry for part in parts]))


def pieces_of_moves(moves: Moves, first: int, limits: MotionLimits) -> Pieces:
    """Cut moves into pieces.

    Args:
        moves: The moves.
        first: Number of the first of them in the whole program.
        limits: Of the axes and the path.
    """
    rows = np.flatnonzero(moves.length >= SHORTEST)
    shapes = geometry(moves)[rows]
    cuts = np.maximum(1, np.ceil(np.abs(shapes.angle) / PIECE_ANGLE)).astype(np.int64)
    owner = np.repeat(np.arange(len(rows)), cuts)
    place = np.arange(len(owner)) - np.repeat(np.cumsum(cuts) - cuts, cuts)
    begin = place / cuts[owner]
    of_move = rows[owner]
    length = moves.length[of_move]
    velocity, acceleration, jerk = _constant_limits(
        moves, of_move, shapes[owner], begin, 1.0 / cuts[owner], limits
    )
    return Pieces(
        move=first + of_move,
        line=moves.line[of_move],
        begin=begin,
        fraction_per_length=1.0 / length,
        length=length / cuts[owner],
        velocity=velocity,
        acceleration=acceleration,
        deceleration=acceleration,
        jerk=jerk,
        entry=np.where(place == 0, 0.0, np.inf),
        pause=np.zeros(len(owner)),
        geometry=shapes[owner],
    )


def _constant_limits(
    moves: Moves,
    of_move: IntArray,
    shapes: Geometry,
    begin: FloatArray,
    span: FloatArray,
    limits: MotionLimits,
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Velocity, acceleration and jerk that any instant of each piece may use, shapes (n,)."""
    scale = 1.0 / moves.length[of_move]
    first, second, third = (
        _bound(shapes, begin, span, order) * scale[:, None] ** order for order in (1, 2, 3)
    )
    spatial = np.any(moves.start[of_move, :3] != moves.end[of_move, :3], axis=1) | (
        shapes.angle != 0.0
    )
    bend = np.linalg.norm(second[:, :3], axis=1)
    rotary_alone = ~spatial & (np.abs(shapes.drift[:, ~_rotary(moves)]).max(axis=1) == 0.0)
    path_acceleration = np.where(
        rotary_alone, limits.rotary_path_acceleration, limits.path_acceleration
    )
    path_jerk = np.where(rotary_alone, limits.rotary_path_jerk, limits.path_jerk)

    rapid = moves.motion[of_move] == Motion.RAPID
    velocity = np.where(rapid, np.inf, moves.feed[of_move] / SECONDS_PER_MINUTE)
    with np.errstate(divide="ignore", over="ignore"):
        velocity = np.minimum(velocity, (limits.velocity / first).min(axis=1))
        centripetal = (CENTRIPETAL_SHARE * limits.acceleration / second).min(axis=1)
        centripetal = np.minimum(centripetal, path_acceleration / bend)
        velocity = np.minimum(velocity, np.sqrt(centripetal))
        turning = (CURVE_JERK_SHARE * limits.jerk / third).min(axis=1)
        velocity = np.minimum(velocity, np.cbrt(turning))

        left = limits.acceleration - second * velocity[:, None] ** 2
        acceleration = np.minimum(path_acceleration, (left / first).min(axis=1))
        left = limits.jerk - third * velocity[:, None] ** 3
        mixed = CURVE_JERK_SHARE * left / (3.0 * second * velocity[:, None])
        acceleration = np.minimum(acceleration, mixed.min(axis=1))
        left = left - 3.0 * second * (velocity * acceleration)[:, None]
        jerk = np.minimum(path_jerk, (left / first).min(axis=1))
    return velocity, acceleration, jerk


def _rotary(moves: Moves) -> np.ndarray[tuple[int], np.dtype[np.bool_]]:
    return moves.axes.rotary()


def _bound(shapes: Geometry, begin: FloatArray, span: FloatArray, order: int) -> FloatArray:
    """Bound of abs(d^order q / du^order) of each axis over u in [begin, begin + span], (n, k).

    A curve lies within h²/8 max|f''| of its chord, h being the span; on an arc |f''| is at most
    |angle|^(order + 2) times the axis's share of the radius.
    """
    rows = np.arange(len(shapes))
    at_begin = np.abs(shapes.derivative(rows, begin, order))
    at_end = np.abs(shapes.derivative(rows, begin + span, order))
    bound = np.maximum(at_begin, at_end)
    amplitude = np.hypot(shapes.cosine, shapes.sine)
    angle = np.abs(shapes.angle)[:, None]
    largest = amplitude * angle**order
    sag = (angle * span[:, None]) ** 2 / 8.0 * largest
    if order == 1:
        largest = largest + np.abs(shapes.drift[:, :3])
    bound[:, :3] = np.minimum(bound[:, :3] + sag, largest)
    return bound


def _dwell(dwell: Dwell, move: int, position: FloatArray) -> Pieces:
    """The piece of a dwell: it stands at ``position``, the end of the move before."""
    zero = np.zeros(1)
    still = Geometry(
        base=position[None],
        drift=np.zeros_like(position)[None],
        cosine=np.zeros((1, 3)),
        sine=np.zeros((1, 3)),
        angle=zero,
        end=position[None],
    )
    return Pieces(
        move=np.array([move]),
        line=np.array([dwell.line]),
        begin=np.array([0.0 if move < 0 else 1.0]),
        fraction_per_length=zero,
        length=zero,
        velocity=zero,
        acceleration=zero,
        deceleration=zero,
        jerk=zero,
        entry=zero,
        pause=np.array([dwell.seconds]),
        geometry=still,
    )


def pieces_of_chunks(
    chunks: Iterable[Chunk], limits: MotionLimits, start: FloatArray
) -> Iterator[Pieces]:
    """Cut a program into pieces, dwells included, in order.

    Args:
        chunks: The program.
        limits: Of the axes and the path.
        start: Where the axes stand before, part coordinates, shape (k,) [mm or deg].

    Raises:
        ValueError: A move does not begin where the one before it ended.
    """
    first = 0
    position = start
    for chunk in chunks:
        moves = chunk.moves
        _check_joined(position, moves)
        done = 0
        for event in chunk.events:
            if isinstance(event, Dwell):
                yield pieces_of_moves(moves[done : event.before], first + done, limits)
                done = event.before
                if done > 0:
                    position = moves.end[done - 1]
                yield _dwell(event, first + done - 1, position)
        yield pieces_of_moves(moves[done:], first + done, limits)
        first += len(moves)
        if len(moves) > 0:
            position = moves.end[-1]


def _check_joined(position: FloatArray, moves: Moves) -> None:
    before = np.concatenate([position[None], moves.end])[: len(moves)]
    gaps = np.abs(moves.start - before).max(axis=1, initial=0.0)
    if np.any(gaps > JOIN_TOLERANCE):
        row = int(np.argmax(gaps > JOIN_TOLERANCE))
        raise ValueError(
            f"line {moves.line[row]}: the move begins at {moves.start[row]}, "
            f"but the axes stand at {before[row]}"
        )
