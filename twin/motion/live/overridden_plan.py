"""A plan that is made only as far as it is needed, and again when the operator's overrides change."""

import dataclasses
import math
from collections.abc import Iterable

import numpy as np

from twin.motion.blocks.blocks import BoolArray
from twin.motion.limits import MachineLimits
from twin.motion.live.open_runs import OpenRuns
from twin.motion.live.transition_kernels import find_transition
from twin.motion.pieces.pieces import Pieces
from twin.motion.profile.backward_pass_kernels import ROUNDING, SLOWEST, backward_pass, find_brake
from twin.motion.profile.forward_pass_kernels import STATE_AT_REST, SegmentTimes, forward_pass
from twin.motion.profile.phase_kernels import PhaseRows, write_brake
from twin.motion.profile.phases import Phases, brakes_from, no_phases, phases_of
from twin.motion.profile.state import PathAhead, State
from twin.motion.profile.windows import LOOK_AHEAD, Window, Windows
from twin.motion.retiming.retiming import PhaseTable, pieces_for_runs
from twin.motion.setpoints.sampling_kernels import OVERLAPPING, state_at
from twin.nc.canonical import FloatArray

FURTHER = 0.25
"""How far it is planned at a time to find a run's end [s]."""


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Overrides:
    """What the operator wants of the plan."""

    feed_override: float = 1.0
    """Factor of programmed feeds."""

    rapid_override: float = 1.0
    """Factor of the velocity of rapids."""

    held: bool = False
    """Stop at the current position."""

    single_block: bool = False
    """Stop at the end of the block."""


@dataclasses.dataclass(frozen=True, slots=True)
class _Drive:
    """What a window of n segments is driven by under the overrides.

    Attributes:
        limits: As the window's, velocities as wanted.
        entry: As the window's, 0 where a block is to stop.
        brakes: From ``backward_pass``.
        block_end: Segment before which a single block stops; -1: none.
        closed: Whether each segment must not be driven on, shape (n,).
    """

    limits: FloatArray
    entry: FloatArray
    brakes: FloatArray
    block_end: int
    closed: BoolArray

    def stop_from(self, segment: int) -> int:
        """The first segment from one on that must not be driven on, or n."""
        ahead = self.closed[segment:]
        return segment + int(np.argmax(ahead)) if np.any(ahead) else len(self.closed)


