"""Two runs of one program held against each other: twin and twin, or twin and real machine."""

import dataclasses
from collections.abc import Mapping
from pathlib import Path

import numpy as np

from twin.compare.tracks import Track, read_track
from twin.errors import UsageError
from twin.logs.column_map import ColumnMap
from twin.nc.canonical import FloatArray

_COARSE_SAMPLES = 8192
"""The offset in time is first sought on so many samples at most, then refined."""


@dataclasses.dataclass(frozen=True, slots=True)
class AxisDifference:
    """How one axis differs between two runs, after they are aligned in time.

    Attributes:
        commanded_max: Greatest difference of the commanded positions [mm or deg].
        actual_max: Greatest difference of the actual positions [mm or deg].
        actual_rms: Root mean square of it [mm or deg].
        following_max: Greatest difference of the following errors [mm or deg].
        following_rms: Root mean square of it [mm or deg].
        time_s: When the actual positions differ most, in the first run's time [s].
        line: Program line there, 0 where neither run knows it.
    """

    commanded_max: float
    actual_max: float
    actual_rms: float
    following_max: float
    following_rms: float
    time_s: float
    line: int


@dataclasses.dataclass(frozen=True, slots=True)
class TrackDifference:
    """How two runs differ.

    Attributes:
        offset_s: What must be added to the second run's time to make it the first's [s].
        overlap_s: How long both runs are known [s].
        axes: By axis that both have.
    """

    offset_s: float
    overlap_s: float
    axes: Mapping[str, AxisDifference]


def compare_files(
    first: str | Path,
    second: str | Path,
    *,
    period_s: float | None = None,
    offset_s: float | None = None,
    columns: ColumnMap | None = None,
) -> TrackDifference:
    """How two recordings, or a recording and a log, differ after they are aligned in time.

    Args:
        first: Recording (``.h5``) or log of a real machine, in a form that ``twin.logs`` reads.
        second: Recording or log that is compared with the first.
        period_s: Time between the samples of logs without a time column [s].
        offset_s: Known offset in time [s]; found by the commanded positions by default.
        columns: What the columns of logs are; by default what their headings say.

    Raises:
        UsageError: A file cannot be read, or the two have nothing in common.
    """
    one, other = (
        read_track(Path(path), period_s=period_s, columns=columns) for path in (first, second)
    )
    return compare_tracks(one, other, offset_s=offset_s)


def compare_tracks(
    first: Track, second: Track, *, offset_s: float | None = None
) -> TrackDifference:
    """Align two runs in time by what was commanded, and compare what was done.

    Args:
        second: Read in between its samples by straight lines.
        offset_s: Known offset [s]; found by least squares of the commanded positions by default.

    Raises:
        UsageError: They share no axis, or no time.
    """
    names = tuple(name for name in first.axes if name in second.axes)
    if not names:
        raise UsageError(
            f"{first.name} has the axes {', '.join(first.axes)}, {second.name} has "
            f"{', '.join(second.axes)}: none in common"
        )
    if offset_s is None:
        offset_s = _best_offset(first, second, names)
    shifted = second.time + offset_s
    low, high = max(first.time[0], shifted[0]), min(first.time[-1], shifted[-1])
    rows = (first.time >= low) & (first.time <= high)
    if not rows.any():
        raise UsageError(f"{first.name} and {second.name} share no time")
    time = first.time[rows]
    axes = {}
    for name in names:
        here, there = first.axes.index(name), second.axes.index(name)
        asked = first.commanded[rows, here]
        done = first.actual[rows, here]
        other_asked = np.interp(time, shifted, second.commanded[:, there])
        other_done = np.interp(time, shifted, second.actual[:, there])
        difference = done - other_done
        following = (asked - done) - (other_asked - other_done)
        worst = int(np.abs(difference).argmax())
        line = int(first.line[rows][worst])
        if line == 0:
            line = int(second.line[min(np.searchsorted(shifted, time[worst]), len(shifted) - 1)])
        axes[name] = AxisDifference(
            commanded_max=float(np.abs(asked - other_asked).max()),
            actual_max=float(np.abs(difference).max()),
            actual_rms=float(np.sqrt(np.mean(difference**2))),
            following_max=float(np.abs(following).max()),
            following_rms=float(np.sqrt(np.mean(following**2))),
            time_s=float(time[worst]),
            line=line,
        )
    return TrackDifference(offset_s, float(high - low), axes)


def _best_offset(first: Track, second: Track, names: tuple[str, ...]) -> float:
    """The offset with the least squared difference of the commanded positions.

    Correlation of the commanded speeds finds it to a sample of a coarse grid; three points of the
    squared difference around it give the minimum between samples, on grids ever finer.
    """
    span = max(np.ptp(first.time), np.ptp(second.time))
    step = max(
        float(min(np.median(np.diff(first.time)), np.median(np.diff(second.time)))),
        float(span) / _COARSE_SAMPLES,
    )
    one = _speeds(first, names, step)
    other = _speeds(second, names, step)
    size = 2 ** int(np.ceil(np.log2(len(one) + len(other))))
    product = np.fft.rfft(one, size, axis=0) * np.conj(np.fft.rfft(other, size, axis=0))
    score = np.fft.irfft(product, size, axis=0).sum(axis=1)
    shift = int(score.argmax())
    shift = shift - size if shift > size // 2 else shift
    offset = float(first.time[0] - second.time[0]) + shift * step
    while step > 1e-6:
        tried = offset + step * np.array([-1.0, 0.0, 1.0])
        errors = [_misfit(first, second, names, value) for value in tried]
        offset = _lowest(tried, errors)
        step /= 4.0
    return offset


def _speeds(track: Track, names: tuple[str, ...], step: float) -> FloatArray:
    time = np.arange(track.time[0], track.time[-1] + step / 2, step)
    columns = [
        np.interp(time, track.time, track.commanded[:, track.axes.index(name)]) for name in names
    ]
    return np.diff(np.column_stack(columns), axis=0)


def _misfit(first: Track, second: Track, names: tuple[str, ...], offset: float) -> float:
    every = max(1, len(first.time) // _COARSE_SAMPLES)
    time = first.time[::every]
    shifted = second.time + offset
    inside = (time >= shifted[0]) & (time <= shifted[-1])
    if not inside.any():
        return float("inf")
    total = 0.0
    for name in names:
        asked = first.commanded[::every, first.axes.index(name)][inside]
        other = np.interp(time[inside], shifted, second.commanded[:, second.axes.index(name)])
        total += float(np.mean((asked - other) ** 2))
    return total


def _lowest(places: FloatArray, values: list[float]) -> float:
    """The lowest point of the parabola through three points, kept between them."""
    a, b, c = values
    bend = a - 2.0 * b + c
    if not np.isfinite(bend) or bend <= 0.0:
        return float(places[int(np.argmin(values))])
    step = float(places[1] - places[0])
    return float(places[1] + step * np.clip(0.5 * (a - c) / bend, -1.0, 1.0))
