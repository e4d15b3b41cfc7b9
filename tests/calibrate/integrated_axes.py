"""Axes whose truth is known, by an integrator of their own, logged as poor loggers do.

``python tests/calibrate/integrated_axes.py [AXES]`` fits 40 axes by default, eight of each group, and prints by
group how many 95 % intervals hold the truth. Nothing here comes from the package but what reads and fits: the
cascade of position and velocity loop, friction, gap and spring are stepped by a midpoint rule every 10 µs.
"""

import collections
import dataclasses
import math
import sys
from collections.abc import Mapping
from typing import Any, Literal

import numba
import numpy as np
import numpy.typing as npt

from twin.calibrate.calibrate import calibrate
from twin.calibrate.fit.solve import Interval
from twin.calibrate.result import Calibration
from twin.errors import UsageError
from twin.files.shipped import machine_file
from twin.logs.column_map import AxisColumns, ColumnTable, ExternalForceTable
from twin.logs.machine_log import AxisLog, MachineLog
from twin.machine.description.config import MachineConfig
from twin.machine.load import read_machine

Numbers = npt.NDArray[np.float64]
GROUPS = ("uneven", "held", "clipped", "injected", "two-mass")
STEP_S = 1e-5
SECONDS = 8.0
_ANY = ColumnTable(column="a", unit="mm")
_BASE_INERTIA_KG = 518.19
"""What motor and screw of the base's X weigh at the axis: what stiffness stands on."""


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Axis:
    """One axis in SI, and how it is logged."""

    group: str
    gain: float
    speed_gain: float
    mass: float
    before: float
    viscous: float
    dry: float
    steady: float
    spring: float = 0.0
    gap: float = 0.0
    limit: float = math.inf
    period: float = 0.001
    noise: float = 5e-7
    force_noise: float = 0.01
    hold: int = 1
    at: Literal["drive", "load"] = "load"
    pushed: bool = False
    seed: int = 0

    @property
    def truth(self) -> dict[str, float]:
        """In the names and units of a machine file."""
        found = {
            "kv": self.gain * 0.06,
            "damping_ratio": math.sqrt(self.speed_gain / self.gain) / 2.0,
            "mass": self.mass,
            "viscous_friction": self.viscous / 1e3,
            "dry_friction": self.dry,
            "constant_force": self.steady,
        }
        if self.spring:
            found |= {"stiffness": self.spring / 1e3, "backlash": self.gap * 1e3}
        return found


def draw(group: str, seed: int) -> Axis:
    """An axis of a group."""
    random = np.random.default_rng([GROUPS.index(group), seed])
    mass = float(random.uniform(700.0, 2000.0))
    gain = float(random.uniform(35.0, 120.0))
    more: dict[str, Any] = {}
    if group == "uneven":
        more["period"] = float(random.choice([0.001, 0.004, 0.01, 0.02]))
    elif group == "held":
        more["hold"] = int(random.choice([2, 4, 5]))
    elif group == "injected":
        more |= {"pushed": True, "at": str(random.choice(["drive", "load"]))}
    elif group == "two-mass":
        more |= {
            "spring": float(random.uniform(6e7, 2e8)),
            "gap": float(random.uniform(1e-5, 4e-5)),
        }
        mass = float(random.uniform(900.0, 1500.0))
    dry = float(random.uniform(0.1, 0.5)) * mass
    speed_gain = gain * float(random.uniform(1.5, 5.0))
    if group == "two-mass":
        # A velocity loop faster than its spring swings up, in a machine as here.
        speed_gain = min(speed_gain, 150.0)
        gain = min(gain, speed_gain / 2.0)
    return Axis(
        group=group, gain=gain, speed_gain=speed_gain, mass=mass, before=_BASE_INERTIA_KG,
        viscous=float(random.uniform(0.5, 4.0)) * mass, dry=dry,
        steady=float(random.uniform(-0.1, 0.1)) * mass, seed=seed,
        noise=float(random.uniform(1e-7, 1e-6)), **more,
    )  # fmt: skip


