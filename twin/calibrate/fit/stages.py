"""The stages of a fit: the linear loop, friction and mass, what else the log asks for."""

import dataclasses
from collections.abc import Sequence

import numpy as np

from twin.calibrate.fit.parameters import AxisParameters, coordinates
from twin.calibrate.fit.promising import EXTRAS, INTEGRATOR, Core, started
from twin.calibrate.fit.simulation import drawn_otherwise
from twin.calibrate.fit.solve import (
    BATCHES,
    ROUGH,
    Interval,
    Problem,
    Solution,
    intervals_beside,
    movers,
    on_one_thread,
    solve,
)
from twin.calibrate.fit.stretch import Stretch, predict
from twin.calibrate.fit.structure import StructureChoice, Tried, choose_structure, leaves_less
from twin.nc.canonical import FloatArray, IntArray
from twin.units import AxisKind, kv_per_second, to_si

_ENOUGH = 1e-4
"""A fit that leaves less than this share of the following error is as good as the simulation."""
OF_THE_LOG = ("delay", "force_delay", "measuring_filter")
"""Parameters of a log's columns; the machine has none."""
_FILTER_S = 0.003
"""Where the search for a filter of the log begins [s]."""
_NOTHING = np.zeros(0)
_WRONG = 1e6
"""Weighted residual of what is not finite."""
NOT_ASKED = "the log does not ask for another value"
"""Why something that the log could show stays as it is in the base."""
_DAMPINGS = (0.5, 1.2)
_WIDE = 0.5
"""A parameter whose interval reaches further than this share to a side is not determined."""
_VISCOUS_SHARE = 0.05
"""Viscous friction is taken to be at most this share of the velocity loop's gain: where positions
alone are logged, the loop gain may be so much higher than fitted, and its damping so much lower."""


@dataclasses.dataclass(frozen=True, slots=True)
class AxisFit:
    """The fit of one axis.

    Attributes:
        parameters: Those of the machine file and of the log.
        fitted: What the log determines, by name.
        conditional: What it determines only as long as a base's value is true: name to interval and
            the names that it depends on.
        undetermined: What it does not determine, and why.
        names: In the order of ``correlations``.
        correlations: Of what was fitted, shape (p, p).
        tried: Structures that were looked at, the chosen one first; none where nothing more was asked for.
    """

    parameters: AxisParameters
    fitted: dict[str, Interval]
    conditional: dict[str, tuple[Interval, tuple[str, ...]]]
    undetermined: dict[str, str]
    names: tuple[str, ...]
    correlations: FloatArray
    tried: tuple[Tried, ...] = ()


@on_one_thread
def fit_axis(
    kind: AxisKind, stretches: Sequence[Stretch], base: AxisParameters, *, filtered: bool = False
) -> AxisFit:
    """Fit one axis.

    Args:
        stretches: All that is fitted.
        base: What is not determined stays at.
        filtered: Whether the actual positions are known to be behind a filter of the log.
    """
    start = _first_guess(kind, stretches, base)
    names = _core(stretches)
    if filtered:
        start = dataclasses.replace(start, measuring_filter=_FILTER_S)
        names.append("measuring_filter")
    problem = _weighted(kind, stretches, start)
    forced = _has(stretches, "force")
    cores = _core_fits(problem, start, names, forced=forced)
    problem = _weighted(kind, stretches, cores[0][0].parameters)
    again = [(solve(problem, one.parameters, one.free), core) for one, core in cores]
    choice = StructureChoice(again[0][0])
    if _share_left(stretches, choice.best.parameters) > _ENOUGH:
        choice = choose_structure(problem, again)
        best = solve(problem, choice.best.parameters, choice.best.free)
        choice = dataclasses.replace(choice, best=best)
    best, undetermined = _without_undetermined(problem, choice.best, base)
    fitted = _allowing_for_others(problem, dataclasses.replace(choice, best=best))
    if best.parameters.reset_time_s != base.reset_time_s and "reset_time_s" not in fitted:
        other = solve(problem, best.parameters, [*best.free, "reset_time_s"])
        fitted["reset_time_s"] = dataclasses.replace(
            other.intervals["reset_time_s"], value=best.parameters.reset_time_s
        )
    undetermined |= {
        name: NOT_ASKED for name in EXTRAS
        if name not in fitted and name not in undetermined and name not in OF_THE_LOG
    }  # fmt: skip
    if any(stretch.command.is_drawn for stretch in stretches):
        fitted = _allowing_for_drawing(kind, stretches, best, fitted)
    fit = _explained(stretches, best, fitted, undetermined)
    return dataclasses.replace(fit, tried=choice.tried)


