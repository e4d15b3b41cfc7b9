"""Heights of some cells as bytes, for pages that draw the stock."""

import dataclasses
import struct
import zlib

import numpy as np
import numpy.typing as npt

from twin.cutting.heights.height_map import HeightMap
from twin.cutting.heights.sweeping import Rectangle

PATCH = 2
"""First byte of a patch."""
LEVELS = 65535
"""Heights travel as so many steps between the blank's underside and its top."""


def patch_message(
    stock: HeightMap,
    rectangle: Rectangle,
    epoch: int = 0,
    tools: npt.NDArray[np.uint8] | None = None,
) -> bytes:
    """Kind, epoch, row, column, rows, columns, then deflated the cells' levels, and the tool that cut each.

    Args:
        epoch: Grows when all that was sent is void.
        tools: Number of the tool that cut each cell of the stock, 0 where none did, shape (ny, nx);
            None: nothing is said of it.
    """
    row, row_end, column, column_end = rectangle
    heights = stock.heights[row:row_end, column:column_end]
    share = (heights - stock.bottom) / (stock.top - stock.bottom)
    levels = np.rint(LEVELS * np.clip(share, 0.0, 1.0)).astype("<u2")
    head = struct.pack("<BxxxIHHHH", PATCH, epoch, row, column, *levels.shape)
    by = b"" if tools is None else tools[row:row_end, column:column_end].tobytes()
    return head + zlib.compress(levels.tobytes() + by, 1)


def grid_of(stock: HeightMap) -> dict[str, object]:
    """What a page must know of a height map to draw it: lengths in mm."""
    return {
        "origin": stock.origin,
        "cell": stock.cell,
        "rows": stock.heights.shape[0],
        "columns": stock.heights.shape[1],
        "bottom": stock.bottom,
        "top": stock.top,
        "outline": dataclasses.asdict(stock.outline),
    }