class OverriddenPlan:
    """Phases under an operator's overrides.

    Args:
        parts: The program's pieces, in order.
        look_ahead: Blocks that are planned at a time, and seen at least beyond these.

    Attributes:
        phases: What is planned and not yet forgotten, in order.
        standing_since: When the plan came to a standstill that it does not leave by itself [s];
            infinite while it moves.
        at_block_end: Whether that is the end of a single block.
    """

    def __init__(
        self, parts: Iterable[Pieces], machine: MachineLimits, look_ahead: int = LOOK_AHEAD
    ) -> None:
        self._windows = Windows(parts, look_ahead)
        self._machine = machine
        self._state = STATE_AT_REST.copy()
        self._wishes = Overrides()
        self.phases: list[Phases] = []
        self.standing_since = math.inf
        self.at_block_end = False
        self._window: Window
        self._drive: _Drive
        self._segments = 0
        self._runs = OpenRuns()
        self._begun = self._empty = False

    def begin(self) -> None:
        """Plan the beginning, unless it is planned; where the parts do not come yet, it can be tried again."""
        if not self._begun:
            self._empty = not self._open()
            self._begun = True

    def work(self) -> bool:
        """Plan a little of the next window ahead; whether there is no more to do until it is needed."""
        return self._windows.work()

    @property
    def ended(self) -> bool:
        """Whether the plan reaches the program's end."""
        return self._empty or (self._window.whole and int(self._state[0]) >= self._window.due)

    def forget(self, time: float) -> None:
        """Drop phases that end before a time [s]."""
        del self.phases[:-1]
        for phases in self.phases:
            kept = phases.rows[:, 0] + phases.rows[:, 1] >= time
            self.phases[0] = Phases(phases.parts, phases.rows[kept], phases.rows_pieces[kept])

    def plan_until(self, time: float) -> None:
        """Plan on to a time [s], or to the program's end."""
        while self._planned_to() < time and not self.ended:
            segment = int(self._state[0])
            window, drive = self._window, self._drive
            stop = drive.stop_from(segment)
            self.at_block_end = segment == drive.block_end
            if self.at_block_end:
                self._stand_until(time)
            elif segment >= window.due:
                self._open()
            elif self._wishes.held or segment == stop:
                self._stand_until(time)
            else:
                until = time + self._runs.time_saved
                if self._runs.waits:
                    until = max(until, float(self._state[4]) + FURTHER)
                rows, segments = forward_pass(
                    drive.limits, drive.entry, drive.brakes, SegmentTimes(window.overlap, window.pause),
                    min(stop, window.due), until, self._state,
                )  # fmt: skip
                phases = phases_of(window, rows, segments)
                self._take_runs(phases, int(self._state[0]) >= min(stop, window.due))

    @property
    def _now(self) -> float:
        """When the plan is in its last state [s]."""
        return float(self._state[4]) - self._runs.time_saved

    def _planned_to(self) -> float:
        """Up to when the phases are known [s]."""
        return self._runs.begin if self._runs.waits else self._now

    def _take_runs(self, phases: Phases, at_end: bool) -> None:
        """Append phases; of a run that goes on beyond them only with its end."""
        table = self._runs.take(
            PhaseTable(phases.rows, phases.rows_pieces), self._run_pieces, self._machine,
            self._wishes.feed_override, at_end,
        )  # fmt: skip
        self._append(Phases(phases.parts, table.rows, table.rows_pieces))

    def override(self, overrides: Overrides, time: float) -> bool:
        """Change the overrides; what is planned for later is dropped.

        Args:
            time: Now, up to which it is planned [s].

        Returns:
            Whether this is possible at once; if not, the plan stays as it is, to be tried again.
        """
        if self.ended and self._now <= time:
            return True
        place = self._state_at(time)
        if place is None:
            return False
        segment, x, v, a, pause = place
        window, drive = _drive(self._window, overrides, segment, x)
        course = PathAhead(drive.limits, drive.entry, drive.brakes[0])
        here = State(segment, x, v, a)
        brake, x_end = None, 0.0
        if a < 0.0 or find_brake(course, here, ROUNDING) < 0:
            brake, x_end = find_transition(window.limits, course, here)
            if brake.border < 0:
                self._rejoin(time)
                return False
        window = window.with_pause(segment, pause)
        self._wishes, self._window, self._drive = overrides, window, drive
        self.standing_since = math.inf
        self._state[:5] = segment, x, v, a, time
        self._state[5:] = STATE_AT_REST[5:]
        self.phases = [no_phases(window.pieces)]
        self._runs = OpenRuns()
        if brake is not None:
            rows = PhaseRows(np.zeros((3, 6)), np.zeros((3, 2), np.int64))
            count, end_time, _, _ = write_brake(rows, 0, window.limits[0], time, here, brake)
            self._append(phases_of(window, rows.phases[:count], rows.segments[:count]))
            self._state[:5] = brake.border - 1, x_end, brake.velocity, 0.0, end_time
        return True

    def _rejoin(self, time: float) -> None:
        """Leave a retimed run for its reference, from which there is always a brake."""
        phases = self.phases[-1]
        if self._run_pieces is None:
            return
        table = self._runs.rejoined(
            PhaseTable(phases.rows, phases.rows_pieces), self._run_pieces, self._machine,
            self._wishes.feed_override, time,
        )  # fmt: skip
        self.phases[-1] = Phases(phases.parts, table.rows, table.rows_pieces)

    def _state_at(self, time: float) -> tuple[int, float, float, float, float] | None:
        """Segment, x, v, a at a time, and how long the segment still pauses [s].

        None between two windows, as the next begins with the next sample, and where two moves
        overlap.
        """
        phases, window = self.phases[-1], self._window
        i, x, v, a, row = state_at(phases.rows, phases.rows_pieces, window.pieces.length, time)
        if row == OVERLAPPING:
            return None
        if row < 0 or self.standing_since <= time:
            segment, (x, v, a) = int(self._state[0]), self._state[1:4].tolist()
            if segment >= len(window.pause):
                return None
            return segment, x, v, a, float(window.pause[segment])
        segment, x = window.segment_at(i, x)
        pause = float(window.pause[segment])
        if window.limits[0, segment] == 0.0:
            pause = max(0.0, float(phases.rows[row, :2].sum()) - time)
        return segment, x, v, a, pause

    def _open(self) -> bool:
        """Go to the next window; whether there is one."""
        window = next(self._windows, None)
        if window is None:
            return False
        window = window.joined()
        known = np.zeros((4, 0))
        if self.phases:
            last = self._window
            if len(last.pause) == self._segments:
                self._state[[0, 5]] -= last.due
                self._state[7:] = 0.0
                known = brakes_from(self._drive.brakes, last.due)
            else:
                # The window has been parted since: segments have other numbers.
                piece, x = last.piece_at(int(self._state[0]), self._state[1])
                self._state[:2] = window.segment_at(piece - int(last.begins[last.due]), x)
                self._state[5:] = STATE_AT_REST[5:]
        self._segments = len(window.pause)
        self._runs.close()
        self._run_pieces = pieces_for_runs(window.pieces[: int(window.begins[window.due])])
        self._window, self._drive = _drive(
            window, self._wishes, int(self._state[0]), self._state[1], known
        )
        self.phases.append(no_phases(window.pieces))
        return True

    def _stand_until(self, time: float) -> None:
        """Add a phase at rest; between two blocks it belongs to the one that has ended."""
        segment, x, now = int(self._state[0]), float(self._state[1]), self._now
        self.standing_since = min(self.standing_since, now)
        lengths = self._window.pieces.length
        piece, x = self._window.piece_at(segment, x)
        if x == 0.0 and piece > 0 and lengths[piece] > 0.0:
            piece -= 1
            x = float(lengths[piece])
        row = np.array([[now, time - now, x, 0.0, 0.0, 0.0]])
        self._append(Phases(self._window.parts, row, np.array([[piece, piece]])))
        self._state[4] = time + self._runs.time_saved

    def _append(self, more: Phases) -> None:
        last = self.phases[-1]
        self.phases[-1] = Phases(
            more.parts,
            np.concatenate([last.rows, more.rows]),
            np.concatenate([last.rows_pieces, more.rows_pieces]),
        )


