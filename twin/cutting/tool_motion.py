"""How a tool moves against the part during a chunk of samples."""

import dataclasses
from collections.abc import Iterable, Iterator

import numpy as np

from twin.columns import Columns
from twin.cutting.heights.height_map import BoolArray
from twin.cutting.material import Points
from twin.nc.canonical import FloatArray, IntArray
from twin.recording.reader import Samples
from twin.toolpath.part_frame import PartFrame


@dataclasses.dataclass(frozen=True, slots=True)
class ToolMotion(Columns):
    """Where a tool went: n samples.

    Attributes:
        ends: Where it was at each.
        off: From its tip to the setpoint's, shape (n, 3) [mm].
        lag: How far it trails its setpoint, shape (n,) [mm].
        time: Shape (n,) [s].
        line: Source line, shape (n,).
        rapid: Whether it belongs to a rapid, shape (n,).
        standing: Whether the spindle is off, shape (n,).
    """

    ends: Points
    off: FloatArray
    lag: FloatArray
    time: FloatArray
    line: IntArray
    rapid: BoolArray
    standing: BoolArray

    def lowered(self, by: float) -> "ToolMotion":
        """The motion of a tool that is longer by so much [mm]."""
        return dataclasses.replace(self, ends=self.ends.lowered(by))

    def followed_by(self, other: "ToolMotion") -> "ToolMotion":
        """Both, one after the other."""
        names = [field.name for field in dataclasses.fields(self)][1:]
        rest = [np.concatenate([getattr(self, name), getattr(other, name)]) for name in names]
        return ToolMotion(self.ends.followed_by(other.ends), *rest)

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
    carriers: Iterable[tuple[int, ...]] = (),
) -> ToolMotion:
    """The motion that samples are of.

    Args:
        samples: n samples.
        joints: Where the axes were then, shape (n, k) [mm or deg].
        reach: How far above the tip the edge ends, which a tool that lags in its direction is off by [mm]; None: the tool
            keeps to the part's Z.
        rapid: Which samples belong to rapids, shape (n,).
        standing: During which of them the spindle is off, shape (n,).
        carriers: Axes between the tool and each of the bodies that carry it; see ``Upright.beyond``.
    """
    setpoint = samples.setpoint
    tilts = reach is not None
    carried = {axes: _places(_at_zero(joints, axes), frame, tilts=tilts) for axes in carriers}
    ends = dataclasses.replace(_places(joints, frame, tilts=tilts), carriers=carried)
    wanted = _places(setpoint.position, frame, tilts=tilts)
    off = wanted.tip - ends.tip
    lag = np.abs(off).sum(axis=1)
    if reach is not None and ends.axis is not None and wanted.axis is not None:
        lag += reach * np.linalg.norm(ends.axis - wanted.axis, axis=1)
    return ToolMotion(ends, off, lag, setpoint.time, setpoint.line, rapid, standing)


def _at_zero(joints: FloatArray, axes: tuple[int, ...]) -> FloatArray:
    """Joints with some axes at zero, shape (n, k)."""
    changed = joints.copy()
    changed[:, axes] = 0.0
    return changed


def _places(joints: FloatArray, frame: PartFrame, *, tilts: bool) -> Points:
    if tilts:
        return Points(*frame.poses(joints))
    return Points(frame.position(joints), frame.direction(joints))


def by_edge(samples: Samples, run: slice) -> Iterator[tuple[slice, bool]]:
    """The samples of a run up to the one at which the tool loses its edge, and those from there on."""
    gone = np.zeros(0) if samples.tool is None else np.flatnonzero(samples.tool.broken[run])
    lost = run.start + int(gone[0]) if len(gone) else run.stop
    if lost > run.start:
        yield slice(run.start, lost), True
    if lost < run.stop:
        yield slice(lost, run.stop), False
