"""A log that is ready to be fitted: looked through, and no faster than a fit needs it."""

import dataclasses
import itertools
from collections.abc import Iterator, Mapping

import numpy as np

from twin.calibrate.defects import Defects, find_defects
from twin.calibrate.fit.ramps import axes_with_ramps, find_cycle, find_ramps
from twin.calibrate.fit.slow import SlowLog, commanded_speed
from twin.calibrate.fit.stretch import Sound, Stretch, stretches_of
from twin.calibrate.health import (
    GAP,
    SLOW_S,
    Health,
    is_filtered,
    look_at_clock,
    refuse_broken_clock,
)
from twin.calibrate.jumps import jumps_of, look_at_jumps
from twin.logs.machine_log import AxisLog, MachineLog
from twin.nc.canonical import BoolArray, FloatArray

MOST_FITTED = 60_000
"""Samples that a fit runs along: more add nothing, and each of hundreds of runs takes longer."""
_MOST_AT_ONCE = 100_000
"""Samples that are looked at or judged at once: what a model has in place of them takes ten times their room."""
_PART_S = 5.0
"""Time of a part of a long log that is fitted or left [s]."""
Rows = tuple[tuple[int, int], ...]
_FASTEST_S = 1e-3
"""A log with shorter periods is averaged to this one [s]."""


