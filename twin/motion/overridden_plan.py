"""A plan that is made only as far as it is needed, and anew when the operator's wishes change."""

import dataclasses
import math
from collections.abc import Iterable

import numpy as np

from twin.motion.phase_kernels import put_brake
from twin.motion.phases import Phases
from twin.motion.pieces import Pieces
from twin.motion.profile_kernels import STATE_AT_REST, find_phases
from twin.motion.reach_kernels import ROUNDING, SLOWEST, find_brake, find_reach
from twin.motion.sampling_kernels import state_at
from twin.motion.transition_kernels import find_transition
from twin.motion.windows import BATCH, entry_velocities, limit_table, windows
from twin.nc.canonical import FloatArray, IntArray


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Wishes:
    """What the operator wants of the plan."""

    feed_override: float = 1.0
    """Factor of programmed feeds."""

    rapid_override: float = 1.0
    """Factor of the velocity of rapids."""

    held: bool = False
    """Stop, wherever it be."""

    single_block: bool = False
    """Stop at the end of the block."""


@dataclasses.dataclass(frozen=True, slots=True)
class _Window:
    """The pieces that are planned at present.

    Attributes:
        pieces: The window's.
        first: How many of the window's pieces lay behind when it was opened.
        end: Piece at which the next window is due, or the program over.
        whole: Whether the program ends with it.
        table: As ``limit_table``: what must not be passed.
        pause: What is left of each dwell [s].
    """

    pieces: Pieces
    first: int
    end: int
    whole: bool
    table: FloatArray
    pause: FloatArray


@dataclasses.dataclass(frozen=True, slots=True)
class _Drive:
    """What a window of n pieces is driven by under the wishes.

    Attributes:
        table: As ``limit_table``, velocities as wanted.
        entry: As ``entry_velocities``, 0 where a block is to stop.
        reach: Highest safe velocity at each border.
        block_end: Piece before which a single block stops; -1: none.
        stop: First piece that must not be driven on, or n.
    """

    table: FloatArray
    entry: FloatArray
    reach: FloatArray
    block_end: int
    stop: int


