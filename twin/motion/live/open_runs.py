"""Runs of arcs while they are planned bit by bit: known as a whole, left before their end."""

import math

import numpy as np

from twin.motion.limits import MachineLimits
from twin.motion.retiming.retiming import (
    WHOLE_SHARE,
    PhaseTable,
    Retimed,
    drive_run,
    joined,
    retime,
)
from twin.motion.retiming.run_kernels import RunPieces, find_runs, run_ends

REJOINING_TURNS = (math.pi / 4.0, math.pi / 2.0, math.pi, 2.0 * math.pi)
"""How far ahead a run may come back to its reference, in this order [rad]."""


class OpenRuns:
    """The run at the end of what is planned, and those that have got a new time law.

    Attributes:
        time_saved: Time that the plan is ahead of its reference [s].
        waiting: Phases of a run whose end is not planned yet, in the reference's time, or None.
    """

    def __init__(self) -> None:
        self.time_saved = 0.0
        self.waiting: PhaseTable | None = None
        self._retimed: list[Retimed] = []

    def close(self) -> None:
        """Go on in a plan whose pieces have other numbers."""
        self._retimed = []

    @property
    def waits(self) -> bool:
        """Whether a run is not complete."""
        return self.waiting is not None

    @property
    def begin(self) -> float:
        """When that run begins [s]."""
        return (
            math.inf if self.waiting is None else float(self.waiting.rows[0, 0]) - self.time_saved
        )

    def take(
        self, more: PhaseTable, pieces: RunPieces | None, machine: MachineLimits, override: float,
        at_end: bool,
    ) -> PhaseTable:  # fmt: skip
        """Take phases that have been planned.

        Args:
            more: What follows on those before.
            pieces: Under the plan, as far as runs are looked for.
            at_end: Whether no run goes on beyond them.
        """
        known = more if self.waiting is None else joined([self.waiting, more])
        self.waiting = None
        if len(known.rows) == 0:
            return known
        certain = len(known.rows)
        if pieces is not None and not at_end:
            runs = find_runs(known.rows, known.rows_pieces, pieces, override)
            if len(runs) > 0 and runs[-1, 1] == certain:
                certain = int(runs[-1, 0])
        if certain < len(known.rows):
            self.waiting = known[certain:]
        if certain == 0:
            return known[:0]
        table, found, self.time_saved = retime(
            known[:certain], pieces, machine, override, self.time_saved
        )
        self._retimed += found
        return table

    def rejoined(
        self, phases: PhaseTable, pieces: RunPieces, machine: MachineLimits, override: float, time: float
    ) -> PhaseTable:  # fmt: skip
        """Phases that come back from a retimed run to its reference as soon as they can.

        Args:
            override: Factor of the programmed feed that it was planned for.
            time: From when on they may change [s].

        Returns:
            The phases; as they were outside any such run, or where nothing leads back.
        """
        for number, run in enumerate(self._retimed):
            if run.begin < time < run.phases.end:
                rejoin = _back(run, pieces, machine, override, time)
                if rejoin is None:
                    break
                after = phases.rows[:, 0] >= run.phases.end - 1e-9
                before = phases.rows[:, 0] < time
                later = rejoin.end - run.phases.end
                del self._retimed[number:]
                kept = PhaseTable(phases.rows[before], phases.rows_pieces[before])
                kept.rows[-1, 1] = time - kept.rows[-1, 0]
                rest = PhaseTable(phases.rows[after], phases.rows_pieces[after]).shifted(later)
                self.time_saved -= later
                return joined([kept, rejoin, rest])
        return phases


def _back(
    run: Retimed, pieces: RunPieces, machine: MachineLimits, override: float, time: float
) -> PhaseTable | None:
    """From a time within a run to its reference, and on along that; None: nothing leads back."""
    rows = run.phases.rows
    row = int(np.searchsorted(rows[:, 0], time, "right")) - 1
    here = run.phases[row:]
    here = PhaseTable(here.rows.copy(), here.rows_pieces)
    gone = time - here.rows[0, 0]
    _, duration, x, v, a, j = here.rows[0]
    x += ((j / 6.0 * gone + 0.5 * a) * gone + v) * gone
    here.rows[0] = time, duration - gone, x, v + (a + 0.5 * j * gone) * gone, a + j * gone, j
    left = run_ends(here.rows, here.rows_pieces)
    reference = run.reference
    # How far each phase of the reference begins before the run's end.
    t, v, a, j = reference.rows[:, 1], *reference.rows[:, 3:].T
    before_end = np.cumsum((((j / 6.0 * t + 0.5 * a) * t + v) * t)[::-1])[::-1]
    ahead = left.distance - before_end
    turn = abs(pieces.curves.angle[pieces.move[left.piece]])
    turn *= pieces.fraction_per_length[left.piece]
    for angle in REJOINING_TURNS:
        beyond = np.flatnonzero(ahead * turn >= angle)
        if len(beyond) == 0:
            break
        at = int(beyond[0])
        target = float(v[at]), float(a[at])
        peak = max(left.begin[0], target[0])
        ends = left._replace(distance=float(ahead[at]), end=target, peak=peak)
        rejoin = drive_run(ends, pieces, machine, override, time, WHOLE_SHARE)
        if rejoin is not None:
            rest = reference[at:]
            return joined([rejoin, rest.shifted(rejoin.end - float(rest.rows[0, 0]))])
    return None
