"""Walls are known closer than by whole cells: beside a way, around a turn, where a tool is drawn out."""

import itertools
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.cutting.forces.test_tooth_forces import Plate, cut, plate
from twin.cutting.kernels.walls import height_by_wall
from twin.job.job_file import ToolTable
from twin.nc.canonical import FloatArray

CELL, RADIUS, DEPTH = 0.5, 5.0, 2.0
TOOL = ToolTable(number=1, diameter=2.0 * RADIUS)
CLOSE = 0.01
"""How close to a wall the material is distinguished from the free [mm]."""


def way(*corners: tuple[float, float], depth: float = DEPTH) -> FloatArray:
    """A level way from corner to corner in steps of 0.1 mm."""
    parts: list[FloatArray] = []
    for begin, end in itertools.pairwise(corners):
        count = round(math.dist(begin, end) / 0.1) + 1
        parts.append(np.linspace(begin, end, count))
    flat = np.concatenate(parts)
    return np.column_stack([flat, np.full(len(flat), -depth)])


def height(part: Plate, x: float, y: float) -> float:
    """What is at a place, above the floor of the cut; NaN: no wall tells."""
    return height_by_wall(part.material, x, y, (x, y), -DEPTH)


def assert_wall(part: Plate, place: tuple[float, float], outwards: tuple[float, float]) -> None:
    x, y = place
    for off, expected in ((CLOSE, 0.0), (-CLOSE, -DEPTH)):
        found = height(part, x + off * outwards[0], y + off * outwards[1])
        assert found == pytest.approx(expected), (place, off)


@given(angle=st.floats(0.0, 360.0), aside=st.floats(-0.5, 0.5), share=st.floats(0.2, 0.8))
def test_beside_a_straight_way(angle: float, aside: float, share: float) -> None:
    part, turn = plate(CELL), math.radians(angle)
    ux, uy = math.cos(turn), math.sin(turn)
    begin = (-10.0 * ux - aside * uy, -10.0 * uy + aside * ux)
    end = (begin[0] + 20.0 * ux, begin[1] + 20.0 * uy)
    cut(part, TOOL, way(begin, end))
    x, y = begin[0] + 20.0 * share * ux, begin[1] + 20.0 * share * uy
    for side in (1.0, -1.0):
        outwards = (-side * uy, side * ux)
        assert_wall(part, (x + RADIUS * outwards[0], y + RADIUS * outwards[1]), outwards)


@given(turn=st.floats(20.0, 160.0), share=st.floats(0.1, 0.9))
def test_around_the_outer_side_of_a_corner(turn: float, share: float) -> None:
    part, angle = plate(CELL), math.radians(turn)
    cut(part, TOOL, way((-12.0, 0.0), (0.0, 0.0), (12.0 * math.cos(angle), 12.0 * math.sin(angle))))
    # It turns to the left: the outer side is from straight down to the right of the way ahead.
    at = share * angle - 0.5 * math.pi
    outwards = (math.cos(at), math.sin(at))
    # The polygon's corner is rounded by the step in which walls are left.
    x, y = RADIUS * outwards[0], RADIUS * outwards[1]
    assert height(part, x + 0.05 * outwards[0], y + 0.05 * outwards[1]) == 0.0
    assert height(part, x - 0.05 * outwards[0], y - 0.05 * outwards[1]) == -DEPTH


@pytest.mark.parametrize("at", [-80.0, -45.0, -10.0, 0.0, 30.0, 60.0])
def test_before_the_place_where_a_tool_is_drawn_out(at: float) -> None:
    part, angle = plate(CELL), math.radians(at)
    level = way((-12.0, 0.0), (0.0, 0.0))
    out = np.linspace(level[-1], level[-1] + [0.0, 0.0, 5.0], 51)
    cut(part, TOOL, np.concatenate([level, out[1:]]))
    outwards = (math.cos(angle), math.sin(angle))
    assert_wall(part, (RADIUS * outwards[0], RADIUS * outwards[1]), outwards)


def test_what_was_cut_further_stays() -> None:
    part = plate(CELL)
    cut(part, TOOL, way((-12.0, 0.12), (12.0, 0.12)))
    cut(part, TOOL, way((-12.0, 0.0), (12.0, 0.0)))
    assert_wall(part, (1.3, RADIUS + 0.12), (0.0, 1.0))
    assert_wall(part, (1.3, -RADIUS), (0.0, -1.0))


def test_a_tool_over_the_part_leaves_none() -> None:
    part = plate(CELL)
    cut(part, TOOL, way((-12.0, 0.0), (12.0, 0.0), depth=-1.0))
    assert not part.walls.any()
