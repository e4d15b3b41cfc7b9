"""Logs whose columns are mislabelled: swapped, of another axis, in another unit."""

import numpy as np

from twin.errors import UsageError
from twin.logs.machine_log import AxisLog
from twin.machine.description.machine_file import AxisTable
from twin.nc.canonical import FloatArray

_FOLLOWS = 0.3
"""What a straight law of lag and speed may leave of the deviation, as a share of the motion."""
_FOLLOWS_AT_ITS_LIMIT = 0.6
"""The same where a force was cut off at its limit: what is kept between are short pieces, of which a straight law
tells little, neither who leads."""
_RIGHT = 0.02
"""A ratio of actual to commanded motion may be off by this."""
_TOO_FAST = 3.0
"""Times the base's velocity that no log of such an axis reaches."""
_TOO_SLOW = 1e-3
_MOST_ROWS = 200_000
"""Rows that a straight law is solved for: of a longer log they are every second, third and so on."""
_OVER_S = 0.02
"""Speeds are taken over this time [s]."""
_LEADS_S = 5e-4
"""An actual position that leads by more is not one [s]."""
_JUMPS = 5.0
"""Times what the command moves in ``_OVER_S`` that no actual position moves between two samples."""
_KNOWN_RATIOS = {
    25.4: "inches", 1 / 25.4: "inches", 1e3: "micrometres or metres", 1e-3: "micrometres or metres",
    57.29578: "radians", 1 / 57.29578: "radians", 10.0: "centimetres", 0.1: "centimetres",
    -1.0: "the other sense", 2.0: "diameters", 0.5: "diameters",
}  # fmt: skip


def refuse_wrong_log(
    where: str, name: str, axis: AxisLog, base: AxisTable, period_s: float, *, clipped: bool
) -> None:
    """Refuse columns that cannot be commanded and actual position of such an axis.

    Args:
        period_s: Between samples [s].
        clipped: Where its force was cut off has been left out.

    Raises:
        UsageError: With the reason, and what would make it right.
    """
    place = f"{where}: axis {name}"
    if axis.kind != base.kind:
        raise UsageError(
            f"{place}: the log is in units of a {axis.kind} axis, the base's {name} is {base.kind}"
        )
    unit = "mm" if axis.kind == "linear" else "deg"
    travelled = float(np.ptp(axis.command))
    if travelled <= 0.0:
        raise UsageError(f"{place}: the command does not move; there is nothing to fit")
    if np.array_equal(axis.command, axis.actual):
        raise UsageError(
            f"{place}: actual equals command in every sample: both are the same quantity; give the "
            "column of the actual position in the map"
        )
    _refuse_speed(place, axis, base, period_s, unit)
    ratio, lead, left = straight_law(axis, period_s)
    if abs(ratio - 1.0) > _RIGHT:
        wrong_unit = next(
            (what for known, what in _KNOWN_RATIOS.items() if abs(ratio / known - 1.0) < 0.03), None
        )
        if wrong_unit is not None and left < _FOLLOWS:
            raise UsageError(
                f"{place}: actual moves {ratio:.4g} times as far as command: one of them is in {wrong_unit}; "
                "give it its own unit or scale in the map"
            )
    _refuse_jumps(place, axis, period_s, abs(ratio), unit)
    if left > (_FOLLOWS_AT_ITS_LIMIT if clipped else _FOLLOWS) or abs(ratio - 1.0) > 10 * _RIGHT:
        raise UsageError(
            f"{place}: actual does not follow command ({100 * left:.0f} % of the motion is left "
            f"unexplained, and it moves {ratio:.3g} times as far): it is the position of another axis, "
            "or another quantity"
        )
    if not clipped and lead > max(_LEADS_S, 0.02 * period_s):
        raise UsageError(
            f"{place}: actual leads command by {lead * 1e3:.3g} ms: the columns are swapped, or "
            "logged at different times; swap them in the map, or give the delay of a column, delay_s"
        )


def _refuse_speed(place: str, axis: AxisLog, base: AxisTable, period_s: float, unit: str) -> None:
    # A command that stands for some samples and then jumps is no faster for that.
    apart = min(max(1, round(_OVER_S / period_s)), len(axis.command) - 1)
    steps = np.abs(axis.command[apart:] - axis.command[:-apart]) / (apart * period_s)
    fastest = float(np.quantile(steps, 0.999))
    if fastest > _TOO_FAST * base.velocity:
        raise UsageError(
            f"{place}: the command moves at up to {fastest:.3g} {unit}/s, the base at "
            f"{base.velocity:g} {unit}/s: the unit of position or of time is another one, or the "
            "base is no such machine"
        )
    if fastest < _TOO_SLOW * base.velocity:
        raise UsageError(
            f"{place}: the command moves at no more than {fastest:.3g} {unit}/s, of "
            f"{base.velocity:g} {unit}/s that the base does: the unit is another one (metres, "
            "inches?), or the log shows no motion"
        )


def _refuse_jumps(place: str, axis: AxisLog, period_s: float, ratio: float, unit: str) -> None:
    """Refuse dropped samples: values between two others that no axis comes to in a sample."""
    apart = min(max(1, round(_OVER_S / period_s)), len(axis.command) - 1)
    commanded = float(np.abs(axis.command[apart:] - axis.command[:-apart]).max())
    steps = np.abs(np.diff(axis.actual))
    worst = int(np.argmax(steps))
    if float(steps[worst]) > _JUMPS * max(ratio, 1.0) * commanded:
        raise UsageError(
            f"{place}: actual jumps by {float(steps[worst]):.4g} {unit} between samples {worst + 1} "
            f"and {worst + 2}, where the command moves by no more than {commanded:.4g} {unit} in "
            f"{apart * period_s * 1e3:.3g} ms: samples were dropped, or the encoder was set again; "
            "leave them out of the log"
        )


def straight_law(axis: AxisLog, period_s: float) -> tuple[float, float, float]:
    """How actual follows command by a straight law of position, speed and acceleration.

    On a circle an axis's acceleration is a multiple of its position; a law without it is solved as
    well, and the one whose ratio is nearer to 1 counts.

    Args:
        period_s: Between samples [s].

    Returns:
        How far actual moves per command, how early it is [s], and what the law leaves as a share
        of the motion.
    """
    speed = np.gradient(axis.command, period_s)
    law = [axis.command, speed, np.ones(len(speed))]
    found = []
    every = slice(None, None, -(-len(speed) // _MOST_ROWS))
    actual = axis.actual[every]
    for columns in (law, [*law, np.gradient(speed, period_s)]):
        table = np.column_stack([column[every] for column in columns])
        parts, *_ = np.linalg.lstsq(table, actual, rcond=None)
        left = float(np.std(actual - table @ parts) / max(np.std(actual), 1e-12))
        found.append((float(parts[0]), float(parts[1]), left))
    return min(found, key=lambda one: abs(one[0] - 1.0))


def refuse_wrong_force(place: str, force: FloatArray, acceleration: FloatArray) -> None:
    """Refuse a force that pushes against the motion that it makes.

    Args:
        force: Of the drive, shape (n,) [N or N m].
        acceleration: Of the axis, shape (n,).

    Raises:
        UsageError: Its sign is wrong, or it is constant.
    """
    if float(np.ptp(force)) <= 0.0:
        raise UsageError(f"{place}: the force never changes: it is another column")
    joint = float(np.corrcoef(force, acceleration)[0, 1])
    if joint < -0.3:
        raise UsageError(
            f"{place}: the force pushes against the acceleration (correlation {joint:.2f}): give its "
            "column a scale of the other sign"
        )