def _core_fits(
    problem: Problem, start: AxisParameters, names: Sequence[str], *, forced: bool
) -> list[tuple[Solution, Core]]:
    """Optima of gain, damping, friction and mass, with and without an integrator.

    First comes what the log asks for; where it does not tell, the drive integrates or not as the
    base does.
    """
    unset = dataclasses.replace(start, reset_time_s=0.0)
    plain, base = Core(tuple(names), unset, forced), Core(tuple(names), start, forced)

    def best(parameters: AxisParameters, free: Sequence[str]) -> Solution:
        starts = (dataclasses.replace(parameters, damping_ratio=z) for z in _DAMPINGS)
        return min(
            (solve(problem, one, free, until=ROUGH) for one in starts),
            key=lambda found: found.cost,
        )

    rigid = best(unset, names)
    integrates = best(started(start, INTEGRATOR), plain.free([INTEGRATOR]))
    both = [(rigid, plain), (integrates, plain)]
    if not start.reset_time_s:
        return both[::-1] if leaves_less(integrates, rigid) else both
    held = dataclasses.replace(integrates.parameters, reset_time_s=start.reset_time_s)
    kept = solve(problem, held, base.free([]))
    if leaves_less(integrates, kept) and leaves_less(integrates, rigid):
        return both[::-1]
    return both if rigid.cost < kept.cost else [(kept, base), *both]


def _allowing_for_others(problem: Problem, choice: StructureChoice) -> dict[str, Interval]:
    """Intervals that hold what rivals have, and what comes of parameters that were not taken in."""
    best, freed = choice.best, dict(choice.larger)
    others = [name for name in EXTRAS if name not in best.free and name not in freed]
    freed |= {
        name: solve(problem, best.parameters, [*best.free, name], until=ROUGH)
        for name in dict.fromkeys([*movers(problem, best, others), *({"delay"} & set(others))])
    }
    fitted = dict(best.intervals)
    alternatives = [(rival.parameters, rival.intervals) for rival in choice.rivals]
    alternatives += [
        (other.parameters, intervals_beside(problem, other, name)) for name, other in freed.items()
    ]
    for parameters, intervals in alternatives:
        for name, interval in fitted.items():
            value = getattr(parameters, name)
            held = intervals.get(name, Interval(value, value, value))
            fitted[name] = interval.spanning(held)
    if "delay" not in fitted:
        late = [freed["delay"], *choice.rivals]
        delays = [one.intervals["delay"] for one in late if "delay" in one.intervals]
        fitted["delay"] = Interval(0.0, 0.0, 0.0).spanning(*delays)
    return fitted


def _allowing_for_drawing(
    kind: AxisKind, stretches: Sequence[Stretch], best: Solution, fitted: dict[str, Interval]
) -> dict[str, Interval]:
    """Widen intervals by what it does to draw the command between its samples by another rule."""
    others = [
        dataclasses.replace(
            stretch, command=drawn_otherwise(stretch.command, stretch.asked, stretch.knots)
        )
        for stretch in stretches
    ]
    other = solve(_weighted(kind, others, best.parameters), best.parameters, best.free)
    return {
        name: interval.widened(abs(getattr(other.parameters, name) - interval.value))
        if name in other.free
        else interval
        for name, interval in fitted.items()
    }


def _share_left(stretches: Sequence[Stretch], parameters: AxisParameters) -> float:
    """What the model leaves of the following error, as a share."""
    left = np.concatenate([columns[0] for columns in _columns_left(stretches, parameters)])
    lag = np.concatenate([stretch.lag for stretch in stretches])
    return float(np.sqrt(np.mean(left**2) / max(float(np.mean(lag**2)), 1e-30)))


def _core(stretches: Sequence[Stretch]) -> list[str]:
    names = ["kv", "damping_ratio", "dry_friction", "constant_force"]
    if _has(stretches, "force"):
        return [*names, "mass", "viscous_friction"]
    if _has(stretches, "current"):
        return [*names, "viscous_friction", "current_scale", "current_at_rest"]
    return names