def command(random: np.random.Generator, seconds: float) -> Numbers:
    """Strokes there and back with a jerk that is smooth, at speeds slow and fast, (n,) [m]."""
    time = np.arange(0.0, seconds, STEP_S)
    place, begin = np.zeros(len(time)), 0.15
    while begin < seconds - 1.0:
        length = float(random.choice([0.002, 0.01, 0.03, 0.06]))
        lasts = float(random.uniform(0.25, 0.6)) * max(0.5, (length / 0.06) ** 0.5)
        for way in (length, -length):
            part = np.clip((time - begin) / lasts, 0.0, 1.0)
            place += way * part**4 * (35.0 - 84.0 * part + 70.0 * part**2 - 20.0 * part**3)
            begin += lasts + float(random.uniform(0.02, 0.1))
    return place


def integrated(axis: Axis) -> tuple[npt.NDArray[Any], Numbers]:
    """Time, command, motor, load, own force and push at every step, (n, 6), in SI; and the times."""
    random = np.random.default_rng([7, axis.seed, GROUPS.index(axis.group)])
    asked = command(random, SECONDS)
    count = len(asked)
    time = np.arange(count) * STEP_S
    push = np.zeros(count)
    if axis.pushed:
        for begin in np.arange(0.5, SECONDS - 0.5, 0.37):
            inside = (time >= begin) & (time < begin + 0.08)
            push[inside] += float(random.choice([-1.0, 1.0])) * 1.2 * axis.mass
    damping = axis.mass * axis.speed_gain
    loop, body = (damping * axis.gain, damping), (axis.mass, axis.viscous, axis.dry, axis.steady)
    if axis.spring:
        give = (axis.before, axis.spring, axis.gap / 2.0)
        done = _two_masses(asked, push, loop, body, give)
    else:
        done = _one_mass(asked, push, loop, body, axis.limit)
    return time, np.column_stack([asked, *done, push])


@numba.njit
def _one_mass(asked, push, loop, body, limit):
    """Motor, load and force of a rigid axis, by the midpoint rule; friction sticks and slides."""
    stiff, damping = loop
    mass, viscous, dry, steady = body
    places, forces = np.zeros(len(asked)), np.zeros(len(asked))
    place = speed = 0.0
    held = STEP_S * dry / mass
    for i in range(len(asked)):
        forces[i] = min(max(stiff * (asked[i] - place) - damping * speed, -limit), limit)
        places[i] = place
        goal = 0.5 * (asked[i] + asked[min(i + 1, len(asked) - 1)])
        middle = place + 0.5 * STEP_S * speed
        half = speed + 0.5 * STEP_S * (forces[i] + push[i] + steady - viscous * speed) / mass
        half -= min(max(half, -0.5 * held), 0.5 * held)
        inner = min(max(stiff * (goal - middle) - damping * half, -limit), limit)
        freed = speed + STEP_S * (inner + push[i] + steady - viscous * half) / mass
        after = freed - min(max(freed, -held), held)
        place += 0.5 * STEP_S * (speed + after)
        speed = after
    return places, places, forces


@numba.njit
def _two_masses(asked, push, loop, body, give):
    """The same of a motor before a gap and a spring, and a table behind them, by leapfrog steps."""
    stiff, damping = loop
    mass, viscous, dry, steady = body
    before, spring, half_gap = give
    behind = mass - before
    damper = 0.2 * math.sqrt(spring * before * behind / mass)
    rows = np.zeros((3, len(asked)))
    motor = motor_speed = table = table_speed = 0.0
    held = STEP_S * dry / behind
    for i in range(len(asked)):
        force = stiff * (asked[i] - motor) - damping * motor_speed
        rows[0, i], rows[1, i], rows[2, i] = motor, table, force
        bent = motor - table
        beyond = bent - max(-half_gap, min(half_gap, bent))
        through = spring * beyond
        if beyond != 0.0:
            through += damper * (motor_speed - table_speed)
        motor_speed += STEP_S * (force - through) / before
        freed = table_speed + STEP_S * (through + push[i] + steady - viscous * table_speed) / behind
        table_speed = freed - min(max(freed, -held), held)
        motor += STEP_S * motor_speed
        table += STEP_S * table_speed
    return rows[0], rows[1], rows[2]


