"""Samples that are no measurements: held, spikes, cut off, counted from a reference that was lost."""

import dataclasses
import itertools

import numpy as np
from scipy.signal import medfilt

from twin.calibrate.findings import LogFinding, resolution
from twin.calibrate.fit.stretch import Sound
from twin.logs.machine_log import AxisLog
from twin.nc.canonical import BoolArray, FloatArray

_NEIGHBOURS = 5
"""Samples whose median a spike is off."""
_SPIKE = 8.0
"""Times the 97th percentile of all distances from that median."""
_ORDINARY = 0.97
_FEWER = 0.02
"""What is off in a larger share of samples is no spike."""
_JUMP = 6.0
"""Times what an ordinary step of the following error differs from those beside it."""
_LEVEL = 10
"""Samples on either side whose level tells a lost reference from a spike."""
_STEPS = 3.0
"""Resolutions that a sample must be expected to move by, for its repetition to be significant."""
_OVER = 10
"""Samples on either side from which that is expected."""
_HELD = 0.3
"""Share of moving samples that repeat the one before, above which a column is held throughout."""
_SINGLE = 0.005
"""Share above which single repetitions are reported."""
_CUT = 5
"""Samples in a row at the very end of a force's range that are cut off."""
_RECOVERS_S = 0.15
"""So long after a force was cut off positions do not follow the model [s]."""


@dataclasses.dataclass(frozen=True, slots=True)
class Defects:
    """What is wrong with the samples of an axis.

    Attributes:
        rows: First and last row, exclusive, of each stretch that counts from one reference.
        held: Whether columns are held over several samples throughout.
    """

    sound: Sound
    rows: tuple[tuple[int, int], ...]
    findings: tuple[LogFinding, ...]
    held: bool


def find_defects(
    name: str, axis: AxisLog, time: FloatArray, rows: tuple[tuple[int, int], ...]
) -> Defects:
    """Look through the samples of an axis.

    Args:
        time: Of the rows [s].
        rows: First and last row, exclusive, of each stretch without a gap.
    """
    sound = Sound(*(np.ones(len(time), np.bool_) for _ in range(3)))
    rows, lost = _one_reference(name, axis, rows)
    findings = list(lost)
    columns = {"command": axis.command, "actual position": axis.actual}
    columns |= {role: axis.more[role] for role in ("force", "current") if role in axis.more}
    masks = {"command": sound.command, "actual position": sound.actual}
    small = "mm" if axis.kind == "linear" else "deg"
    units = {"force": "N" if axis.kind == "linear" else "N m", "current": "A"}
    for column, values in columns.items():
        # Position follows the command: what is left of it has no motion that hides a spike.
        looked = axis.command - values if column == "actual position" else values
        bad = _spikes(looked, rows)
        if bad.any():
            masks.get(column, sound.force)[_with_neighbours(bad)] = False
            worst = int(np.flatnonzero(bad)[0])
            findings.append(
                LogFinding(
                    "spike",
                    f"{name}: {column} has {np.count_nonzero(bad)} spikes, the first in row {worst + 1}, "
                    f"{values[worst]:.6g} {units.get(column, small)}; they are left out",
                )
            )
    stale = {column: _stale(values, rows) for column, values in columns.items()}
    held, gaps = _held(name, time, stale, sound)
    findings += gaps
    for role in ("force", "current"):
        if role in axis.more:
            findings += _cut_off(name, axis.more[role], units[role], time, sound)
    return Defects(sound, rows, tuple(findings), held)


def _spikes(values: FloatArray, rows: tuple[tuple[int, int], ...]) -> BoolArray:
    """Samples that stand off the median of their neighbours as no other does, shape (n,)."""
    off = np.zeros(len(values))
    for begin, end in rows:
        part = values[begin:end]
        off[begin:end] = np.abs(part - medfilt(part, _NEIGHBOURS))
        off[[begin, begin + 1, end - 2, end - 1]] = 0.0
    least = max(float(np.quantile(off, _ORDINARY)), resolution(values))
    noise = 1e-9 * max(float(np.abs(values).max()), 1e-9)
    bad = off > max(_SPIKE * least, 1e-3 * float(np.ptp(values)), noise)
    return bad if float(np.mean(bad)) < _FEWER else np.zeros(len(values), np.bool_)


def _with_neighbours(bad: BoolArray) -> BoolArray:
    wide = bad.copy()
    wide[1:] |= bad[:-1]
    wide[:-1] |= bad[1:]
    return wide


def _stale(values: FloatArray, rows: tuple[tuple[int, int], ...]) -> tuple[BoolArray, float]:
    """Samples that repeat the one before while it moves, shape (n,), and their share."""
    stale, moving = np.zeros(len(values), np.bool_), np.zeros(len(values), np.bool_)
    least = _STEPS * resolution(values)
    for begin, end in rows:
        part = values[begin:end]
        if len(part) <= 2 * _OVER:
            continue
        same = np.append(False, np.diff(part) == 0.0)
        step = np.zeros(len(part))
        step[_OVER:-_OVER] = (part[2 * _OVER :] - part[: -2 * _OVER]) / (2.0 * _OVER)
        moves = np.abs(step) > max(least, 1e-12)
        stale[begin:end], moving[begin:end] = same, moves
    count = int(np.count_nonzero(moving))
    share = float(np.count_nonzero(stale & moving)) / count if count else 0.0
    if share > _HELD:
        return _later_of_runs(stale, _length_of_hold(stale & moving, moving)), share
    return stale & moving, share


def _length_of_hold(stale: BoolArray, moving: BoolArray) -> int:
    """Samples that a held value typically lasts, while it moves."""
    fresh = int(np.count_nonzero(moving & ~stale))
    return max(2, round(np.count_nonzero(moving) / max(1, fresh)))


