"""What a log of a few samples a second still tells: the lag as a whole, and friction by a current."""

import dataclasses
from collections.abc import Sequence

import numpy as np

from twin.calibrate.fit.parameters import AxisParameters, coordinates
from twin.calibrate.fit.ramps import Ramp, predict_ramp
from twin.calibrate.fit.solve import BATCHES, Interval, Problem, Solution, solve
from twin.calibrate.fit.stages import AxisFit
from twin.logs.machine_log import AxisLog
from twin.nc.canonical import BoolArray, FloatArray, IntArray
from twin.units import AxisKind, kv_per_second, to_si

_FEW = 3
"""Ramps that are needed."""
_SHARES = (0.0, 0.5, 1.0)
_OUTLIER = 2.0
"""A residual beyond so many typical ones counts by its square root: a course was mistaken."""
_STILL = 0.02
"""An axis slower than this share of its greatest speed counts as standing."""
_REACHES = 0.3
"""Share of the rapid velocity that a log must reach to show friction that grows with speed."""
_TOO_SLOW = "the log is too slow to show how the position loop settles"
_UNDETERMINED = {
    "kv": _TOO_SLOW,
    "damping_ratio": _TOO_SLOW,
    "mass": "the log is too slow for accelerations",
}


@dataclasses.dataclass(frozen=True, slots=True)
class SlowLog:
    """One axis of a slow log.

    Attributes:
        rows: First and last row, exclusive, of each stretch.
        ramps: Its samples that fell into ramps.
        speed: Commanded, of every row, 0 where it is not logged [mm/s or deg/s].
        known: Rows whose speed is known.
    """

    axis: AxisLog
    rows: tuple[tuple[int, int], ...]
    ramps: list[Ramp]
    speed: FloatArray
    known: BoolArray


def commanded_speed(
    axis: AxisLog, time: FloatArray, whole: BoolArray
) -> tuple[FloatArray, BoolArray]:
    """Commanded velocity of every row, 0 where it is not determined, and where it is; shape (n,) each.

    Args:
        time: Of its rows [s].
        whole: Whether positions go on from each row to the next, shape (n - 1,).
    """
    if "command_velocity" in axis.more:
        return axis.more["command_velocity"], np.ones(len(time), np.bool_)
    known = np.append(True, whole) & np.append(whole, True)
    with np.errstate(divide="ignore", invalid="ignore"):
        speed = np.gradient(axis.command, time)
    return np.where(known, speed, 0.0), known


def fit_slow(
    kind: AxisKind, logs: Sequence[SlowLog], base: AxisParameters, fastest: float
) -> AxisFit:
    """Fit what slow logs say about an axis; everything else stays at the base's value.

    Args:
        base: What is not determined stays at.
        fastest: Rapid velocity of the base's axis [mm/s or deg/s].
    """
    ramps = [ramp for log in logs for ramp in log.ramps]
    if len(ramps) >= _FEW:
        best = _fit_ramps(kind, ramps, base)
        reasons = dict(_UNDETERMINED)
    else:
        best = _fit_trail(kind, logs, base)
        reasons = _UNDETERMINED | {
            "velocity_feedforward": "the log does not tell a drive's lag from a delay of its columns"
        }
    fitted = dict(best.intervals)
    feed = fitted.pop("velocity_feedforward", None)
    unit = "mm" if kind == "linear" else "deg"
    conditional: dict[str, tuple[Interval, tuple[str, ...]]] = {}
    parameters = best.parameters
    of_ramps = {} if feed is None else {"velocity_feedforward": (feed, ("kv",))}
    if feed is not None:
        reasons["velocity_feedforward"] = (
            f"only the lag that it leaves is determined; {feed.value:.3g} holds for the base's kv "
            f"{parameters.kv:.4g}"
        )
    if all("current" in log.axis.more for log in logs):
        reached = max(float(np.abs(log.speed).max(initial=0.0)) for log in logs)
        reaches = reached >= _REACHES * fastest
        parameters, conditional = _fit_friction(kind, logs, parameters, viscous=reaches)
        reasons |= {
            name: f"only its ratio to the force per ampere is determined; {interval.value:.4g} holds for "
            f"current_scale {parameters.current_scale:.4g}"
            for name, (interval, _) in conditional.items()
        }
        if not reaches:
            reasons["viscous_friction"] = (
                f"the log reaches {reached:.3g} of {fastest:.3g} {unit}/s, and a friction that grows "
                "with speed would be extrapolated"
            )
        reasons["current_scale"] = (
            "too few samples within ramps tell force per ampere from friction"
        )
    else:
        reasons |= dict.fromkeys(
            ("dry_friction", "viscous_friction", "constant_force"),
            "positions of a slow log do not tell it",
        )
    return AxisFit(
        parameters, fitted, of_ramps | conditional, reasons, best.free, best.correlations
    )


