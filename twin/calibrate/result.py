"""The result of a calibration: by axis what was fitted, by log how well it is predicted."""

import dataclasses
import math
from collections.abc import Mapping
from pathlib import Path

from twin.calibrate.findings import LogFinding
from twin.calibrate.fit.ball_bar import ONE_DIRECTION, BallBarFit
from twin.calibrate.fit.solve import Interval
from twin.calibrate.fit.stages import NOT_ASKED, AxisFit
from twin.calibrate.limits import Limits
from twin.machine.description.machine_file import AxisTable
from twin.nc.canonical import FloatArray
from twin.units import AxisKind

FIT, HOLD_OUT = "fit", "hold-out"
_UNEXPLAINED = 0.5
"""Share of a lag or a force that may be left."""


@dataclasses.dataclass(frozen=True, slots=True)
class TimeSeries:
    """Logged and predicted over time, for plots; shape (n,) each.

    Attributes:
        time: [s].
        logged: Lag of position [mm or deg], or of velocity where a log is slow.
        predicted: The model's lag, in the same units.
        slow: Whether it is the lag of velocity at single samples within ramps.
        logged_force: Force [N or N m] or what the control shows [A]; empty where none is logged.
        predicted_force: The model's force or current.
        force_time: When, which is not always when positions were [s].
        speed: Commanded, at the samples of ``logged`` [mm/s or deg/s].
    """

    time: FloatArray
    logged: FloatArray
    predicted: FloatArray
    slow: bool
    logged_force: FloatArray
    predicted_force: FloatArray
    force_time: FloatArray
    speed: FloatArray


@dataclasses.dataclass(frozen=True, slots=True)
class SlowFigures:
    """How well velocities within the ramps of a slow log are predicted.

    Attributes:
        logged_rms: Of the lag of velocity in single samples [mm/s or deg/s].
        left_rms: Of what the model leaves of it.
        ramps: So many samples fell into ramps that tell.
    """

    logged_rms: float
    left_rms: float
    ramps: int

    @property
    def share(self) -> float:
        """What is left of the lag of velocity."""
        return self.left_rms / self.logged_rms


@dataclasses.dataclass(frozen=True, slots=True)
class LogFigures:
    """How well one axis of one log is predicted.

    Attributes:
        role: ``fit`` or ``hold-out``.
        logged_rms: Of the logged following error [mm or deg].
        left_rms: Of what the model leaves of it [mm or deg].
        force_share: What it leaves of the force, as a share; None where none is logged.
        current_correlation: Of logged and predicted current where the axis moves; None likewise.
        ramps: What it leaves of the lag of velocity in ramps; None where not looked at.
    """

    log: str
    role: str
    axis: str
    kind: AxisKind
    logged_rms: float
    left_rms: float
    force_share: float | None
    current_correlation: float | None
    ramps: SlowFigures | None
    course: TimeSeries

    @property
    def share(self) -> float:
        """What is left of the following error."""
        return self.left_rms / self.logged_rms if self.logged_rms else math.inf

    @property
    def judged_share(self) -> float:
        """What the fit is judged by: of a slow log the lag of velocity in ramps, where it has any."""
        return self.share if self.ramps is None else self.ramps.share

    @property
    def ramps_line(self) -> str:
        """What is left within the ramps of a slow log, in words; empty where none was looked at."""
        if self.ramps is None:
            return ""
        unit = "mm/s" if self.kind == "linear" else "deg/s"
        return (
            f"{Path(self.log).name}, {self.axis}: lag of velocity within {self.ramps.ramps} ramps: "
            f"{self.ramps.logged_rms:.3g} {unit} rms logged, {self.ramps.left_rms:.3g} {unit} left "
            f"({100 * self.ramps.share:.1f} %)"
        )

    @property
    def lag_is_unexplained(self) -> bool:
        """Whether more than half of the lag that the fit is judged by is left."""
        return self.judged_share > _UNEXPLAINED

    @property
    def force_is_unexplained(self) -> bool:
        """Whether more than half of a logged force is left: no fit of it deserves trust."""
        return self.force_share is not None and self.force_share > _UNEXPLAINED

    def as_contract(self) -> dict[str, object]:
        """As ``--json`` writes it."""
        unit = "um" if self.kind == "linear" else "mdeg"
        data: dict[str, object] = {
            "log": self.log,
            "role": self.role,
            "axis": self.axis,
            f"logged_rms_{unit}": self.logged_rms * 1e3,
            f"left_rms_{unit}": self.left_rms * 1e3,
            "share": self.share,
        }
        for name in ("force_share", "current_correlation"):
            if getattr(self, name) is not None:
                data[name] = getattr(self, name)
        if self.ramps is not None:
            unit = "mm_per_s" if self.kind == "linear" else "deg_per_s"
            data |= {
                f"velocity_logged_rms_{unit}": self.ramps.logged_rms,
                f"velocity_left_rms_{unit}": self.ramps.left_rms,
                "velocity_share": self.ramps.share,
                "ramps": self.ramps.ramps,
            }
        return data


