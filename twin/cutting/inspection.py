"""How far the machined part is from what it should be."""

import dataclasses
from typing import Any

import numpy as np

from twin.cutting.height_map import HeightMap
from twin.cutting.outline import BoolArray
from twin.errors import ConfigError
from twin.nc.canonical import FloatArray
from twin.units import UM_PER_MM

STEEPEST = 1.0
"""Slope above which a height says nothing of the distance between surfaces: a wall that is
displaced by a hair's breadth differs by its whole height."""


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Inspection:
    """What measuring the part found; positive deviations are material left standing."""

    deviation_mm: FloatArray
    """Distance of the part's surface from the nominal one over each cell, shape (ny, nx) [mm];
    NaN where either is steep, where there is no part, and on the blank's own skin."""
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
            f"±{self.tolerance_um:g} µm"
        )

    def as_json(self) -> dict[str, Any]:
        """Figures for a report: max, min, mean and rms [µm], shares of cells."""
        here = UM_PER_MM * self.deviation_mm[self.measured]
        volumes = {"standing_mm3": self.standing_mm3, "missing_mm3": self.missing_mm3}
        if not len(here):
            return {"measured_share": 0.0, **volumes}
        return {
            **volumes,
            "measured_share": float(self.measured.mean()),
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
        part: The machined part.
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
    steepness = np.maximum(_steepness(part), _steepness(nominal))
    gentle = (steepness <= STEEPEST) & part.solid() & nominal.solid()
    touched = part.machined() | nominal.machined()
    cosine = 1.0 / np.sqrt(1.0 + _steepness(nominal) ** 2)
    deviation = (part.heights - nominal.heights) * cosine
    off = (part.heights - nominal.heights) * part.cell**2
    return Inspection(
        deviation_mm=np.where(gentle & touched, deviation, np.nan),
        tolerance_um=tolerance_um,
        standing_mm3=float(off.clip(min=0.0).sum()),
        missing_mm3=float((-off).clip(min=0.0).sum()),
    )


def _steepness(height_map: HeightMap) -> FloatArray:
    """Steepest slope from each cell to a neighbour, shape (ny, nx)."""
    heights = height_map.heights
    result = np.zeros_like(heights)
    for axis in (0, 1):
        step = np.abs(np.diff(heights, axis=axis)) / height_map.cell
        before = [(0, 0), (0, 0)]
        after = [(0, 0), (0, 0)]
        before[axis], after[axis] = (1, 0), (0, 1)
        slope = np.maximum(np.pad(step, before), np.pad(step, after))
        result = np.hypot(result, slope)
    return result
