"""Where a program's time goes: by move, and by what held the path back."""

import dataclasses
import enum
from collections.abc import Iterable
from pathlib import Path

import numpy as np

from twin.motion.limits import MotionLimits
from twin.motion.phases import Phases, plan_phases
from twin.motion.setpoints import Setpoints
from twin.nc.canonical import Axes, Chunk, FloatArray, IntArray

AT_LIMIT = 0.999
"""Share of a limit from which on a path counts as held back by it."""


class Cause(enum.IntEnum):
    """What a move spends its time on."""

    AT_FEED = 0
    """Going at the highest velocity of the piece: the feed, or what the axes can do."""
    SPEEDING_UP = 1
    BRAKING = 2
    SLOW = 3
    """Going evenly below the piece's velocity: the next corner is too near to speed up for."""
    DWELL = 4


CAUSE_NAMES = {
    Cause.AT_FEED: "at full speed",
    Cause.SPEEDING_UP: "speeding up",
    Cause.BRAKING: "braking",
    Cause.SLOW: "between corners",
    Cause.DWELL: "dwell",
}


@dataclasses.dataclass(frozen=True, slots=True)
class Summary:
    """The time of a program's moves that take any, as columns of n rows in program order.

    Attributes:
        move: Number of the move in the program, shape (n,); a dwell has that of the move before.
        line: Source line, shape (n,).
        seconds: By cause, shape (n, 5) [s]; columns in the order of ``Cause``.
        ideal: Time the move would take at its feed, or at the axes' velocities for a rapid,
            without speeding up or braking, shape (n,) [s].
    """

    move: IntArray
    line: IntArray
    seconds: FloatArray
    ideal: FloatArray

    @property
    def total(self) -> float:
        """Cycle time [s]."""
        return float(self.seconds.sum())

    def by_cause(self) -> dict[str, float]:
        """Time of the whole program by cause [s]."""
        sums = self.seconds.sum(axis=0)
        return {CAUSE_NAMES[cause]: float(sums[cause]) for cause in Cause}

    def lost(self) -> FloatArray:
        """Time that each row takes beyond its ideal, dwells not counted, shape (n,) [s]."""
        return self.seconds[:, : Cause.DWELL].sum(axis=1) - self.ideal


def summarize(chunks: Iterable[Chunk], limits: MotionLimits, *, start: FloatArray) -> Summary:
    """Plan a program without sampling it and add up its time.

    Args:
        chunks: The program.
        limits: Of the axes and the path.
        start: Where the axes stand before, part coordinates, shape (k,) [mm or deg].
    """
    rows: dict[tuple[int, int], FloatArray] = {}
    for phases in plan_phases(chunks, limits, start=start):
        _add(rows, phases)
    keys = np.array(list(rows), np.int64).reshape(-1, 2)
    values = np.array(list(rows.values()), np.float64).reshape(-1, len(Cause) + 1)
    return Summary(keys[:, 0], keys[:, 1], values[:, :-1], values[:, -1])


def _add(rows: dict[tuple[int, int], FloatArray], phases: Phases) -> None:
    """Add the time of phases to the rows of their moves; a phase may cross several."""
    pieces = phases.pieces
    for (_, duration, x, v, a, j), (first, last) in zip(
        phases.rows, phases.rows_pieces, strict=True
    ):
        spent = 0.0
        left_behind = -x
        for piece in range(first, last + 1):
            left_behind += pieces.length[piece]
            until = duration
            if piece < last:
                until = _time_at(left_behind, v, a, j, duration)
            key = (int(pieces.move[piece]), int(pieces.line[piece]))
            row = rows.setdefault(key, np.zeros(len(Cause) + 1))
            row[_cause(v, a, j, pieces.velocity[piece], pieces.pause[piece])] += until - spent
            spent = until
            if until >= duration:
                break
    seen = np.unique(phases.rows_pieces)
    covered = np.arange(seen.min(), seen.max() + 1)
    for piece in covered:
        if pieces.length[piece] > 0.0 and pieces.velocity[piece] > 0.0:
            key = (int(pieces.move[piece]), int(pieces.line[piece]))
            row = rows.setdefault(key, np.zeros(len(Cause) + 1))
            row[-1] += pieces.length[piece] / pieces.velocity[piece]


def _cause(v: float, a: float, j: float, highest: float, pause: float) -> Cause:
    if pause > 0.0:
        return Cause.DWELL
    if a > 0.0 or (a == 0.0 and j > 0.0):
        return Cause.SPEEDING_UP
    if a < 0.0 or j < 0.0:
        return Cause.BRAKING
    return Cause.AT_FEED if v >= AT_LIMIT * highest else Cause.SLOW


def _time_at(x: float, v: float, a: float, j: float, duration: float) -> float:
    """When x is reached within a phase [s]."""
    roots = np.roots([j / 6.0, a / 2.0, v, -x])
    real = roots.real[(np.abs(roots.imag) < 1e-9) & (roots.real >= 0.0)]
    return min(duration, float(real.min())) if len(real) > 0 else duration


def draw(setpoints: Setpoints, axes: Axes, path: Path) -> None:
    """Draw path speed and axis speeds over time, and path speed over the path.

    Args:
        setpoints: Of the program, or of the part of it that is of interest.
        axes: Their names and kinds.
        path: Picture to write; its suffix says which form (.svg, .png).
    """
    import matplotlib as mpl
    from matplotlib.figure import Figure

    speed = np.linalg.norm(setpoints.velocity[:, :3], axis=1)
    steps = np.linalg.norm(np.diff(setpoints.position[:, :3], axis=0, prepend=np.nan), axis=1)
    way = np.cumsum(np.nan_to_num(steps))
    with mpl.rc_context({"font.size": 9, "svg.hashsalt": "twin"}):
        figure = Figure(figsize=(9.0, 7.0), layout="constrained")
        over_time, by_axis, over_path = figure.subplots(3, 1)
        over_time.plot(setpoints.time, speed * 60.0)
        over_time.set(xlabel="time [s]", ylabel="path speed [mm/min]")
        for column, (name, kind) in enumerate(zip(axes.names, axes.kinds, strict=True)):
            unit = "mm/s" if kind == "linear" else "deg/s"
            by_axis.plot(setpoints.time, setpoints.velocity[:, column], label=f"{name} [{unit}]")
        by_axis.set(xlabel="time [s]", ylabel="axis speed")
        by_axis.legend(loc="upper right", ncols=len(axes))
        over_path.plot(way, speed * 60.0)
        over_path.set(xlabel="way of X Y Z [mm]", ylabel="path speed [mm/min]")
        figure.savefig(path)