def _later_of_runs(same: BoolArray, length: int) -> BoolArray:
    """Of runs of equal samples, those that are no first one of a hold of some length."""
    begins = np.maximum.accumulate(np.where(same, 0, np.arange(len(same))))
    return same & ((np.arange(len(same)) - begins) % length != 0)


def _held(
    name: str, time: FloatArray, stale: dict[str, tuple[BoolArray, float]],
    sound: Sound,
) -> tuple[bool, list[LogFinding]]:  # fmt: skip
    """Leave out what repeats the sample before.

    A command that is held while the position is not was held by the interpolator: the drive got its
    steps, and they are taken as they are.
    """
    masks = {"command": sound.command, "actual position": sound.actual}
    by_logger = stale["actual position"][1] > _SINGLE
    held, findings = False, []
    period = float(np.median(np.diff(time)))
    for column, (repeats, share) in stale.items():
        if share <= _SINGLE or (column == "command" and not by_logger):
            continue
        masks.get(column, sound.force)[repeats] = False
        first = int(np.flatnonzero(repeats)[0]) + 1
        if share > _HELD:
            held = True
            length = len(repeats) / max(1, np.count_nonzero(~repeats)) * period * 1e3
            message = f"has a new value every {length:.3g} ms only, and repeats it between"
        else:
            message = (
                f"repeats the sample before in {np.count_nonzero(repeats)} rows, first row {first}"
            )
        findings.append(
            LogFinding(
                "repeated",
                f"{name}: {column} {message}; repetitions are left out, as no measurements",
            )
        )
    return held, findings


def _cut_off(
    name: str, values: FloatArray, unit: str, time: FloatArray, sound: Sound
) -> list[LogFinding]:
    """Leave out where a force is at the very end of its range, and positions until it has settled."""
    findings = []
    span = float(np.ptp(values))
    for sense, word in ((1.0, "above"), (-1.0, "below")):
        ends = sense * values
        at_end = ends >= ends.max() - 1e-9 * span
        count = int(np.count_nonzero(at_end))
        beside = int(np.count_nonzero(ends >= ends.max() - 0.005 * span)) - count
        runs = np.convolve(at_end, np.ones(_CUT), "valid") > _CUT - 0.5
        if not runs.any() or count < 2 * beside or not np.ptp(values[at_end]) <= 1e-9 * span:
            continue
        if abs(float(values[at_end][0])) < 0.25 * float(np.abs(values).max()):
            continue
        sound.force[at_end] = False
        for row in np.flatnonzero(np.diff(at_end.astype(np.int8), append=0) < 0):
            end = int(np.searchsorted(time, time[row] + _RECOVERS_S))
            begin = (
                int(np.flatnonzero(~at_end[: row + 1])[-1]) if not at_end[: row + 1].all() else 0
            )
            sound.actual[begin:end] = False
            sound.force[begin:end] = False
        findings.append(
            LogFinding(
                "clipped",
                f"{name}: force or current is cut off {word} {values[at_end][0]:.6g} {unit} in {count} "
                f"samples, first in row {int(np.flatnonzero(at_end)[0]) + 1}; these and "
                f"{_RECOVERS_S:g} s after each are left out",
            )
        )
    return findings


def _one_reference(
    name: str, axis: AxisLog, rows: tuple[tuple[int, int], ...]
) -> tuple[tuple[tuple[int, int], ...], list[LogFinding]]:
    """Cut where the position starts to count from another zero, and keep the longest part."""
    lag = axis.command - axis.actual
    lost = [jump for begin, end in rows for jump in _jumps(lag[begin:end], begin)]
    if not lost:
        return rows, []
    where = [row for row, _ in lost]
    edges = [rows[0][0], *where, rows[-1][1]]
    begin, end = max(itertools.pairwise(edges), key=lambda part: part[1] - part[0])
    kept = tuple(
        (max(a, begin), min(b, end)) for a, b in rows if min(b, end) - max(a, begin) > 2 * _OVER
    )
    unit = "mm" if axis.kind == "linear" else "deg"
    jumps = ", ".join(f"{size:+.4g} {unit} in row {row + 1}" for row, size in lost[:3])
    message = (
        f"{name}: actual position loses its reference: it jumps by {jumps}"
        f"{f' and {len(lost) - 3} times more' if len(lost) > 3 else ''}, and stays there; rows "
        f"{begin + 1} to {end}, the longest that count from one zero, are fitted"
    )
    return kept, [LogFinding("reference", message)]


def _jumps(lag: FloatArray, first: int) -> list[tuple[int, float]]:
    """Rows at which the following error changes its level from one sample to the next, and by how much."""
    if len(lag) < 4 * _LEVEL:
        return []
    steps = np.diff(lag)
    sizes = np.abs(steps - medfilt(steps, 2 * _NEIGHBOURS + 1))
    least = max(_JUMP * float(np.quantile(sizes, 0.995)), _STEPS * resolution(lag))
    found = []
    for place in np.flatnonzero(sizes > max(least, 1e-9)):
        before, after = lag[max(0, place - _LEVEL + 1) : place + 1], lag[place + 1 :][:_LEVEL]
        if len(before) < _LEVEL or len(after) < _LEVEL:
            continue
        trend = float(np.median(np.append(np.diff(before), np.diff(after))))
        changed = float(np.median(after) - np.median(before)) - _LEVEL * trend
        if abs(abs(changed) - sizes[place]) < 0.3 * sizes[place]:
            found.append((first + int(place) + 1, -float(np.sign(changed) * sizes[place])))
    return found
