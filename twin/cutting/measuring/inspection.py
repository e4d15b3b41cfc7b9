"""How far the machined part is from what it should be."""

import dataclasses
from typing import Any

import numpy as np

from twin.cutting.heights.height_map import HeightMap
from twin.cutting.kernels.surface_distance import FoundBy, MapSurface, surface_distances
from twin.cutting.kernels.wall_distance import KNOWN, WallColumn, WallDistance
from twin.cutting.material import STRAIGHT_MM
from twin.errors import ConfigError
from twin.nc.canonical import BoolArray, FloatArray
from twin.units import UM_PER_MM

STEEPEST = 1.0
"""Slope up to which the distance between surfaces follows from the difference of their heights: a wall
that is displaced by a hair's breadth differs by its whole height."""
WALL_ERROR_MM = 2.0 * STRAIGHT_MM
"""What the places of two walls that tools have left are off by at most [mm]."""
_TO_THE_SIDE = 1.5
"""From the middle of the last cell that is measured, behind one at the blank's side, to that side [cells]."""
_BESIDE = 0.75
"""Every wall has a cell behind it whose middle is as near [cells]."""
RAW = 1e-3
"""A wall that is where the blank's own side is, to this, is that side [cells]."""


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Inspection:
    """What measuring the part found; positive deviations are material left standing."""

    deviation_mm: FloatArray
    """Distance of the part's surface from the nominal one over each cell, shape (ny, nx) [mm]; over a
    cell beside a wall the greater of those of wall and top. NaN on the blank's own surface, and where the
    place of a wall is not known and no cell differs."""
    bound_mm: float
    """How much farther the part's surface may be from the nominal one than was measured [mm]: a cell,
    if there are walls whose place is known to a cell only."""
    judged: int
    """Cells that belong to what was machined, or should have been."""
    tolerance_um: float
    """What ``within_share`` counts [µm]."""
    standing_mm3: float
    """Material that should have gone, walls included [mm³]."""
    missing_mm3: float
    """Material that should have stayed, walls included [mm³]."""

    @property
    def measured(self) -> BoolArray:
        """Cells that were measured, shape (ny, nx)."""
        return np.isfinite(self.deviation_mm)

    @property
    def measured_share(self) -> float:
        """Share of the cells that belong to what was machined, or should have been, that were measured."""
        return int(self.measured.sum()) / self.judged if self.judged else 0.0

    @property
    def most_standing_mm(self) -> float:
        """The most that was left standing [mm]."""
        return float(self.deviation_mm[self.measured].max(initial=0.0))

    @property
    def holds(self) -> bool:
        """Whether every measured deviation is within the tolerance."""
        here = np.abs(self.deviation_mm[self.measured])
        return float(here.max(initial=0.0)) * UM_PER_MM <= self.tolerance_um

    @property
    def summary(self) -> str:
        """One line for a person."""
        figures = self.as_json()
        if "max_um" not in figures:
            return "no surface of the part could be measured"
        return (
            f"part: {figures['min_um']:+.1f} to {figures['max_um']:+.1f} µm, mean "
            f"{figures['mean_um']:+.2f} µm, {100 * figures['within_share']:.2f} % within "
            f"±{self.tolerance_um:g} µm; {100 * figures['measured_share']:.1f} % measured, walls "
            f"to {figures['bound_um']:.0f} µm"
        )

    def as_json(self) -> dict[str, Any]:
        """Figures for a report: max, min, mean and rms [µm], shares of cells."""
        here = UM_PER_MM * self.deviation_mm[self.measured]
        volumes = {"standing_mm3": self.standing_mm3, "missing_mm3": self.missing_mm3}
        if not len(here):
            return {"measured_share": 0.0, **volumes}
        return {
            **volumes,
            "measured_share": self.measured_share,
            "bound_um": UM_PER_MM * self.bound_mm,
            "max_um": float(here.max()),
            "min_um": float(here.min()),
            "mean_um": float(here.mean()),
            "rms_um": float(np.sqrt((here**2).mean())),
            "tolerance_um": self.tolerance_um,
            "within_share": float((np.abs(here) <= self.tolerance_um).mean()),
        }


