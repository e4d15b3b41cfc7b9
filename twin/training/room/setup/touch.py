"""How near the end of a stopped tool is to the part as it has been cut so far."""

import math
from typing import NamedTuple

import numpy as np

from twin.cutting.heights.height_map import HeightMap
from twin.nc.canonical import FloatArray

CONTACT_MM = 0.02
"""Distance at which the feeler lamp is lit [mm]: a strip of paper drags."""
_CELLS_NEAR = 1.5
"""So many cells the middle of one may lie behind the edge of the blank that it belongs to."""
FAR_MM = 1e3
"""Farther than anything that is asked for [mm]."""


class Touch(NamedTuple):
    """Where a tool's end is relative to the part.

    Attributes:
        gap: Between the two; negative: so deep the end is in the material [mm].
        away: Unit vector out of the material, seen from the part; zero where the end is above it.
    """

    gap: float
    away: tuple[float, float] = (0.0, 0.0)

    @property
    def meets(self) -> bool:
        """Whether paper would drag between them."""
        return self.gap <= CONTACT_MM


def touch(stock: HeightMap, tip: FloatArray, diameter: float) -> Touch:
    """Hold an upright cylinder against a part: exact on the blank's own faces, to half a cell on what was cut.

    Args:
        tip: Middle of the cylinder's lower end, seen from the part, shape (3,) [mm].
        diameter: Of the cylinder [mm].
    """
    x, y, z = (float(value) for value in tip)
    radius = 0.5 * diameter
    edge = np.ravel(stock.outline.snap(np.array([x]), np.array([y])))
    beside = math.hypot(x - edge[0], y - edge[1]) - radius
    outside = max(beside, z - stock.top)
    if outside > CONTACT_MM:
        return Touch(outside)
    slack = _CELLS_NEAR * stock.cell
    cells, across, along = _around(stock, x, y, radius + slack)
    distance = np.hypot(across, along)
    high = cells > max(z - CONTACT_MM, stock.bottom)
    near = high & (distance <= radius + slack)
    if not near.any():
        return Touch(FAR_MM)
    side = float(distance[near].min()) - radius
    if side - slack <= beside:
        side, gap = beside, np.array([x, y]) - edge
    else:
        side, gap = side - 0.5 * stock.cell, -np.array([across[near].mean(), along[near].mean()])
    top = z - float(cells[near].max())
    length = math.hypot(*gap)
    if top >= side or not length:
        return Touch(max(top, side))
    return Touch(side, (float(gap[0]) / length, float(gap[1]) / length))


def _around(
    stock: HeightMap, x: float, y: float, reach: float
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """The cells about a place, and how far their middles are from it along X and Y [mm]."""
    spans = []
    for place, first, count in zip((y, x), stock.origin[::-1], stock.heights.shape, strict=True):
        middle = (place - first) / stock.cell
        low = max(0, math.floor(middle - reach / stock.cell))
        spans.append(slice(low, min(count, math.ceil(middle + reach / stock.cell) + 1)))
    rows, columns = (np.arange(span.start, max(span.start, span.stop)) for span in spans)
    along, across = np.meshgrid(
        stock.origin[1] + rows * stock.cell - y,
        stock.origin[0] + columns * stock.cell - x,
        indexing="ij",
    )
    return stock.heights[spans[0], spans[1]], across, along
