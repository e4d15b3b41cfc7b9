"""The nominal part of a job: whether the tool has cut into it, and in which line."""

import abc
import dataclasses
from pathlib import Path
from typing import Any, Generic, NamedTuple, TypeVar

import numpy as np

from twin.cutting.cut import Cutter
from twin.cutting.heights.height_map import HeightMap
from twin.cutting.tridexel.dexels import TriDexel
from twin.errors import ConfigError
from twin.files.stl import read_stl
from twin.job.job_file import NominalTable
from twin.nc.canonical import FloatArray, IntArray
from twin.recording.reader import Samples
from twin.toolpath.part_frame import PartFrame
from twin.units import UM_PER_MM

_TRACED = 256
"""Of the places that a chunk cut too deep, so many are traced back to their samples."""
SMALL = 0.2
"""A nominal part that is smaller than this share of the blank in every direction counts in other units, or is another
part: a centimetre is a tenth of what it should be, an inch a twenty-fifth."""

OUTSIDE = 1e-3
"""Share of a nominal part outside its blank from which it is reported: less is due to the grid."""

Nominal = HeightMap | TriDexel
"""What a part should be, on the grid of the part."""
NominalT = TypeVar("NominalT", HeightMap, TriDexel)


@dataclasses.dataclass(frozen=True, slots=True)
class NominalGouge:
    """Where the tool cut below the nominal part.

    Attributes:
        depth_mm: Below its surface.
        time_s: When [s].
        place: Where, program coordinates with the table at its zero [mm].
    """

    depth_mm: float
    line: int
    time_s: float
    place: tuple[float, float, float]

    def as_json(self) -> dict[str, Any]:
        """The object ``nominal_gouge`` of ``result.json``."""
        return dataclasses.asdict(self)


class ToolPath(NamedTuple):
    """Where the tool was during m samples, in the part's frame.

    Attributes:
        tip: Of the tool, shape (m, 3) [mm].
        axis: Direction from the tip to the spindle, shape (m, 3).
        radius: Of the tool, shape (m,) [mm].
        flute: Length of its edge, shape (m,) [mm].
    """

    tip: FloatArray
    axis: FloatArray
    radius: FloatArray
    flute: FloatArray


class Deep(NamedTuple):
    """n places that were cut too deep.

    Attributes:
        points: Shape (n, 3) [mm].
        depth: In the nominal part, shape (n,) [mm].
        marks: What the tool passes where it is the first to cut too deep, shape (n, 3) [mm].
        aside: How much farther than its edge they are from it then, at most, shape (n,) [mm].
        above: How far above them its tip is then, at most [mm].
    """

    points: FloatArray
    depth: FloatArray
    marks: FloatArray
    aside: FloatArray
    above: float

    def only(self, rows: IntArray) -> "Deep":
        """Some of them."""
        points, depth, marks, aside, above = self
        return Deep(points[rows], depth[rows], marks[rows], aside[rows], above)


