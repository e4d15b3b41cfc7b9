"""What is compared: an evenly sampled stretch of a log, as it was and as the model has it."""

import dataclasses

import numpy as np

from twin.calibrate.fit.parameters import Parameters
from twin.calibrate.fit.simulation import Command, command_of, seen_at, simulate_axis
from twin.logs.machine_log import AxisLog
from twin.nc.canonical import FloatArray

_SETTLED_S = 0.1
"""What begins before the log is not known: so long it is not looked at [s]."""


@dataclasses.dataclass(frozen=True, slots=True)
class Stretch:
    """An evenly sampled stretch of one axis's log.

    Attributes:
        time: Shape (n,) [s].
        command: What it was told.
        asked: Logged commanded positions, shape (n,) [mm or deg].
        actual: Logged actual positions, shape (n,) [mm or deg].
        force: Logged force, (n,) [N or N m]; None where none is.
        current: Logged force of unknown scale, (n,); None where none is.
        load: Logged positions of a second encoder at the axis, (n,) [mm or deg]; None where none is.
        first: The first sample that is looked at.
    """

    time: FloatArray
    command: Command
    asked: FloatArray
    actual: FloatArray
    force: FloatArray | None
    current: FloatArray | None
    load: FloatArray | None
    first: int

    @property
    def lag(self) -> FloatArray:
        """Logged following error, from the first sample that is looked at."""
        return (self.asked - self.actual)[self.first :]


def stretches_of(
    axis: AxisLog, time: FloatArray, period_s: float, rows: tuple[tuple[int, int], ...]
) -> list[Stretch]:
    """Cut an axis's log.

    Args:
        axis: Its columns.
        time: Of the rows [s].
        period_s: Between samples [s].
        rows: First and last row, exclusive, of each stretch.
    """

    def of(role: str, part: slice) -> FloatArray | None:
        return axis.more[role][part] if role in axis.more else None

    found = []
    for begin, end in rows:
        part = slice(begin, end)
        asked, actual = axis.command[part], axis.actual[part]
        command = command_of(axis.kind, period_s, asked, actual, of("external_force", part))
        first = min(len(asked) // 4, 1 + int(_SETTLED_S / period_s))
        found.append(
            Stretch(
                time[part],
                command,
                asked,
                actual,
                of("force", part),
                of("current", part),
                of("load", part),
                first,
            )
        )
    return found


@dataclasses.dataclass(frozen=True, slots=True)
class Prediction:
    """What the model has in place of a stretch, from the first sample that is looked at; (n,).

    Attributes:
        actual: Positions [mm or deg].
        force: Of the drive [N or N m]; empty where none is logged.
        current: What the control shows for it; likewise.
    """

    actual: FloatArray
    force: FloatArray
    current: FloatArray


def predict(parameters: Parameters, stretch: Stretch) -> Prediction:
    """Run the model along a stretch and see it as the log does."""
    command = stretch.command
    motion = simulate_axis(parameters, command)
    kept = slice(stretch.first, None)
    actual = seen_at(motion.position, motion.velocity, command, parameters.delay)[kept]
    if stretch.force is None and stretch.current is None:
        return Prediction(actual, actual[:0], actual[:0])
    rate = np.gradient(motion.force, command.step_s)
    force = seen_at(motion.force, rate, command, parameters.force_delay)[kept]
    shown = force / parameters.current_scale + parameters.current_at_rest
    return Prediction(actual, force, shown)