class OverriddenPlan:
    """Phases under an operator's wishes.

    Args:
        parts: The program's pieces, in order.

    Attributes:
        phases: What is planned and not yet forgotten, in order.
        standing_since: When the plan came to a standstill that it does not leave by itself [s];
            infinite while it moves.
        at_block_end: Whether that is the end of a single block.
    """

    def __init__(self, parts: Iterable[Pieces]) -> None:
        self._windows = windows(parts)
        self._state = STATE_AT_REST.copy()
        self._wishes = Wishes()
        self.phases: list[Phases] = []
        self.standing_since = math.inf
        self.at_block_end = False
        self._window: _Window
        self._drive: _Drive
        self._empty = not self._open()

    @property
    def ended(self) -> bool:
        """Whether the plan reaches the program's end."""
        return self._empty or (self._window.whole and int(self._state[0]) >= self._window.end)

    def forget(self, time: float) -> None:
        """Drop phases that end before a time [s]."""
        del self.phases[:-1]
        for phases in self.phases:
            kept = phases.rows[:, 0] + phases.rows[:, 1] >= time
            self.phases[0] = Phases(phases.pieces, phases.rows[kept], phases.rows_pieces[kept])

    def plan_until(self, time: float) -> None:
        """Plan on to a time [s], or to the program's end."""
        while self._state[4] < time and not self.ended:
            piece = int(self._state[0])
            window, drive = self._window, self._drive
            self.at_block_end = piece == drive.block_end
            if self._wishes.held or self.at_block_end or piece == drive.stop < window.end:
                self._stand_until(time)
            elif piece >= window.end:
                self._open()
            else:
                stop = min(drive.stop, window.end)
                rows, pieces = find_phases(
                    drive.table, drive.entry, drive.reach, window.pause, stop, time, self._state
                )
                self._append(rows, pieces)

    def wish(self, wishes: Wishes, time: float) -> bool:
        """Change the wishes; what is planned for later is dropped.

        Args:
            wishes: What is wanted from now on.
            time: Now, up to which it is planned [s].

        Returns:
            Whether this is possible at once; if not, the plan stays as it is, to be tried again.
        """
        if self.ended and self._state[4] <= time:
            return True
        piece, x, v, a, pause = self._state_at(time)
        window = self._window
        if piece >= len(window.pieces):
            # Between two windows; the next begins with the next sample.
            return False
        drive = self._make_drive(wishes, piece)
        tables = drive.table, drive.entry, drive.reach
        brake = None
        if a < 0.0 or find_brake(*tables, piece, x, v, a, ROUNDING, 0) < 0:
            brake = find_transition(window.table, *tables, piece, x, v, a)
            if brake[0] < 0:
                return False
        self._wishes, self._drive = wishes, drive
        self.standing_since = math.inf
        window.pause[piece] = pause
        self._state[:] = piece, x, v, a, time, -1.0, -1.0
        self.phases = [_no_phases(window.pieces)]
        if brake is not None:
            end, x_end, w, deceleration, jerk = brake
            rows, pieces = np.zeros((3, 6)), np.zeros((3, 2), np.int64)
            count, _, end_time, _ = put_brake(
                rows, pieces, 0, window.pieces.length, piece, end, time, x, v, a, w,
                deceleration, jerk,
            )  # fmt: skip
            self._append(rows[:count], pieces[:count])
            self._state[:] = end, x_end, w, 0.0, end_time, -1.0, -1.0
        return True

    def _state_at(self, time: float) -> tuple[int, float, float, float, float]:
        """Piece, x, v, a at a time, and how long the piece still pauses [s]."""
        phases = self.phases[-1]
        window = self._window
        i, x, v, a, row = state_at(phases.rows, phases.rows_pieces, window.pieces.length, time)
        if row < 0 or self.standing_since <= time:
            i, (x, v, a) = int(self._state[0]), self._state[1:4].tolist()
            return i, x, v, a, float(window.pause[i]) if i < len(window.pause) else 0.0
        pause = float(window.pause[i])
        if window.pieces.length[i] == 0.0:
            pause = max(0.0, float(phases.rows[row, :2].sum()) - time)
        return i, x, v, a, pause

    def _open(self) -> bool:
        """Go to the next window, from the piece of the state on; whether there is one."""
        window, whole = next(self._windows, (None, True))
        if window is None:
            return False
        first = 0
        if self.phases:
            first = self._window.first + int(self._state[0]) - BATCH
        pieces = window[first:]
        end = len(pieces) if whole else BATCH - first
        self._window = _Window(pieces, first, end, whole, limit_table(pieces), pieces.pause.copy())
        self._state[0] = 0.0
        self._state[5:] = STATE_AT_REST[5:]
        self._drive = self._make_drive(self._wishes, 0)
        self.phases.append(_no_phases(pieces))
        return True

    def _make_drive(self, wishes: Wishes, piece: int) -> _Drive:
        pieces = self._window.pieces
        override = np.where(pieces.rapid, wishes.rapid_override, wishes.feed_override)
        wanted = override * np.where(pieces.rapid, pieces.velocity, pieces.feed)
        table = self._window.table.copy()
        table[1] = 0.0 if wishes.held else np.minimum(pieces.velocity, wanted)
        entry = entry_velocities(pieces)
        block_end = -1
        if wishes.single_block:
            others = np.flatnonzero(pieces.line[piece:] != pieces.line[piece])
            if len(others) > 0:
                block_end = piece + int(others[0])
                entry[block_end] = 0.0
        closed = (table[1] < SLOWEST) & (pieces.length > 0.0)
        closed[:piece] = False
        stop = int(np.argmax(closed)) if np.any(closed) else len(pieces)
        if block_end >= 0:
            stop = min(stop, block_end)
        reach = np.zeros(len(pieces) + 1)
        reach[piece:] = find_reach(table[:, piece:], entry[piece:], np.zeros(0))
        return _Drive(table, entry, reach, block_end, stop)

    def _stand_until(self, time: float) -> None:
        """Add a phase at rest; between two blocks it belongs to the one that has ended."""
        piece, x, now = int(self._state[0]), self._state[1], self._state[4]
        self.standing_since = min(self.standing_since, float(now))
        lengths = self._window.pieces.length
        if x == 0.0 and piece > 0 and lengths[piece] > 0.0:
            piece -= 1
            x = lengths[piece]
        self._append(np.array([[now, time - now, x, 0.0, 0.0, 0.0]]), np.array([[piece, piece]]))
        self._state[4] = time

    def _append(self, rows: FloatArray, rows_pieces: IntArray) -> None:
        last = self.phases[-1]
        self.phases[-1] = Phases(
            last.pieces,
            np.concatenate([last.rows, rows]),
            np.concatenate([last.rows_pieces, rows_pieces]),
        )


def _no_phases(pieces: Pieces) -> Phases:
    return Phases(pieces, np.zeros((0, 6)), np.zeros((0, 2), np.int64))
