"""The health of a log: its clock, its resolution, its columns; what it cannot tell, and why."""

import dataclasses
import itertools
import math
from collections.abc import Mapping

import numpy as np

from twin.calibrate.findings import LogFinding, resolution
from twin.calibrate.fit.ramps import NEEDED
from twin.calibrate.fit.solve import Interval
from twin.calibrate.fit.stretch import stamp_step
from twin.calibrate.refusal import straight_law
from twin.errors import UsageError
from twin.logs.machine_log import AxisLog, MachineLog
from twin.nc.canonical import FloatArray

GAP = 1.5
"""A step of the clock above this, in periods, is a gap."""
_BRIDGED, _BRIDGED_S = 5.5, 0.012
"""A gap of no more periods, nor longer [s], is no end of a stretch: the command is drawn over it."""
_SPREAD = 0.02
"""Share of steps above ``GAP`` that are the clock's unevenness rather than gaps."""
_UNEVEN_GAP = 4.0
"""And what is a gap then, in periods."""
SLOW_S = 0.025
"""A log with longer periods does not show how a position loop settles [s]."""
SHORTEST = 50
"""Samples of a stretch that is fitted."""
_JITTER = 0.02
"""Standard deviation of the steps of a clock, in periods, from which it is reported as uneven."""
_SKEWED_S = 2e-4
"""Columns that were taken less apart count as taken together [s]."""
_BANDS, _BAND = (0.12, 0.26, 0.42), 0.08
"""Where noise is looked at, in shares of the rate of samples."""
_FALLS = 3.0
"""The power of filtered noise falls by more, from the first of these bands to the last."""
_STEEP = 15.0
"""And by less, from the first to the second: what falls by more is motion."""
_SCALED = 0.02
"""Actual may move by this share more or less than command."""
_EXPLAINED = 5.0
"""Times what the law leaves that a ratio must be off by."""
_OFFSET = 0.2
"""Share of the range of the lag that an actual position at rest may be off."""
_OTHER_MASS = 20.0
"""Times the base's mass, or a part of it, that rather is another unit."""
_SPECTRUM = 1000
"""Fewest samples for the colour of noise and the scale of motion."""
_HELD = 0.5
"""Share of samples that repeat the one before while the command moves, above which it is held."""


@dataclasses.dataclass(frozen=True, slots=True)
class Health:
    """What the clock of a log is like.

    Attributes:
        period_s: Between samples [s].
        stretches: First and last row, exclusive, of what was sampled evenly.
    """

    period_s: float
    stretches: tuple[tuple[int, int], ...]
    findings: tuple[LogFinding, ...]


def look_at_clock(log: MachineLog) -> Health:
    """Find the period of a log and where its clock breaks."""
    steps = np.diff(log.time)
    rising = steps[steps > 0]
    period = _period(rising)
    uneven = float(np.mean(steps > GAP * period)) > _SPREAD
    gaps = steps > (_UNEVEN_GAP if uneven else GAP) * period
    jumps = steps <= 0
    ends = steps > min(_BRIDGED * period, max(_BRIDGED_S, GAP * period))
    cuts = np.flatnonzero((gaps & ends) | jumps) + 1
    edges = [0, *cuts.tolist(), len(log.time)]
    long = [(a, b) for a, b in itertools.pairwise(edges) if b - a >= SHORTEST]
    findings = []
    if len(log.missing):
        rows = ", ".join(str(row) for row in log.missing[:5])
        findings.append(
            LogFinding(
                "missing",
                f"{len(log.missing)} rows miss a number and are gaps: row {rows}"
                + ("" if len(log.missing) <= 5 else " and so on"),
            )
        )
    if gaps.any():
        lost = float(np.sum(steps[gaps]) - period * np.count_nonzero(gaps))
        where = int(np.flatnonzero(gaps)[0])
        findings.append(
            LogFinding(
                "gap",
                f"{np.count_nonzero(gaps)} gaps, {lost:.3g} s without samples, first at "
                f"{float(log.time[where]):.6g} s; short ones are bridged, what lies between others "
                "is fitted piece by piece",
            )
        )
    if jumps.any():
        first = float(log.time[np.flatnonzero(jumps)[0]])
        findings.append(
            LogFinding(
                "clock-jump",
                f"the clock stops or jumps back {np.count_nonzero(jumps)} times, first at "
                f"{first:.6g} s; what lies between is fitted piece by piece",
            )
        )
    steady = rising[rising < GAP * period]
    spread = float(np.std(steady)) if len(steady) else 0.0
    if spread > _JITTER * period and stamp_step(log.time) < spread:
        findings.append(
            LogFinding(
                "uneven",
                f"samples come every {period * 1e3:.3g} ms, give or take {spread * 1e3:.2g} ms; time "
                "stamps are taken as they are",
            )
        )
    if period > SLOW_S:
        findings.append(_slow(log, period))
    return Health(period, tuple(long), tuple(findings))


