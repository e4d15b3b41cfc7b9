import math

import numpy as np
import pytest

from tests.cutting.conftest import Motion
from twin.cutting.cut import Cutter
from twin.cutting.force import MATERIALS
from twin.cutting.ledger import BINS
from twin.job import StockTable, ToolTable
from twin.toolpath.part_frame import PartFrame

FRAME = PartFrame(rotary=None, center=(0.0, 0.0))


def shoulder(samples: Motion, width: float, feed: float) -> Cutter:
    """Cut a shoulder of a given width, 4 mm deep, along the edge of a plate."""
    stock = StockTable(shape="box", size=(60.0, 40.0, 12.0), cell=0.1, material="C45")
    tool = ToolTable(number=1, diameter=10.0, teeth=4, speed=3000.0)
    cutter = Cutter(stock, tool, FRAME, np.zeros(3))
    x = np.arange(-40.0, 40.0, feed / 60.0 * 1e-3)
    motion = np.stack([x, np.full(len(x), 25.0 - width), np.full(len(x), -4.0)], 1)
    cutter.add(samples(motion, 5), np.zeros(len(x), np.bool_))
    return cutter


@pytest.mark.parametrize("width", [2.0, 5.0])
def test_force_follows_kienzle(width: float, samples: Motion) -> None:
    feed = 1200.0
    cutter = shoulder(samples, width, feed)
    per_tooth = feed / (3000.0 * 4)
    engaged = math.acos(1 - 2 * width / 10.0)
    chip = 2 * width / 10.0 * per_tooth / engaged
    steel = MATERIALS["C45"]
    power = steel.kc * chip**-steel.mc * width * 4.0 * feed / 60.0 / 1000.0
    speed = math.pi * 10.0 * 3000.0 / 60.0 / 1000.0
    result = cutter.result()
    assert result.power_w == pytest.approx(power, rel=0.1)
    assert result.force_n == pytest.approx(power / speed, rel=0.1)
    (block,) = result.blocks.values()
    assert block.width_mm == pytest.approx(width, rel=0.1)
    assert block.depth_mm == 4.0
    assert block.removed_mm3 == pytest.approx(result.removed_mm3)
    assert block.removed_mm3 == pytest.approx(60.0 * width * 4.0, rel=0.02)


def test_without_material_or_speed_no_force_is_made_up(samples: Motion) -> None:
    stock = StockTable(shape="box", size=(60.0, 40.0, 12.0), material="C45")
    cutter = Cutter(stock, ToolTable(number=1), FRAME, np.zeros(3))
    cutter.add(samples(np.array([[-40.0, 0, -2], [40, 0, -2]])), np.zeros(2, np.bool_))
    assert cutter.result().force_n is None
    assert cutter.result().as_json()["blocks"][0]["force_n"] is None


def test_removal_over_time_adds_up_in_bounded_memory(samples: Motion) -> None:
    cutter = shoulder(samples, 2.0, 60.0)
    result = cutter.result()
    assert sum(result.removed_over_time) == pytest.approx(result.removed_mm3)
    assert len(result.removed_over_time) <= BINS
    assert result.bin_s * (len(result.removed_over_time) - 1) <= 80.0
    # The plate is 60 mm long: the tool meets it at -35 and leaves it at 30, at 1 mm/s.
    cutting = np.flatnonzero(np.array(result.removed_over_time) > 0)
    assert cutting[0] * result.bin_s == pytest.approx(6.0, abs=2 * result.bin_s + 1)
    assert cutting[-1] * result.bin_s == pytest.approx(70.0, abs=2 * result.bin_s + 1)
