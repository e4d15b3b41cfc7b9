"""Synthetic machines whose truth is known: do the intervals of ``twin calibrate`` cover it?

``python -m tests.calibrate.study [MACHINES]`` draws machines (200 by default) with random drives, noise,
quantisation, delay and rates from 50 Hz to 4 kHz, with force, with a current or with positions alone;
half of them have a dead time, a filter of speed or command, an integrator, or a log behind a measuring
filter. ``--first N`` passes over those before, ``--processes N`` fits so many at a time, ``--json FILE``
keeps every interval beside its truth. It prints by parameter how many intervals cover the truth, and
ends with 1 where less than 90 % or more than 99 % of all do, or where something that is not told is
not named.
"""

import argparse
import collections
import dataclasses
import json
import multiprocessing
import sys
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from twin.calibrate.fit.parameters import AxisParameters, of_base
from twin.calibrate.fit.simulation import command_of, seen_at, simulate_axis
from twin.calibrate.fit.solve import Interval
from twin.calibrate.fit.stages import OF_THE_LOG, AxisFit, fit_axis
from twin.calibrate.fit.stretch import stretches_of
from twin.files.shipped import machine_file
from twin.logs.column_map import AxisColumns, ColumnTable
from twin.logs.machine_log import AxisLog
from twin.machine.description.machine_file import AxisTable
from twin.machine.load import read_machine
from twin.machine.model.drives import is_unstable, tune
from twin.nc.canonical import FloatArray

RATES = (50, 100, 250, 500, 1000, 4000)
BASE_MASS = 1041.154
SECONDS = 6.0
_FINE_S = 0.00025
_AVERAGED = 1000
"""Rate above which ``twin calibrate`` averages neighbouring samples."""
_ANY = ColumnTable(column="a", unit="mm")
_EXTRAS = {
    "loop_delay_s": (0.0005, 0.003),
    "velocity_filter_s": (0.0005, 0.003),
    "command_filter_s": (0.001, 0.008),
    "reset_time_s": (0.01, 0.06),
    "measuring_filter": (0.001, 0.006),
}
"""What a machine may have besides, and between which values [s]."""


@dataclasses.dataclass(frozen=True, slots=True)
class Drawn:
    """A machine and its log."""

    truth: AxisParameters
    log: AxisLog
    rate: int
    kind: str


def _shipped_axis() -> AxisTable:
    """X of mill4 without integral action: as many parameters as a log of some seconds tells."""
    return read_machine(machine_file("mill4")).changed("X", reset_time_s=0.0).axis("X")


def draw(random: np.random.Generator) -> Drawn:
    """Draw a machine, run it and log it."""
    mass = float(random.uniform(200.0, 1500.0))
    base = of_base(_shipped_axis(), mass)
    truth = dataclasses.replace(
        base,
        kv=float(random.uniform(2.0, 10.0)),
        damping_ratio=float(random.uniform(0.4, 1.5)),
        viscous_friction=float(random.uniform(0.0, 0.005)) * mass,
        dry_friction=float(random.uniform(0.05, 0.6)) * mass,
        constant_force=float(random.uniform(-0.2, 0.2)) * mass,
        velocity_feedforward=0.0,
        current_scale=float(random.uniform(30.0, 300.0)),
        current_at_rest=float(random.uniform(-0.3, 0.3)),
        delay=float(random.choice([0.0, random.uniform(0.0, 0.005)])),
        **_extras(random),
    )
    if is_unstable(tune(_axis_with(truth), mass)):
        return draw(random)
    rate, kind = int(random.choice(RATES)), str(random.choice(["positions", "current", "force"]))
    asked = _course(random)
    command = command_of(
        "linear", np.linspace(0.0, _FINE_S * (len(asked) - 1), len(asked)), asked, asked
    )
    motion = simulate_axis(truth, command)
    every = round(1.0 / rate / _FINE_S)
    seen = seen_at(motion.position, motion.velocity, command, truth.delay)[::every]
    noise, step = random.uniform(0.1e-3, 2e-3), random.choice([0.0, 0.1e-3, 1e-3])
    actual = seen + noise * random.standard_normal(len(seen))
    actual = np.round(actual / step) * step if step else actual
    force = motion.force[::every] + 0.02 * mass * random.standard_normal(len(seen))
    more: dict[str, FloatArray] = {}
    if kind == "force":
        more["force"] = force
    elif kind == "current":
        more["current"] = force / truth.current_scale + truth.current_at_rest
    columns = AxisColumns(command=_ANY, actual=_ANY)
    return Drawn(truth, AxisLog("linear", asked[::every], actual, more, columns), rate, kind)


