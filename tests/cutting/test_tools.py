import math

import numpy as np
import pytest

from tests.cutting.conftest import Motion
from twin.cutting.cut import Cutter
from twin.cutting.tools import default_cell, profile
from twin.errors import ConfigError
from twin.job.job_file import StockTable, ToolTable
from twin.toolpath.part_frame import PartFrame
from twin.toolpath.tool_plan import ToolPlan

FRAME = PartFrame(rotary=None, center=(0.0, 0.0))
PLATE = StockTable(shape="box", size=(60.0, 40.0, 12.0), cell=0.05)
FLAT = ToolTable(number=1, diameter=8.0)
BALL = ToolTable(number=2, kind="ball", diameter=8.0)
BULL = ToolTable(number=3, kind="bull", diameter=8.0, corner=1.5)
DRILL = ToolTable(number=4, kind="drill", diameter=8.0)
CHAMFER = ToolTable(number=5, kind="chamfer", diameter=8.0, tip=1.0)


def removed(tool: ToolTable, samples: Motion, *points: tuple[float, float, float]) -> float:
    cutter = Cutter(PLATE, tool, FRAME, np.zeros(3))
    cutter.add(samples(np.array(points)), np.zeros(len(points), np.bool_))
    return cutter.result().removed_mm3


def section(tool: ToolTable, depth: float) -> float:
    """Area of the groove that a tool leaves, by fine summation of its profile [mm²]."""
    across = np.linspace(-tool.diameter / 2, tool.diameter / 2, 200_001)
    return float(np.maximum(depth - profile(tool).height(np.abs(across)), 0).mean() * tool.diameter)


def revolved(tool: ToolTable, depth: float) -> float:
    """Volume of the hole that a plunge leaves [mm³]."""
    radius = np.linspace(0, tool.diameter / 2, 200_001)
    ring = 2 * math.pi * radius * np.maximum(depth - profile(tool).height(radius), 0)
    return float(ring.mean() * tool.diameter / 2)


@pytest.mark.parametrize("tool", [FLAT, BALL, BULL, DRILL, CHAMFER], ids=lambda tool: tool.kind)
@pytest.mark.parametrize("depth", [2.0, 7.0])
def test_slot_and_hole_have_the_tools_form(tool: ToolTable, depth: float, samples: Motion) -> None:
    hole = removed(tool, samples, (0.0, 0.0, 5.0), (0.0, 0.0, -depth))
    assert hole == pytest.approx(revolved(tool, depth), rel=0.01)
    slot = removed(tool, samples, (-10.0, 0.0, -depth), (10.0, 0.0, -depth))
    assert slot == pytest.approx(20.0 * section(tool, depth) + revolved(tool, depth), rel=0.01)


def test_closed_forms() -> None:
    cone = math.pi * 16.0 * (4.0 / math.tan(math.radians(59.0))) / 3
    drilled = math.pi * 16.0 * 5.0 - 2 * cone
    assert revolved(DRILL, 5.0) == pytest.approx(drilled, rel=1e-4)
    assert revolved(BALL, 4.0) == pytest.approx(2 / 3 * math.pi * 64.0, rel=1e-4)
    quarter = 1.5**2 * (1 - math.pi / 4)
    assert section(BULL, 3.0) == pytest.approx(8.0 * 3.0 - 2 * quarter, rel=1e-4)
    assert section(CHAMFER, 3.5) == pytest.approx(8.0 * 3.5 - 3.5**2, rel=1e-4)


