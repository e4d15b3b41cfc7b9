"""Boxes that go with the tool, held against a stock that is cut from any side."""

import numpy as np
import pytest

from twin.cutting.material import Points
from twin.cutting.tools import profile
from twin.cutting.tridexel.blanks import box
from twin.cutting.tridexel.boxes import Box, boxes_met
from twin.cutting.tridexel.material import TriDexelMaterial
from twin.cutting.tridexel.solids.moving_solid import Poses
from twin.job.job_file import ToolTable
from twin.machine.model.head_shape import HeadSolid
from twin.nc.canonical import FloatArray

CELL_MM = 0.5
HOUSING = Box((-30.0, -20.0, 50.0), (30.0, 40.0, 120.0))
BLOCK = box(np.array([-20.0, -20.0, -40.0]), np.array([20.0, 20.0, 0.0]), CELL_MM)


def met(tips: list[list[float]], axis: FloatArray, along_x: FloatArray) -> FloatArray:
    count = len(tips)
    poses = Poses(np.array(tips), np.tile(axis, (count, 1)))
    return boxes_met(BLOCK, poses, np.tile(along_x, (count, 1)), HOUSING)


def turned(angle: float) -> tuple[FloatArray, FloatArray]:
    """Axis and X of a tool that leans about Y [deg]."""
    sine, cosine = np.sin(np.deg2rad(angle)), np.cos(np.deg2rad(angle))
    return np.array([sine, 0.0, cosine]), np.array([cosine, 0.0, -sine])


def test_an_upright_box_is_as_deep_as_its_lower_face() -> None:
    axis, along_x = turned(0.0)
    found = met([[0, 0, 0], [0, 0, -53.0], [0, 0, -49.0]], axis, along_x)
    # The beginning of a step is the end of the one before.
    assert found == pytest.approx([3.0, 2.0])
    assert met([[0, 0, 0], [0, 0, -49.5]], axis, along_x) == pytest.approx([0.0])


def test_a_box_that_passes_within_a_step_is_seen() -> None:
    axis, along_x = turned(0.0)
    assert met([[-80.0, 0.0, -52.0], [80.0, 0.0, -52.0]], axis, along_x) == pytest.approx([2.0])


@pytest.mark.parametrize("angle", [90.0, -90.0, 37.0, -20.0])
@pytest.mark.parametrize("off", [-6.0, 4.0])
def test_a_leaning_box_meets_what_points_within_it_do(angle: float, off: float) -> None:
    axis, along_x = turned(angle)
    # The middle of its lower face is brought to the block, so far out of it along the tool's axis.
    tip = np.array([0.0, 0.0, -10.0]) + (20.0 + off - 50.0) * axis
    found = met([tip.tolist()] * 2, axis, along_x)
    grid = np.arange(-20.0 + 0.25, 20.0, 0.5)
    points = np.stack(np.meshgrid(grid, grid, grid - 20.0), -1).reshape(-1, 3) - tip
    seen = np.stack([points @ along_x, points @ np.cross(axis, along_x), points @ axis], 1)
    inside = ((seen > HOUSING.low) & (seen < HOUSING.high)).all(axis=1)
    assert (found[0] > 0.0) == bool(inside.any())


def test_the_head_and_what_carries_it_are_told_by_their_names() -> None:
    """Each where it is: the ram does not swivel, and is told from 0.05 mm on and not at 0.05 mm clearance."""
    head = [
        HeadSolid("housing", False, (30.0, 30.0), (0.0, 10.0), 50.0, 70.0),
        HeadSolid("ram", False, (30.0, 30.0), (0.0, 10.0), 90.0, 70.0, beyond=(3,)),
    ]
    tool = ToolTable(number=1, diameter=6.0, length=40.0, flute=20.0, holder=8.0)
    contact = TriDexelMaterial(BLOCK).contact(tool, profile(tool), lambda _tool: head)
    axis, along_x = turned(90.0)
    tip = np.array([[-28.0, 0.0, -10.0], [-34.0, 0.0, -10.0]])
    upright, x = turned(0.0)
    for depth in (-0.05, 0.05):
        # The ram's lower face, over the block's upper one.
        ram = np.array([[60.0, 0.0, -90.0 - depth], [10.0, 0.0, -90.0 - depth]])
        carriers = {(3,): Points(ram, np.tile(x, (2, 1)), np.tile(upright, (2, 1)))}
        points = Points(tip, np.tile(along_x, (2, 1)), np.tile(axis, (2, 1)), carriers)
        found = contact.measure(points, np.zeros(1, np.bool_))
        assert found["housing"].depth[0] > 1.0
        assert ("ram" in found) == (depth > 0.0)
    assert found["ram"].depth[0] == pytest.approx(0.05)
