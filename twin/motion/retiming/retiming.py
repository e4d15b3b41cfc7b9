"""Runs of a plan, driven faster between the same states.

The bounds of a segment hold with any mixture of v, a and j. Along a curve that leaves much unused:
where the path points along one axis it follows the curve with the other. Here the plan of a run of
arcs is replaced by one that is found from the axes' own limits at each place.
"""

import dataclasses
import math

import numpy as np

from twin.motion.limits import MachineLimits
from twin.motion.pieces.pieces import Pieces
from twin.motion.retiming.retimed_kernels import retimed_phases, uses_of_limits
from twin.motion.retiming.run_kernels import RunEnds, RunKind, RunPieces, find_runs, run_ends
from twin.motion.retiming.solver_kernels import fastest_rate
from twin.motion.retiming.table_kernels import cut_run, first_rate, run_table, tightened
from twin.nc.canonical import FloatArray, IntArray

JERK_SHARE = 0.98
"""Of the jerk limits that a run uses, so that there is always a way out of it."""

SHORT_JERK_SHARE = 0.99
"""Of the jerk limits that a run of less than ``LEAST_TURN`` uses: its end is near."""

WHOLE_SHARE = 0.999
"""Of the jerk limits that a transition out of a run uses: between nodes a little more is used."""

ATTEMPTS = 4
"""At a time law that keeps all limits between the nodes too."""

ROUNDING = 1e-10
"""By how much a run that begins or ends at the feed seems faster than that."""

MOST_EXCESS = 1.2
"""By how much slower an attempt may have to be for there to be another."""

LITTLE_EXCESS = 1.0005
"""By how much slower a run may have to be for all of it to be driven slower."""

LEAST_GAIN = 1e-3
"""Of a run's time, relative; for less it stays as it is."""


@dataclasses.dataclass(frozen=True, slots=True)
class PhaseTable:
    """Phases over pieces.

    Attributes:
        rows: As in ``Phases``.
        rows_pieces: As in ``Phases``.
    """

    rows: FloatArray
    rows_pieces: IntArray

    @property
    def end(self) -> float:
        """When the last phase ends [s]."""
        return float(self.rows[-1, 0] + self.rows[-1, 1])

    def __getitem__(self, rows: slice) -> "PhaseTable":
        return PhaseTable(self.rows[rows], self.rows_pieces[rows])

    def shifted(self, by: float) -> "PhaseTable":
        """These phases, later."""
        rows = self.rows.copy()
        rows[:, 0] += by
        return PhaseTable(rows, self.rows_pieces)

    def slowed(self, by: float) -> "PhaseTable":
        """These phases, from rest to rest, in so many times the time."""
        begin = self.rows[0, 0]
        rows = self.rows / [1.0, 1.0 / by, 1.0, by, by**2, by**3]
        rows[:, 0] = begin + by * (rows[:, 0] - begin)
        return PhaseTable(rows, self.rows_pieces)


@dataclasses.dataclass(frozen=True, slots=True)
class Retimed:
    """A run under a new time law.

    Attributes:
        begin: When it begins [s].
        reference: How it would have been; it begins at the same time.
    """

    begin: float
    phases: PhaseTable
    reference: PhaseTable


def joined(tables: list[PhaseTable]) -> PhaseTable:
    """Consecutive phases as one table."""
    return PhaseTable(
        np.concatenate([table.rows for table in tables]),
        np.concatenate([table.rows_pieces for table in tables]),
    )


def pieces_for_runs(pieces: Pieces) -> RunPieces | None:
    """What runs need of pieces; None where there is no arc."""
    if not np.any(pieces.geometry.table.angle):
        return None
    return RunPieces(
        pieces.geometry.row, pieces.begin, pieces.fraction_per_length, pieces.length, pieces.feed,
        pieces.entry, pieces.rounding, pieces.path_acceleration, pieces.path_jerk,
        pieces.geometry.table.curves(),
    )  # fmt: skip


def retime(
    phases: PhaseTable, pieces: RunPieces | None, machine: MachineLimits, override: float, time_saved: float
) -> tuple[PhaseTable, list[Retimed], float]:  # fmt: skip
    """Drive the runs among phases faster; what comes after them begins earlier.

    Args:
        pieces: Under them, None where none is an arc; phases that go beyond these stay as they are.
        time_saved: Time that the plan is ahead of the phases already [s].

    Returns:
        The phases, the runs that have changed, and the time gained after them [s].
    """
    parts, found = list[PhaseTable](), list[Retimed]()
    done = 0
    if pieces is None:
        return phases.shifted(-time_saved), found, time_saved
    runs = find_runs(phases.rows, phases.rows_pieces, pieces, override)
    for first, last, kind in runs[runs[:, 2] > 0]:
        reference = phases[first:last].shifted(-time_saved)
        ends = run_ends(reference.rows, reference.rows_pieces)
        begin = float(reference.rows[0, 0])
        share = JERK_SHARE if kind == RunKind.LONG else SHORT_JERK_SHARE
        faster = drive_run(ends, pieces, machine, override, begin, share)
        if faster is None or faster.end > reference.end - LEAST_GAIN * (reference.end - begin):
            continue
        parts += [phases[done:first].shifted(-time_saved), faster]
        found.append(Retimed(begin, faster, reference))
        time_saved += reference.end - faster.end
        done = last
    if not found and time_saved == 0.0:
        return phases, found, time_saved
    return joined([*parts, phases[done:].shifted(-time_saved)]), found, time_saved


def drive_run(
    ends: RunEnds, pieces: RunPieces, machine: MachineLimits, override: float, begin: float,
    share: float,
) -> PhaseTable | None:  # fmt: skip
    """The fastest phases of a run that are found; None if none keep the limits.

    Args:
        begin: Of the run [s].
        share: Of the jerk limits to use.
    """
    nodes = cut_run(ends, pieces, machine)
    table = run_table(nodes, pieces, machine, override)
    start = first_rate(table, ends, nodes)
    at_rest = ends.begin[0] == 0.0, ends.end[0] == 0.0
    for attempt in range(ATTEMPTS):
        rate, kept = fastest_rate(table, share, start, at_rest)
        if not kept:
            return None
        phases = PhaseTable(*retimed_phases(nodes, pieces, rate, begin))
        uses = uses_of_limits(phases.rows, phases.rows_pieces, pieces, machine, override)
        fast, hard, sudden = uses.max(axis=0).tolist()
        slower = max(fast, math.sqrt(hard), math.cbrt(sudden))
        if slower <= 1.0 + ROUNDING:
            return phases
        if slower > MOST_EXCESS:
            return None
        if attempt > 0 or slower < LITTLE_EXCESS:
            # As a whole: what is left is too little to look for its places.
            if all(at_rest):
                return phases.slowed(slower)
            uses = np.maximum(uses, [slower, slower**2, slower**3])
        table = tightened(table, uses)
    return None
