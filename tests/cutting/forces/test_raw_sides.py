"""Thin cuts on the sides of a blank that no tool has touched, at the cell that is chosen by default."""

import math
from typing import Any

import numpy as np
import pytest

from tests.cutting.forces.test_tooth_forces import FEED, STEEL, Plate, by_hand, cut
from twin.cutting.forces.cutter_form import cutter_form, force_law
from twin.cutting.heights.height_map import blank, raw_walls
from twin.cutting.kernels.teeth import ToothScratch, tooth_bench
from twin.cutting.kernels.tooth_forces import tooth_forces
from twin.cutting.tools import default_cell
from twin.job.job_file import StockTable, ToolTable
from twin.nc.canonical import FloatArray

RADIUS, DEPTH = 5.0, 3.0
TOOL = ToolTable(number=1, diameter=2.0 * RADIUS, teeth=4)
QUARTER = 0.5 * math.pi


def thoroughly(*values: float) -> list[Any]:
    return [pytest.param(value, marks=pytest.mark.thorough) for value in values]


WIDTHS = [0.1, *thoroughly(0.2, 0.5), 1.0]


def raw(stock: StockTable) -> Plate:
    uncut = blank(stock, np.zeros(3), default_cell([TOOL], stock))
    return Plate(uncut, raw_walls(uncut))


def loads(part: Plate, points: FloatArray, ahead: FloatArray) -> ToothScratch:
    cut(part, TOOL, points)
    scratch, law = tooth_bench(), force_law(TOOL, STEEL)
    tooth_forces(part.material, points[-1], FEED * ahead, cutter_form(TOOL), law, 1.0, scratch)
    return scratch


def assert_within(scratch: ToothScratch, expected: tuple[FloatArray, float, float]) -> None:
    mean, peak, torque = expected
    assert np.linalg.norm(scratch.mean) == pytest.approx(np.linalg.norm(mean), rel=0.05)
    assert scratch.figures[0] == pytest.approx(peak, rel=0.05)
    assert scratch.figures[1] == pytest.approx(torque, rel=0.05)


@pytest.mark.parametrize("size", [59.8, *thoroughly(60.0, 60.1), 60.3])
@pytest.mark.parametrize("width", WIDTHS)
@pytest.mark.parametrize("turn", range(4))
def test_a_thin_cut_on_the_side_of_a_box(size: float, width: float, turn: int) -> None:
    part = raw(StockTable(shape="box", size=(size, size, 20.0)))
    x = np.linspace(-40.0, 3.0, 431)
    way = np.column_stack(
        [x, np.full_like(x, 0.5 * size + RADIUS - width), np.full_like(x, -DEPTH)]
    )
    for _ in range(turn):
        way = np.column_stack([-way[:, 1], way[:, 0], way[:, 2]])
    ahead = (way[-1] - way[0]) / np.linalg.norm(way[-1] - way[0])
    first = -QUARTER, -math.asin(1.0 - width / RADIUS)
    assert_within(loads(part, way, ahead), by_hand(TOOL, DEPTH, *first))


@pytest.mark.parametrize("diameter", [60.0, *thoroughly(60.3)])
@pytest.mark.parametrize("width", WIDTHS)
@pytest.mark.parametrize("degrees", [20.0, 45.0, 170.0])
def test_a_thin_cut_around_a_cylinder(diameter: float, width: float, degrees: float) -> None:
    part = raw(StockTable(shape="cylinder", diameter=diameter, height=20.0))
    around = 0.5 * diameter + RADIUS - width
    angle = np.radians(np.linspace(degrees - 30.0, degrees, 301))
    way = np.column_stack(
        [around * np.cos(angle), around * np.sin(angle), np.full_like(angle, -DEPTH)]
    )
    ahead = np.array([-math.sin(angle[-1]), math.cos(angle[-1]), 0.0])
    meets = (around**2 + RADIUS**2 - 0.25 * diameter**2) / (2.0 * around * RADIUS)
    arc = QUARTER - math.acos(meets), QUARTER
    assert_within(loads(part, way, ahead), by_hand(TOOL, DEPTH, *arc))