def _slow(log: MachineLog, period: float) -> LogFinding:
    """What a slow log does not tell, and what else would have to be logged for it to tell more."""
    message = (
        f"{1 / period:.3g} samples a second are too few for the dynamics of a drive; what can still be "
        "fitted: the lag as a whole, friction where a force is logged, and ramps where velocities are logged"
    )
    lacking = {
        name: [role for role in NEEDED if role not in axis.more] for name, axis in log.axes.items()
    }
    without = "; ".join(f"{name} {', '.join(roles)}" for name, roles in lacking.items() if roles)
    if without:
        message += f"; columns for ramps that the map lacks: {without}"
    return LogFinding("slow", message)


def _period(rising: FloatArray) -> float:
    """Typical time between samples [s]: the mean, of a clock with few digits too."""
    if not len(rising):
        return 1.0
    middle = float(np.median(rising))
    return float(np.mean(rising[rising < GAP * middle]))


def refuse_broken_clock(log: MachineLog, health: Health) -> None:
    """Refuse a log without a single stretch that is long enough to be fitted.

    Raises:
        UsageError: With what is wrong with the clock, and what would make it right.
    """
    if health.stretches:
        return
    count = len(log.time)
    if count < SHORTEST:
        raise UsageError(
            f"{log.name}: has {count} samples; a fit needs {SHORTEST} in a row: log for longer"
        )
    standing = int(np.count_nonzero(np.diff(log.time) <= 0))
    if standing:
        raise UsageError(
            f"{log.name}: its clock stops or jumps back at {standing} of {count} samples: where they "
            "are even, give the map a 'period' in place of 'time'; else log time with more digits"
        )
    raise UsageError(
        f"{log.name}: has no stretch of {SHORTEST} samples in a row without a gap: nothing can be fitted"
    )


def is_filtered(command: FloatArray, actual: FloatArray) -> bool:
    """Whether the noise of positions falls off towards high frequencies, as behind a filter.

    Motion falls off there too, but far more steeply, and it is in the command as well.

    Args:
        command: Commanded positions of one even stretch, shape (n,).
        actual: Actual ones, shape (n,).
    """
    if len(actual) < _SPECTRUM:
        return False
    moved, *_ = _band_powers(command)
    middle, high, highest = _band_powers(actual)
    return moved < middle < _STEEP * high and middle > _FALLS * highest > 0.0


def _band_powers(values: FloatArray) -> list[float]:
    bent = np.diff(values, 2)
    frequency = np.fft.rfftfreq(len(bent))[1:]
    power = np.abs(np.fft.rfft(bent * np.hanning(len(bent)))[1:]) ** 2
    power = power / (2.0 * np.sin(np.pi * frequency)) ** 4
    return [float(np.mean(power[(frequency > low) & (frequency <= low + _BAND)])) for low in _BANDS]


def look_at_axis(name: str, axis: AxisLog, health: Health) -> list[LogFinding]:
    """What one axis's columns cannot tell."""
    findings = []
    lag = axis.command - axis.actual
    small = "µm" if axis.kind == "linear" else "mdeg"
    step = max(resolution(axis.command), resolution(axis.actual))
    peak = float(np.abs(lag - np.median(lag)).max())
    if step > 0.05 * peak > 0:
        findings.append(
            LogFinding(
                "coarse",
                f"{name}: positions come in steps of {step * 1e3:.4g} {small}, its lag is at most "
                f"{peak * 1e3:.4g} {small}: small effects drown in the steps",
            )
        )
    moving = np.abs(np.diff(axis.command)) > 0
    if health.period_s <= SLOW_S and moving.mean() < 0.9:
        runs = np.flatnonzero(moving)
        between = np.diff(runs)
        if len(between) and np.median(between) >= 2 and float(np.mean(between >= 2)) > _HELD:
            held = float(np.median(between)) * health.period_s * 1e3
            findings.append(
                LogFinding(
                    "held",
                    f"{name}: the command changes every {held:.3g} ms only, in steps: the log is "
                    "faster than the interpolator; steps are taken as they are",
                )
            )
    return findings


