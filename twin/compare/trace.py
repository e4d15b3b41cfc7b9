"""The run as a person can see it: a few thousand points, however long it was."""

from collections.abc import Iterator

import numpy as np

from twin.nc.canonical import Axes, FloatArray, IntArray
from twin.recording.reader import Samples
from twin.toolpath.part_frame import PartFrame

_ERROR_COLUMN = 2
_FIRST_AXIS_COLUMN = 6
POINTS = 4000
"""A trace holds at least half and at most twice so many points."""


class Trace:
    """Thins a run for plots, in bounded memory.

    Of every group of consecutive samples the one with the greatest contour error is kept, so that
    thinning never hides a peak. When the groups become too many they are merged by twos.

    Args:
        part_zero: Machine coordinates of program zero, shape (k,) [mm or deg].
    """

    def __init__(self, axes: Axes, part_frame: PartFrame, part_zero: FloatArray) -> None:
        self.axes = axes
        self._frame = part_frame
        self._origin = part_frame.program_zero(part_zero)
        self._part_zero = np.asarray(part_zero, np.float64)
        self._group = 1
        nothing = np.zeros((0, _FIRST_AXIS_COLUMN + 3 * len(axes)))
        self._kept, self._count = [nothing], 0
        self._open = nothing
        self._open_count = 0
        self._last = nothing

    def add(self, samples: Samples, error_um: FloatArray, lower: FloatArray | float = 0.0) -> None:
        """Take in the next chunk.

        Args:
            samples: n samples.
            error_um: Their contour errors, shape (n,) [µm].
            lower: How much lower than the first tool's the tip is, shape (n,) [mm].
        """
        lower = np.broadcast_to(lower, len(samples))
        count = len(samples)
        if not count:
            return
        while self._count + (self._open_count + count) // self._group > 2 * POINTS:
            self._merge()
        head = min((self._group - self._open_count) % self._group, count)
        if head:
            self._put_into_open(
                self._of(samples, error_um, lower, _greatest_of(error_um[:head])), head
            )
        tail = head + (count - head) // self._group * self._group
        worst = head + _worst_rows(error_um[head:tail], self._group)
        whole = self._of(samples, error_um, lower, worst)
        if self._open_count == self._group:
            whole = np.concatenate([self._open, whole])
            self._open, self._open_count = self._open[:0], 0
        if len(whole):
            self._kept.append(whole)
            self._count += len(whole)
        if tail < count:
            row = tail + _greatest_of(error_um[tail:])
            self._put_into_open(self._of(samples, error_um, lower, row), count - tail)
        self._last = self._of(samples, error_um, lower, np.array([count - 1]))

    def _put_into_open(self, row: FloatArray, count: int) -> None:
        """Let the worst row of some samples compete for the group that is not full yet."""
        if not len(self._open) or row[0, _ERROR_COLUMN] > self._open[0, _ERROR_COLUMN]:
            self._open = row
        self._open_count += count

    def _merge(self) -> None:
        """Make one group of every two."""
        kept = np.concatenate(self._kept)
        if len(kept) % 2:
            kept, last = kept[:-1], kept[-1:]
            both = np.concatenate([last, self._open])
            self._open = both[_greatest_of(both[:, _ERROR_COLUMN])]
            self._open_count += self._group
        kept = kept[_worst_rows(kept[:, _ERROR_COLUMN], 2)]
        self._kept, self._count = [kept], len(kept)
        self._group *= 2

    def _of(
        self, samples: Samples, error_um: FloatArray, lower: FloatArray, rows: IntArray
    ) -> FloatArray:
        """What is kept of some samples."""
        asked, joints = samples.setpoint, samples.joint_position[rows]
        tip = self._frame.position(samples[rows].real(self._frame), lower[rows]) - self._origin
        return np.column_stack(
            [
                asked.time[rows],
                asked.line[rows].astype(np.float64),
                error_um[rows],
                tip,
                joints - self._part_zero,
                asked.position[rows] - joints,
                asked.velocity[rows],
            ]
        )

    def _rows(self) -> FloatArray:
        rest = [self._open, self._last] if self._open_count else []
        self._kept = [np.concatenate(self._kept)]
        return np.concatenate([*self._kept, *rest]) if rest else self._kept[0]

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
        return self._rows()[:, _ERROR_COLUMN]

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


def _worst_rows(error: FloatArray, size: int) -> IntArray:
    """Of every ``size`` rows the one with the greatest error."""
    groups = error.reshape(-1, size)
    return np.arange(len(groups)) * size + groups.argmax(axis=1)


def _greatest_of(error: FloatArray) -> IntArray:
    """The row with the greatest error, shape (1,)."""
    return np.array([error.argmax()])


def line_changes(trace: Trace) -> Iterator[tuple[float, int]]:
    """Time and line of every point at which another program line begins."""
    time, line = trace.time, trace.line
    for index in np.flatnonzero(np.diff(line, prepend=-1)):
        yield float(time[index]), int(line[index])
