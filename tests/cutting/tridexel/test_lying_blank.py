"""Bars that lie along an axis, as a rotary table holds them."""

import math

import numpy as np
import pytest

from twin.cutting.heights import height_map
from twin.cutting.program_summary import SummaryBuilder
from twin.cutting.tridexel import blanks
from twin.cutting.tridexel.engagement import volume
from twin.errors import ConfigError
from twin.job.job_file import JobFile, StockTable


def tube(axis: str | None) -> StockTable:
    return StockTable.model_validate(
        {"shape": "tube", "diameter": 12.0, "bore": 5.0, "height": 20.0, "axis": axis}
    )


@pytest.mark.parametrize("axis", ["X", "Y", "Z", None])
def test_a_tube_lies_along_the_axis_that_it_names(axis: str | None) -> None:
    stock = tube(axis)
    part = blanks.blank(stock, np.array([3.0, -2.0, 7.0]), 0.2)
    assert volume(part) == pytest.approx(math.pi * (36.0 - 6.25) * 20.0, rel=1e-3)
    size = np.full(3, 12.0)
    size["XYZ".index(axis or "Z")] = 20.0
    np.testing.assert_allclose(np.diff(part.corners, axis=0)[0], size)
    np.testing.assert_allclose(part.corners[1], [3.0, -2.0, 7.0] + size * [0.5, 0.5, 0.0])


def test_a_program_that_cuts_it_has_no_height_map() -> None:
    assert SummaryBuilder(JobFile(program="p.nc", stock=tube("X"))).summary().tilts
    assert not SummaryBuilder(JobFile(program="p.nc", stock=tube("Z"))).summary().tilts
    with pytest.raises(ConfigError, match="lies along Y"):
        height_map.blank(tube("Y"), np.zeros(3), 0.5)


def test_a_box_has_no_axis() -> None:
    with pytest.raises(ValueError, match="axis is for shapes"):
        StockTable(shape="box", size=(1.0, 1.0, 1.0), axis="X")