def _fit_ramps(kind: AxisKind, ramps: list[Ramp], base: AxisParameters) -> Solution:
    """Delay of the columns and share of feed-forward, from lags of velocity within ramps."""
    typical = max(float(np.median([abs(ramp.lag) for ramp in ramps])) * 0.1, 1e-6)

    def residuals(parameters: AxisParameters) -> FloatArray:
        left = np.array([predict_ramp(parameters, ramp).lag - ramp.lag for ramp in ramps]) / typical
        size = np.abs(left) / _OUTLIER
        return left * np.where(
            size > 1.0, np.sqrt(np.maximum(size, 1.0)) / np.maximum(size, 1.0), 1.0
        )

    batch = (np.arange(len(ramps)) * min(BATCHES, len(ramps)) // len(ramps)).astype(np.int64)
    problem = Problem(residuals, batch, coordinates(kind, 1.0))
    trail = (1.0 - np.array(_SHARES)) / kv_per_second(base.kv)
    starts = [
        dataclasses.replace(base, velocity_feedforward=share, delay=0.008 - float(part))
        for share, part in zip(_SHARES, trail, strict=True)
    ]
    tried = [solve(problem, start, ["delay", "velocity_feedforward"]) for start in starts]
    return min(tried, key=lambda solution: solution.cost)


def _fit_trail(kind: AxisKind, logs: Sequence[SlowLog], base: AxisParameters) -> Solution:
    """Delay of the columns, from the lag of position over the speed."""
    lags, speeds = [], []
    for log in logs:
        for begin, end in log.rows:
            part = np.arange(begin, end)[log.known[begin:end]]
            lags.append((log.axis.command - log.axis.actual)[part])
            speeds.append(log.speed[part])
    lag, speed = np.concatenate(lags), np.concatenate(speeds)
    typical = max(float(np.std(lag)), 1e-9)
    loop = (1.0 - base.velocity_feedforward) / kv_per_second(base.kv)

    def residuals(parameters: AxisParameters) -> FloatArray:
        return (lag - speed * (loop + parameters.delay)) / typical

    batch: IntArray = (np.arange(len(lag)) * BATCHES // len(lag)).astype(np.int64)
    return solve(Problem(residuals, batch, coordinates(kind, 1.0)), base, ["delay"])


def kinematics(log: SlowLog, parameters: AxisParameters) -> tuple[FloatArray, FloatArray]:
    """Speed and acceleration of every row, as the model has them; shape (n,) each."""
    speed = log.speed.copy()
    change = np.zeros(len(speed))
    for ramp in log.ramps:
        seen = predict_ramp(parameters, ramp)
        speed[ramp.row], change[ramp.row] = seen.velocity, seen.acceleration
    return speed, change


def slow_force(
    log: SlowLog, parameters: AxisParameters, kind: AxisKind
) -> tuple[FloatArray, BoolArray]:
    """Force of the drive in every row [N or N m], and which rows move; shape (n,) each."""
    speed, change = kinematics(log, parameters)
    moves = np.abs(speed) > _STILL * np.abs(speed).max(initial=1e-9)
    force = (
        parameters.mass * to_si(kind) * change
        + parameters.viscous_friction * speed
        + parameters.dry_friction * np.sign(speed) * moves
        - parameters.constant_force
    )
    return force, moves


def _fit_friction(
    kind: AxisKind, logs: Sequence[SlowLog], at: AxisParameters, *, viscous: bool
) -> tuple[AxisParameters, dict[str, tuple[Interval, tuple[str, ...]]]]:
    """Friction from the current of rows that move, for the force per ampere that ramps suggest."""
    rows = [_friction_rows(log, at) for log in logs]
    columns = np.vstack([part[0] for part in rows])
    shown = np.concatenate([part[1] for part in rows])
    inertia = at.mass * to_si(kind)
    if viscous:
        found, *_ = np.linalg.lstsq(columns, shown, rcond=None)
    else:
        # What is known of viscous friction takes its share of the force, as the mass does.
        moved = columns[:, 0] + at.viscous_friction / inertia * columns[:, 1]
        less, *_ = np.linalg.lstsq(np.column_stack([moved, columns[:, 2:]]), shown, rcond=None)
        found = np.array([less[0], less[0] * at.viscous_friction / inertia, less[1], less[2]])
    scale = inertia / found[0] if found[0] > 0 else at.current_scale
    rest = shown - columns @ found
    typical = max(float(np.std(rest)), 1e-9)

    def residuals(parameters: AxisParameters) -> FloatArray:
        weights = np.array([
            inertia / parameters.current_scale,
            parameters.viscous_friction / parameters.current_scale,
            parameters.dry_friction / parameters.current_scale,
            parameters.current_at_rest,
        ])  # fmt: skip
        return (columns @ weights - shown) / typical

    start = dataclasses.replace(
        at, current_scale=float(scale), dry_friction=max(0.0, float(found[2] * scale)),
        viscous_friction=max(0.0, float(found[1] * scale)), current_at_rest=float(found[3]),
    )  # fmt: skip
    batch = (np.arange(len(shown)) * BATCHES // len(shown)).astype(np.int64)
    by_name = coordinates(kind, max(start.dry_friction, 1.0))
    free = ["dry_friction", "current_at_rest", *["viscous_friction"] * viscous]
    solution = solve(Problem(residuals, batch, by_name), start, free)
    stands_on = ("current_scale",)
    return solution.parameters, {
        name: (interval, stands_on) for name, interval in solution.intervals.items()
    }


def _friction_rows(log: SlowLog, at: AxisParameters) -> tuple[FloatArray, FloatArray]:
    """Columns of acceleration, speed, its sign and one, of rows that move; and their current."""
    speed, change = kinematics(log, at)
    moves = np.abs(speed) > _STILL * np.abs(speed).max(initial=1e-9)
    columns = np.column_stack([change, speed, np.sign(speed), np.ones(len(speed))])
    return columns[moves], log.axis.more["current"][moves]
