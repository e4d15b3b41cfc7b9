"""The run as a person can see it: a few thousand points, however long it was."""

from collections.abc import Iterator

import numpy as np

from twin.nc.canonical import Axes, FloatArray, IntArray
from twin.recording.reader import Samples
from twin.toolpath.part_frame import PartFrame

_FIRST_AXIS_COLUMN = 6
POINTS = 4000
"""A trace holds at least half and at most twice so many points."""


class Trace:
    """Thins a run for plots, in bounded memory.

    Of every group of consecutive samples the one with the greatest contour error is kept, so that
    thinning never hides a peak. When the groups become too many they are merged by twos.

    Args:
        axes: Axes of the samples.
        part_frame: How the part turns under the tool.
        part_zero: Machine coordinates of program zero, shape (k,) [mm or deg].

    Attributes:
        axes: As given.
    """

    def __init__(self, axes: Axes, part_frame: PartFrame, part_zero: FloatArray) -> None:
        self.axes = axes
        self._frame = part_frame
        self._origin = part_zero[:3] - np.array([*part_frame.center, 0.0])
        self._part_zero = np.asarray(part_zero, np.float64)
        self._group = 1
        self._kept = np.zeros((0, _FIRST_AXIS_COLUMN + 3 * len(axes)))
        self._pending: list[FloatArray] = []
        self._pending_rows = 0

    def add(self, samples: Samples, error_um: FloatArray) -> None:
        """Take in the next chunk.

        Args:
            samples: n samples.
            error_um: Their contour errors, shape (n,) [µm].
        """
        asked = samples.setpoint
        rows = np.column_stack(
            [
                asked.time,
                asked.line.astype(np.float64),
                error_um,
                self._frame.position(self._frame.real(samples.joint_position)) - self._origin,
                samples.joint_position - self._part_zero,
                asked.position - samples.joint_position,
                asked.velocity,
            ]
        )
        self._pending.append(rows)
        self._pending_rows += len(rows)
        if self._pending_rows >= self._group:
            self._group_pending()

    def _group_pending(self) -> None:
        rows = np.concatenate(self._pending)
        whole = len(rows) - len(rows) % self._group
        self._kept = np.concatenate([self._kept, _worst_of(rows[:whole], self._group)])
        self._pending, self._pending_rows = [rows[whole:]], len(rows) - whole
        while len(self._kept) > 2 * POINTS:
            if len(self._kept) % 2:
                self._kept, last = self._kept[:-1], self._kept[-1:]
                self._pending.insert(0, np.repeat(last, self._group, axis=0))
                self._pending_rows += self._group
            self._kept = _worst_of(self._kept, 2)
            self._group *= 2

    def _rows(self) -> FloatArray:
        rest = np.concatenate(self._pending) if self._pending_rows else self._kept[:0]
        if len(rest) == 0:
            return self._kept
        return np.concatenate([self._kept, _worst_of(rest, len(rest)), rest[-1:]])

    @property
    def time(self) -> FloatArray:
        """Shape (m,) [s]."""
        return self._rows()[:, 0]

    @property
    def line(self) -> IntArray:
        """Commanded program line, shape (m,)."""
        return self._rows()[:, 1].astype(np.int64)

    @property
    def error_um(self) -> FloatArray:
        """Contour error, shape (m,) [µm]."""
        return self._rows()[:, 2]

    @property
    def tool(self) -> FloatArray:
        """Simulated tool point on the part, program coordinates at table zero, (m, 3) [mm]."""
        return self._rows()[:, 3:_FIRST_AXIS_COLUMN]

    @property
    def position(self) -> FloatArray:
        """Simulated part coordinates of all axes, shape (m, k) [mm or deg]."""
        return self._columns(0)

    @property
    def lag(self) -> FloatArray:
        """Following error of all axes, shape (m, k) [mm or deg]."""
        return self._columns(1)

    @property
    def velocity(self) -> FloatArray:
        """Commanded, shape (m, k) [mm/s or deg/s]."""
        return self._columns(2)

    @property
    def path_speed(self) -> FloatArray:
        """Commanded speed of X Y Z together, shape (m,) [mm/s]."""
        return np.linalg.norm(self.velocity[:, :3], axis=1)

    def _columns(self, block: int) -> FloatArray:
        width = len(self.axes)
        return self._rows()[:, _FIRST_AXIS_COLUMN + block * width :][:, :width]


def _worst_of(rows: FloatArray, size: int) -> FloatArray:
    """Of every ``size`` rows the one with the greatest error."""
    groups = rows[:, 2].reshape(-1, size)
    return rows[np.arange(len(groups)) * size + groups.argmax(axis=1)]


def line_changes(trace: Trace) -> Iterator[tuple[float, int]]:
    """Time and line of every point at which another program line begins."""
    time, line = trace.time, trace.line
    for index in np.flatnonzero(np.diff(line, prepend=-1)):
        yield float(time[index]), int(line[index])
