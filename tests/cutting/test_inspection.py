import json
import math
from pathlib import Path

import numpy as np
import pytest
import trimesh
from trimesh.visual import ColorVisuals

from tests.cutting.conftest import samples
from twin.cutting.colours import MACHINED_RGB, RAW_RGB, deviation_colours
from twin.cutting.cut import Cutter
from twin.cutting.height_map import blank
from twin.cutting.inspection import inspect
from twin.cutting.part import part_mesh, write_glb, write_stl
from twin.errors import ConfigError
from twin.job.job_file import Job, JobFile, StockTable, ToolTable
from twin.toolpath.part_frame import PartFrame

FRAME = PartFrame(rotary=None, center=(0.0, 0.0))
PLATE = StockTable(shape="box", size=(60.0, 40.0, 12.0), cell=0.25)


def slotted(offset: float, along: str = "joints") -> Cutter:
    cutter = Cutter(
        PLATE,
        ToolTable(number=1),
        FRAME,
        np.zeros(3),
        along="setpoints" if along == "setpoints" else "joints",
    )
    motion = samples(np.linspace([-50.0, 0.0, -3.0], [50.0, 0.0, -3.0], 300))
    motion.joint_position[:] += [0.0, 0.0, offset]
    cutter.add(motion, np.zeros(300, np.bool_))
    return cutter


def test_a_slot_too_deep_is_measured_and_walls_are_not() -> None:
    found = inspect(slotted(-0.03).map, slotted(-0.03, "setpoints").map, 20.0)
    figures = found.as_json()
    assert figures["min_um"] == pytest.approx(-30.0)
    assert figures["max_um"] == pytest.approx(-30.0)
    assert figures["within_share"] == 0.0
    slot = 10.0 / 40.0
    assert figures["measured_share"] == pytest.approx(slot, abs=0.03), "the skin is not measured"
    assert inspect(slotted(-0.03).map, slotted(-0.03, "setpoints").map, 31.0).as_json()[
        "within_share"
    ] == pytest.approx(1.0)
    json.dumps(figures)


def test_nothing_measured_says_so() -> None:
    part = slotted(0.0).map
    part.heights[:] = part.bottom
    assert inspect(part, part, 20.0).as_json() == {
        "measured_share": 0.0,
        "standing_mm3": 0.0,
        "missing_mm3": 0.0,
    }


def test_different_grids_are_refused() -> None:
    other = blank(PLATE.model_copy(update={"cell": 0.5}), np.zeros(3), 0.5)
    with pytest.raises(ConfigError, match="same grid"):
        inspect(slotted(0.0).map, other, 20.0)
    moved = blank(PLATE, np.array([0.1, 0.0, 0.0]), 0.25)
    with pytest.raises(ConfigError, match="same place"):
        inspect(slotted(0.0).map, moved, 20.0)


def test_part_agrees_with_a_nominal_stl(tmp_path: Path) -> None:
    cutter = slotted(0.0)
    write_stl(cutter.map, tmp_path / "nominal.stl")
    file = JobFile(program="x.nc", stock=StockTable(shape="stl", file="nominal.stl", cell=0.25))
    stock = Job(tmp_path, file).file.stock
    assert stock is not None
    assert stock.extent == pytest.approx((60.0, 40.0, 12.0))
    nominal = blank(stock, np.zeros(3), 0.25)
    figures = inspect(cutter.map, nominal, 5.0).as_json()
    assert figures["within_share"] == 1.0
    assert figures["measured_share"] > 0.2


@pytest.mark.parametrize("content", ["", "solid nothing\nendsolid", "not an STL at all"])
def test_wrong_stl_is_refused(content: str, tmp_path: Path) -> None:
    path = tmp_path / "wrong.stl"
    path.write_text(content)
    with pytest.raises(ConfigError, match=r"wrong\.stl"):
        blank(StockTable(shape="stl", file=str(path)), np.zeros(3), 1.0)
    with pytest.raises(ConfigError, match=r"none\.stl"):
        blank(StockTable(shape="stl", file=str(tmp_path / "none.stl")), np.zeros(3), 1.0)


def test_ball_stl_is_draped_to_its_formula(tmp_path: Path) -> None:
    trimesh.creation.icosphere(subdivisions=5, radius=10.0).export(tmp_path / "ball.stl")
    stock = StockTable(shape="stl", file=str(tmp_path / "ball.stl"), position=(1.0, 2.0, 3.0))
    draped = blank(stock, np.zeros(3), 0.1)
    cap = 2 / 3 * math.pi * 1000.0 + math.pi * 100.0 * 10.0
    assert draped.volume == pytest.approx(cap, rel=0.01)
    assert draped.top == 3.0
    assert draped.heights.max() == pytest.approx(3.0, abs=0.01)


def test_tube_keeps_its_bore() -> None:
    tube = StockTable(shape="tube", diameter=40.0, bore=20.0, height=8.0, cell=0.4)
    mesh = part_mesh(blank(tube, np.zeros(3), 0.4))
    mesh.merge_vertices()
    assert mesh.is_watertight
    assert mesh.volume == pytest.approx(math.pi * (400.0 - 100.0) * 8.0, rel=2e-3)
    with pytest.raises(ValueError, match="smaller than its diameter"):
        StockTable(shape="tube", diameter=20.0, bore=20.0, height=8.0)
    with pytest.raises(ValueError, match="needs diameter and height and bore"):
        StockTable(shape="tube", diameter=20.0, height=8.0)


def test_glb_carries_colours_in_metres(tmp_path: Path) -> None:
    cutter = slotted(0.0)
    write_glb(cutter.map, tmp_path / "part.glb")
    scene = trimesh.load_scene(tmp_path / "part.glb")
    (mesh,) = scene.geometry.values()
    assert isinstance(mesh, trimesh.Trimesh)
    np.testing.assert_allclose(scene.extents, [0.06, 0.012, 0.04], atol=1e-6)
    assert isinstance(mesh.visual, ColorVisuals)
    seen = {tuple(colour[:3].tolist()) for colour in np.asarray(mesh.visual.vertex_colors)}
    assert seen == {RAW_RGB, MACHINED_RGB}


def test_deviation_colours_run_from_blue_to_red() -> None:
    colours = deviation_colours(np.array([-9.0, 0.0, 9.0, np.nan]), 1.0).astype(int)
    assert colours[0, 2] > colours[0, 0] + 80
    assert colours[1, 1] > colours[1, 0]
    assert colours[2, 0] > colours[2, 2] + 80
    assert len(set(colours[3].tolist())) == 1
