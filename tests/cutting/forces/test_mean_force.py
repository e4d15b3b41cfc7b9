import math

import numpy as np
import pytest

from tests.cutting.conftest import Motion
from twin.cutting.cut import Cutter
from twin.cutting.forces.direction import RADIAL_SHARE
from twin.cutting.forces.materials import materials
from twin.cutting.watching.cut_log import TIME_BINS
from twin.job.job_file import StockTable, ToolTable
from twin.nc.canonical import FloatArray
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
    steel = materials()["C45"]
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


def test_the_force_of_a_block_is_no_spike(samples: Motion) -> None:
    """A slot, by a machine that is 1 µm off, in short chunks; the second block goes on in it for 0.4 mm."""
    stock = StockTable(shape="box", size=(60.0, 60.0, 12.0), material="C45")
    tool = ToolTable(number=1, diameter=8.0, teeth=3, speed=6000.0)
    cutter = Cutter(stock, tool, FRAME, np.zeros(3))
    x = np.arange(-10.0, 0.0, 800.0 / 60e3)
    way = np.stack([x, 0.3 * x, np.full(len(x), -3.0)], 1)
    way += np.random.default_rng(2).uniform(-1e-3, 1e-3, way.shape)
    line = np.where(x < -0.4, 1.0, 2.0)
    for first in range(0, len(x), 37):
        part = slice(first, first + 37)
        cutter.add(samples(way[part], line[part], first * 1e-3), np.zeros(len(x[part]), np.bool_))
    steel, feed = materials()["C45"], 800.0 * math.hypot(1.0, 0.3)
    chip = 2.0 * feed / (6000.0 * 3) / math.pi
    power = steel.kc * chip**-steel.mc * 8.0 * 3.0 * feed / 60.0 / 1000.0
    force = power / (math.pi * 8.0 * 6000.0 / 60.0 / 1000.0)
    result = cutter.result()
    assert result.blocks[2].force_n == pytest.approx(force, rel=0.1)


def towards(samples: Motion, start: tuple[float, float], end: tuple[float, float]) -> FloatArray:
    """Mean force on the tool that cuts a plate from start to end, 4 mm deep, shape (3,) [N]."""
    stock = StockTable(shape="box", size=(60.0, 40.0, 12.0), cell=0.1, material="C45")
    tool = ToolTable(number=1, diameter=10.0, teeth=4, speed=3000.0)
    cutter = Cutter(stock, tool, FRAME, np.zeros(3))
    way = np.linspace([*start, -4.0], [*end, -4.0], 3000)
    cutter.add(samples(way), np.zeros(len(way), np.bool_))
    return cutter.force[1200:1800].mean(axis=0)


def test_force_on_a_full_slot_holds_back_and_pushes_left(samples: Motion) -> None:
    for start, end in (((-20.0, 0.0), (20.0, 0.0)), ((0.0, 15.0), (0.0, -15.0))):
        ahead = np.subtract(end, start) / np.linalg.norm(np.subtract(end, start))
        force = towards(samples, start, end)
        sideways = force[:2] @ [-ahead[1], ahead[0]]
        assert force[:2] @ ahead == pytest.approx(-RADIAL_SHARE * sideways, rel=0.05)
        assert sideways > 100.0
        assert force[2] == 0.0


def test_climb_milling_pulls_and_conventional_milling_holds_back(samples: Motion) -> None:
    # Clockwise seen from above: with the material on the right the tool climbs.
    climbing = towards(samples, (-20.0, 22.0), (20.0, 22.0))
    conventional = towards(samples, (20.0, 22.0), (-20.0, 22.0))
    assert climbing[0] > 50.0, "it is pulled along, towards +X"
    assert climbing[1] > 50.0, "and away from the material"
    assert conventional[0] > 50.0, "it is held back: it travels towards -X"
    assert abs(conventional[1]) < climbing[1]


def test_a_plunge_pushes_up_with_a_drills_thrust(samples: Motion) -> None:
    stock = StockTable(shape="box", size=(30.0, 30.0, 20.0), cell=0.1, material="42CrMo4")
    tool = ToolTable(number=1, kind="drill", diameter=8.0, teeth=2, speed=1000.0)
    cutter = Cutter(stock, tool, FRAME, np.zeros(3))
    z = np.linspace(1.0, -12.0, 4000)
    way = np.stack([0 * z, 0 * z, z], 1)
    cutter.add(samples(way), np.zeros(len(way), np.bool_))
    per_turn = 13.0 / 4.0 / (1000.0 / 60.0)
    steel = materials()["42CrMo4"]
    kc = steel.kc * (per_turn / 2 * 2 / math.pi) ** -steel.mc
    thrust = kc * 8.0 / 4 * per_turn * math.sin(math.radians(59.0))
    force = cutter.force[2000:3900]
    assert force[:, 2].mean() == pytest.approx(thrust, rel=0.05)
    assert np.abs(force[:, :2]).max() == 0.0


@pytest.mark.parametrize(
    ("material", "row"),
    [
        ("C45", (3.05, 2.80, 2.60, 2.40, 2.20, 2.05)),
        ("E335", (3.05, 2.80, 2.60, 2.40, 2.20, 2.05)),
        ("42CrMo4", (4.35, 3.90, 3.45, 3.10, 2.75, 2.45)),
        ("16MnCr5", (3.75, 3.30, 2.95, 2.60, 2.30, 2.05)),
        ("EN-GJL-250", (2.05, 1.80, 1.60, 1.45, 1.30, 1.15)),
    ],
)
def test_constants_give_a_chuck_makers_table(material: str, row: tuple[float, ...]) -> None:
    """Röhm, Reference RN 1391, table 2: kc [kN/mm²] by feed at a setting angle of 45 degrees."""
    feed = np.array([0.16, 0.25, 0.4, 0.63, 1.0, 1.6])
    constants = materials()[material]
    kc = constants.kc * (feed * math.sin(math.radians(45.0))) ** -constants.mc
    np.testing.assert_allclose(kc / 1000.0, row, rtol=0.07)


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
    assert len(result.removed_over_time) <= TIME_BINS
    assert result.bin_s * (len(result.removed_over_time) - 1) <= 80.0
    # The plate is 60 mm long: the tool meets it at -35 and leaves it at 30, at 1 mm/s.
    cutting = np.flatnonzero(np.array(result.removed_over_time) > 0)
    assert cutting[0] * result.bin_s == pytest.approx(6.0, abs=2 * result.bin_s + 1)
    assert cutting[-1] * result.bin_s == pytest.approx(70.0, abs=2 * result.bin_s + 1)
