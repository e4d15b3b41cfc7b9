"""How well the fitted model predicts an axis of a log."""

import numpy as np

from twin.calibrate.fit.parameters import Parameters
from twin.calibrate.fit.ramps import predict_ramp
from twin.calibrate.fit.slow import slow_force
from twin.calibrate.fit.stretch import Prediction, Stretch, predict
from twin.calibrate.prepared import PreparedLog
from twin.calibrate.result import Course, LogFigures, SlowFigures
from twin.nc.canonical import BoolArray, FloatArray
from twin.units import kv_per_second

_SEEN_MOVING = 0.02
"""Share of the greatest speed from which an axis counts as moving."""
_NOTHING = np.zeros(0)


def figures_of(item: PreparedLog, name: str, parameters: Parameters) -> LogFigures:
    """Run the model along an axis of a log and compare.

    Args:
        item: The log.
        name: Of the axis.
        parameters: As fitted.
    """
    if item.is_slow:
        return _slow_figures(item, name, parameters)
    pieces = item.stretches(name)
    predicted = [predict(parameters, piece) for piece in pieces]
    lag = np.concatenate([piece.lag for piece in pieces])
    model = np.concatenate([
        (piece.asked - one.actual)[piece.seen] for piece, one in zip(pieces, predicted, strict=True)
    ])  # fmt: skip
    time = np.concatenate([piece.time[piece.seen] for piece in pieces])
    speed = np.concatenate([piece.command.kinematics[piece.seen, 0] for piece in pieces])
    force_time, logged, modelled, moves = _forces(pieces, predicted)
    shown = all(piece.force is None for piece in pieces)
    left = _rms(modelled - logged) / max(_rms(logged), 1e-12) if len(logged) else None
    correlation = _correlation(logged[moves], modelled[moves]) if shown and len(logged) else None
    course = Course(time, lag, model, False, logged, modelled, force_time, speed)
    return LogFigures(
        item.log.name, item.role, name, item.log.axes[name].kind, _rms(lag), _rms(lag - model),
        left, correlation, None, course,
    )  # fmt: skip


def _forces(
    pieces: list[Stretch], predicted: list[Prediction]
) -> tuple[FloatArray, FloatArray, FloatArray, BoolArray]:
    """Time, logged and predicted force (or current) of the rows that are looked at, and which move."""
    columns = [piece.logged_force for piece in pieces]
    known = [column for column in columns if column is not None]
    if len(known) < len(pieces):
        return _NOTHING, _NOTHING, _NOTHING, np.zeros(0, np.bool_)
    time = np.concatenate([piece.time[piece.felt] for piece in pieces])
    model = np.concatenate([
        (one.current if piece.force is None else one.force)[piece.felt]
        for piece, one in zip(pieces, predicted, strict=True)
    ])  # fmt: skip
    speed = np.abs(np.concatenate([piece.command.kinematics[piece.felt, 0] for piece in pieces]))
    return time, np.concatenate(known), model, speed > _SEEN_MOVING * speed.max(initial=1e-9)


def _slow_figures(item: PreparedLog, name: str, parameters: Parameters) -> LogFigures:
    slow, axis = item.slow(name), item.log.axes[name]
    logged = np.array([ramp.lag for ramp in slow.ramps])
    model = np.array([predict_ramp(parameters, ramp).lag for ramp in slow.ramps])
    ramps = None
    if len(logged) and _rms(logged):
        ramps = SlowFigures(_rms(logged), _rms(logged - model), len(logged))
    whole = (axis.command - axis.actual)[slow.told]
    loop = (1.0 - parameters.velocity_feedforward) / kv_per_second(parameters.kv)
    force, moves = slow_force(slow, parameters, axis.kind)
    correlation, shown, current = None, _NOTHING, _NOTHING
    if "current" in axis.more:
        shown = axis.more["current"][moves]
        current = (force / parameters.current_scale + parameters.current_at_rest)[moves]
        correlation = _correlation(shown, current)
    rows = np.array([ramp.row for ramp in slow.ramps], np.int64)
    course = Course(
        item.log.time[rows],
        logged,
        model,
        True,
        shown,
        current,
        item.log.time[moves],
        slow.speed[rows],
    )
    left = whole - slow.speed[slow.told] * (loop + parameters.delay)
    return LogFigures(
        item.log.name, item.role, name, axis.kind, _rms(whole), _rms(left), None, correlation,
        ramps, course,
    )  # fmt: skip


def _rms(values: FloatArray) -> float:
    return float(np.sqrt(np.mean(values**2))) if len(values) else 0.0


def _correlation(one: FloatArray, other: FloatArray) -> float | None:
    if len(one) < 3 or np.ptp(one) == 0.0 or np.ptp(other) == 0.0:
        return None
    return float(np.corrcoef(one, other)[0, 1])
