"""The machine file of a calibration, with every value's interval and where it came from."""

import dataclasses
import math
from collections.abc import Iterator

from twin.calibrate.fit.parameters import Parameters
from twin.calibrate.fit.solve import Interval
from twin.calibrate.fit.stages import OF_THE_LOG
from twin.calibrate.result import AxisResult, Calibration
from twin.machine.description.config import AxisTable
from twin.version import __version__


def machine_text(result: Calibration, *, base: str, name: str) -> str:
    """A machine file that stands on its base.

    Args:
        result: The calibration.
        base: What the file's ``base`` shall be: a shipped machine's name or a path.
        name: Of the new machine.
    """
    logs = list(dict.fromkeys(figures.log for figures in result.logs if figures.role == "fit"))
    lines = [
        f"# Fitted by twin calibrate {__version__} to {_plain(', '.join(logs))}.",
        "# Each value with its 95 % interval; what is not here is as in the base.",
        f"base = {_quoted(base)}",
        f"name = {_quoted(name)}",
    ]
    for axis, found in result.axes.items():
        lines += ["", f"[axes.{axis}]", *_axis_lines(found)]
    return "\n".join(lines) + "\n"


def _axis_lines(axis: AxisResult) -> Iterator[str]:
    fit = axis.fit
    known = set(AxisTable.model_fields)
    for field in dataclasses.fields(Parameters):
        name, value = field.name, getattr(fit.parameters, field.name)
        if name in fit.fitted and name not in OF_THE_LOG and name in known:
            yield f"{name} = {_number(value)}    # {_span(fit.fitted[name], axis.units[name])}"
        elif name in fit.conditional and name in known:
            interval, given = fit.conditional[name]
            stands_on = " and ".join(given)
            told = _span(interval, axis.units[name])
            yield f"{name} = {_number(value)}    # {told}, given the {stands_on}"
            if "current_scale" in given and name == "dry_friction":
                scale = _number(fit.parameters.current_scale)
                yield f"current_scale = {scale}    # not determined: what the friction stands on"
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