@dataclasses.dataclass(frozen=True, slots=True)
class AxisResult:
    """One axis.

    Attributes:
        units: Of the parameters, by name.
        moved: What its motor feels there [kg or kg m²].
        period_s: The base's servo period [s].
    """

    kind: AxisKind
    fit: AxisFit
    units: Mapping[str, str]
    limits: Limits
    base: AxisTable
    moved: float
    period_s: float


@dataclasses.dataclass(frozen=True, slots=True)
class Calibration:
    """The whole.

    Attributes:
        findings: About the logs, by file.
    """

    base: str
    axes: Mapping[str, AxisResult]
    logs: tuple[LogFigures, ...]
    findings: Mapping[str, tuple[LogFinding, ...]]
    ball_bars: tuple[BallBarFit, ...] = ()

    def as_contract(self) -> dict[str, object]:
        """As ``--json`` writes it."""
        return {
            "schema": 1,
            "base": self.base,
            "axes": {name: _axis_contract(axis) for name, axis in self.axes.items()},
            "logs": [figures.as_contract() for figures in self.logs],
            "ball_bars": [_ball_bar_contract(circle) for circle in self.ball_bars],
            "findings": [
                {"log": log, "code": finding.code, "message": finding.message}
                for log, findings in self.findings.items()
                for finding in findings
            ],
        }


def _axis_contract(axis: AxisResult) -> dict[str, object]:
    fit = axis.fit
    return {
        "fitted": {
            name: _interval_contract(interval, axis.units[name])
            for name, interval in fit.fitted.items()
        },
        "conditional": {
            name: _interval_contract(interval, axis.units[name]) | {"given": list(given)}
            for name, (interval, given) in fit.conditional.items()
        },
        "undetermined": dict(fit.undetermined),
        "limits": dict(axis.limits.reached),
        "limits_told": dict(axis.limits.known),
        "correlations": {
            "names": list(fit.names),
            "matrix": [[round(float(value), 4) for value in row] for row in fit.correlations],
        },
    }


def _ball_bar_contract(circle: BallBarFit) -> dict[str, object]:
    data: dict[str, object] = {
        "log": circle.log,
        "plane": circle.plane,
        "lost_motion": {
            name: _interval_contract(interval, "mm") for name, interval in circle.lost.items()
        },
        "logged_rms_um": circle.logged_rms * 1e3,
        "left_rms_um": circle.left_rms * 1e3,
    }
    if circle.squareness is None or circle.lag is None:
        return data | {"undetermined": dict.fromkeys(("squareness", "lag_mismatch"), ONE_DIRECTION)}
    return data | {
        "squareness": _interval_contract(circle.squareness, "um/m"),
        "lag_mismatch": _interval_contract(circle.lag, "s"),
    }


def _interval_contract(interval: Interval, unit: str) -> dict[str, object]:
    return {
        "value": interval.value,
        "low": _finite(interval.low),
        "high": _finite(interval.high),
        "unit": unit,
    }


def _finite(value: float) -> float | None:
    return value if math.isfinite(value) else None


def verdict_sentence(name: str, axis: AxisResult, logs: tuple[LogFigures, ...]) -> str:
    """The answer in one sentence."""
    own = [figures for figures in logs if figures.axis == name]
    unseen = [figures for figures in own if figures.role == HOLD_OUT]
    judged = unseen or own
    ramps = sum(figures.ramps.ramps for figures in judged if figures.ramps is not None)
    what = f"lag of velocity in {ramps} ramps" if ramps else "lag"
    if not judged:
        names = ", ".join(axis.fit.fitted) or "nothing"
        return f"{name}: from a ball-bar only, which determines {names}."
    shares = max((figures.judged_share for figures in judged), default=math.inf)
    seen = "of a log that it has not seen" if unseen else "of the fitted log"
    left = f"{100 * shares:.3g} %"
    if shares >= 1.0:
        sentence = f"{name}: is worse than no model: of the {what} {seen} it leaves {left}"
    elif shares > _UNEXPLAINED:
        sentence = f"{name}: leaves {left} of the {what} {seen} unexplained"
    else:
        sentence = f"{name}: predicts the {what} {seen} to {100 * shares:.2g} %"
    forces = [figures for figures in judged if figures.force_is_unexplained]
    if forces:
        sentence += (
            f", but leaves {100 * (forces[0].force_share or 0.0):.0f} % of the force unexplained"
        )
    open_ones = [
        parameter
        for parameter, why in axis.fit.undetermined.items()
        if parameter not in axis.fit.conditional and why != NOT_ASKED
    ]
    if not open_ones:
        return f"{sentence}; nothing is undetermined."
    first = open_ones[0]
    more = open_ones[1:]
    rest = f", and so {'are' if more[1:] else 'is'} {', '.join(more)}" if more else ""
    return f"{sentence}; {first} is undetermined ({axis.fit.undetermined[first]}){rest}."
