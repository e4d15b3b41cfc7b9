"""Displaced, tilted and undersized walls and floors, flat and round, at cells from 0.05 to 0.5 mm: none is missed."""

import math
from collections.abc import Iterator

import pytest

from tests.cutting.measuring.test_inspection import Shape, boss, cut_along, slot
from twin.cutting.measuring.inspection import inspect
from twin.nc.canonical import FloatArray

LENGTH = 36.0
"""Of the plate: what a tilt displaces by at its ends is half of that times the tilt [mm]."""
FARTHER = 0.35
"""Of a cell: by how much more than it is, and than the stated bound, a displacement may seem."""
TOLERANCE_UM = 20.0
DIAGONAL = 0.25 * math.pi


def defects(cell: float) -> Iterator[tuple[str, float]]:
    """Kinds and sizes [mm]."""
    for size in (0.0, 0.01, 0.03, 0.1, 0.25 * cell, 0.5 * cell, cell, 1.5 * cell, 0.5):
        yield "aside", size
    for size in (0.02, 0.05, 0.5 * cell, 1.2 * cell, -0.05, -0.8 * cell):
        yield "under", size
    for size in (0.09, 0.36):
        yield "tilt", size
    for size in (0.03, -0.03, 0.3, -0.3):
        yield "floor", size


def path(shape: Shape, angle: float, kind: str, size: float) -> FloatArray:
    """The tool's path with a defect."""
    if kind == "floor":
        points = shape(angle)
        points[points[:, 2] < 0.0, 2] -= size
        return points
    amount = size / (0.5 * LENGTH) if kind == "tilt" else size
    return shape(angle, **{kind: amount})


@pytest.mark.parametrize("shape", [slot, boss])
def test_no_displacement_is_missed_at_half_a_millimetre(shape: Shape) -> None:
    hold(shape, 0.3, 0.5)


@pytest.mark.thorough
@pytest.mark.parametrize("cell", [0.05, 0.1, 0.15, 0.2, 0.25, 0.35, 0.5])
@pytest.mark.parametrize("angle", [0.0, 0.11, 0.3, DIAGONAL, 1.2])
@pytest.mark.parametrize("shape", [slot, boss])
def test_no_displacement_is_missed(shape: Shape, angle: float, cell: float) -> None:
    hold(shape, angle, cell)


def hold(shape: Shape, angle: float, cell: float) -> None:
    """Measure every defect: never less than it is by more than the bound, nor much more."""
    nominal = cut_along(shape(angle), cell)
    for kind, size in defects(cell):
        if kind == "tilt" and shape is boss:
            continue
        found = inspect(cut_along(path(shape, angle, kind, size), cell), nominal, TOLERANCE_UM)
        figures = found.as_json()
        seen = max(figures["max_um"], -figures["min_um"]) / 1e3
        true, bound = abs(size), found.bound_mm + 1e-9
        # Along the plate's diagonal a tilted slot is longer; at its side a wall that is moved aside goes on
        # beyond the end of the right one.
        diagonal = shape is slot and angle == DIAGONAL and kind == "aside"
        most = true * (math.sqrt(2.0) if kind == "tilt" or diagonal else 1.0)
        assert true - bound <= seen <= most + bound + FARTHER * cell, (kind, size)
        if true > TOLERANCE_UM / 1e3 + bound:
            assert not found.holds, (kind, size)
