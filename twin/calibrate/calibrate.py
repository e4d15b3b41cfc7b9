"""Logs in, a calibration out: the stages in their order, axis by axis."""

import dataclasses
from collections.abc import Sequence

import numpy as np

from twin.calibrate.fit.ball_bar import STIFFNESS, BallBarFit, fit_ball_bar
from twin.calibrate.fit.give import NO_SECOND_ENCODER, fit_give
from twin.calibrate.fit.parameters import Parameters, coordinates, of_base
from twin.calibrate.fit.ramps import axes_with_ramps, find_cycle, find_ramps, predict_ramp
from twin.calibrate.fit.slow import SlowLog, fit_slow, slow_force
from twin.calibrate.fit.solve import Interval, on_one_thread
from twin.calibrate.fit.stages import OF_THE_LOG, AxisFit, fit_axis
from twin.calibrate.fit.stretch import Stretch, predict, stretches_of
from twin.calibrate.health import (
    SLOW_S,
    Finding,
    Health,
    is_filtered,
    look_at_axis,
    look_at_clock,
    look_at_fit,
    look_at_motion,
    refuse_broken_clock,
)
from twin.calibrate.limits import Limits, planner_limits
from twin.calibrate.refusal import refuse_wrong_force, refuse_wrong_log
from twin.calibrate.result import FIT, HOLD_OUT, AxisResult, Calibration, Course, LogFigures
from twin.errors import UsageError
from twin.logs.ball_bar import BallBarLog
from twin.logs.machine_log import AxisLog, MachineLog
from twin.machine.description.config import AxisTable, Machine
from twin.machine.model.drives import reflected_inertia
from twin.machine.model.model import build_spec, compiled, drives
from twin.nc.canonical import FloatArray
from twin.units import AxisKind

_FASTEST_S = 1e-3
"""A log with shorter periods is averaged to this one [s]."""
_SEEN_MOVING = 0.02
"""Share of the greatest speed from which an axis counts as moving."""
_NOTHING = np.zeros(0)
_NO_LOG = "no log of the axis's positions was given"


@dataclasses.dataclass(frozen=True, slots=True)
class _Log:
    log: MachineLog
    role: str
    health: Health
    cycle_s: float


@on_one_thread
def calibrate(
    machine: Machine,
    logs: Sequence[MachineLog],
    hold_out: Sequence[MachineLog] = (),
    axes: Sequence[str] = (),
    ball_bars: Sequence[BallBarLog] = (),
) -> Calibration:
    """Fit a machine's drives to logs.

    Args:
        machine: The base: what logs do not determine stays as it has it.
        logs: What is fitted.
        hold_out: What the fit is judged by.
        axes: Which to fit; all that the logs have by default.
        ball_bars: Circles that tell what an axis loses where it turns round.

    Raises:
        UsageError: A log is not what it is said to be, or has nothing to fit.
    """
    fitted = [_prepared(log, FIT) for log in logs]
    held = [_prepared(log, HOLD_OUT) for log in hold_out]
    circles = tuple(fit_ball_bar(log) for log in ball_bars)
    names = _axes(machine, fitted, axes, circles)
    masses = _masses(machine)
    findings = {
        item.log.name: item.health.findings + _axis_findings(machine, item, names)
        for item in fitted + held
    }
    results: dict[str, AxisResult] = {}
    figures: list[LogFigures] = []
    for name in names:
        kind = machine.axis(name).kind
        base = of_base(machine.axis(name), masses[name])
        own = [item for item in fitted if name in item.log.axes]
        fit = _fit(kind, name, own, base, machine.axis(name).velocity)
        fit = _with_give(machine, name, fit, own, masses[name])
        fit = _as_built(machine.axis(name), _with_ball_bars(machine.axis(name), name, fit, circles))
        results[name] = AxisResult(
            kind, fit, _units(kind), _limits(name, own, machine.axis(name)), machine.axis(name),
            masses[name], machine.file.servo_period_s,
        )  # fmt: skip
        for item in (item for item in own if item.health.period_s <= SLOW_S):
            told = look_at_fit(name, fit.fitted, masses[name], filtered=_is_filtered(item, name))
            findings[item.log.name] += tuple(told)
        figures += [
            _figures(item, name, fit.parameters) for item in fitted + held if name in item.log.axes
        ]
    order = {item.log.name: number for number, item in enumerate(fitted + held)}
    figures.sort(key=lambda one: (one.role != FIT, order[one.log]))
    return Calibration(machine.file.name, results, tuple(figures), findings, circles)