def inspect(part: HeightMap, nominal: HeightMap, tolerance_um: float) -> Inspection:
    """Measure a part against its nominal shape, at right angles to the nominal surface.

    Args:
        nominal: What it should be, on the same grid: the part cut along the commanded path, or
            ``height_map.blank`` of a nominal STL.
        tolerance_um: Deviation that is still good [µm].

    Raises:
        ConfigError: The two maps do not lie on the same grid.
    """
    if part.heights.shape != nominal.heights.shape or part.cell != nominal.cell:
        raise ConfigError(
            f"a part of {part.heights.shape} cells of {part.cell:g} mm cannot be compared with one "
            f"of {nominal.heights.shape} cells of {nominal.cell:g} mm: use the same grid"
        )
    if not np.allclose(part.origin, nominal.origin, atol=1e-6):
        raise ConfigError("the two parts do not lie at the same place")
    slope, above = steepness(nominal.heights, nominal.cell), part.heights - nominal.heights
    touched = (part.machined() | nominal.machined()) & (part.solid() | nominal.solid())
    flat = np.maximum(steepness(part.heights, part.cell), slope) <= STEEPEST
    gentle = touched & flat & part.solid() & nominal.solid() & (np.abs(above) <= part.cell)
    deviation = np.where(gentle, above / np.sqrt(1.0 + slope**2), np.nan)
    # At the blank's own sides it is not noted what else is near: there the next row of cells tells.
    edge = _raw_sides(part) | _raw_sides(nominal)
    upright = (_beside_walls(part) | _beside_walls(nominal)) & ~edge
    rest = (touched & ~edge | upright) & ~gentle
    found_by = np.full(rest.shape, FoundBy.HEIGHT)
    one, other = (MapSurface(each.heights, _without(each.behind, edge)) for each in (part, nominal))
    surface_distances(
        one,
        other,
        part.cell,
        rest,
        flat,
        deviation,
        found_by,
    )
    unseen = rest & upright & (found_by == FoundBy.HEIGHT) & (deviation == 0.0)
    unseen &= ~_both_slope(part, nominal)
    unseen |= _nominal_within_raw_side(part, nominal)
    off = above * part.cell**2
    deviation = np.where(unseen, np.nan, deviation)
    coarse = unseen.any() or bool((found_by == FoundBy.CELLS).any())
    known_to = WALL_ERROR_MM + _TO_THE_SIDE * _change_beside(edge, deviation)
    return Inspection(
        deviation_mm=deviation,
        bound_mm=part.cell if coarse else min(known_to, part.cell),
        judged=int((touched | rest).sum()),
        tolerance_um=tolerance_um,
        standing_mm3=float(off.clip(min=0.0).sum()),
        missing_mm3=float((-off).clip(min=0.0).sum()),
    )


def _change_beside(edge: BoolArray, deviation: FloatArray) -> float:
    """How much the deviation changes at most from the cells beside those at the blank's sides, which are not measured, to the next [mm].

    A wall that runs into a side goes on from one of the three cells behind it.
    """
    most = 0.0
    for turn in range(4):
        outside, measured = np.rot90(edge, turn), np.rot90(deviation, turn)
        behind = np.pad(measured[2:], ((0, 0), (1, 1)), constant_values=np.nan)
        next_three = np.stack([behind[:, :-2], behind[:, 1:-1], behind[:, 2:]])
        change = np.fmin.reduce(np.abs(next_three - measured[1:-1]))
        at = outside[:-2] & np.isnan(measured[:-2]) & np.isfinite(change)
        most = max(most, float(change[at].max(initial=0.0)))
    return most


def _beside_walls(height_map: HeightMap) -> BoolArray:
    """Cells from which it goes down steeply, or whose wall is known, but for the blank's own sides."""
    heights = height_map.heights
    drop = np.zeros_like(heights)
    for axis in (0, 1):
        step = np.diff(heights, axis=axis)
        before, after = [(0, 0), (0, 0)], [(0, 0), (0, 0)]
        before[axis], after[axis] = (1, 0), (0, 1)
        drop = np.maximum(drop, np.maximum(np.pad(step, before), np.pad(-step, after)))
    walls = height_map.behind[..., WallColumn.DISTANCE]
    near = (walls > KNOWN) & (walls <= KNOWN + _BESIDE)
    steep = (drop > STEEPEST * height_map.cell) & (walls <= KNOWN)
    return height_map.solid() & ~_raw_sides(height_map) & (steep | near)


def _raw_sides(height_map: HeightMap) -> BoolArray:
    """Cells whose nearest wall is the blank's own side."""
    inside = height_map.outline.inside(height_map.x, height_map.y[:, None]) / height_map.cell
    return np.abs(height_map.behind[..., WallColumn.DISTANCE] - KNOWN - inside) < RAW


def _without(behind: WallDistance, cells: BoolArray) -> WallDistance:
    return np.where(cells[..., None], np.float32(0.0), behind)


def _nominal_within_raw_side(part: HeightMap, nominal: HeightMap) -> BoolArray:
    """Cells at a side of the blank that no tool has touched although the nominal part ends before it."""
    own, walls = _raw_sides(part) & ~_raw_sides(nominal), nominal.behind
    return (
        own
        & (walls[..., WallColumn.DISTANCE] > KNOWN)
        & (walls[..., WallColumn.LOWEST] <= part.behind[..., WallColumn.LOWEST] + part.cell)
    )


def _both_slope(part: HeightMap, nominal: HeightMap) -> BoolArray:
    """Where both are known to be a slope, of which heights tell all."""
    return (part.behind[..., WallColumn.DISTANCE] == KNOWN) & (
        nominal.behind[..., WallColumn.DISTANCE] == KNOWN
    )


def steepness(heights: FloatArray, cell: float) -> FloatArray:
    """Steepest slope from each cell to a neighbour, shape (ny, nx)."""
    result = np.zeros_like(heights)
    for axis in (0, 1):
        step = np.abs(np.diff(heights, axis=axis)) / cell
        before = [(0, 0), (0, 0)]
        after = [(0, 0), (0, 0)]
        before[axis], after[axis] = (1, 0), (0, 1)
        slope = np.maximum(np.pad(step, before), np.pad(step, after))
        result = np.hypot(result, slope)
    return result
