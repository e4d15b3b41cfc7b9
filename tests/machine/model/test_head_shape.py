"""What is above the holder, of heads that stand and of heads that swivel."""

import mujoco
import numpy as np
import pytest

from tests.cutting.conftest import samples as standing
from twin.cutting.tool_motion import tool_motion
from twin.files.shipped import machine_file
from twin.job.job_file import ToolTable
from twin.machine.description.kinematics import part_carrier
from twin.machine.load import read_machine
from twin.machine.model.head_shape import HeadSolid
from twin.machine.model.model import MachineModel
from twin.units import MM

TOOL = ToolTable(number=1, diameter=12.0, length=100.0)


def solids_of(name: str) -> dict[str, HeadSolid]:
    head = MachineModel(read_machine(machine_file(name)), TOOL).head
    return {solid.name: solid for solid in head.above_tip(TOOL)}


def test_what_carries_a_swivel_head_is_held_against_the_stock_too() -> None:
    solids = solids_of("mill5h")
    assert set(solids) == {"holder's flange", "spindle nose", "spindle housing", "swivel", "head"}
    head = solids["head"]
    # The swivel B is between it and the spindle; the housing goes with the spindle.
    assert (head.beyond, solids["spindle housing"].beyond) == ((3,), ())
    # 55 mm above the nose, which is 100 mm above the tip; 140 mm to 500 mm behind the spindle's axis.
    assert head.above == pytest.approx(155.0)
    assert head.half == pytest.approx((180.0, 180.0))
    assert head.offset == pytest.approx((0.0, 320.0))


def test_only_what_turns_with_the_spindle_is_round() -> None:
    """A tri-dexel stock lets round solids lean with the tool, and looks at no box."""
    round_ones = {name for name, solid in solids_of("mill5h").items() if solid.round}
    assert round_ones == {"holder's flange", "spindle nose", "spindle housing"}


@pytest.mark.parametrize("name", ["mill4", "mill4_light", "mill4a", "mill5"])
def test_a_head_that_stands_ends_at_its_slide(name: str) -> None:
    solids = solids_of(name)
    assert "head" in solids
    assert not any(solid.startswith("gantry") for solid in solids)
    # What carries the head on its slide does not go up and down with it.
    assert {solid.beyond for solid in solids.values()} == (
        {(), (2,)} if name == "mill4_light" else {()}
    )


@pytest.mark.parametrize("name", ["mill4_light", "mill5h"])
def test_what_carries_the_tool_is_where_the_model_has_it(name: str) -> None:
    """Middles of all solids, seen from the part, as MuJoCo's own bodies have them at random joints."""
    machine = read_machine(machine_file(name))
    whole = MachineModel(machine, TOOL)
    model, axes = whole.solids, len(machine.axes)
    frame = machine.part_frame.at(np.zeros(axes), TOOL.length)
    data, generator = mujoco.MjData(model), np.random.default_rng(4)
    joints = np.vstack([np.zeros(axes), generator.uniform(-80.0, 80.0, (8, axes))])
    solids = whole.head.above_tip(TOOL)
    none = np.zeros(len(joints), np.bool_)
    beyond = {solid.beyond for solid in solids if solid.beyond}
    motion = tool_motion(standing(joints), joints, frame, 20.0, none, none, beyond)
    in_model, found = np.zeros((2, len(joints), len(solids), 3))
    for row, position in enumerate(joints):
        for axis, value in zip(machine.axes.names, position * machine.joint_scale, strict=True):
            data.joint(machine.axis(axis).joint).qpos = value
        mujoco.mj_forward(model, data)
        table = data.body(part_carrier(model))
        for at, solid in enumerate(solids):
            off = data.geom(solid.name).xpos - table.xpos
            in_model[row, at] = table.xmat.reshape(3, 3).T @ off / MM
            places = motion.ends.carrying(solid)[row : row + 1]
            assert places.axis is not None
            x, z = places.turn[0], places.axis[0]
            middle = (*solid.offset, solid.above + solid.height / 2.0)
            found[row, at] = places.tip[0] + middle @ np.stack([x, np.cross(z, x), z])
    # The part's frame and that of the table's body are parallel.
    assert found - found[0, 0] == pytest.approx(in_model - in_model[0, 0], abs=1e-6)
