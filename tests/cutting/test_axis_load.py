"""The cutting force on the axes: what the tool is pushed with, seen from the machine."""

import math

import numpy as np
import pytest

from tests.cutting.conftest import Motion
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
