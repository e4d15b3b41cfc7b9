"""The cutting force on the axes: what the tool is pushed with, seen from the machine."""

import math

import numpy as np
import pytest

from tests.cutting.conftest import Motion
from tests.five_axes import FIRST_LENGTH, on_machine, trunnion
from twin.cutting.axis_load import AxisLoad
from twin.cutting.cut import Cutter
from twin.cutting.program_summary import ProgramSummary
from twin.errors import ConfigError
from twin.job.job_file import StockTable, ToolTable
from twin.toolpath.part_frame import PartFrame
from twin.toolpath.tool_plan import ToolPlan

FRAME = PartFrame(rotary=3, center=(5.0, -3.0), turn_zero=20.0)
ZERO = np.array([5.0, -3.0, 0.0, 20.0])
TOOL = ToolTable(number=1, diameter=8.0, teeth=3, speed=4000.0)
SUMMARY = ProgramSummary(tools=ToolPlan((TOOL,)))
DISC = StockTable(shape="cylinder", diameter=120.0, height=20.0, cell=0.2, material="C45")


def test_turning_the_table_alone_loads_it_by_force_times_radius(samples: Motion) -> None:
    radius, count = 45.0, 4000
    motion = np.tile(ZERO + np.array([radius, 0.0, -2.0, 0.0]), (count, 1))
    motion[:, 3] += np.linspace(0.0, 120.0, count)
    load = AxisLoad(DISC, SUMMARY, FRAME, ZERO)
    half = count // 2
    loads = np.concatenate([load(samples(motion[part]).setpoint)
                            for part in (slice(0, half), slice(half, None))])  # fmt: skip
    cutting = loads[1500:3500].mean(axis=0)
    # The tool travels around the part towards +Y of the machine: a slot holds it back along -Y
    # and pushes it to the left, towards the axis of rotation.
    assert cutting[1] < -10.0
    assert cutting[0] < -50.0
    assert cutting[3] == pytest.approx(radius * 1e-3 * cutting[1], rel=1e-6)
    assert np.all(loads[:, 2] <= 1e-9)


def test_loads_are_the_forces_on_the_part_turned_back(samples: Motion) -> None:
    time = np.linspace(0.0, 1.0, 3000)
    motion = ZERO + np.stack(
        [30 * np.cos(3 * time), 25 * np.sin(2 * time), -1 - time, 70 * time], axis=1
    )
    load = AxisLoad(DISC, SUMMARY, FRAME, ZERO)(samples(motion).setpoint)
    cutter = Cutter(DISC, TOOL, FRAME, ZERO)
    cutter.add(samples(motion), np.zeros(len(motion), np.bool_))
    np.testing.assert_allclose(
        np.hypot(load[:, 0], load[:, 1]), np.hypot(cutter.force[:, 0], cutter.force[:, 1])
    )
    np.testing.assert_allclose(load[:, 2], cutter.force[:, 2])
    middle = 1500
    turned = math.radians(motion[middle, 3] - FRAME.turn_zero)
    across = cutter.force[middle, :2] @ [math.cos(turned), math.sin(turned)]
    assert load[middle, 0] == pytest.approx(across)
    assert np.abs(load[:, 0]).max() > 50.0


def test_what_cannot_be_reckoned_is_refused() -> None:
    bare = DISC.model_copy(update={"material": None})
    with pytest.raises(ConfigError, match=r"stock\.material"):
        AxisLoad(bare, SUMMARY, FRAME, ZERO)
    idle = ProgramSummary(tools=ToolPlan((ToolTable(number=1),)))
    with pytest.raises(ConfigError, match="spindle speed"):
        AxisLoad(DISC, idle, FRAME, ZERO)


def test_on_five_axes_the_loads_do_the_work_of_the_force(samples: Motion) -> None:
    """Virtual work: what all axes do is the force along the path of the tip over the part."""
    setup = on_machine(trunnion())
    frame = PartFrame(None, (0.0, 0.0), chain=setup.chain).at(setup.zero, FIRST_LENGTH)
    tool = TOOL.model_copy(update={"length": FIRST_LENGTH})
    summary = ProgramSummary(tools=ToolPlan((tool,)), tilts=True)
    stock = StockTable(shape="box", size=(60.0, 60.0, 20.0), cell=0.5, material="C45")
    share = np.linspace(0.0, 1.0, 2000)[:, None]
    begin, end = np.array([-35.0, 0.0, -2.0, 0.0, 0.0]), np.array([35.0, 4.0, -3.0, 6.0, 4.0])
    motion = samples(setup.zero + begin + share * (end - begin))
    load = AxisLoad(stock, summary, frame, setup.zero)(motion.setpoint)
    cutter = Cutter(stock, tool, frame, setup.zero, along="setpoints", tilts=True)
    cutter.add(motion, np.zeros(len(share), np.bool_))
    assert np.abs(cutter.force).max() > 50.0
    rate = np.gradient(motion.setpoint.position, axis=0)
    rate[:, 3:] *= np.deg2rad(1.0) * 1e3
    tip = np.gradient(frame.position(motion.setpoint.position), axis=0)
    np.testing.assert_allclose(
        (load * rate).sum(axis=1)[1:-1], (cutter.force * tip).sum(axis=1)[1:-1], atol=1e-3
    )


def test_a_slot_takes_the_force_that_it_takes_of_a_height_map(samples: Motion) -> None:
    time = np.linspace(-1.0, 1.0, 3000)[:, None]
    motion = ZERO + time * [70.0, 0.0, 0.0, 0.0] - [0.0, 0.0, 2.0, 0.0]
    stock = StockTable(shape="box", size=(100.0, 40.0, 20.0), cell=0.2, material="C45")
    found = []
    for tilts in (False, True):
        cutter = Cutter(stock, TOOL, FRAME, ZERO, along="setpoints", tilts=tilts)
        cutter.add(samples(motion), np.zeros(len(time), np.bool_))
        found.append(cutter.force[1000:2000].mean(axis=0))
    assert np.linalg.norm(found[1] - found[0]) < 0.02 * np.linalg.norm(found[0])
