"""Where a program's time goes: by block, by what the path does, and by what held it back."""

import dataclasses
import enum
from collections import defaultdict
from collections.abc import Iterable

import numpy as np

from twin.motion.limits import MotionLimits
from twin.motion.planner import plan_phases
from twin.motion.profile.brake_kernels import time_to
from twin.motion.profile.phases import Phases
from twin.motion.report.reasons import SHORT, STOP, Reasons, reasons
from twin.nc.canonical import Axes, Chunk, FloatArray, IntArray

AT_LIMIT = 0.99
"""Share of a limit from which on a path counts as held back by it."""


class Cause(enum.IntEnum):
    """What a block spends its time on."""

    AT_FEED = 0
    """Going at the highest velocity of the place: the feed, or what the axes can do."""
    SPEEDING_UP = 1
    BRAKING = 2
    SLOW = 3
    """Going evenly below the place's velocity: the next corner is too near to speed up for."""
    DWELL = 4


CAUSE_NAMES = {
    Cause.AT_FEED: "at full speed",
    Cause.SPEEDING_UP: "speeding up",
    Cause.BRAKING: "braking",
    Cause.SLOW: "evenly between corners",
    Cause.DWELL: "dwell",
}


@dataclasses.dataclass(frozen=True, slots=True)
class Summary:
    """The time of a program's blocks that take any, as columns of n rows in program order.

    Attributes:
        move: Number of the move in the program, shape (n,); a dwell has that of the move before.
        line: Source line, shape (n,).
        seconds: By cause, shape (n, 5) [s]; columns in the order of ``Cause``.
        ideal: Time the block would take at its feed, or at the axes' velocities for a rapid,
            without corners, shape (n,) [s].
        lost_to: What each row loses time to, by reason [s]; n rows.
        ramps: Time of speeding up and braking of the whole program, by what bounds it [s].
    """

    move: IntArray
    line: IntArray
    seconds: FloatArray
    ideal: FloatArray
    lost_to: list[dict[str, float]]
    ramps: dict[str, float]

    @property
    def total(self) -> float:
        """Cycle time [s]."""
        return float(self.seconds.sum())

    def by_cause(self) -> dict[str, float]:
        """Time of the whole program by cause [s]."""
        sums = self.seconds.sum(axis=0)
        return {CAUSE_NAMES[cause]: float(sums[cause]) for cause in Cause}

    def by_reason(self) -> dict[str, float]:
        """Time that the whole program loses, by reason, the largest first [s]."""
        sums: dict[str, float] = defaultdict(float)
        for row in self.lost_to:
            for reason, seconds in row.items():
                sums[reason] += seconds
        return dict(sorted(sums.items(), key=lambda item: -item[1]))

    def lost(self) -> FloatArray:
        """Time that each row takes beyond its ideal, dwells not counted, shape (n,) [s]."""
        return self.seconds[:, : Cause.DWELL].sum(axis=1) - self.ideal


class _Row:
    """The time of one block, as it is added up."""

    def __init__(self) -> None:
        self.seconds = np.zeros(len(Cause))
        self.ideal = 0.0
        self.lost_to: dict[str, float] = defaultdict(float)


def summarize(
    chunks: Iterable[Chunk], limits: MotionLimits, *, start: FloatArray, axes: Axes
) -> Summary:
    """Plan a program without sampling it and add up its time.

    Args:
        start: Where the axes are before, part coordinates, shape (k,) [mm or deg].
    """
    rows: dict[tuple[int, int], _Row] = defaultdict(_Row)
    ramps: dict[str, float] = defaultdict(float)
    for phases in plan_phases(chunks, limits, start=start):
        whole = phases.joined()
        _add(rows, ramps, whole, reasons(whole.pieces, limits, axes.names))
    keys = np.array(list(rows), np.int64).reshape(-1, 2)
    return Summary(
        move=keys[:, 0],
        line=keys[:, 1],
        seconds=np.array([row.seconds for row in rows.values()]).reshape(-1, len(Cause)),
        ideal=np.array([row.ideal for row in rows.values()]),
        lost_to=[dict(row.lost_to) for row in rows.values()],
        ramps=dict(sorted(ramps.items(), key=lambda item: -item[1])),
    )