def _prepared(log: MachineLog, role: str) -> _Log:
    health = look_at_clock(log)
    refuse_broken_clock(log, health)
    times = round(_FASTEST_S / health.period_s)
    if times > 1:
        log = _averaged(log, health, times)
        health = look_at_clock(log)
    slow = health.period_s > SLOW_S
    cycle = find_cycle(log, health.stretches) if slow and axes_with_ramps(log) else 0.0
    return _Log(log, role, health, cycle)


def _averaged(log: MachineLog, health: Health, times: int) -> MachineLog:
    """A log with fewer samples, each the mean of some: what is linear stays as it is."""

    def mean(values: FloatArray) -> FloatArray:
        parts = [values[a : a + (b - a) // times * times] for a, b in health.stretches]
        return np.concatenate([part.reshape(-1, times).mean(axis=1) for part in parts])

    axes = {
        name: dataclasses.replace(
            axis, command=mean(axis.command), actual=mean(axis.actual),
            more={role: mean(values) for role, values in axis.more.items()},
        )
        for name, axis in log.axes.items()
    }  # fmt: skip
    time = mean(log.time)
    return MachineLog(log.name, time, axes, np.zeros(len(time), np.int64))


def _axes(
    machine: Machine, logs: Sequence[_Log], wanted: Sequence[str], circles: Sequence[BallBarFit]
) -> list[str]:
    logged = {name for item in logs for name in item.log.axes}
    logged |= {name for circle in circles for name in circle.plane}
    unknown = sorted((set(wanted) | logged) - set(machine.axes.names))
    if unknown:
        raise UsageError(
            f"{machine.file.name} has no axis {unknown[0]}: it has {', '.join(machine.axes.names)}"
        )
    absent = [name for name in wanted if name not in logged]
    if absent:
        raise UsageError(f"no log has axis {absent[0]}: they have {', '.join(sorted(logged))}")
    return [name for name in machine.axes.names if name in (wanted or logged)]


def _masses(machine: Machine) -> dict[str, float]:
    found = drives(machine, compiled(build_spec(machine), machine))
    return {name: drive.moved for name, drive in zip(machine.axes.names, found, strict=True)}


def _axis_findings(machine: Machine, item: _Log, names: Sequence[str]) -> tuple[Finding, ...]:
    """Refuse what cannot be, tell what is poor."""
    found: list[Finding] = []
    for name in names:
        if name not in item.log.axes:
            continue
        axis, place = item.log.axes[name], f"{item.log.name}: axis {name}"
        pieces = [_rows(axis, begin, end) for begin, end in item.health.stretches]
        piece = max(pieces, key=lambda one: float(np.ptp(one.command)))
        period = item.health.period_s
        refuse_wrong_log(item.log.name, name, piece, machine.axis(name), period)
        if period <= SLOW_S:
            if "force" in axis.more:
                speed = np.gradient(piece.actual, period)
                smooth = np.convolve(np.gradient(speed, period), np.ones(9) / 9, "same")
                refuse_wrong_force(place, piece.more["force"], smooth)
            found += look_at_motion(name, piece, period)
        found += look_at_axis(name, axis, item.health)
    return tuple(found)


def _units(kind: AxisKind) -> dict[str, str]:
    give = {"backlash": "mm", "stiffness": "N/mm"}
    if kind == "rotary":
        give = {"backlash": "deg", "stiffness": "N m/deg"}
    return {name: way.unit for name, way in coordinates(kind, 1.0).items()} | give


def _fit(
    kind: AxisKind, name: str, logs: Sequence[_Log], base: Parameters, fastest: float
) -> AxisFit:
    fast = [item for item in logs if item.health.period_s <= SLOW_S]
    if not logs:
        every = [field.name for field in dataclasses.fields(base) if field.name not in OF_THE_LOG]
        return AxisFit(base, {}, {}, dict.fromkeys(every, _NO_LOG), (), np.zeros((0, 0)))
    if not fast:
        return fit_slow(kind, [_slow(item, name) for item in logs], base, fastest)
    pieces = [piece for item in fast for piece in _stretches(item, name)]
    return fit_axis(kind, pieces, base, filtered=all(_is_filtered(item, name) for item in fast))


def _is_filtered(item: _Log, name: str) -> bool:
    begin, end = max(item.health.stretches, key=lambda rows: rows[1] - rows[0])
    axis = item.log.axes[name]
    return is_filtered(axis.command[begin:end], axis.actual[begin:end])


def _stretches(item: _Log, name: str) -> list[Stretch]:
    return stretches_of(
        item.log.axes[name], item.log.time, item.health.period_s, item.health.stretches
    )


def _slow(item: _Log, name: str) -> SlowLog:
    ramps = []
    if name in axes_with_ramps(item.log):
        ramps = find_ramps(item.log, name, item.health.stretches, item.cycle_s)
    return SlowLog(item.log.axes[name], item.health.stretches, ramps, item.health.period_s)


def _limits(name: str, logs: Sequence[_Log], base: AxisTable) -> Limits:
    if not logs:
        return Limits({}, {})
    slow = all(item.health.period_s > SLOW_S for item in logs)
    pieces = [
        (_rows(item.log.axes[name], begin, end), item.health.period_s)
        for item in logs
        if slow or item.health.period_s <= SLOW_S
        for begin, end in item.health.stretches
    ]
    return planner_limits(pieces, base, slow=slow)


def _rows(axis: AxisLog, begin: int, end: int) -> AxisLog:
    return dataclasses.replace(
        axis, command=axis.command[begin:end], actual=axis.actual[begin:end],
        more={role: values[begin:end] for role, values in axis.more.items()},
    )  # fmt: skip


def _with_give(
    machine: Machine, name: str, fit: AxisFit, logs: Sequence[_Log], moved: float
) -> AxisFit:
    """A fit with backlash and stiffness, where a second encoder tells them."""
    pieces = [
        piece
        for item in logs
        if item.health.period_s <= SLOW_S and "load" in item.log.axes[name].more
        for piece in _stretches(item, name)
    ]
    if not pieces:
        absent = dict.fromkeys(("backlash", "stiffness"), NO_SECOND_ENCODER)
        return dataclasses.replace(fit, undetermined=fit.undetermined | absent)
    axis = machine.axis(name)
    mass = fit.parameters.mass if "mass" in fit.fitted else moved
    fitted, conditional = dict(fit.fitted), dict(fit.conditional)
    friction = fitted.get("dry_friction") or conditional.get("dry_friction", (None,))[0]
    give = fit_give(axis.kind, pieces, fit.parameters, mass - reflected_inertia(axis), friction)
    undetermined = dict(fit.undetermined)
    if give.backlash is None:
        undetermined["backlash"] = give.why
    elif give.backlash.low <= 0.0:
        undetermined["backlash"] = _up_to(give.backlash.high, axis)
    else:
        fitted["backlash"] = give.backlash
    if give.stiffness is None:
        undetermined["stiffness"] = give.why
    elif "mass" in fit.fitted:
        known = fit.fitted["mass"]
        off = max(known.high - known.value, known.value - known.low) / known.value
        fitted["stiffness"] = give.stiffness.widened(off * give.stiffness.value)
    else:
        conditional["stiffness"] = (give.stiffness, ("mass",))
        undetermined["stiffness"] = "only its ratio to the mass is told"
    return dataclasses.replace(
        fit, fitted=fitted, conditional=conditional, undetermined=undetermined
    )


def _with_ball_bars(
    axis: AxisTable, name: str, fit: AxisFit, circles: Sequence[BallBarFit]
) -> AxisFit:
    """A fit with the backlash that ball-bars tell, where no second encoder does."""
    lost = [circle.lost[name] for circle in circles if name in circle.lost]
    if not lost or "backlash" in fit.fitted:
        return fit
    strained = 2.0 * fit.parameters.dry_friction / axis.stiffness if axis.stiffness else 0.0
    middle = lost[0].spanning(*lost[1:])
    low, value, high = (end - strained for end in (middle.low, middle.value, middle.high))
    undetermined, fitted = dict(fit.undetermined), dict(fit.fitted)
    undetermined["stiffness"] = STIFFNESS
    if low > 0.0:
        fitted["backlash"] = Interval(value, low, high)
        undetermined.pop("backlash", None)
    else:
        undetermined["backlash"] = _up_to(high, axis)
    return dataclasses.replace(fit, fitted=fitted, undetermined=undetermined)


def _up_to(high: float, axis: AxisTable) -> str:
    """Why a backlash that may be none is not taken."""
    return f"anything up to {max(high, 0.0):.3g} {_units(axis.kind)['backlash']} would fit as well"


def _as_built(axis: AxisTable, fit: AxisFit) -> AxisFit:
    """A fit without what an axis cannot have that has no screw; it is named."""
    if axis.lead:
        return fit
    told = {name: interval for name, (interval, _) in fit.conditional.items()} | fit.fitted
    undetermined = dict(fit.undetermined)
    for name in {"backlash", "stiffness"} & set(told):
        undetermined[name] = (
            f"the log has {told[name].value:.4g} {_units(axis.kind)[name]}, but the base's axis has no "
            "'lead', and nothing gives in an axis without a screw"
        )
    gone = ("backlash", "stiffness")
    return dataclasses.replace(
        fit,
        fitted={name: interval for name, interval in fit.fitted.items() if name not in gone},
        conditional={name: pair for name, pair in fit.conditional.items() if name not in gone},
        undetermined=undetermined,
    )


def _figures(item: _Log, name: str, parameters: Parameters) -> LogFigures:
    axis = item.log.axes[name]
    if item.health.period_s > SLOW_S:
        return _slow_figures(item, name, axis, parameters)
    pieces = _stretches(item, name)
    predicted = [predict(parameters, piece) for piece in pieces]
    lag = np.concatenate([piece.lag for piece in pieces])
    model = np.concatenate([
        piece.asked[piece.first :] - one.actual
        for piece, one in zip(pieces, predicted, strict=True)
    ])  # fmt: skip
    time = np.concatenate([piece.time[piece.first :] for piece in pieces])
    force_share = correlation = None
    logged_force = model_force = _NOTHING
    if all(piece.force is not None for piece in pieces):
        logged_force = np.concatenate(
            [piece.force[piece.first :] for piece in pieces if piece.force is not None]
        )
        model_force = np.concatenate([one.force for one in predicted])
        force_share = _rms(model_force - logged_force) / max(_rms(logged_force), 1e-12)
    elif all(piece.current is not None for piece in pieces):
        logged_force = np.concatenate(
            [piece.current[piece.first :] for piece in pieces if piece.current is not None]
        )
        model_force = np.concatenate([one.current for one in predicted])
        speed = np.abs(
            np.concatenate(
                [
                    piece.command.position[:: piece.command.every, 1][piece.first :]
                    for piece in pieces
                ]
            )
        )
        moves = speed > _SEEN_MOVING * speed.max(initial=1e-9)
        correlation = _correlation(logged_force[moves], model_force[moves])
        force_share = _rms(model_force - logged_force) / max(_rms(logged_force), 1e-12)
    return LogFigures(
        item.log.name, item.role, name, axis.kind, _rms(lag), _rms(lag - model), force_share,
        correlation, None, Course(time, lag, model, False, logged_force, model_force),
    )  # fmt: skip


def _slow_figures(item: _Log, name: str, axis: AxisLog, parameters: Parameters) -> LogFigures:
    slow = _slow(item, name)
    seen = [predict_ramp(parameters, ramp).lag for ramp in slow.ramps]
    logged, model = np.array([ramp.lag for ramp in slow.ramps]), np.array(seen)
    share = _rms(model - logged) / _rms(logged) if len(logged) and _rms(logged) else None
    whole = axis.command - axis.actual
    loop = (1.0 - parameters.velocity_feedforward) / (parameters.kv * 1000.0 / 60.0)
    speed = axis.more.get("command_velocity", np.gradient(axis.command, item.health.period_s))
    force, moves = slow_force(slow, parameters, axis.kind)
    correlation, shown, current = None, _NOTHING, _NOTHING
    if "current" in axis.more:
        shown = axis.more["current"][moves]
        current = (force / parameters.current_scale + parameters.current_at_rest)[moves]
        correlation = _correlation(shown, current)
    rows = [ramp.row for ramp in slow.ramps]
    course = Course(
        item.log.time[rows], logged, model, True, shown, current,
    )  # fmt: skip
    left = whole - speed * (loop + parameters.delay)
    return LogFigures(
        item.log.name, item.role, name, axis.kind, _rms(whole), _rms(left), None, correlation,
        share, course,
    )  # fmt: skip


def _rms(values: FloatArray) -> float:
    return float(np.sqrt(np.mean(values**2))) if len(values) else 0.0


def _correlation(one: FloatArray, other: FloatArray) -> float | None:
    if len(one) < 3 or np.ptp(one) == 0.0 or np.ptp(other) == 0.0:
        return None
    return float(np.corrcoef(one, other)[0, 1])