def _extras(random: np.random.Generator) -> dict[str, float]:
    """Nothing in half of the cases, else one or two of ``_EXTRAS``."""
    count = int(random.choice([0, 0, 1, 2]))
    names = random.choice(list(_EXTRAS), count, replace=False)
    return {str(name): float(random.uniform(*_EXTRAS[str(name)])) for name in names}


def extras_of(drawn: Drawn) -> list[str]:
    """What of ``_EXTRAS`` a machine has."""
    return [name for name in _EXTRAS if getattr(drawn.truth, name)]


def _axis_with(truth: AxisParameters) -> AxisTable:
    names = set(AxisTable.model_fields) & set(AxisParameters.__dataclass_fields__)
    changes = {name: getattr(truth, name) for name in names}
    return _shipped_axis().model_copy(update=changes)


def _course(random: np.random.Generator) -> FloatArray:
    """Strokes with smooth starts, slow reversals and rests, shape (n,) [mm]."""
    time = np.arange(0.0, SECONDS, _FINE_S)
    change = np.zeros(len(time))
    begin = 0.1
    while begin < SECONDS - 1.0:
        speed, rise = float(random.choice([3, 20, 80, 200, 350])), float(random.uniform(0.06, 0.2))
        hold = float(random.uniform(0.1, 0.4))
        for sense in (1, -1):
            for start, sign in ((begin, sense), (begin + rise + hold, -sense)):
                part = (time - start) / rise
                inside = (part > 0) & (part < 1)
                change[inside] += sign * speed / rise * (1 - np.cos(2 * np.pi * part[inside]))
            begin += 2 * rise + hold + 0.03
    velocity = np.cumsum(change) * _FINE_S
    return np.cumsum(velocity) * _FINE_S


def fit(drawn: Drawn) -> AxisFit:
    """Fit a drawn machine on mill4 as ``twin calibrate`` does."""
    axis, rate = drawn.log, drawn.rate
    if rate > _AVERAGED:
        times = rate // _AVERAGED
        axis = dataclasses.replace(
            axis, command=_mean(axis.command, times), actual=_mean(axis.actual, times),
            more={role: _mean(values, times) for role, values in axis.more.items()},
        )  # fmt: skip
        rate = _AVERAGED
    time = np.linspace(0.0, (len(axis.command) - 1) / rate, len(axis.command))
    base = of_base(_shipped_axis(), BASE_MASS)
    return fit_axis("linear", stretches_of(axis, time, ((0, len(time)),)), base)


