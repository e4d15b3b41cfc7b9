"""Colours of the part: raw surface, machined surface, deviation."""

import numpy as np
import numpy.typing as npt

from twin.cutting.heights.height_map import HeightMap
from twin.nc.canonical import FloatArray

RAW_RGB = (112, 118, 126)
"""The blank's own surface, dark as rolled steel: what was machined stands out."""
MACHINED_RGB = (196, 200, 206)
"""Where a tool went."""
UNMEASURED_RGB = (170, 170, 170)

DEVIATION_STOPS = (
    (-1.0, (33, 72, 178)),
    (-0.5, (86, 170, 220)),
    (0.0, (120, 190, 110)),
    (0.5, (245, 205, 70)),
    (1.0, (200, 40, 30)),
)
"""From too deep (blue) over right (green) to left standing (red), in shares of the scale."""

Colours = npt.NDArray[np.uint8]


def surface_colours(height_map: HeightMap) -> Colours:
    """Raw where the blank's own surface is untouched, machined elsewhere, shape (ny, nx, 3)."""
    machined = height_map.machined()
    return np.where(machined[..., None], MACHINED_RGB, RAW_RGB).astype(np.uint8)


def deviation_colours(deviation_mm: FloatArray, scale_mm: float) -> Colours:
    """Colours of deviations from -scale to scale; grey where there is none, shape (..., 3).

    Args:
        deviation_mm: Any shape [mm]; NaN for unmeasured.
        scale_mm: Deviation that has the last colour [mm].
    """
    share = np.nan_to_num(deviation_mm / scale_mm)
    places = [place for place, _ in DEVIATION_STOPS]
    channels = [
        np.interp(share, places, [colour[channel] for _, colour in DEVIATION_STOPS])
        for channel in range(3)
    ]
    colours = np.stack(channels, axis=-1)
    measured = np.isfinite(deviation_mm)[..., None]
    return np.where(measured, np.round(colours), UNMEASURED_RGB).astype(np.uint8)
