"""How well the fitted model predicts an axis of a log."""

from collections.abc import Iterable
from typing import NamedTuple

import numpy as np

from twin.calibrate.fit.parameters import AxisParameters
from twin.calibrate.fit.ramps import predict_ramp
from twin.calibrate.fit.slow import slow_force
from twin.calibrate.fit.stretch import Stretch, predict
from twin.calibrate.prepared import PreparedLog
from twin.calibrate.result import LogFigures, SlowFigures, TimeSeries
from twin.nc.canonical import FloatArray
from twin.units import kv_per_second

_SEEN_MOVING = 0.02
"""Share of the greatest speed from which an axis counts as moving."""
_NOTHING = np.zeros(0)


def figures_of(item: PreparedLog, name: str, parameters: AxisParameters) -> LogFigures:
    """Run the model along an axis of a log and compare."""
    if item.is_slow:
        return _slow_figures(item, name, parameters)
    axis = item.log.axes[name]
    seen = _joined(
        (_judged(parameters, piece) for piece in item.judged(name)),
        sum(end - begin for begin, end in item.rows(name)),
    )
    left, correlation = None, None
    if len(seen.force):
        left = _rms(seen.force_model - seen.force) / max(_rms(seen.force), 1e-12)
    if len(seen.force) and "force" not in axis.more:
        speed = np.abs(seen.force_speed)
        moves = speed > _SEEN_MOVING * speed.max(initial=1e-9)
        correlation = _correlation(seen.force[moves], seen.force_model[moves])
    course = TimeSeries(
        seen.time, seen.lag, seen.lag_model, False, seen.force, seen.force_model, seen.force_time,
        seen.speed,
    )  # fmt: skip
    return LogFigures(
        item.log.name, item.role, name, axis.kind, _rms(seen.lag), _rms(seen.lag - seen.lag_model),
        left, correlation, None, course,
    )  # fmt: skip


class _Judged(NamedTuple):
    """Rows that are looked at, logged and as the model has them; those of a force are others than those of a lag."""

    time: FloatArray
    lag: FloatArray
    lag_model: FloatArray
    speed: FloatArray
    force_time: FloatArray
    force: FloatArray
    force_model: FloatArray
    force_speed: FloatArray


def _joined(parts: Iterable[_Judged], most: int) -> _Judged:
    """Parts joined; the memory of each is freed once it is copied.

    Args:
        parts: Of one axis.
        most: Rows of all of them at most.
    """
    columns = [np.empty(most) for _ in _Judged._fields]
    filled = [0] * len(columns)
    for part in parts:
        for number, values in enumerate(part):
            columns[number][filled[number] : filled[number] + len(values)] = values
            filled[number] += len(values)
    return _Judged(*(column[:count] for column, count in zip(columns, filled, strict=True)))


def _judged(parameters: AxisParameters, piece: Stretch) -> _Judged:
    model, speed = predict(parameters, piece), piece.command.kinematics[:, 0]
    lag_model = (piece.asked - model.actual)[piece.seen]
    positions = (piece.time[piece.seen], piece.lag, lag_model, speed[piece.seen])
    force = piece.logged_force
    if force is None:
        return _Judged(*positions, _NOTHING, _NOTHING, _NOTHING, _NOTHING)
    given = model.current if piece.force is None else model.force
    return _Judged(
        *positions, piece.time[piece.measured], force, given[piece.measured], speed[piece.measured]
    )


def _slow_figures(item: PreparedLog, name: str, parameters: AxisParameters) -> LogFigures:
    slow, axis = item.slow(name), item.log.axes[name]
    logged = np.array([ramp.lag for ramp in slow.ramps])
    model = np.array([predict_ramp(parameters, ramp).lag for ramp in slow.ramps])
    ramps = None
    if len(logged) and _rms(logged):
        ramps = SlowFigures(_rms(logged), _rms(logged - model), len(logged))
    whole = (axis.command - axis.actual)[slow.known]
    loop = (1.0 - parameters.velocity_feedforward) / kv_per_second(parameters.kv)
    force, moves = slow_force(slow, parameters, axis.kind)
    correlation, shown, current = None, _NOTHING, _NOTHING
    if "current" in axis.more:
        shown = axis.more["current"][moves]
        current = (force / parameters.current_scale + parameters.current_at_rest)[moves]
        correlation = _correlation(shown, current)
    rows = np.array([ramp.row for ramp in slow.ramps], np.int64)
    course = TimeSeries(
        item.log.time[rows],
        logged,
        model,
        True,
        shown,
        current,
        item.log.time[moves],
        slow.speed[rows],
    )
    left = whole - slow.speed[slow.known] * (loop + parameters.delay)
    return LogFigures(
        item.log.name, item.role, name, axis.kind, _rms(whole), _rms(left), None, correlation,
        ramps, course,
    )  # fmt: skip


def _rms(values: FloatArray) -> float:
    return float(np.sqrt(values @ values / len(values))) if len(values) else 0.0


def _correlation(one: FloatArray, other: FloatArray) -> float | None:
    if len(one) < 3 or np.ptp(one) == 0.0 or np.ptp(other) == 0.0:
        return None
    return float(np.corrcoef(one, other)[0, 1])