def _drive(
    window: Window, overrides: Overrides, segment: int, x: float, known: FloatArray | None = None
) -> tuple[Window, _Drive]:
    """What a window is driven by from a place on; the window, parted where a block is to stop."""
    pieces = window.pieces
    block_end = -1
    if overrides.single_block:
        piece, _ = window.piece_at(segment, x)
        others = np.flatnonzero(pieces.line[piece:] != pieces.line[piece])
        if len(others) > 0:
            window = window.parted_at(piece + int(others[0]))
            block_end, _ = window.segment_at(piece + int(others[0]), 0.0)
    first = window.begins[:-1]
    rapid, feed = pieces.rapid[first], pieces.feed[first]
    override = np.where(rapid, overrides.rapid_override, overrides.feed_override)
    limits, entry = window.limits.copy(), window.entry.copy()
    wanted = np.minimum(limits[1], override * np.where(rapid, limits[1], feed))
    limits[1] = 0.0 if overrides.held else wanted
    closed = (limits[1] < SLOWEST) & (limits[0] > 0.0)
    if block_end >= 0:
        entry[block_end] = 0.0
        closed[block_end] = True
        known = None
    brakes = np.zeros((4, len(entry)))
    known = np.zeros((4, 0)) if known is None else known[:, segment:].copy()
    known[[1, 3]] -= segment
    brakes[:, segment:] = backward_pass(limits[:, segment:], entry[segment:], known)
    brakes[[1, 3]] += segment
    return window, _Drive(limits, entry, brakes, block_end, closed)
