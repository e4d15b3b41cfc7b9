"""The machine file of a calibration, with every value's interval and where it came from."""

import dataclasses
import math
from collections.abc import Iterator

from twin.calibrate.fit.parameters import AxisParameters
from twin.calibrate.fit.solve import Interval
from twin.calibrate.fit.stages import OF_THE_LOG
from twin.calibrate.result import AxisResult, Calibration
from twin.machine.description.machine_file import AxisTable
from twin.machine.model.drive_actuators import stiffest
from twin.machine.model.drives import reflected_inertia
from twin.units import to_si
from twin.version import __version__


def machine_text(result: Calibration, *, base: str, name: str) -> str:
    """A machine file that is based on another.

    Args:
        base: What the file's ``base`` shall be: a shipped machine's name or a path.
    """
    fitted = [figures.log for figures in result.logs if figures.role == "fit"]
    logs = list(dict.fromkeys([*fitted, *(circle.log for circle in result.ball_bars)]))
    lines = [
        f"# Fitted by twin calibrate {__version__} to {_plain(', '.join(logs))}.",
        "# Each value with its 95 % interval; what is not here is as in the base.",
        f"base = {_quoted(base)}",
        f"name = {_quoted(name)}",
    ]
    for axis, found in result.axes.items():
        lines += ["", f"[axes.{axis}]", *_axis_lines(found)]
    square = {
        circle.plane: circle.squareness
        for circle in result.ball_bars
        if circle.squareness is not None
    }
    if square:
        lines += ["", "[geometry.squareness]"]
        lines += [
            f"{plane} = {_number(interval.value)}    # {_span(interval, 'µm/m')}"
            for plane, interval in square.items()
        ]
    return "\n".join(lines) + "\n"


def _axis_lines(axis: AxisResult) -> Iterator[str]:
    fit = axis.fit
    give = list(_give_lines(axis))
    gives = any(not line.startswith("#") for line in give)
    known = set(AxisTable.model_fields)
    for field in dataclasses.fields(AxisParameters):
        name, value = field.name, getattr(fit.parameters, field.name)
        if name == "mass" and name in fit.fitted and gives:
            yield _motor_line(axis)
        elif name in fit.fitted and name not in OF_THE_LOG and name in known:
            yield f"{name} = {_number(value)}    # {_span(fit.fitted[name], axis.units[name])}"
        elif name in fit.conditional and name in known:
            interval, given = fit.conditional[name]
            stands_on = " and ".join(given)
            span = _span(interval, axis.units[name])
            yield f"{name} = {_number(value)}    # {span}, given the {stands_on}"
            if "current_scale" in given and name == "dry_friction":
                scale = _number(fit.parameters.current_scale)
                yield f"current_scale = {scale}    # not determined: what the friction stands on"
    yield from give
    for name, value in axis.limits.reached.items():
        if name in axis.limits.known:
            limit = _number(axis.limits.known[name])
            yield f"{name} = {limit}    # what the commands come to again and again"
        else:
            yield f"# {name} as in the base: the commands reach {value:.5g}, but no limit"
    for name in OF_THE_LOG:
        if name in fit.fitted:
            yield f"# of the log, not of the machine: {name} {_span(fit.fitted[name], 's', True)}"
    for name, why in fit.undetermined.items():
        yield (
            f"# {name} as in the base: {_plain(why)}"
            if name not in fit.conditional
            else (f"# {name}: {_plain(why)}")
        )
    if not fit.fitted and not fit.conditional:
        yield "# nothing was determined"


def _give_lines(axis: AxisResult) -> Iterator[str]:
    """Backlash and stiffness, as far as they are there and can be simulated."""
    known = axis.fit.fitted | {name: pair[0] for name, pair in axis.fit.conditional.items()}
    if "backlash" in known:
        interval = known["backlash"]
        span = _span(interval, axis.units["backlash"])
        yield f"backlash = {_number(interval.value)}    # {span}"
    if "stiffness" in known:
        interval = known["stiffness"]
        span = _span(interval, axis.units["stiffness"])
        if interval.value < stiffest(axis.base, axis.moved, axis.period_s):
            yield f"stiffness = {_number(interval.value)}    # {span}"
        else:
            yield f"# stiffness {interval.value:.4g} swings within a servo period: rigid"


def _motor_line(axis: AxisResult) -> str:
    """The mass as inertia of the motor: behind a gap or spring a file has no other key for it."""
    base, mass = axis.base, axis.fit.parameters.mass
    assert base.lead is not None
    turns = (2.0 * math.pi / (base.lead * to_si(axis.kind))) ** 2
    carried = axis.moved - reflected_inertia(base)
    motor = (mass - carried) / turns - base.screw_inertia
    if motor <= 0.0:
        return f"# mass {mass:.5g} is less than the base carries: motor_inertia as in the base"
    return f"motor_inertia = {_number(motor)}    # of a mass of {mass:.5g} that the motor feels"


def _span(interval: Interval, unit: str, with_value: bool = False) -> str:
    if interval.value < interval.low:
        return f"none: anything above {interval.low:.3g} {unit} would fit as well"
    value = f"{interval.value:.5g}, " if with_value else ""
    low, high = (
        "open" if math.isinf(end) else f"{end:.5g}" for end in (interval.low, interval.high)
    )
    return f"{value}{low} to {high} {unit}".rstrip()


def _number(value: float) -> str:
    text = f"{value:.7g}"
    return text if any(mark in text for mark in ".e") else f"{text}.0"


def _plain(text: str) -> str:
    return "".join(letter if letter.isprintable() else " " for letter in text)


def _quoted(text: str) -> str:
    escaped = text.replace("\\", "\\\\").replace('"', '\\"')
    return f'"{_plain(escaped)}"'
