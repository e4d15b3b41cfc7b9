"""Baselines: what a program came to when it was last approved.

A later run is held to it: the first block whose path differs is named with its program line.
"""

import math
from collections.abc import Iterable, Iterator
from pathlib import Path

from twin.compare.baseline_text import (
    Entry,
    RunFigures,
    entries,
    number,
    read_entries,
    read_head,
    text,
    write,
)
from twin.compare.verdict import Reason
from twin.errors import UsageError
from twin.files.atomic import complete_or_absent
from twin.job.job_file import BaselineTable
from twin.nc.canonical import Axes, Chunk
from twin.nc.text.diagnostics import ProgramError

_SMALLEST_TIME = 1e-6
"""A cycle time that differs by no more than this is the same [s]: what the file resolves."""
_SWEEP_DEG = 0.5
"""Sweeps that differ by more are not the same; the end point tells a wrong angle within the turn,
but not the sign, nor whole turns."""


def write_baseline(path: Path, figures: RunFigures, axes: Axes, chunks: Iterable[Chunk]) -> None:
    """Store a baseline, complete or not at all.

    Args:
        path: The file.
        figures: What the run came to.
        axes: Of the moves.
        chunks: The program.
    """
    with complete_or_absent(path) as temporary, temporary.open("w", encoding="utf-8") as file:
        write(file, figures, axes.names, entries(chunks))


def compare_baseline(
    path: Path,
    figures: RunFigures | None,
    axes: Axes,
    chunks: Iterable[Chunk],
    limits: BaselineTable,
) -> list[Reason]:
    """Hold a run to its baseline.

    Args:
        path: The stored file.
        figures: What the run came to; None when it did not come to its end.
        axes: Of the moves.
        chunks: The program; where it no longer interprets, the baseline tells what was there.
        limits: How far they may differ.

    Returns:
        One reason each for path, feed, cycle time and contour error, where they differ too much;
        those of path and feed name the first block that differs.

    Raises:
        UsageError: The file is not a baseline.
    """
    if not path.is_file():
        message = f"there is no baseline {path}; --update-baseline stores one"
        return [Reason("baseline-missing", message, 0, 0.0)]
    try:
        with path.open(encoding="utf-8") as file:
            stored, names = read_head(file)
            reasons = _program_reasons(read_entries(file, names), names, axes, chunks, limits)
    except (ValueError, IndexError, TypeError) as error:
        message = f"{path}: is not a baseline of this twin: {error}; --update-baseline stores one"
        raise UsageError(message) from error
    return reasons + ([] if figures is None else _figure_reasons(stored, figures, limits))


def _figure_reasons(stored: RunFigures, now: RunFigures, limits: BaselineTable) -> list[Reason]:
    reasons = []
    allowed = limits.cycle_time_percent / 100.0 * stored.cycle_time_s + _SMALLEST_TIME
    if abs(now.cycle_time_s - stored.cycle_time_s) > allowed:
        message = (
            f"cycle time {now.cycle_time_s:.3f} s, baseline {stored.cycle_time_s:.3f} s: "
            f"differs by more than {limits.cycle_time_percent:g} %"
        )
        reasons.append(Reason("baseline-cycle-time", message, 0, now.cycle_time_s))
    if now.contour_um - stored.contour_um > limits.contour_um:
        message = (
            f"contour error {now.contour_um:.1f} µm, baseline {stored.contour_um:.1f} µm: "
            f"grew by more than {limits.contour_um:g} µm"
        )
        reasons.append(Reason("baseline-contour", message, 0, 0.0))
    return reasons


def _program_reasons(
    stored: Iterator[Entry],
    names: tuple[str, ...],
    axes: Axes,
    chunks: Iterable[Chunk],
    limits: BaselineTable,
) -> list[Reason]:
    if axes.names != names:
        told = f"axes {' '.join(axes.names)}, baseline {' '.join(names)}"
        return [Reason("baseline-path", told, 0, 0.0)]
    program = entries(chunks)
    reasons: list[Reason] = []
    before: Entry | None = None
    line = 0
    try:
        # One by one, for the stored entry at which the program breaks is the one to tell.
        while True:
            before, now = next(stored, None), None
            now = next(program, None)
            line = line if now is None else now.line
            if before is None and now is None:
                return reasons
            difference = _difference(before, now, names, limits.path_um / 1e3, line)
            if difference is not None:
                return [*reasons, difference]
            if not reasons and before is not None and now is not None:
                reasons += _feed_reasons(before, now, limits)
    except ProgramError as error:
        message = f"no longer interprets, baseline {_told(before, names)}"
        return [*reasons, Reason("baseline-path", message, error.diagnostic.line, 0.0)]


def _feed_reasons(before: Entry, now: Entry, limits: BaselineTable) -> list[Reason]:
    if abs(now.feed - before.feed) <= limits.feed_percent / 100.0 * before.feed + 1e-6:
        return []
    message = (
        f"feed {number(now.feed)}, baseline {number(before.feed)}: "
        f"differs by more than {limits.feed_percent:g} %"
    )
    return [Reason("baseline-feed", message, now.line, 0.0)]


def _told(entry: Entry | None, names: tuple[str, ...]) -> str:
    return "its end" if entry is None else text(entry, names, entry.start, entry.feed)


def _difference(
    before: Entry | None, now: Entry | None, names: tuple[str, ...], tolerance: float, line: int
) -> Reason | None:
    """How one entry differs, if it does."""
    if before is None or now is None or now.kind != before.kind:
        missing = before or now
        what = "baseline-path" if missing is None or missing.is_path else "baseline-function"
        return Reason(what, f"{_told(now, names)}, baseline {_told(before, names)}", line, 0.0)
    message = _path_difference(before, now, names, tolerance)
    return None if message is None else Reason("baseline-path", message, line, 0.0)


def _path_difference(
    before: Entry, now: Entry, names: tuple[str, ...], tolerance: float
) -> str | None:
    for what, one, other in (("starts", now.start, before.start), ("ends", now.end, before.end)):
        for name, here, there in zip(names, one, other, strict=False):
            if abs(here - there) > tolerance:
                return f"{what} at {name}{number(here)}, baseline {name}{number(there)}"
    if now.kind == "dwell" and abs(now.value - before.value) > _SMALLEST_TIME:
        return f"dwell {number(now.value)} s, baseline {number(before.value)} s"
    return _arc_difference(before, now, tolerance) if now.center else None


def _arc_difference(before: Entry, now: Entry, tolerance: float) -> str | None:
    if math.dist(now.center, before.center) > tolerance:
        here, there = (" ".join(map(number, arc.center)) for arc in (now, before))
        return f"arc about ({here}), baseline ({there})"
    same_side = sum(a * b for a, b in zip(now.normal, before.normal, strict=True))
    if abs(now.value * same_side - before.value) > _SWEEP_DEG:
        return f"arc of {number(now.value)} degrees, baseline {number(before.value)}"
    return None
