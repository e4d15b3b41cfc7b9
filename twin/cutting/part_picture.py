"""The part from above as a picture, lit from the left: without OpenGL, so that every report has one."""

import io

import numpy as np
from PIL import Image

from twin.cutting.colours import surface_colours
from twin.cutting.height_map import HeightMap

_LONGEST = 640
"""Pixels of the picture's longer side."""
_LIGHT = np.array([-0.45, 0.45, 0.77])
"""Towards the light, of length 1: from the upper left, as drawings are lit."""
_AMBIENT = 0.35
_DEEP = 0.25
"""How much darker the lowest place is than the highest, as a share."""


def part_picture(height_map: HeightMap) -> bytes:
    """A PNG of the part from above, +X to the right and +Y up; where there is no material it is clear."""
    step = max(1, -(-max(height_map.heights.shape) // _LONGEST))
    heights = height_map.heights[::step, ::step]
    slope_y, slope_x = (
        np.gradient(heights, height_map.cell * step)
        if min(heights.shape) > 1
        else (np.zeros_like(heights),) * 2
    )
    normal = np.stack([-slope_x, -slope_y, np.ones_like(heights)], axis=-1)
    normal /= np.linalg.norm(normal, axis=-1, keepdims=True)
    light = _AMBIENT + (1.0 - _AMBIENT) * np.clip(normal @ _LIGHT, 0.0, 1.0) / _LIGHT[2]
    depth = (height_map.top - heights) / max(height_map.top - height_map.bottom, 1e-9)
    shade = np.clip(light * (1.0 - _DEEP * np.clip(depth, 0.0, 1.0)), 0.0, 1.15)
    colours = surface_colours(height_map)[::step, ::step] * shade[..., None]
    solid = height_map.solid()[::step, ::step]
    pixels = np.dstack([np.clip(colours, 0.0, 255.0), np.where(solid, 255.0, 0.0)])
    image = Image.fromarray(pixels[::-1].astype(np.uint8), "RGBA")
    larger = max(1, _LONGEST // max(image.size))
    image = image.resize((image.width * larger, image.height * larger), Image.Resampling.NEAREST)
    file = io.BytesIO()
    image.save(file, "PNG")
    return file.getvalue()