def look_at_motion(name: str, axis: AxisLog, period_s: float) -> list[LogFinding]:
    """What does not fit between commanded and actual positions of one even stretch."""
    findings = []
    ratio, _, left = straight_law(axis, period_s)
    enough = len(axis.command) >= _SPECTRUM
    if enough and abs(ratio - 1.0) > max(_SCALED, _EXPLAINED * left):
        findings.append(
            LogFinding(
                "scale",
                f"{name}: actual moves {ratio:.4g} times as far as command: no drive does; give one of "
                "them a scale in the map, or what is fitted takes it up",
            )
        )
    lag = axis.command - axis.actual
    rests = np.gradient(axis.command) == 0.0
    if np.count_nonzero(rests) >= SHORTEST:
        offset = float(np.median(lag[rests]))
        if abs(offset) > _OFFSET * float(np.ptp(lag)) > 0.0:
            unit = "mm" if axis.kind == "linear" else "deg"
            findings.append(
                LogFinding(
                    "offset",
                    f"{name}: where the command rests, actual stands {-offset:.4g} {unit} off it: if the "
                    "two count from different zeros, give one of them an offset in the map; else it "
                    "is the work of a constant force",
                )
            )
    return findings


def look_at_fit(
    name: str, fitted: Mapping[str, Interval], base_mass: float, *, filtered: bool
) -> list[LogFinding]:
    """What a fit shows or explains: columns taken at different times, filtered, in other units.

    Args:
        fitted: What its logs determine.
        base_mass: What the motor of the base moves [kg or kg m²].
        filtered: Whether the noise of its positions is that of a filtered column.
    """
    findings = []
    for key, column in (("delay", "actual position"), ("force_delay", "force or current")):
        skew = fitted.get(key)
        if skew is not None and (skew.low > 0.0 or skew.high < 0.0):
            if min(abs(skew.low), abs(skew.high)) < _SKEWED_S:
                continue
            when = "later" if skew.value > 0.0 else "earlier"
            if key == "delay" and skew.high < 0.0:
                findings.append(_feed_forward(name, skew))
                continue
            findings.append(
                LogFinding(
                    "skew",
                    f"{name}: {column} is logged {abs(skew.value) * 1e3:.3g} ms {when} than the command "
                    f"({_milliseconds(skew)}); the fit takes that as the log's, and the drive's own "
                    "lag can still be fitted",
                )
            )
    mass = fitted.get("mass")
    if mass is not None and not 1.0 / _OTHER_MASS < mass.value / base_mass < _OTHER_MASS:
        findings.append(
            LogFinding(
                "unit",
                f"{name}: the mass comes to {mass.value / base_mass:.3g} times the base's: unless the "
                "base is another kind of machine, force or positions are in another unit (inches, "
                "kilonewtons?)",
            )
        )
    smooth = fitted.get("measuring_filter")
    if filtered or (smooth is not None and smooth.low > 0.0):
        seen = (
            "" if smooth is None
            else f", of {smooth.value * 1e3:.3g} ms ({_milliseconds(smooth)}), which dulls what is faster "
            f"than {1.0 / (2.0 * math.pi * max(smooth.value, 1e-6)):.0f} Hz"
        )  # fmt: skip
        why = ": its noise falls off towards high frequencies" if filtered else ""
        findings.append(
            LogFinding(
                "filtered",
                f"{name}: actual position is logged behind a filter{seen}{why}; the filter is taken as "
                "the log's, and loop gain, damping and friction can still be fitted",
            )
        )
    return findings


def _feed_forward(name: str, delay: Interval) -> LogFinding:
    """What an actual position says that seems to be logged before it is there."""
    return LogFinding(
        "feed-forward",
        f"{name}: actual position seems to be logged {abs(delay.value) * 1e3:.3g} ms earlier than the "
        f"command ({_milliseconds(delay)}): unless the columns are that far apart, the drive receives the "
        "speed of the command (velocity_feedforward), and kv, damping_ratio and the share of "
        "feed-forward cannot be separated; if the log is late, give the map a delay_s of the column",
    )


def _milliseconds(interval: Interval) -> str:
    low, high = sorted((abs(interval.low), abs(interval.high)))
    return f"{low * 1e3:.3g} to {high * 1e3:.3g} ms"