def _has(stretches: Sequence[Stretch], role: str) -> bool:
    return all(getattr(stretch, role) is not None for stretch in stretches)


def _first_guess(
    kind: AxisKind, stretches: Sequence[Stretch], base: AxisParameters
) -> AxisParameters:
    """Loop gain from the lag over speed, mass or scale from force over acceleration."""
    speed, change = np.vstack([_kinematics(stretch)[stretch.seen] for stretch in stretches]).T
    lag = np.concatenate([stretch.lag for stretch in stretches])
    slope = float(speed @ lag / max(speed @ speed, 1e-12))
    trail = (1.0 - base.velocity_feedforward) / kv_per_second(base.kv)
    kv = base.kv * trail / slope if slope > 0.05 * trail and trail else base.kv
    guess = dataclasses.replace(base, kv=kv)
    speed, change = np.vstack([_kinematics(stretch)[stretch.measured] for stretch in stretches]).T
    columns = np.column_stack([change, speed, np.sign(speed), np.ones(len(speed))])
    logged = [stretch.logged_force for stretch in stretches]
    shown = np.concatenate([column for column in logged if column is not None] or [_NOTHING])
    if _has(stretches, "force"):
        found, *_ = np.linalg.lstsq(columns, shown, rcond=None)
        mass = max(float(found[0]) / to_si(kind), 1e-3 * base.mass)
        guess = dataclasses.replace(guess, mass=mass)
    elif _has(stretches, "current"):
        found, *_ = np.linalg.lstsq(columns, shown, rcond=None)
        scale = base.mass * to_si(kind) / max(float(found[0]), 1e-9 * base.mass)
        guess = dataclasses.replace(guess, current_scale=scale, current_at_rest=float(found[3]))
    small = 2e-3 * _force_scale(kind, stretches, guess)
    return dataclasses.replace(guess, dry_friction=max(guess.dry_friction, small))


def _kinematics(stretch: Stretch) -> FloatArray:
    """Commanded speed and acceleration at all samples, (n, 2)."""
    return stretch.command.kinematics


def _force_scale(kind: AxisKind, stretches: Sequence[Stretch], of: AxisParameters) -> float:
    change = np.concatenate([_kinematics(stretch)[:, 1] for stretch in stretches])
    return max(of.mass * to_si(kind) * float(np.sqrt(np.mean(change**2))), 1e-9)


def _weighted(kind: AxisKind, stretches: Sequence[Stretch], at: AxisParameters) -> Problem:
    """The problem, every column weighted by what is left of it at some parameters."""
    left = [np.concatenate(column) for column in zip(*_columns_left(stretches, at), strict=True)]
    weights = [1.0 / max(float(np.sqrt(np.mean(column**2))), 1e-9) for column in left]

    def residuals(parameters: AxisParameters) -> FloatArray:
        # A loop that swings up by itself has no finite end, and is as wrong as can be.
        with np.errstate(over="ignore", invalid="ignore"):
            parts = _columns_left(stretches, parameters)
            whole = [
                weight * column
                for columns in parts
                for weight, column in zip(weights, columns, strict=True)
            ]
            return np.clip(np.nan_to_num(np.concatenate(whole), nan=_WRONG), -_WRONG, _WRONG)

    return Problem(
        residuals, _batches(stretches, forced=len(weights) > 1),
        coordinates(kind, _force_scale(kind, stretches, at)),
    )  # fmt: skip


def _columns_left(
    stretches: Sequence[Stretch], parameters: AxisParameters
) -> list[list[FloatArray]]:
    """What the model leaves, by stretch and by logged column."""
    forced, shown = _has(stretches, "force"), _has(stretches, "current")
    parts = []
    for stretch in stretches:
        predicted = predict(parameters, stretch)
        columns = [(predicted.actual - stretch.actual)[stretch.seen]]
        if forced and stretch.force is not None:
            columns.append((predicted.force - stretch.force)[stretch.measured])
        elif shown and stretch.current is not None:
            columns.append((predicted.current - stretch.current)[stretch.measured])
        parts.append(columns)
    return parts


def _batches(stretches: Sequence[Stretch], *, forced: bool) -> IntArray:
    """Which of the stretches of time each residual belongs to."""
    total = sum(np.count_nonzero(stretch.seen) for stretch in stretches)
    before, parts = 0, []
    for stretch in stretches:
        number = (before + np.cumsum(stretch.seen) - stretch.seen) * BATCHES // total
        number = np.minimum(number, BATCHES - 1)
        parts += [number[rows] for rows in (stretch.seen, *[stretch.measured] * forced)]
        before += np.count_nonzero(stretch.seen)
    return np.concatenate(parts).astype(np.int64)


