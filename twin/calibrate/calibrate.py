"""Logs in, a calibration out: the stages in their order, axis by axis."""

import dataclasses
from collections.abc import Sequence

import numpy as np

from twin.calibrate.figures import figures_of
from twin.calibrate.findings import LogFinding
from twin.calibrate.fit.ball_bar import BallBarFit, fit_ball_bar
from twin.calibrate.fit.parameters import AxisParameters, of_base
from twin.calibrate.fit.slow import fit_slow
from twin.calibrate.fit.solve import on_one_thread
from twin.calibrate.fit.stages import OF_THE_LOG, AxisFit, fit_axis
from twin.calibrate.health import look_at_axis, look_at_fit, look_at_motion
from twin.calibrate.limits import Limits, planner_limits
from twin.calibrate.prepared import MOST_FITTED, PreparedLog, prepared
from twin.calibrate.refusal import refuse_wrong_force, refuse_wrong_log
from twin.calibrate.result import FIT, HOLD_OUT, AxisResult, Calibration, LogFigures
from twin.calibrate.transmission import as_built, units_of, with_ball_bars, with_give
from twin.errors import UsageError
from twin.logs.ball_bar import BallBarLog
from twin.logs.machine_log import MachineLog
from twin.machine.description.config import MachineConfig
from twin.machine.description.machine_file import AxisTable
from twin.machine.model.model import build_spec, compiled, drives
from twin.units import AxisKind

_NO_LOG = "no log of the axis's positions was given"


@on_one_thread
def calibrate(
    machine: MachineConfig,
    logs: Sequence[MachineLog],
    hold_out: Sequence[MachineLog] = (),
    axes: Sequence[str] = (),
    ball_bars: Sequence[BallBarLog] = (),
) -> Calibration:
    """Fit a machine's drives to logs.

    Args:
        machine: The base: what logs do not determine stays as it has it.
        hold_out: What the fit is judged by.
        axes: Which to fit; all that the logs have by default.
        ball_bars: Circles that tell what an axis loses where it turns round.

    Raises:
        UsageError: A log is not what it is said to be, or has nothing to fit.
    """
    fitted = [prepared(log, FIT) for log in logs]
    held = [prepared(log, HOLD_OUT) for log in hold_out]
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
        fit = with_give(machine, name, fit, own, masses[name])
        fit = as_built(machine.axis(name), with_ball_bars(machine.axis(name), name, fit, circles))
        results[name] = AxisResult(
            kind, fit, units_of(kind), _limits(name, own, machine.axis(name)), machine.axis(name),
            masses[name], machine.file.servo_period_s,
        )  # fmt: skip
        for item in (item for item in own if not item.is_slow):
            noted = look_at_fit(name, fit.fitted, masses[name], filtered=item.is_filtered(name))
            findings[item.log.name] += tuple(noted)
        figures += [
            figures_of(item, name, fit.parameters)
            for item in fitted + held
            if name in item.log.axes
        ]
    order = {item.log.name: number for number, item in enumerate(fitted + held)}
    figures.sort(key=lambda one: (one.role != FIT, order[one.log]))
    return Calibration(machine.file.name, results, tuple(figures), findings, circles)


def _axes(
    machine: MachineConfig,
    logs: Sequence[PreparedLog],
    wanted: Sequence[str],
    circles: Sequence[BallBarFit],
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


def _masses(machine: MachineConfig) -> dict[str, float]:
    found = drives(machine, compiled(build_spec(machine), machine))
    return {name: drive.moved for name, drive in zip(machine.axes.names, found, strict=True)}


def _axis_findings(
    machine: MachineConfig, item: PreparedLog, names: Sequence[str]
) -> tuple[LogFinding, ...]:
    """Refuse columns that cannot be right, report poor ones."""
    found: list[LogFinding] = []
    for name in names:
        if name not in item.log.axes:
            continue
        axis, place = item.cleaned(name), f"{item.log.name}: axis {name}"
        pieces = [axis.of_rows(slice(begin, end)) for begin, end in item.rows(name)]
        piece = max(pieces, key=lambda one: float(np.ptp(one.command)))
        period = item.health.period_s
        defects = item.defects[name].findings if name in item.defects else ()
        clipped = any(one.code == "clipped" for one in defects)
        refuse_wrong_log(item.log.name, name, piece, machine.axis(name), period, clipped=clipped)
        found += defects
        if not item.is_slow:
            if "force" in axis.more:
                speed = np.gradient(piece.actual, period)
                smooth = np.convolve(np.gradient(speed, period), np.ones(9) / 9, "same")
                refuse_wrong_force(place, piece.more["force"], smooth)
            found += look_at_motion(name, piece, period)
        found += look_at_axis(name, axis, item.health)
        rows = sum(end - begin for begin, end in item.rows(name))
        if not item.is_slow and item.role == FIT and rows > MOST_FITTED:
            message = f"{name}: of {rows} samples the {MOST_FITTED} in which it moves most are fitted; all are judged"
            found.append(LogFinding("long", message))
    return tuple(found)


def _fit(
    kind: AxisKind, name: str, logs: Sequence[PreparedLog], base: AxisParameters, fastest: float
) -> AxisFit:
    fast = [item for item in logs if not item.is_slow]
    if not logs:
        every = [field.name for field in dataclasses.fields(base) if field.name not in OF_THE_LOG]
        return AxisFit(base, {}, {}, dict.fromkeys(every, _NO_LOG), (), np.zeros((0, 0)))
    if not fast:
        return fit_slow(kind, [item.slow(name) for item in logs], base, fastest)
    pieces = [piece for item in fast for piece in item.fitted(name)]
    return fit_axis(kind, pieces, base, filtered=all(item.is_filtered(name) for item in fast))


def _limits(name: str, logs: Sequence[PreparedLog], base: AxisTable) -> Limits:
    if not logs:
        return Limits({}, {})
    slow = all(item.is_slow for item in logs)
    pieces = [
        (axis.of_rows(slice(begin, end)), item.health.period_s)
        for item in logs
        if slow or not item.is_slow
        for axis in [item.cleaned(name)]
        for begin, end in item.parts(name)
    ]
    return planner_limits(pieces, base, slow=slow)
