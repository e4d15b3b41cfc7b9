"""The velocity along pieces: windows, the two passes, and runs of arcs driven faster."""

from collections.abc import Iterable, Iterator

import numpy as np

from twin.motion.limits import MotionLimits
from twin.motion.pieces.pieces import Pieces
from twin.motion.profile.backward_pass_kernels import backward_pass
from twin.motion.profile.forward_pass_kernels import STATE_AT_REST, SegmentTimes, forward_pass
from twin.motion.profile.phases import Phases, brakes_from, phases_of
from twin.motion.profile.windows import Windows
from twin.motion.retiming.retiming import PhaseTable, pieces_for_runs, retime


def phases_of_pieces(parts: Iterable[Pieces], limits: MotionLimits) -> Iterator[Phases]:
    """Plan the velocity along pieces, from rest."""
    state = STATE_AT_REST.copy()
    known = np.zeros((4, 0))
    machine, time_saved = limits.arrays(), 0.0
    for window in Windows(parts):
        brakes = backward_pass(window.limits, window.entry, known)
        times = SegmentTimes(window.overlap, window.pause)
        rows, segments = forward_pass(
            window.limits, window.entry, brakes, times, window.due, np.inf, state
        )
        if len(rows) > 0:
            phases = phases_of(window, rows, segments)
            pieces = pieces_for_runs(window.parts[0])
            if pieces is not None or time_saved > 0.0:
                table = PhaseTable(phases.rows, phases.rows_pieces)
                table, _, time_saved = retime(table, pieces, machine, 1.0, time_saved)
                phases = Phases(phases.parts, table.rows, table.rows_pieces)
            yield phases
        known = brakes_from(brakes, window.due)
        state[[0, 5]] -= window.due
        state[7:] = 0.0


def seconds_alone(pieces: Pieces, limits: MotionLimits) -> float:
    """How long pieces take from rest to rest [s]."""
    return max((phases.end_time for phases in phases_of_pieces([pieces], limits)), default=0.0)
