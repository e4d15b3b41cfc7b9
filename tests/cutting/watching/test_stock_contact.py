"""What must not go into the stock: who is seen, how deep, and how finely."""

import dataclasses

import numpy as np
import pytest

from tests.cutting.conftest import Motion
from twin.cutting.cut import Cutter
from twin.job.job_file import StockTable, ToolTable
from twin.nc.canonical import FloatArray
from twin.toolpath.part_frame import PartFrame

CELL = 0.06
FRAME = PartFrame(rotary=3, center=(0.0, 0.0))
ZERO = np.zeros(4)
BLOCK = StockTable(shape="box", size=(12.0, 9.0, 60.0), cell=CELL)
TOOL = ToolTable(
    number=1, diameter=2.0, length=50.0, flute=8.0, shank=4.0, holder=10.0, free_length=20.0
)


@dataclasses.dataclass(frozen=True)
class Solid:
    """A solid of the head above the tip."""

    name: str
    round: bool
    half: tuple[float, float]
    offset: tuple[float, float]
    above: float
    height: float = 50.0
    beyond: tuple[int, ...] = ()


HEAD = (
    Solid("spindle nose", True, (12.0, 12.0), (0.0, 0.0), 30.0),
    Solid("head", False, (20.0, 30.0), (0.0, 5.0), 45.0),
)
FLANKS = {"edge": 1.0, "shank": 2.0, "holder": 5.0, "spindle nose": 12.0, "head": 20.0}
LOWER = {"edge": 0.0, "shank": 8.0, "holder": 20.0, "spindle nose": 30.0, "head": 45.0}


def past(what: str, gap: float, step: float) -> FloatArray:
    """A way past the block's +X side, its top 1 mm above the lower end of one solid."""
    y = np.arange(-9.0, 9.0, step)
    position = np.zeros((len(y), 4))
    position[:, 0] = 6.0 + FLANKS[what] + gap
    position[:, 1] = y
    position[:, 2] = -1.0 - LOWER[what]
    return position


@pytest.mark.parametrize("step", [0.05, 0.5])
@pytest.mark.parametrize("gap", [-0.065, 0.05])
@pytest.mark.parametrize("what", list(FLANKS))
def test_a_flank_in_the_part_stops_the_cut(
    samples: Motion, what: str, gap: float, step: float
) -> None:
    """By half a cell and less than 0.05 mm; and no alarm with 0.05 mm to spare."""
    cutter = Cutter(BLOCK, TOOL, FRAME, ZERO, halts=True, head=lambda _tool: HEAD)
    way = past(what, gap, step)
    for first in range(0, len(way), 50):
        part = way[first : first + 50]
        cutter.add(samples(part, 7), np.full(len(part), what == "edge"))
    if gap > 0.0:
        assert cutter.halted is None
        return
    assert cutter.halted is not None
    assert cutter.halted.what == ("rapid" if what == "edge" else what)
    assert cutter.halted.line == 7
    assert cutter.halted.depth_mm == pytest.approx(1.0, abs=1e-6)


def test_the_head_turns_against_the_part_with_the_table(samples: Motion) -> None:
    angle = np.linspace(0.0, 90.0, 400)
    away = np.zeros((400, 4))
    away[:, 0], away[:, 2], away[:, 3] = 30.0, -46.0, angle
    away[:, :2] = [0.0, -30.0]  # the head's box ends 5 + 30 mm towards +Y of the tool
    tool = TOOL.model_copy(update={"holder": 4.0, "free_length": 49.0, "shank": 2.0})
    cutter = Cutter(BLOCK, tool, FRAME, ZERO, halts=True, head=lambda _tool: HEAD[1:])
    cutter.add(samples(away[:1]), np.zeros(1, np.bool_))
    cutter.add(samples(away), np.zeros(400, np.bool_))
    assert cutter.halted is not None
    assert cutter.halted.what == "head"


def test_a_holder_that_follows_into_what_was_cut_before_is_no_alarm(samples: Motion) -> None:
    """Roughed wide in one chunk with the feeds that let the holder in: it counts as cut by then."""
    wide = ToolTable(number=1, diameter=6.0, length=40.0, flute=4.0, holder=4.0, free_length=3.0)
    x = np.linspace(-20.0, 20.0, 300)
    passes = []
    for depth in (-2.0, -4.0, -6.0):
        for y in (-6.0, -3.0, 0.0, 3.0, 6.0):
            way = np.zeros((300, 4))
            way[:, 0], way[:, 1], way[:, 2] = x, y, depth
            up = np.tile(way[-1], (60, 1))
            up[:, 2] = np.linspace(depth, 10.0, 60)
            back = np.tile([-20.0, y, 10.0, 0.0], (2, 1))
            passes += [way, up, back]
    motion = np.concatenate(passes)
    cutter = Cutter(BLOCK, wide, FRAME, ZERO, halts=True)
    cutter.add(samples(motion), np.zeros(len(motion), np.bool_))
    assert cutter.halted is None
    assert cutter.map.heights.max() == pytest.approx(-6.0)