@pytest.mark.parametrize("tool", [BULL, DRILL, CHAMFER], ids=lambda tool: tool.kind)
def test_ramp_is_the_sum_of_small_level_steps(tool: ToolTable, samples: Motion) -> None:
    ends = np.array([[-8.0, 0.0, 0.0], [8.0, 0.0, -5.0]])
    ramp = removed(tool, samples, *map(tuple, ends))
    steps = np.linspace(ends[0], ends[1], 400)
    steps = np.stack([np.repeat(steps[:, 0], 2)[1:], 0 * steps[:-1, 0].repeat(2)[:1].repeat(799),
                      np.repeat(steps[:, 2], 2)[:-1]], 1)  # fmt: skip
    assert ramp == pytest.approx(removed(tool, samples, *map(tuple, steps)), rel=0.01)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"kind": "bull"}, "needs corner"),
        ({"corner": 1.0}, "needs corner"),
        ({"kind": "bull", "corner": 6.0}, "at most half"),
        ({"angle": 90.0}, "drill"),
        ({"tip": 2.0}, "chamfer"),
        ({"kind": "chamfer", "tip": 10.0}, "smaller"),
        ({"free_length": 99.0}, "at most the length"),
    ],
)
def test_impossible_tools_are_refused(change: dict[str, object], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        ToolTable.model_validate({"number": 1, "diameter": 10.0, **change})


def test_tools_change_between_moves(samples: Motion) -> None:
    plan = ToolPlan((FLAT, DRILL), (0, 5))
    cutter = Cutter(PLATE, plan, FRAME, np.zeros(3))
    motion = np.array([[-20.0, 0, 5], [-20, 0, -3], [-20, 0, 5], [20, 0, 5], [20, 0, -3]])
    lines = np.array([1, 2, 3, 7, 8])  # the move is the line less one
    cutter.add(samples(motion, lines), np.zeros(5, np.bool_))
    expected = revolved(FLAT, 3.0) + revolved(DRILL, 3.0)
    assert cutter.tool is DRILL
    assert cutter.result().removed_mm3 == pytest.approx(expected, rel=0.01)
    both = plan.runs(np.array([-1, 0, 4, 5, 9]))
    assert [(run.start, run.stop, tool.kind) for run, tool in both] == [
        (0, 3, "flat"),
        (3, 5, "drill"),
    ]
    thin = ToolTable(number=9, diameter=3.0)
    plate = StockTable(shape="box", size=(100.0, 80.0, 10.0))
    assert default_cell([FLAT, thin], plate) == pytest.approx(0.15)
    wide = ToolTable(number=9, diameter=40.0)
    small = StockTable(shape="box", size=(10.0, 8.0, 10.0))
    assert default_cell([wide], plate) == pytest.approx(2.0)
    assert default_cell([wide], small) == pytest.approx(0.2)


def test_holder_and_shank_in_the_material_are_gouges(samples: Motion) -> None:
    short = ToolTable(number=1, diameter=6.0, flute=20.0, free_length=4.0, holder=30.0, length=40.0)
    motion = np.array([[-60.0, 0.0, -6.0], [0.0, 0.0, -6.0]])
    motion = np.linspace(motion[0], motion[1], 200)
    cutter = Cutter(PLATE.model_copy(update={"cell": 0.2}), short, FRAME, np.zeros(3))
    cutter.add(samples(motion, 3), np.zeros(200, np.bool_))
    (gouge,) = cutter.result().gouges
    assert gouge.what == "holder"
    assert gouge.depth_mm == pytest.approx(2.0)
    assert gouge.position[0] == pytest.approx(-45.0, abs=2.0), "the holder's rim meets the plate"
    thick = ToolTable(number=1, diameter=6.0, flute=4.0, shank=10.0, length=60.0)
    cutter = Cutter(PLATE.model_copy(update={"cell": 0.2}), thick, FRAME, np.zeros(3))
    cutter.add(samples(motion, 3), np.zeros(200, np.bool_))
    assert {gouge.what for gouge in cutter.result().gouges} == {"shank"}


def test_unknown_material_lists_the_known() -> None:
    stock = PLATE.model_copy(update={"material": "cheese"})
    with pytest.raises(ConfigError, match=r"'cheese' is not known: there are 1\.4301"):
        Cutter(stock, FLAT, FRAME, np.zeros(3))