def _mean(values: FloatArray, times: int) -> FloatArray:
    return values[: len(values) // times * times].reshape(-1, times).mean(axis=1)


def truths(drawn: Drawn, found: AxisFit) -> dict[str, float]:
    """What the intervals of a fit should hold; what stands on the base's mass is held to that."""
    truth = drawn.truth
    ratio = 1.0 if drawn.kind == "force" else BASE_MASS / truth.mass
    if "current_at_rest" in found.conditional:
        hidden = truth.constant_force / truth.current_scale
        truth = dataclasses.replace(truth, current_at_rest=truth.current_at_rest - hidden)
    scaled = ("dry_friction", "constant_force", "viscous_friction", "current_scale")
    return {
        name: getattr(truth, name) * (ratio if name in scaled else 1.0) for name in intervals(found)
    }


def intervals(found: AxisFit) -> dict[str, Interval]:
    """All that a fit has taken from a log."""
    return found.fitted | {name: interval for name, (interval, _) in found.conditional.items()}


def covered(drawn: Drawn, found: AxisFit) -> dict[str, bool]:
    """Which intervals hold the truth."""
    true, told = truths(drawn, found), intervals(found)
    return {name: told[name].low <= true[name] <= told[name].high for name in told}


def unnamed(drawn: Drawn, found: AxisFit) -> list[str]:
    """What this log cannot tell, or the fit did not take from it, and is not named."""
    hidden = {"positions": {"mass", "viscous_friction"}, "current": {"mass"}, "force": set[str]()}
    silent = set(OF_THE_LOG) | (
        {"current_scale", "current_at_rest"} if "current" not in drawn.log.more else set()
    )
    every = {field.name for field in dataclasses.fields(AxisParameters)}
    needed = hidden[drawn.kind] | (every - silent - set(intervals(found)))
    return sorted(needed - set(found.undetermined))


@dataclasses.dataclass(frozen=True, slots=True)
class Outcome:
    """What became of one machine.

    Attributes:
        number: Of the machine.
        rate: Of its log [Hz].
        kind: What is logged beside positions.
        extras: What of ``_EXTRAS`` it has.
        intervals: By parameter: low, value and high, and what is true.
        missed: Parameters whose interval does not hold the truth.
        unnamed: What is neither told nor named.
    """

    number: int
    rate: int
    kind: str
    extras: list[str]
    intervals: dict[str, tuple[float, float, float, float]]
    missed: list[str]
    unnamed: list[str]

    def __str__(self) -> str:
        """One line of the table."""
        has, missed = " ".join(self.extras), " ".join(self.missed)
        silent = f"not named: {' '.join(self.unnamed)}" if self.unnamed else ""
        line = f"{self.number:4} {self.rate:5} Hz {self.kind:10} [{has}] {missed} {silent}"
        return line.rstrip()


def judge(numbered: tuple[int, Drawn]) -> Outcome:
    """Fit a drawn machine and hold the result to its truth."""
    number, drawn = numbered
    found = fit(drawn)
    true, told = truths(drawn, found), intervals(found)
    marks = covered(drawn, found)
    return Outcome(
        number, drawn.rate, drawn.kind, extras_of(drawn),
        {name: (one.low, one.value, one.high, true[name]) for name, one in told.items()},
        [name for name, hit in marks.items() if not hit], unnamed(drawn, found),
    )  # fmt: skip


def main(arguments: Sequence[str]) -> int:
    """Run the study and print its table."""
    parser = argparse.ArgumentParser(
        description="Do the intervals of twin calibrate cover the truth?"
    )
    parser.add_argument("machines", nargs="?", type=int, default=200)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--processes", type=int, default=1)
    parser.add_argument("--json", type=Path)
    asked = parser.parse_args(arguments)
    random = np.random.default_rng(asked.seed)
    drawn = [(number, draw(random)) for number in range(asked.machines)][asked.first :]
    outcomes = []
    with multiprocessing.Pool(asked.processes) as pool:
        for outcome in pool.imap_unordered(judge, drawn):
            outcomes.append(outcome)
            print(outcome, flush=True)
    if asked.json:
        kept = sorted(outcomes, key=lambda one: one.number)
        asked.json.write_text(json.dumps([dataclasses.asdict(one) for one in kept], indent=1))
    hits: dict[str, list[bool]] = collections.defaultdict(list)
    for outcome in outcomes:
        for name in outcome.intervals:
            hits[name].append(name not in outcome.missed)
    every = [hit for found in hits.values() for hit in found]
    lost = sum(bool(outcome.unnamed) for outcome in outcomes)
    for name, found in sorted(hits.items()):
        print(f"{name:24} {np.mean(found):6.1%} of {len(found)}")
    print(f"{'all':24} {np.mean(every):6.1%} of {len(every)}; not named: {lost} of {len(outcomes)}")
    return 0 if 0.90 <= np.mean(every) <= 0.99 and not lost else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
