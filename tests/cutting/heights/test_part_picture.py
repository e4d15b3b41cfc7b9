"""The picture of the part against the height map that it shows."""

import io

import numpy as np
from PIL import Image

from twin.cutting.heights.height_map import HeightMap, blank
from twin.cutting.heights.part import part_picture
from twin.job.job_file import StockTable


def height_map(
    size: tuple[float, float, float] = (40.0, 20.0, 10.0), cell: float = 0.5
) -> HeightMap:
    return blank(StockTable(shape="box", size=size), np.zeros(3), cell)


def pixels(part: HeightMap) -> np.ndarray:
    return np.asarray(Image.open(io.BytesIO(part_picture(part))))


def test_where_a_tool_went_is_bright_with_y_up() -> None:
    part = height_map()
    part.heights[-10:, :20] -= 2.0  # a quarter at the upper left
    picture = pixels(part)
    height, width = picture.shape[:2]
    assert abs(width / height - 2.0) < 0.05
    upper_left = picture[height // 8, width // 8, :3].mean()
    lower_right = picture[-height // 8, -width // 8, :3].mean()
    assert upper_left > lower_right + 50.0


def test_what_was_cut_through_is_clear() -> None:
    part = height_map()
    part.heights[15:25, 35:45] = part.bottom
    picture = pixels(part)
    height, width = picture.shape[:2]
    assert picture[height // 2, width // 2, 3] == 0
    assert picture[2, 2, 3] == 255


def test_large_maps_are_thinned_and_a_single_cell_is_drawn() -> None:
    assert max(pixels(height_map((400.0, 300.0, 10.0), 0.2)).shape) <= 640
    assert pixels(height_map((1.0, 1.0, 1.0), 1.0)).shape[2] == 4