def logged(axis: Axis) -> MachineLog:
    """What a log of an axis holds: rows at the logger's moments, in mm and N."""
    random = np.random.default_rng([11, axis.seed])
    time, columns = integrated(axis)
    steps = np.full(round(time[-1] / axis.period) - 2, axis.period)
    if axis.group == "uneven":
        steps *= 1.0 + random.uniform(-0.1, 0.1, len(steps))
    stamps = np.cumsum(steps)
    stamps = stamps[stamps < time[-1]]
    asked, motor, load, force, push = (np.interp(stamps, time, c) for c in columns.T)
    motor = motor + axis.noise * random.standard_normal(len(stamps))
    load = load + axis.noise * random.standard_normal(len(stamps))
    if axis.at == "drive":
        force = force + push
    force = force + axis.force_noise * float(np.std(force)) * random.standard_normal(len(stamps))
    if axis.group == "clipped":
        most = 0.6 * float(np.abs(force).max())
        force = np.clip(force, -most, most)
    if axis.hold > 1:
        kept = np.arange(len(stamps)) // axis.hold * axis.hold
        asked, motor, load, force, push = (c[kept] for c in (asked, motor, load, force, push))
    more = {"force": force}
    if axis.pushed:
        more["external_force"] = push
    if axis.spring:
        more["load"] = load * 1e3
    injected = ExternalForceTable(column="a", unit="N", at=axis.at) if axis.pushed else None
    table = AxisColumns(command=_ANY, actual=_ANY, external_force=injected)
    return MachineLog(
        f"{axis.group}-{axis.seed}.csv", stamps,
        {"X": AxisLog("linear", asked * 1e3, motor * 1e3, more, table)},
        np.zeros(len(stamps), np.int64),
    )  # fmt: skip


def base() -> MachineConfig:
    """``mill4`` without integral action on X."""
    return read_machine(machine_file("mill4")).changed("X", reset_time_s=0.0)


def fitted(axis: Axis) -> Calibration:
    """Calibrated as a user does it."""
    return calibrate(base(), [logged(axis)])


def intervals(result: Calibration) -> Mapping[str, Interval]:
    """All that is claimed: of conditional values those, whose conditions hold here."""
    fit = result.axes["X"].fit
    return fit.fitted | {name: interval for name, (interval, _) in fit.conditional.items()}


def misses(axis: Axis, result: Calibration) -> tuple[int, list[str]]:
    """How many intervals are claimed, and those that miss the truth."""
    found, wrong, count = intervals(result), list[str](), 0
    for name, true in axis.truth.items():
        if name in found:
            count += 1
            one = found[name]
            if not one.low <= true <= one.high:
                wrong.append(
                    f"{name} {one.value:.5g} [{one.low:.5g}, {one.high:.5g}] for {true:.5g}"
                )
    return count, wrong


def main() -> int:
    """Print the table; 1 where a group is outside 90 to 99 %, given its size, or a defect is unnamed."""
    each = int(sys.argv[1]) // len(GROUPS) if sys.argv[1:] else 8
    named = {"held": "repeated", "clipped": "clipped", "uneven": "uneven"}
    held: dict[str, list[int]] = collections.defaultdict(lambda: [0, 0])
    unnamed = 0
    for group in GROUPS:
        for seed in range(each):
            axis = draw(group, seed)
            try:
                result = fitted(axis)
            except UsageError as refused:
                print(f"{group} {seed}: refused: {refused}", flush=True)
                unnamed += 1
                continue
            count, wrong = misses(axis, result)
            held[group][0] += count - len(wrong)
            held[group][1] += count
            codes = {one.code for told in result.findings.values() for one in told}
            unnamed += group in named and named[group] not in codes
            share = result.logs[0].share
            print(
                f"{group} {seed}: {count} claimed, left {100 * share:.2g} %; {'; '.join(wrong)}",
                flush=True,
            )
    for group, (inside, count) in held.items():
        print(
            f"{group:10} {inside} of {count} intervals hold the truth ({100 * inside / max(1, count):.0f} %)"
        )
    return int(unnamed > 0 or any(inside < 0.9 * count for inside, count in held.values()))


if __name__ == "__main__":
    sys.exit(main())