def _add(
    rows: dict[tuple[int, int], _Row], ramps: dict[str, float], phases: Phases, why: Reasons
) -> None:
    """Add the time of phases to the rows of their blocks; a phase may cross several."""
    pieces = phases.pieces
    slow_places = _slow_places(phases, why)
    ends = np.append(phases.rows[1:, 0], np.inf)
    for (begin, whole, x, v, a, j), (first, last), slow_place, end in zip(
        phases.rows, phases.rows_pieces, slow_places, ends, strict=True
    ):
        # Where two moves overlap, the time is that of the second.
        duration = min(whole, end - begin)
        spent, gone, ahead = 0.0, 0.0, -x
        for piece in range(first, last + 1):
            ahead += pieces.length[piece]
            until = duration
            if piece < last:
                until = min(duration, float(time_to(ahead, v, a, j, duration)))
            distance = ((j / 6.0 * until + 0.5 * a) * until + v) * until
            row = rows[int(pieces.move[piece]), int(pieces.line[piece])]
            highest = float(pieces.velocity[piece])
            cause = _cause(v, a, j, highest, float(pieces.length[piece]))
            row.seconds[cause] += until - spent
            if cause != Cause.DWELL:
                asked = highest if pieces.rapid[piece] else float(pieces.feed[piece])
                row.ideal += (distance - gone) / asked
                row.lost_to[why.velocity[piece]] += (distance - gone) * (
                    1.0 / highest - 1.0 / asked
                )
                reason = SHORT if cause == Cause.SLOW else slow_place
                row.lost_to[reason] += until - spent - (distance - gone) / highest
            if cause in (Cause.SPEEDING_UP, Cause.BRAKING):
                ramps[(why.jerk if j != 0.0 else why.acceleration)[piece]] += until - spent
            spent, gone = until, distance
            if until >= duration:
                break


def _cause(v: float, a: float, j: float, highest: float, length: float) -> Cause:
    if length == 0.0:
        return Cause.DWELL
    if a > 0.0 or (a == 0.0 and j > 0.0):
        return Cause.SPEEDING_UP
    if a < 0.0 or j < 0.0:
        return Cause.BRAKING
    return Cause.AT_FEED if v >= AT_LIMIT * highest else Cause.SLOW


def _slow_places(phases: Phases, why: Reasons) -> list[str]:
    """Why each phase is slow: what bounds the place that is braked to or speeded up from."""
    out = [""] * len(phases.rows)
    here = STOP
    waiting: list[int] = []
    for row, ((_, _, x, _, a, j), (piece, _)) in enumerate(
        zip(phases.rows, phases.rows_pieces, strict=True)
    ):
        if a > 0.0 or (a == 0.0 and j > 0.0):
            if waiting:
                here = _reason_at(int(piece), float(x), phases, why)
                for braking in waiting:
                    out[braking] = here
                waiting = []
            out[row] = here
        else:
            waiting.append(row)
    last = int(phases.rows_pieces[-1, 1]) if len(phases.rows) else 0
    for braking in waiting:
        out[braking] = _reason_at(last + 1, 0.0, phases, why)
    return out


def _reason_at(piece: int, x: float, phases: Phases, why: Reasons) -> str:
    """What bounds the velocity at x in a piece.

    The nearest border that has a bound, or the slower of the pieces that meet at the nearest one.
    """
    if piece >= len(why.entry):
        return STOP
    nearer_end = x > 0.5 * phases.pieces.length[piece]
    borders = (piece + 1, piece) if nearer_end else (piece, piece + 1)
    for border in borders:
        if border < len(why.entry) and why.entry[border]:
            return why.entry[border]
    beside = min(piece + 1, len(why.entry) - 1) if nearer_end else max(piece - 1, 0)
    slower = min(piece, beside, key=lambda number: float(phases.pieces.velocity[number]))
    return why.velocity[slower]
