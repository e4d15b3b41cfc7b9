"""Setpoints of the circular test: one circle at a constant feed, and how it looks when measured."""

import dataclasses
import math
from collections.abc import Iterator

import numpy as np

from twin.errors import UsageError
from twin.machine.description.config import MachineConfig
from twin.motion.setpoints.setpoints import Setpoints
from twin.nc.canonical import FloatArray
from twin.recording.form import Samples
from twin.units import DEGREE, SECONDS_PER_MINUTE

PLANES = {
    "XY": ("X", "Y"),
    "ZX": ("Z", "X"),
    "YZ": ("Y", "Z"),
    "XYC": ("X", "Y"),
    "ZXB": ("Z", "X"),
    "YZA": ("Y", "Z"),
}
"""Axes of each plane, in the order in which positive turns go; the last three also turn the table that lies
in it, whatever its axis is called."""
_TURNED = {"YZA": 0, "ZXB": 1, "XYC": 2}
"""Which of X, Y, Z the table turns about."""

RUN_IN = math.pi / 2
"""Angle at full feed before the measured turn begins, as with a ball bar [rad]."""
_GENTLE = 0.5
"""Share of an axis's acceleration that the run-up takes."""
_CHUNK = 16384


@dataclasses.dataclass(frozen=True, slots=True)
class CirclePath:
    """A circle of one machine.

    With ``XYC``, ``ZXB`` and ``YZA`` a point of the table, as far from its axis as the radius, is followed at a constant
    distance: the table turns once while two axes draw the circle that keeps the tool beside that
    point. The measured distance then tells the three axes apart from each other.

    Attributes:
        plane: One of ``PLANES``.
        radius: [mm].
        feed: Along the circle [mm/min].
        direction: 1 counter-clockwise, -1 clockwise.
    """

    machine: MachineConfig
    plane: str
    radius: float
    feed: float
    direction: int

    def __post_init__(self) -> None:
        if self.plane not in PLANES:
            raise UsageError(f"no plane '{self.plane}': known are {', '.join(PLANES)}")
        if not (self.radius > 0 and self.feed > 0):
            raise UsageError("radius and feed must be positive")
        if self.plane in _TURNED and self._table is None:
            raise UsageError(
                f"machine '{self.machine.file.name}' has no rotary table for {self.plane}"
            )
        self._refuse_what_the_axes_cannot()

    @property
    def _table(self) -> tuple[int, FloatArray] | None:
        """Column of the axis that turns along, and where it turns about; None: nothing does."""
        normal = _TURNED.get(self.plane)
        return None if normal is None else self.machine.part_frame.table_about(normal)

    @property
    def speed(self) -> float:
        """Along the circle [mm/s]."""
        return self.feed / SECONDS_PER_MINUTE

    @property
    def run_up_s(self) -> float:
        """Time from rest to full feed [s]."""
        slowest = min(self.machine.axis(name).acceleration for name in PLANES[self.plane])
        return max(0.1, 2.0 * self.speed / (_GENTLE * slowest))

    def _columns(self) -> tuple[int, int]:
        first, second = (self.machine.axes.index(name) for name in PLANES[self.plane])
        return first, second

    @property
    def _length(self) -> float:
        """From the spindle nose to the ball, so that it reaches a table that lies below the travel of Z [mm]."""
        travel = self.machine.axis("Z").travel
        if self._table is None or travel is None or "Z" not in PLANES[self.plane]:
            return 0.0
        return max(0.0, travel[0] + self.radius - float(self._table[1][2]))

    def _center(self) -> FloatArray:
        """Where the circle lies in the machine: in the middle of the travel, shape (k,)."""
        travel = [self.machine.axis(name).travel or (0.0, 0.0) for name in self.machine.axes.names]
        center = np.array([(low + high) / 2 for low, high in travel])
        rotary = self.machine.axes.rotary()
        center[rotary] = np.clip(0.0, *np.array(travel)[rotary].T)
        if self._table is not None:
            first, second = self._columns()
            center[[first, second]] = self._table[1][[first, second]]
            center[first] += self.radius
            center[2] += self._length
        return center

    def _refuse_what_the_axes_cannot(self) -> None:
        center = self._center()
        for name in PLANES[self.plane]:
            axis = self.machine.axis(name)
            if self.speed > axis.velocity:
                most = axis.velocity * SECONDS_PER_MINUTE
                raise UsageError(f"{name} reaches {most:g} mm/min, not {self.feed:g}")
            if self.speed**2 / self.radius > axis.acceleration:
                most = math.sqrt(axis.acceleration * self.radius) * SECONDS_PER_MINUTE
                raise UsageError(
                    f"radius {self.radius:g} mm at {self.feed:g} mm/min asks more of {name} than "
                    f"its acceleration of {axis.acceleration:g} mm/s²; up to {most:.0f} mm/min fits"
                )
            low, high = axis.travel or (-math.inf, math.inf)
            middle = center[self.machine.axes.index(name)]
            most = min(middle - low, high - middle)
            if self.radius > most:
                raise UsageError(
                    f"radius {self.radius:g} mm does not fit the travel of {name}; "
                    f"up to {most:g} mm does"
                )
        if self._table is not None:
            self._refuse_too_fast_a_turn(self.machine.axes.names[self._table[0]])

    def _refuse_too_fast_a_turn(self, name: str) -> None:
        most = self.machine.axis(name).velocity * DEGREE * self.radius * SECONDS_PER_MINUTE
        if self.feed > most:
            raise UsageError(f"{name} is fast enough for {most:.0f} mm/min, not {self.feed:g}")

    def _angle(self, time: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Angle, rate and its change: from rest with a smooth hump of acceleration, then steady."""
        rise, rate = self.run_up_s, self.direction * self.speed / self.radius
        wave = 2.0 * math.pi / rise
        inside = np.minimum(time, rise)
        angle = rate / rise * (inside**2 / 2 + (np.cos(wave * inside) - 1.0) / wave**2)
        angle += rate * (time - inside)
        speed = rate / rise * (inside - np.sin(wave * inside) / wave)
        change = np.where(time < rise, rate / rise * (1.0 - np.cos(wave * time)), 0.0)
        return angle, speed, change

    def setpoints(self) -> Iterator[Setpoints]:
        """Setpoints from rest through run-up, run-in and one measured turn, in chunks."""
        period = self.machine.file.servo_period_s
        total = self.run_up_s + (RUN_IN + 2.2 * math.pi) * self.radius / self.speed
        count = math.ceil(total / period)
        for first in range(0, count, _CHUNK):
            yield self._chunk(
                period * np.arange(first, min(first + _CHUNK, count), dtype=np.float64)
            )

    def _chunk(self, time: FloatArray) -> Setpoints:
        angle, rate, change = self._angle(time)
        n, k = len(time), len(self.machine.axes)
        position, velocity, acceleration = (np.zeros((n, k)) for _ in range(3))
        position += self._center()
        first, second = self._columns()
        cosine, sine, radius = np.cos(angle), np.sin(angle), self.radius
        position[:, first] += radius * cosine
        position[:, second] += radius * sine
        velocity[:, first] = -radius * sine * rate
        velocity[:, second] = radius * cosine * rate
        acceleration[:, first] = -radius * (cosine * rate**2 + sine * change)
        acceleration[:, second] = radius * (cosine * change - sine * rate**2)
        if self._table is not None:
            rotary = self._table[0]
            # The part turns against the axis (ISO 841), so the axis runs against the circle.
            position[:, rotary] = -angle / DEGREE
            velocity[:, rotary] = -rate / DEGREE
            acceleration[:, rotary] = -change / DEGREE
        none = np.zeros(n, np.int64)
        return Setpoints(time, none, none, np.zeros(n), position, velocity, acceleration)

    def measured(self, samples: Samples) -> FloatArray:
        """What a ball bar sees: the tool from the centre of the circle.

        Args:
            samples: n samples of the machine.

        Returns:
            Shape (n, 2) [mm].
        """
        center = self._center()
        frame = self.machine.part_frame.at(center, self._length)
        real = samples.real(frame)
        columns = list(self._columns())
        if self._table is None:
            return (real - center)[:, columns]
        # The followed point is fixed to the part, which turns against the circle. There, with
        # the table at zero, its place was measured.
        seen = (frame.position(real) - frame.program_zero(center))[:, columns]
        return seen * np.array([1.0, -1.0])
