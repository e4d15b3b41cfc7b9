"""The figures of a run: what the comparison found, ready for the verdict and the report."""

import dataclasses
from collections.abc import Mapping

import numpy as np

from twin.nc.canonical import BoolArray, FloatArray, IntArray
from twin.units import AxisKind


@dataclasses.dataclass(frozen=True, slots=True)
class AxisTracking:
    """Following error of one axis: setpoint minus simulated position.

    Attributes:
        kind: ``linear`` counts in µm, ``rotary`` in mdeg.
        max: Greatest magnitude [µm or mdeg].
        rms: Root mean square over all samples [µm or mdeg].
        line: Program line commanded at the greatest.
        time_s: When that was [s].
        p99: What 99 % of the samples do not exceed [µm or mdeg], to 0.1 %.
    """

    kind: AxisKind
    max: float
    rms: float
    line: int
    time_s: float
    p99: float = 0.0


@dataclasses.dataclass(frozen=True, slots=True)
class ContourFigures:
    """Contour error: shortest distance from the tool to the commanded path, seen from the part.

    Of the whole program, or of all its blocks of one shape.

    Attributes:
        max: Greatest [µm].
        rms: Root mean square [µm].
        p99: What 99 % of the samples do not exceed [µm], to 0.1 %.
        worst_line: Source line of the block nearest to the worst point; 0 without samples.
        worst_time_s: When it was reached [s].
    """

    max: float
    rms: float
    p99: float
    worst_line: int
    worst_time_s: float


@dataclasses.dataclass(frozen=True, slots=True)
class WorstPlace:
    """The greatest contour error on one program line.

    Attributes:
        time_s: When [s].
        error_um: Contour error [µm].
        position: Commanded, shape (k,) [mm or deg]: the part's coordinates, those of the control's screen once
            what it adds is known.
    """

    line: int
    time_s: float
    error_um: float
    position: FloatArray
    move: int = -1


@dataclasses.dataclass(frozen=True, slots=True)
class ArcFigures:
    """Circular figures of one arc block of at least 90 degrees, with the table at rest.

    Attributes:
        time_s: When the tool reached the arc [s].
        radius_mm: Commanded radius [mm].
        sweep_deg: Commanded opening angle, signed, all turns [deg].
        circular_deviation_um: ISO 230-4 circular deviation G (see ``twin.compare.circular.circle``) [µm].
        radial_max_um: Greatest radial deviation, positive outside the commanded circle [µm].
        radial_min_um: Least radial deviation [µm].
        polar: Angle [deg] in the arc's plane (``twin.compare.circular.arcs.plane_axes``) and radial
            deviation [µm] by row for a polar plot, shape (m, 2); empty for all but the worst arcs.
    """

    line: int
    time_s: float
    radius_mm: float
    sweep_deg: float
    circular_deviation_um: float
    radial_max_um: float
    radial_min_um: float
    polar: FloatArray

    @property
    def radial_deviation_um(self) -> float:
        """The radial deviation that is farthest from zero, with its sign [µm]."""
        return max(self.radial_max_um, self.radial_min_um, key=abs)


@dataclasses.dataclass(frozen=True, slots=True)
class BidirectionalFigures:
    """Figures of a full circle that was run in both directions, after ISO 230-4.

    Attributes:
        radius_mm: Commanded radius [mm].
        circular_deviation_um: G(b), about the least-squares circle of both [µm].
        mean_radial_deviation_um: D: radius of that circle minus the commanded one [µm].
        hysteresis_um: H: greatest difference of the radial deviations at one angle [µm].
    """

    counter_clockwise_line: int
    clockwise_line: int
    radius_mm: float
    circular_deviation_um: float
    mean_radial_deviation_um: float
    hysteresis_um: float


@dataclasses.dataclass(frozen=True, slots=True)
class BlockFigures:
    """Contour error of m blocks as columns, by line; a line's rapids after its feeds.

    Attributes:
        line: Source line, shape (m,).
        rapid: Whether the row is about the rapids of the line, shape (m,).
        arc: Whether an arc is among its moves, shape (m,).
        samples: How many samples were nearest to it, shape (m,).
        max_um: Greatest contour error, shape (m,) [µm].
        rms_um: Root mean square, shape (m,) [µm].
        p99_um: What 99 % of the samples of one passage do not exceed, at most 0.8 % too high; of
            several passages the greatest, shape (m,) [µm].
        time_s: When the greatest was reached, shape (m,) [s].
        forgotten: How often a block was dropped because enough others were worse. Those that are
            the worst of all are exact in ``max_um`` even so; their other figures leave out what
            was before they were dropped and came again.
    """

    line: IntArray
    rapid: BoolArray
    arc: BoolArray
    samples: IntArray
    max_um: FloatArray
    rms_um: FloatArray
    p99_um: FloatArray
    time_s: FloatArray
    forgotten: int = 0

    def __len__(self) -> int:
        return len(self.line)


NO_BLOCKS = BlockFigures(
    line=np.zeros(0, np.int64),
    rapid=np.zeros(0, np.bool_),
    arc=np.zeros(0, np.bool_),
    samples=np.zeros(0, np.int64),
    max_um=np.zeros(0),
    rms_um=np.zeros(0),
    p99_um=np.zeros(0),
    time_s=np.zeros(0),
)


@dataclasses.dataclass(frozen=True, slots=True)
class CornerFigures:
    """The corners of a program: how far they are rounded.

    Attributes:
        rounding_um: Greatest rounding: shortest distance from a corner to the tool's path [µm].
        line: Source line that ends at that corner; 0 without corners.
        time_s: When the tool was nearest to it [s].
        rms_um: Root mean square of the corners' roundings [µm].
        p99_um: What 99 % of the corners' roundings do not exceed [µm], to 0.1 %.
    """

    count: int = 0
    rounding_um: float = 0.0
    line: int = 0
    time_s: float = 0.0
    rms_um: float = 0.0
    p99_um: float = 0.0


NO_CORNERS = CornerFigures()


@dataclasses.dataclass(frozen=True, slots=True)
class Figures:
    """Everything the comparison found.

    Attributes:
        duration_s: Time of the last sample [s].
        worst: The lines with the greatest contour errors, greatest first.
        blocks: By source line, feeds and rapids apart.
        features: Contour error of ``line`` and ``arc`` blocks; those that the program has.
        bidirectional: Full circles that were run in both directions, by line.
        shares: What drives and every error of the geometry have of the greatest contour error, along
            it [µm]; empty where the machine has no such errors.
        direction: Angle between the tool's commanded and simulated directions in the part, counted as a rotary
            axis; None where nothing tilts the one against the other.
    """

    samples: int
    duration_s: float
    tracking: Mapping[str, AxisTracking]
    contour: ContourFigures
    arcs: tuple[ArcFigures, ...]
    worst: tuple[WorstPlace, ...]
    blocks: BlockFigures = NO_BLOCKS
    features: Mapping[str, ContourFigures] = dataclasses.field(default_factory=dict)
    corners: CornerFigures = NO_CORNERS
    bidirectional: tuple[BidirectionalFigures, ...] = ()
    shares: Mapping[str, float] = dataclasses.field(default_factory=dict)
    direction: AxisTracking | None = None
