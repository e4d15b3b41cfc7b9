"""How a tool moves against the part during a chunk of samples."""

import dataclasses
from collections.abc import Iterator

import numpy as np

from twin.columns import Columns
from twin.cutting.height_map import BoolArray
from twin.cutting.material import Points
from twin.nc.canonical import FloatArray, IntArray
from twin.recording.reader import Samples
from twin.toolpath.part_frame import PartFrame


@dataclasses.dataclass(frozen=True, slots=True)
class ToolMotion(Columns):
    """Where a tool went: n samples.

    Attributes:
        points: Of its tip in the part's frame, shape (n, 3) [mm].
        turn: As of ``Points``, at each sample.
        axis: Direction from the tip to the spindle there, shape (n, 3); None: +Z.
        lag: How far it trails its setpoint, shape (n,) [mm].
        time: Shape (n,) [s].
        line: Source line, shape (n,).
        rapid: Whether it belongs to a rapid, shape (n,).
        standing: Whether the spindle is off, shape (n,).
    """

    points: FloatArray
    turn: FloatArray
    axis: FloatArray | None
    lag: FloatArray
    time: FloatArray
    line: IntArray
    rapid: BoolArray
    standing: BoolArray

    @property
    def ends(self) -> Points:
        """Where the tool was at each sample."""
        return Points(self.points, self.turn, self.axis)

    def lowered(self, by: float) -> "ToolMotion":
        """The motion of a tool that is longer by so much [mm]."""
        down = np.array([0.0, 0.0, by]) if self.axis is None else by * self.axis
        return dataclasses.replace(self, points=self.points - down)

    @property
    def group(self) -> IntArray:
        """A number that changes wherever a stretch must end."""
        return self.line * 4 + self.rapid * 2 + self.standing


def tool_motion(
    samples: Samples,
    joints: FloatArray,
    frame: PartFrame,
    reach: float | None,
    rapid: BoolArray,
    standing: BoolArray,
) -> ToolMotion:
    """The motion that samples are of.

    Args:
        samples: n samples.
        joints: Where the axes were then, shape (n, k) [mm or deg].
        reach: How far above the tip the edge ends, which a tool that lags in its direction is off by [mm]; None: the tool
            keeps to the part's Z.
        rapid: Which samples belong to rapids, shape (n,).
        standing: During which of them the spindle is off, shape (n,).
    """
    setpoint = samples.setpoint
    meant, points = frame.position(setpoint.position), frame.position(joints)
    lag = np.abs(meant - points).sum(axis=1)
    turn, axis = frame.direction(joints), None
    if reach is not None:
        turn, axis = frame.tool_x(joints), frame.tool_direction(joints)
        lag += reach * np.linalg.norm(axis - frame.tool_direction(setpoint.position), axis=1)
    return ToolMotion(points, turn, axis, lag, setpoint.time, setpoint.line, rapid, standing)


def by_edge(samples: Samples, run: slice) -> Iterator[tuple[slice, bool]]:
    """The samples of a run up to the one at which the tool loses its edge, and those from there on."""
    gone = np.zeros(0) if samples.tool is None else np.flatnonzero(samples.tool.broken[run])
    lost = run.start + int(gone[0]) if len(gone) else run.stop
    if lost > run.start:
        yield slice(run.start, lost), True
    if lost < run.stop:
        yield slice(lost, run.stop), False