@dataclasses.dataclass(frozen=True, slots=True)
class PreparedLog:
    """A log, and what is known of it before anything is fitted.

    Attributes:
        role: ``fit`` or ``hold-out``.
        cycle_s: Over which a slow log's control forms velocities; 0 where nothing tells [s].
        defects: Of its axes; none of a slow log.
    """

    log: MachineLog
    role: str
    health: Health
    cycle_s: float
    defects: Mapping[str, Defects]

    @property
    def is_slow(self) -> bool:
        """Whether it has too few samples a second for the dynamics of a drive."""
        return self.health.period_s > SLOW_S

    def rows(self, name: str) -> Rows:
        """First and last row, exclusive, of the stretches of an axis that are fitted."""
        found = self.defects.get(name)
        return self.health.stretches if found is None else found.rows

    def stretches(self, name: str) -> list[Stretch]:
        """What is fitted of an axis."""
        found = self.defects.get(name)
        sound = None if found is None else found.sound
        return stretches_of(self.log.axes[name], self.log.time, self.rows(name), sound)

    def parts(self, name: str) -> Iterator[tuple[int, int]]:
        """As ``rows``; a long stretch in parts, each with a beginning of its own."""
        for begin, end in self.rows(name):
            count = -(-(end - begin) // _MOST_AT_ONCE)
            edges = [begin + (end - begin) * part // count for part in range(count + 1)]
            yield from itertools.pairwise(edges)

    def judged(self, name: str) -> Iterator[Stretch]:
        """All of an axis, one part after the other."""
        found = self.defects.get(name)
        sound = None if found is None else found.sound
        for part in self.parts(name):
            yield from stretches_of(self.log.axes[name], self.log.time, (part,), sound)

    def fitted(self, name: str) -> list[Stretch]:
        """What a fit of an axis runs along: of a long log the parts in which it moves most."""
        rows, period = self.rows(name), self.health.period_s
        if sum(end - begin for begin, end in rows) <= MOST_FITTED:
            return self.stretches(name)
        size = round(_PART_S / period)
        parts = [
            (start, min(start + size, end))
            for begin, end in rows
            for start in range(begin, end - size // 2, size)
        ]
        course = self.log.axes[name].command
        travel = [float(np.abs(np.diff(course[a:b])).sum()) for a, b in parts]
        liveliest = np.argsort(travel)[::-1][: MOST_FITTED // size]
        kept = tuple(parts[number] for number in sorted(liveliest))
        found = self.defects.get(name)
        sound = None if found is None else found.sound
        return stretches_of(self.log.axes[name], self.log.time, kept, sound)

    def slow(self, name: str) -> SlowLog:
        """An axis of a slow log."""
        ramps = []
        if name in axes_with_ramps(self.log):
            ramps = find_ramps(self.log, name, self.health.stretches, self.cycle_s)
        axis, time, period = self.log.axes[name], self.log.time, self.health.period_s
        steps = np.diff(time)
        whole = (steps > 0.0) & (steps < GAP * period) & ~jumps_of(self.log, period)
        return SlowLog(axis, self.health.stretches, ramps, *commanded_speed(axis, time, whole))

    def is_filtered(self, name: str) -> bool:
        """Whether positions of an axis are logged behind a filter, as their noise shows."""
        begin, end = max(self.rows(name), key=lambda rows: rows[1] - rows[0])
        axis = self.cleaned(name).of_rows(slice(begin, min(end, begin + _MOST_AT_ONCE)))
        return is_filtered(axis.command, axis.actual)

    def cleaned(self, name: str) -> AxisLog:
        """An axis with straight lines in place of what is no measurement, for a first look."""
        axis, found = self.log.axes[name], self.defects.get(name)
        if found is None:
            return axis
        time, sound = self.log.time, found.sound
        more = {
            role: _bridged(time, values, sound.force) if role in ("force", "current") else values
            for role, values in axis.more.items()
        }
        return dataclasses.replace(
            axis, command=_bridged(time, axis.command, sound.command),
            actual=_bridged(time, axis.actual, sound.actual), more=more,
        )  # fmt: skip


def _bridged(time: FloatArray, values: FloatArray, good: BoolArray) -> FloatArray:
    return values if good.all() or not good.any() else np.interp(time, time[good], values[good])


def prepared(log: MachineLog, role: str) -> PreparedLog:
    """Look through a log, and average it where it is faster than a fit needs it.

    Args:
        role: ``fit`` or ``hold-out``.

    Raises:
        UsageError: Its clock is broken.
    """
    health = look_at_clock(log)
    refuse_broken_clock(log, health)
    if health.period_s > SLOW_S:
        cycle = find_cycle(log, health.stretches) if axes_with_ramps(log) else 0.0
        jumps = look_at_jumps(log, jumps_of(log, health.period_s))
        extended = dataclasses.replace(health, findings=(*health.findings, *jumps))
        return PreparedLog(log, role, extended, cycle, {})
    defects = {
        name: find_defects(name, axis, log.time, health.stretches)
        for name, axis in log.axes.items()
    }
    times = round(_FASTEST_S / health.period_s)
    fast = PreparedLog(log, role, health, 0.0, defects)
    # Held values change once in a while: their means are those of other moments.
    if times < 2 or any(one.held for one in defects.values()):
        return fast
    return _averaged(fast, times)


def _averaged(fast: PreparedLog, times: int) -> PreparedLog:
    """A log with fewer samples, each the mean of some: what is linear stays as it is."""
    log, stretches = fast.log, fast.health.stretches

    def groups(values: FloatArray | BoolArray) -> FloatArray:
        parts = [values[a : a + (b - a) // times * times] for a, b in stretches]
        return np.concatenate([part.reshape(-1, times).mean(axis=1) for part in parts])

    def sound(defects: Defects) -> Sound:
        masks = (defects.sound.command, defects.sound.actual, defects.sound.force)
        return Sound(*(groups(mask) == 1.0 for mask in masks))

    axes = {
        name: dataclasses.replace(
            axis, command=groups(axis.command), actual=groups(axis.actual),
            more={role: groups(values) for role, values in axis.more.items()},
        )
        for name, axis in log.axes.items()
    }  # fmt: skip
    first, begins = 0, []
    for begin, end in stretches:
        begins.append((begin, end, first))
        first += (end - begin) // times

    def rows(old: Rows) -> Rows:
        kept = [
            (first + -(-(max(a, begin) - begin) // times), first + (min(b, end) - begin) // times)
            for a, b in old
            for begin, end, first in begins
            if min(b, end) - max(a, begin) >= 2 * times
        ]
        return tuple(kept)

    time = groups(log.time)
    less = MachineLog(log.name, time, axes, np.zeros(len(time), np.int64), log.missing)
    defects = {
        name: dataclasses.replace(one, sound=sound(one), rows=rows(one.rows))
        for name, one in fast.defects.items()
    }
    health = dataclasses.replace(
        fast.health, period_s=fast.health.period_s * times, stretches=rows(stretches)
    )
    return PreparedLog(less, fast.role, health, 0.0, defects)
