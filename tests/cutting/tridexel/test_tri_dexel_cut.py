"""The same cuts of a height map and of a tri-dexel stock, and what a part cut from several sides must not meet."""

import dataclasses
import itertools
import math
from pathlib import Path

import numpy as np
import pytest
import trimesh

from tests.cutting.conftest import samples
from twin.cutting.cut import Cutter
from twin.cutting.watching.cut_log import HEIGHT_MAP, TRI_DEXEL
from twin.errors import ConfigError
from twin.files.shipped import machine_file
from twin.job.job_file import StockTable, ToolTable
from twin.machine.load import read_machine
from twin.nc.canonical import BoolArray, FloatArray
from twin.toolpath.part_frame import PartFrame

LENGTH_MM = 100.0
UPRIGHT = PartFrame(rotary=3, center=(0.0, 0.0))
ZERO = np.zeros(4)
PLATE = StockTable(shape="box", size=(30.0, 20.0, 8.0), cell=0.2, material="C45")
FLAT = ToolTable(
    number=1, diameter=6.0, length=LENGTH_MM, flute=12.0, free_length=20.0, speed=3000.0
)
BAR_ZERO = np.array([-50.0, 0.0, -545.0, 0.0])
"""On the axis of A of mill4a with a tool of ``LENGTH_MM``."""


def way(*places: tuple[float, ...], step: float = 0.05) -> FloatArray:
    """Samples along straight lines between places."""
    ends = np.array(places, np.float64)
    parts = [
        np.linspace(a, b, max(2, math.ceil(np.abs(b - a).max() / step)))
        for a, b in itertools.pairwise(ends)
    ]
    return np.concatenate(parts)


def on_mill4a(length: float = LENGTH_MM) -> PartFrame:
    return read_machine(machine_file("mill4a")).part_frame.at(BAR_ZERO, length)


def bar(tool: ToolTable, *, halts: bool = True) -> Cutter:
    """A square bar of 20 mm along the axis of A."""
    stock = StockTable(shape="box", size=(30.0, 20.0, 20.0), position=(15.0, 0.0, 10.0), cell=0.2)
    return Cutter(stock, tool, on_mill4a(), BAR_ZERO, halts=halts, tilts=True)


def cut(cutter: Cutter, places: FloatArray, *, rapid: bool = False, line: int = 1) -> float:
    made = samples(places + BAR_ZERO, line=line)
    flags: BoolArray = np.full(len(places), rapid)
    return cutter.add(made, flags)


@pytest.mark.parametrize(
    "more",
    [
        {"kind": "flat"},
        {"kind": "ball"},
        {"kind": "bull", "corner": 1.0},
        {"kind": "drill"},
        {"kind": "chamfer", "tip": 1.0},
    ],
    ids=lambda more: more["kind"],
)
def test_both_agree_where_the_tool_keeps_to_z(more: dict[str, object]) -> None:
    tool = ToolTable.model_validate({**FLAT.model_dump(exclude_unset=True), **more})
    motion = way((-20, -3, -2, 0), (6, 2, -2.5, 0), (6, 2, -1, 0), (6.5, -5, -4, 0))
    results = []
    for tilts in (False, True):
        cutter = Cutter(PLATE, tool, UPRIGHT, ZERO, tilts=tilts)
        cutter.add(samples(motion), np.zeros(len(motion), np.bool_))
        results.append(cutter.result())
    one, other = results
    assert (one.stock, other.stock) == (HEIGHT_MAP, TRI_DEXEL)
    assert other.removed_mm3 == pytest.approx(one.removed_mm3, rel=5e-3)
    assert other.air_share == pytest.approx(one.air_share, abs=0.02)
    assert one.force_n is not None
    assert other.force_n == pytest.approx(one.force_n, rel=0.15)
    assert not other.gouges


@pytest.mark.seconds("twenty passes with their mesh")
def test_a_bar_is_squared_from_four_sides(tmp_path: Path) -> None:
    cutter = bar(FLAT)
    removed = 0.0
    for side in range(4):
        turn = 90.0 * side
        rows = [
            place
            for row, y in enumerate((-9.0, -5.0, 0.0, 5.0, 9.0))
            for place in ((-5.0, y, 8.0, turn), (35.0, y, 8.0, turn))[:: 1 - 2 * (row % 2)]
        ]
        removed += cut(cutter, way(*rows, step=0.5), line=side + 1)
        cut(cutter, way((35.0, 9.0, 8.0, turn), (35.0, 9.0, 30.0, turn + 90.0), step=0.5))
    assert removed == pytest.approx(30.0 * (20.0**2 - 16.0**2), rel=1e-3)
    assert cutter.halted is None
    cutter.material.write_stl(tmp_path / "part.stl", np.zeros(3))
    mesh = trimesh.load_mesh(tmp_path / "part.stl")
    assert mesh.is_watertight
    assert mesh.volume == pytest.approx(30.0 * 16.0**2, rel=1e-3)
    assert mesh.extents == pytest.approx([30.0, 16.0, 16.0], abs=2e-3)