class NominalWatch(abc.ABC, Generic[NominalT]):
    """Looks after every chunk whether what it cut reaches into the nominal part.

    Attributes:
        cutter: Cuts the part; another, or a copy of it as it was, may take its place.
        nominal: The nominal part on the grid of the machined one.
        misfit: Why the file can hardly be that of the part; None where it can.
        worst: The deepest so far, None without any.
    """

    def __init__(
        self, nominal: NominalTable, cutter: Cutter, part_frame: PartFrame, part_zero: FloatArray
    ) -> None:
        """Lay the nominal part into the blank.

        Args:
            part_zero: Machine coordinates of program zero, shape (k,) [mm or deg].

        Raises:
            ConfigError: Its file cannot be read, or it lies beside the blank.
        """
        self.cutter = cutter
        self._frame = part_frame
        self._corner = part_frame.program_zero(part_zero)
        self._allowed = nominal.gouge_um / UM_PER_MM
        self.worst: NominalGouge | None = None
        file = Path(nominal.file)
        self.nominal: NominalT = self._laid(file)
        if self._is_empty():
            raise ConfigError(
                f"job key 'nominal.file': {file} has nothing over the stock: it counts in "
                "program coordinates, in mm"
            )
        mesh = read_stl(file)
        corners = self._corner + mesh.bounds
        self.misfit = _misfit(corners, cutter.material.corners, self._allowed)
        if (np.bincount(mesh.edges_unique_inverse) % 2).any():
            self.misfit = (
                "the surface of the nominal part is open, and cuts where it is missing are not seen"
            )
        elif self.misfit is None and (outside := self._outside_share()) > OUTSIDE:
            self.misfit = f"{outside:.1%} of the nominal part lie outside the stock"

    def look(self, samples: Samples) -> tuple[NominalGouge, int] | None:
        """Look at what the cutter's last chunk cut.

        Returns:
            Where it first went too deep, and in which sample; None where it did not.
        """
        deep = self._too_deep(samples) if len(samples) else None
        if deep is None or not len(deep.depth):
            return None
        rows = np.arange(len(deep.depth))[:: max(1, len(deep.depth) // _TRACED)]
        deep = deep.only(np.append(rows, deep.depth.argmax()))
        reached = _first_within(deep, self._tool_path(samples))
        if self.worst is None or deep.depth[-1] > self.worst.depth_mm:
            self.worst = self._gouge(samples, int(reached[-1]), deep, -1)
        first = int(reached.argmin())
        sample = int(reached[first])
        return self._gouge(samples, sample, deep, first), sample

    @abc.abstractmethod
    def _laid(self, file: Path) -> NominalT:
        """The nominal part on the grid of the machined one."""

    @abc.abstractmethod
    def _is_empty(self) -> bool:
        """Whether nothing of it lies in the blank."""

    @abc.abstractmethod
    def _outside_share(self) -> float:
        """Share of it, within the box around the blank, that the uncut blank does not hold."""

    @abc.abstractmethod
    def _too_deep(self, samples: Samples) -> Deep | None:
        """What the cutter's last chunk cut too deep; None where it cut nothing."""

    def _tool_path(self, samples: Samples) -> ToolPath:
        joints, plan, move = samples.real(self._frame), self.cutter.plan, samples.setpoint.move
        tip = self._frame.position(joints, plan.lower(move))
        radius, flute = np.zeros((2, len(tip)))
        for run, tool in plan.runs(move):
            radius[run], flute[run] = tool.diameter / 2.0, tool.flute
        return ToolPath(tip, self._frame.tool_direction(joints), radius, flute)

    def _gouge(self, samples: Samples, sample: int, deep: Deep, row: int) -> NominalGouge:
        x, y, z = (float(value) for value in deep.points[row] - self._corner)
        asked, depth = samples.setpoint, float(deep.depth[row])
        return NominalGouge(depth, int(asked.line[sample]), float(asked.time[sample]), (x, y, z))


def _first_within(deep: Deep, path: ToolPath) -> IntArray:
    """The first of m samples in which each mark is as near to the tool's axis as its edge; else the nearest, shape (n,)."""
    found = np.zeros(len(deep.depth), np.int64)
    for number, (mark, aside) in enumerate(zip(deep.marks, deep.aside, strict=True)):
        arm = mark - path.tip
        height = (arm * path.axis).sum(axis=1)
        away = np.linalg.norm(arm - height[:, None] * path.axis, axis=1) - path.radius - aside
        away = np.where(height < -deep.above, np.inf, away)
        found[number] = int((away <= max(0.0, float(away.min()))).argmax())
    return found


def _misfit(nominal: FloatArray, blank: FloatArray, allowed: float) -> str | None:
    """Why a nominal part can hardly be what a blank is to become; None where it can.

    Args:
        nominal: Two opposite corners of the box around it, shape (2, 3) [mm].
        blank: The same of the blank.
        allowed: How far the two may be off [mm].
    """
    beyond = np.maximum(blank[0] - nominal[0], nominal[1] - blank[1])
    if beyond.max() > allowed:
        axis = "XYZ"[int(beyond.argmax())]
        return f"the nominal part reaches {beyond.max():.3g} mm out of the stock along {axis}"
    size, whole = (np.diff(corners, axis=0)[0] for corners in (nominal, blank))
    if (size < SMALL * whole).all():
        sizes = (" x ".join(f"{side:.3g}" for side in sides) for sides in (size, whole))
        return "the nominal part has {} mm in a stock of {} mm".format(*sizes)
    return None
