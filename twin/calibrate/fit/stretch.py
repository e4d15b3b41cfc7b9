"""What is compared: a stretch of a log without a gap, as it was and as the model has it."""

import dataclasses

import numpy as np

from twin.calibrate.fit.parameters import AxisParameters
from twin.calibrate.fit.simulation import AxisCommand, command_of, seen_at, simulate_axis
from twin.logs.machine_log import AxisLog
from twin.nc.canonical import BoolArray, FloatArray

_SETTLED_S = 0.1
"""What begins before the log is not known: so long it is not looked at [s]."""
_EVEN = 1e-3
"""A clock whose stamps are this share of a period off an even one is taken as even."""


@dataclasses.dataclass(frozen=True, slots=True)
class Sound:
    """Which samples of an axis's log are measurements of its own, shape (n,) each.

    Attributes:
        command: The others repeat the one before, or are spikes.
        actual: The same of the actual position, and of what follows a force that was cut off.
        force: The same of force or current.
    """

    command: BoolArray
    actual: BoolArray
    force: BoolArray

    def part(self, rows: slice) -> "Sound":
        """That of some rows."""
        return Sound(self.command[rows], self.actual[rows], self.force[rows])


@dataclasses.dataclass(frozen=True, slots=True)
class Stretch:
    """A stretch of one axis's log without a gap.

    Attributes:
        time: Shape (n,) [s].
        asked: Logged commanded positions, shape (n,) [mm or deg].
        actual: Logged actual positions, shape (n,) [mm or deg].
        force: Logged force, (n,) [N or N m]; None where none is.
        current: Logged force of unknown scale, (n,); None where none is.
        load: Logged positions of a second encoder at the axis, (n,) [mm or deg]; None where none is.
        driven: Force that is injected at the drive, which gives it besides its own, (n,); None where none is.
        pushed: Force that is injected at the load, (n,); None where none is.
        knots: Samples of the command that are its own, shape (n,).
        seen: Rows of actual positions that are looked at.
        measured: Rows of force or current that are looked at.
    """

    time: FloatArray
    command: AxisCommand
    asked: FloatArray
    actual: FloatArray
    force: FloatArray | None
    current: FloatArray | None
    load: FloatArray | None
    driven: FloatArray | None
    pushed: FloatArray | None
    knots: BoolArray
    seen: BoolArray
    measured: BoolArray

    @property
    def lag(self) -> FloatArray:
        """Logged following error of the rows that are looked at."""
        return (self.asked - self.actual)[self.seen]

    @property
    def logged_force(self) -> FloatArray | None:
        """Force, else current, of the rows that are looked at; None where neither is logged."""
        column = self.current if self.force is None else self.force
        return None if column is None else column[self.measured]


def stretches_of(
    axis: AxisLog, time: FloatArray, rows: tuple[tuple[int, int], ...], sound: Sound | None = None
) -> list[Stretch]:
    """Cut an axis's log.

    Args:
        time: Of the rows, as logged [s].
        rows: First and last row, exclusive, of each stretch.
        sound: Which samples are to be looked at; all by default.
    """
    if sound is None:
        every = np.ones(len(time), np.bool_)
        sound = Sound(every, every, every)
    return [_stretch(axis, time, slice(*piece), sound.part(slice(*piece))) for piece in rows]


def _stretch(axis: AxisLog, time: FloatArray, part: slice, sound: Sound) -> Stretch:
    def of(role: str) -> FloatArray | None:
        return axis.more[role][part] if role in axis.more else None

    clock, asked, actual = _clock(time[part]), axis.command[part], axis.actual[part]
    injected = of("external_force")
    command = command_of(axis.kind, clock, asked, actual, injected, sound.command)
    settled = clock - clock[0] > _SETTLED_S
    settled[len(clock) // 4 :] = True
    at_drive = axis.columns.external_force is not None and axis.columns.external_force.at == "drive"
    return Stretch(
        clock,
        command,
        asked,
        actual,
        of("force"),
        of("current"),
        of("load"),
        injected if at_drive else None,
        None if at_drive else injected,
        sound.command,
        settled & sound.actual,
        settled & sound.force,
    )


def _clock(time: FloatArray) -> FloatArray:
    """Time stamps as they are; where they are even but for their last digit, an even clock."""
    even = np.linspace(time[0], time[-1], len(time))
    period = (time[-1] - time[0]) / (len(time) - 1)
    off = time - even
    middle = (off.max() + off.min()) / 2.0
    if np.ptp(off) <= 2.0 * max(_EVEN * period, stamp_step(time)):
        return np.asarray(even + middle, np.float64)
    return time


def stamp_step(time: FloatArray) -> float:
    """What the last digit of time stamps counts, 0 where it counts far less than a period [s]."""
    steps = np.diff(time)
    period = float(np.median(steps))
    decades = 10.0 ** np.arange(np.floor(np.log10(period)), np.floor(np.log10(period)) - 3, -1)
    for step in decades:
        counts = time / step
        if np.all(np.abs(counts - np.round(counts)) < 1e-3):
            return float(step) if np.any(np.round(steps / step) != np.round(period / step)) else 0.0
    return 0.0


@dataclasses.dataclass(frozen=True, slots=True)
class Prediction:
    """What the model has in place of a stretch, for every row; (n,).

    Attributes:
        actual: Positions [mm or deg].
        force: Of the drive [N or N m]; empty where none is logged.
        current: What the control shows for it; likewise.
    """

    actual: FloatArray
    force: FloatArray
    current: FloatArray


def predict(parameters: AxisParameters, stretch: Stretch) -> Prediction:
    """Run the model along a stretch and see it as the log does."""
    command = stretch.command
    motion = simulate_axis(parameters, command)
    actual = seen_at(motion.position, motion.velocity, command, parameters.delay)
    if stretch.force is None and stretch.current is None:
        return Prediction(actual, actual[:0], actual[:0])
    given = motion.force + command.push if stretch.driven is not None else motion.force
    rate = np.gradient(given, command.step_s)
    force = seen_at(given, rate, command, parameters.force_delay)
    shown = force / parameters.current_scale + parameters.current_at_rest
    return Prediction(actual, force, shown)
