"""The health of a log: its clock, its resolution, its columns; what it cannot tell, and why."""

import dataclasses
import itertools
import math
from collections.abc import Mapping

import numpy as np

from twin.calibrate.fit.solve import Interval
from twin.calibrate.refusal import straight_law
from twin.errors import UsageError
from twin.logs.machine_log import AxisLog, MachineLog
from twin.nc.canonical import FloatArray

GAP = 1.5
"""A step of the clock above this, in periods, is a gap."""
SLOW_S = 0.025
"""A log with longer periods does not show how a position loop settles [s]."""
SHORTEST = 50
"""Samples of a stretch that is fitted."""
_JITTER = 0.2
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
"""Samples without which noise has no colour, and motion no scale, to speak of."""
_HELD = 0.5
"""Share of samples that repeat the one before while the command moves, above which it is held."""


@dataclasses.dataclass(frozen=True, slots=True)
class Finding:
    """Something about a log that a person should know.

    Attributes:
        code: ``gap``, ``clock-jump``, ``slow``, ``coarse``, ``held``, ``jitter``, ``skew``,
            ``filtered``, ``scale``, ``offset``, ``unit``.
        message: In words, with what can still be fitted.
    """

    code: str
    message: str


@dataclasses.dataclass(frozen=True, slots=True)
class Health:
    """What the clock of a log is like.

    Attributes:
        period_s: Between samples [s].
        stretches: First and last row, exclusive, of what was sampled evenly.
        findings: About the clock.
    """

    period_s: float
    stretches: tuple[tuple[int, int], ...]
    findings: tuple[Finding, ...]


def look_at_clock(log: MachineLog) -> Health:
    """Find the period of a log and where its clock breaks."""
    steps = np.diff(log.time)
    rising = steps[steps > 0]
    period = float(np.median(rising)) if len(rising) else 1.0
    gaps = steps > GAP * period
    jumps = steps <= 0
    cuts = np.flatnonzero(gaps | jumps) + 1
    edges = [0, *cuts.tolist(), len(log.time)]
    long = [(a, b) for a, b in itertools.pairwise(edges) if b - a >= SHORTEST]
    findings = []
    if gaps.any():
        lost = float(np.sum(steps[gaps]) - period * np.count_nonzero(gaps))
        findings.append(
            Finding(
                "gap",
                f"{np.count_nonzero(gaps)} gaps, {lost:.3g} s without samples; what lies between is "
                "fitted piece by piece",
            )
        )
    if jumps.any():
        first = float(log.time[np.flatnonzero(jumps)[0]])
        findings.append(
            Finding(
                "clock-jump",
                f"the clock stands or jumps back {np.count_nonzero(jumps)} times, first at "
                f"{first:.6g} s; what lies between is fitted piece by piece",
            )
        )
    even = rising[rising < GAP * period]
    if len(even) and float(np.std(even)) > _JITTER * period:
        findings.append(
            Finding("jitter", f"samples come every {period * 1e3:.3g} ms, but unevenly; they are "
                    "taken as even, which blurs what is faster")
        )  # fmt: skip
    if period > SLOW_S:
        findings.append(
            Finding(
                "slow",
                f"{1 / period:.3g} samples a second are too few for the dynamics of a drive; what "
                "can still be fitted: the lag as a whole, friction where a force is logged, and "
                "ramps where velocities are logged",
            )
        )
    return Health(period, tuple(long), tuple(findings))


def refuse_broken_clock(log: MachineLog, health: Health) -> None:
    """Refuse a log without a single stretch that is long enough to be fitted.

    Args:
        log: The log.
        health: Of its clock.

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
            f"{log.name}: its clock stands or runs back at {standing} of {count} samples: where they "
            "are even, give the map a 'period' in place of 'time'; else log time with more digits"
        )
    raise UsageError(
        f"{log.name}: has no stretch of {SHORTEST} samples in a row without a gap: nothing can be fitted"
    )


def resolution(values: FloatArray) -> float:
    """The step that values come in, 0 where they come in none.

    The least difference counts when (nearly) all others are its multiples.
    """
    steps = np.abs(np.diff(np.unique(values)))
    steps = steps[steps > 1e-12 * max(1.0, float(np.abs(values).max()))]
    if len(steps) < 2:
        return 0.0
    least = float(np.min(steps))
    parts = steps / least
    even = np.abs(parts - np.round(parts)) < 0.02
    return least if float(np.mean(even)) > 0.95 else 0.0


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


def look_at_axis(name: str, axis: AxisLog, health: Health) -> list[Finding]:
    """What one axis's columns cannot tell."""
    findings = []
    lag = axis.command - axis.actual
    small = "µm" if axis.kind == "linear" else "mdeg"
    step = max(resolution(axis.command), resolution(axis.actual))
    peak = float(np.abs(lag - np.median(lag)).max())
    if step > 0.05 * peak > 0:
        findings.append(
            Finding(
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
                Finding(
                    "held",
                    f"{name}: the command changes every {held:.3g} ms only, in steps: the log is "
                    "faster than the interpolator; steps are taken as they are",
                )
            )
    return findings


def look_at_motion(name: str, axis: AxisLog, period_s: float) -> list[Finding]:
    """What does not fit between commanded and actual positions of one even stretch."""
    findings = []
    ratio, _, left = straight_law(axis, period_s)
    enough = len(axis.command) >= _SPECTRUM
    if enough and abs(ratio - 1.0) > max(_SCALED, _EXPLAINED * left):
        findings.append(
            Finding(
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
                Finding(
                    "offset",
                    f"{name}: where the command rests, actual stands {-offset:.4g} {unit} off it: if the "
                    "two count from different zeros, give one of them an offset in the map; else it "
                    "is the work of a constant force",
                )
            )
    return findings


def look_at_fit(
    name: str, fitted: Mapping[str, Interval], base_mass: float, *, filtered: bool
) -> list[Finding]:
    """What a fit shows or explains: columns taken at different times, filtered, in other units.

    Args:
        name: Of the axis.
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
            findings.append(
                Finding(
                    "skew",
                    f"{name}: {column} is logged {abs(skew.value) * 1e3:.3g} ms {when} than the command "
                    f"({_milliseconds(skew)}); the fit takes that as the log's, and the drive's own "
                    "lag can still be fitted",
                )
            )
    mass = fitted.get("mass")
    if mass is not None and not 1.0 / _OTHER_MASS < mass.value / base_mass < _OTHER_MASS:
        findings.append(
            Finding(
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
            Finding(
                "filtered",
                f"{name}: actual position is logged behind a filter{seen}{why}; the filter is taken as "
                "the log's, and loop gain, damping and friction can still be fitted",
            )
        )
    return findings


def _milliseconds(interval: Interval) -> str:
    low, high = sorted((abs(interval.low), abs(interval.high)))
    return f"{low * 1e3:.3g} to {high * 1e3:.3g} ms"