def test_turning_the_part_at_cutting_height_is_a_rapid_into_the_stock() -> None:
    cutter = bar(FLAT)
    cut(cutter, way((-5.0, 0.0, 8.0, 0.0), (15.0, 0.0, 8.0, 0.0)))
    assert cutter.halted is None
    cut(cutter, way((15.0, 0.0, 8.0, 0.0), (15.0, 0.0, 8.0, 90.0), step=0.5), rapid=True, line=7)
    assert cutter.halted is not None
    assert (cutter.halted.what, cutter.halted.line) == ("rapid", 7)


def test_leaning_about_a_tip_at_rest_is_a_rapid_into_the_stock() -> None:
    """A swivel head turns the tool about its tip beside a block: the tip takes no way, the edge does."""
    zero = np.array([0.0, 0.0, -450.0, 0.0, 0.0])
    frame = read_machine(machine_file("mill5h")).part_frame.at(zero, LENGTH_MM)
    stock = StockTable(shape="box", size=(30.0, 20.0, 8.0), cell=0.2)
    angle = np.arange(0.0, -30.0, -0.5)
    pivot = 200.0 + LENGTH_MM
    lean = np.deg2rad(angle)
    places = np.zeros((len(angle), 5))
    places[:, 0] = 18.5 + pivot * np.sin(lean)
    places[:, 2] = -6.0 - pivot * (1.0 - np.cos(lean))
    places[:, 3] = angle
    for rapid, met in ((False, None), (True, ("rapid", 7))):
        cutter = Cutter(stock, FLAT, frame, zero, halts=True, tilts=True)
        cutter.add(samples(places + zero, line=7), np.full(len(places), rapid))
        halted = cutter.halted
        assert (None if halted is None else (halted.what, halted.line)) == met


def test_turning_beside_the_stock_is_none() -> None:
    cutter = bar(FLAT)
    cut(cutter, way((15.0, 0.0, 15.0, 0.0), (15.0, 0.0, 15.0, 360.0), step=1.0), rapid=True)
    assert cutter.halted is None
    assert not cutter.events()


@pytest.mark.parametrize("deep", [0.1, 3.0])
def test_a_holder_that_meets_a_turned_part_stops_it(deep: float) -> None:
    short = FLAT.model_copy(update={"flute": 6.0, "free_length": 6.0, "holder": 12.0})
    cutter = bar(short)
    cut(cutter, way((15.0, 0.0, 12.0, 90.0), (15.0, 0.0, 4.0 - deep, 90.0)), line=3)
    assert cutter.halted is not None
    assert (cutter.halted.what, cutter.halted.line) == ("holder", 3)
    # It is met within a stretch, which is half a radius long at most.
    assert min(deep, 0.02) < cutter.halted.depth_mm < min(deep, 1.5) + 0.02


def test_a_holder_just_above_a_turned_part_meets_nothing() -> None:
    short = FLAT.model_copy(update={"flute": 6.0, "free_length": 6.0, "holder": 12.0})
    cutter = bar(short)
    cut(cutter, way((15.0, 0.0, 12.0, 90.0), (15.0, 0.0, 4.05, 90.0)))
    assert cutter.halted is None


def test_a_longer_tool_reaches_along_its_own_axis() -> None:
    length_difference = FLAT.model_copy(update={"number": 2, "length": FLAT.length + 5.0})
    cutter = bar(FLAT)
    plan = dataclasses.replace(cutter.plan, tools=(FLAT, length_difference), first_move=(0, 1))
    cutter = Cutter(
        StockTable(shape="box", size=(30.0, 20.0, 20.0), position=(15.0, 0.0, 10.0), cell=0.2),
        plan,
        on_mill4a(),
        BAR_ZERO,
        tilts=True,
    )
    cut(cutter, way((15.0, 0.0, 20.0, 90.0), (15.0, 0.0, 13.0, 90.0)), line=2)
    assert cutter.result().removed_mm3 == pytest.approx(math.pi * 9.0 * 2.0, rel=1e-2)


def test_there_is_no_height_map_of_it() -> None:
    with pytest.raises(ConfigError, match="more than one side"):
        _ = bar(FLAT).map
