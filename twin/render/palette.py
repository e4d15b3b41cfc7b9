"""Colours of the contour error, on the trail and in its legend."""

import numpy as np
import numpy.typing as npt

ERROR_STOPS = ((0.0, (40, 170, 90)), (0.5, (245, 200, 40)), (1.0, (205, 25, 25)))
"""From no error to that of the scale."""


def error_palette(count: int) -> npt.NDArray[np.uint8]:
    """Colours from no error to the scale's, shape (count, 3)."""
    share = np.linspace(0.0, 1.0, count)
    stops = [stop for stop, _ in ERROR_STOPS]
    channels = [np.interp(share, stops, [rgb[i] for _, rgb in ERROR_STOPS]) for i in range(3)]
    return np.stack(channels, axis=1).round().astype(np.uint8)
