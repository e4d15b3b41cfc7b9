"""Every solid that carries the tool, of machines that tilt, against a tri-dexel stock: 0.05 mm deep and 0.05 mm clear."""

import numpy as np
import pytest

from tests.cutting.conftest import samples as standing
from twin.cutting.material import Points
from twin.cutting.tool_motion import tool_motion
from twin.cutting.tools import profile
from twin.cutting.tridexel.blanks import box
from twin.cutting.tridexel.material import TriDexelMaterial
from twin.files.shipped import machine_file
from twin.job.job_file import ToolTable
from twin.machine.load import read_machine
from twin.machine.model.head_shape import HeadSolid
from twin.machine.model.model import MachineModel
from twin.nc.canonical import FloatArray

TOOL = ToolTable(number=1, diameter=12.0, length=100.0)
CELL_MM = 0.5
LOW, HIGH = np.array([-4.0, -4.0, -10.0]), np.array([4.0, 4.0, 0.0])
LEANS_DEG = 30.0
"""Of a swivel, for what it does not turn."""


def middle_below(solid: HeadSolid, points: Points) -> FloatArray:
    """The middle of a solid's lower face, seen from the part, at the first of the points."""
    places = points.carrying(solid)
    assert places.axis is not None
    x, z = places.turn[0], places.axis[0]
    return places.tip[0] + np.array([*solid.offset, solid.above]) @ [x, np.cross(z, x), z]


@pytest.mark.parametrize("name", ["mill4a", "mill5", "mill5h"])
def test_a_twentieth_into_the_stock_is_seen_and_a_twentieth_clear_is_not(name: str) -> None:
    machine = read_machine(machine_file(name))
    head, axes = MachineModel(machine, TOOL).head, machine.axes
    frame = machine.part_frame.at(np.zeros(len(axes)), TOOL.length)
    solids = head.above_tip(TOOL)
    assert {"holder's flange", "spindle nose", "head"} <= {solid.name for solid in solids}
    contact = TriDexelMaterial(box(LOW, HIGH, CELL_MM)).contact(TOOL, profile(TOOL), head.above_tip)
    none = np.zeros(2, np.bool_)
    beyond = {solid.beyond for solid in solids if solid.beyond}

    def points_at(joints: FloatArray) -> Points:
        both = np.tile(joints, (2, 1))
        return tool_motion(standing(both), both, frame, TOOL.flute, none, none, beyond).ends

    for solid in solids:
        joints = np.zeros(len(axes))
        joints[list(solid.beyond)] = LEANS_DEG
        way = [0.0, 0.0, HIGH[2]] - middle_below(solid, points_at(joints))
        for depth in (-0.05, 0.05):
            moved = joints.copy()
            moved[:3] += way - [0.0, 0.0, depth]
            found = contact.measure(points_at(moved), none[:1])
            assert (solid.name in found) == (depth > 0.0), (solid.name, depth)
            if depth > 0.0:
                assert found[solid.name].depth[0] == pytest.approx(depth, abs=1e-6)