def _without_undetermined(
    problem: Problem, best: Solution, base: AxisParameters
) -> tuple[Solution, dict[str, str]]:
    """Leave undetermined parameters at the base's value, the worst first."""
    reasons: dict[str, str] = {}
    while True:
        widths = {
            name: _width(problem, name, interval) for name, interval in best.intervals.items()
        }
        worst = max(widths, key=lambda name: widths[name], default="")
        if not worst or widths[worst] <= _WIDE or len(best.free) == 1:
            return best, reasons
        interval = best.intervals[worst]
        reasons[worst] = _why(best, worst, interval, problem.coordinates[worst].unit)
        kept = [name for name in best.free if name != worst]
        stays = dataclasses.replace(best.parameters, **{worst: getattr(base, worst)})
        best = solve(problem, stays, kept)


def _width(problem: Problem, name: str, interval: Interval) -> float:
    """How far an interval reaches, as a share of what would matter."""
    coordinate = problem.coordinates[name]
    reach = max(interval.high - interval.value, interval.value - interval.low)
    if name in ("delay", "force_delay", "measuring_filter"):
        return reach / max(abs(interval.value), 2e-3)
    if name in ("velocity_feedforward", "acceleration_feedforward"):
        return reach
    if name == "current_at_rest":
        return 0.0
    if coordinate.logarithmic:
        return reach / interval.value
    return reach / max(abs(interval.value), 1e2 * coordinate.step)


def _why(best: Solution, name: str, interval: Interval, unit: str) -> str:
    index = best.free.index(name)
    others = np.abs(best.correlations[index]).copy()
    others[index] = 0.0
    twin = int(np.argmax(others))
    span = f"anything from {interval.low:.3g} to {interval.high:.3g} {unit}".rstrip()
    if others[twin] > 0.95:
        return (
            f"the log does not tell it from {best.free[twin]} (correlation {others[twin]:.3f}): "
            f"{span} would fit as well"
        )
    return f"the log hardly depends on it: {span} would fit as well"


def _explained(
    stretches: Sequence[Stretch], best: Solution, fitted: dict[str, Interval],
    undetermined: dict[str, str],
) -> AxisFit:  # fmt: skip
    """Say what each value stands on."""
    reasons = dict(undetermined)
    conditional: dict[str, tuple[Interval, tuple[str, ...]]] = {}
    mass = best.parameters.mass
    if "constant_force" not in best.free:
        reasons.setdefault("constant_force", "an integrating drive takes up whatever is constant")
    if not _has(stretches, "force"):
        known = _has(stretches, "current")
        if "constant_force" not in best.free and "current_at_rest" in fitted:
            at_rest = fitted.pop("current_at_rest")
            conditional["current_at_rest"] = (at_rest, ("constant_force",))
            reasons["current_at_rest"] = "the log does not tell it from a constant force"
        reasons["mass"] = (
            "a current of unknown scale does not tell it" if known
            else "positions alone do not tell it"
        )  # fmt: skip
        for name in ("dry_friction", "constant_force", "viscous_friction", "current_scale"):
            if name in fitted:
                conditional[name] = (fitted.pop(name), ("mass",))
                reasons[name] = (
                    f"only its ratio to the mass is determined; {conditional[name][0].value:.4g} holds "
                    f"for the base's {mass:.5g}"
                )
        if not known and "viscous_friction" not in best.free:
            reasons["viscous_friction"] = (
                "positions alone do not tell it from kv (correlation 1.000); kv holds from the base's "
                f"viscous friction to {100 * _VISCOUS_SHARE:g} % of the velocity loop's gain"
            )
            gain = fitted.get("kv")
            if gain is not None:
                high = gain.high * (1.0 + _VISCOUS_SHARE)
                fitted["kv"] = Interval(gain.value, gain.low, high)
            damping = fitted.get("damping_ratio")
            if damping is not None:
                low = damping.low / (1.0 + _VISCOUS_SHARE)
                fitted["damping_ratio"] = Interval(damping.value, low, damping.high)
    return AxisFit(best.parameters, fitted, conditional, reasons, best.free, best.correlations)
