import itertools
import json
import math
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
import trimesh
from trimesh.visual import ColorVisuals

from tests.cutting.conftest import samples
from twin.cutting.cut import Cutter
from twin.cutting.heights.colours import MACHINED_RGB, RAW_RGB, deviation_colours
from twin.cutting.heights.height_map import HeightMap, blank
from twin.cutting.heights.part import part_mesh, write_glb, write_stl
from twin.cutting.measuring.inspection import inspect
from twin.cutting.measuring.nominal_from_above import nominal_map
from twin.errors import ConfigError
from twin.job.job_file import JobFile, StockTable, ToolTable
from twin.job.load import Job
from twin.nc.canonical import FloatArray
from twin.toolpath.part_frame import PartFrame

Shape = Callable[..., FloatArray]
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


def test_a_slot_too_deep_is_measured_and_the_skin_is_not() -> None:
    found = inspect(slotted(-0.03).map, slotted(-0.03, "setpoints").map, 20.0)
    figures = found.as_json()
    assert figures["min_um"] == pytest.approx(-30.0)
    assert figures["max_um"] == 0.0, "the walls are where they should be"
    assert not found.holds
    share = np.isfinite(found.deviation_mm).mean()
    assert share == pytest.approx(10.0 / 40.0, abs=0.03), "the skin is not measured"
    assert inspect(slotted(-0.03).map, slotted(-0.03, "setpoints").map, 31.0).holds
    json.dumps(figures)


def turned(points: FloatArray, angle: float) -> FloatArray:
    cosine, sine = math.cos(angle), math.sin(angle)
    x, y, z = points.T
    return np.column_stack([x * cosine - y * sine, x * sine + y * cosine, z])


def slot(angle: float, *, aside: float = 0.0, tilt: float = 0.0, under: float = 0.0) -> FloatArray:
    """Two passes of a tool of 6 mm: a slot of 10 mm through the whole plate."""
    passes = []
    for x in (under - 2.0, 2.0 - under):
        corners = np.array([[x, -40.0, 5.0], [x, -40.0, -4.0], [x, 40.0, -4.0], [x, 40.0, 5.0]])
        passes += [np.linspace(a, b, 200) for a, b in itertools.pairwise(corners)]
    return turned(turned(np.concatenate(passes), tilt) + np.array([aside, 0.0, 0.0]), angle)


def boss(angle: float, *, aside: float = 0.0, under: float = 0.0, **_: float) -> FloatArray:
    """Circles of a tool of 6 mm around a boss of 14 mm."""
    rings = []
    for radius in (27.0, 22.0, 17.0, 12.0, 10.0 - under):
        way = np.linspace(0.0, 2.0 * math.pi, 500)
        ring = [radius * np.cos(way) + aside, radius * np.sin(way), np.full(500, -4.0)]
        rings.append(np.column_stack(ring))
    return turned(np.concatenate(rings), angle)


def cut_along(points: FloatArray, cell: float) -> HeightMap:
    plate = StockTable(shape="box", size=(36.0, 36.0, 12.0), cell=cell)
    cutter = Cutter(plate, ToolTable(number=1, diameter=6.0), FRAME, np.zeros(3))
    cutter.add(samples(points), np.zeros(len(points), np.bool_))
    return cutter.map


@pytest.mark.parametrize("shape", [slot, boss])
@pytest.mark.parametrize("cell", [0.25, 0.5])
@pytest.mark.parametrize("angle", [0.0, 0.3, 0.25 * math.pi])
def test_a_wall_is_measured_closer_than_by_cells(shape: Shape, cell: float, angle: float) -> None:
    nominal = cut_along(shape(angle), cell)
    changes = [("aside", 0.01), ("aside", 0.4 * cell), ("aside", 1.7 * cell), ("aside", 0.5)]
    changes += [("under", 0.05), ("under", 1.1 * cell), ("tilt", 0.02)]
    for name, size in changes:
        found = inspect(cut_along(shape(angle, **{name: size}), cell), nominal, 20.0)
        size = {"tilt": 0.02 * 18.0 if shape is slot else 0.0}.get(name, size)
        figures = found.as_json()
        most = max(figures["max_um"], -figures["min_um"]) / 1e3
        # Walls that are farther apart than a cell may seem up to a cell farther, never closer.
        assert size - found.bound_mm <= most <= size + (0.35 if size < cell else 1.0) * cell
        if size > 0.021:
            assert not found.holds, (name, size)


def test_a_slot_beside_its_place_leaves_material_and_takes_some() -> None:
    found = inspect(cut_along(slot(0.0, aside=0.5), 0.25), cut_along(slot(0.0), 0.25), 50.0)
    figures = found.as_json()
    assert figures["max_um"] == pytest.approx(500.0, abs=10.0)
    assert figures["min_um"] == pytest.approx(-500.0, abs=10.0)
    assert found.standing_mm3 == pytest.approx(found.missing_mm3) == pytest.approx(72.0)
    assert figures["measured_share"] > 0.95


def plate_with(solids: list[trimesh.Trimesh], file: Path) -> HeightMap:
    """The nominal part of a slot of 10 mm, or of a boss, on the grid of a cut one."""
    mesh = trimesh.util.concatenate(solids)
    mesh.export(file)
    return nominal_map(cut_along(slot(0.0), 0.25), file, FRAME.program_zero(np.zeros(3)))


def test_the_walls_of_a_mesh_are_known_closer_than_by_cells(tmp_path: Path) -> None:
    floor = trimesh.creation.box(bounds=[[-50, -50, -12], [50, 50, -4]])
    sides = [
        trimesh.creation.box(bounds=[[5, -50, -12], [50, 50, 0]]),
        trimesh.creation.box(bounds=[[-50, -50, -12], [-5, 50, 0]]),
    ]
    nominal = plate_with([floor, *sides], tmp_path / "slot.stl")
    for aside in (0.0, 0.03, 0.1):
        figures = inspect(cut_along(slot(0.0, aside=aside), 0.25), nominal, 20.0).as_json()
        assert figures["max_um"] == pytest.approx(1e3 * aside, abs=10.0)
        assert figures["min_um"] == pytest.approx(-1e3 * aside, abs=10.0)
    solid = trimesh.creation.cylinder(radius=7.0, segment=[[0, 0, -12], [0, 0, 0]], sections=512)
    nominal = plate_with([floor, solid], tmp_path / "boss.stl")
    for under in (0.0, 0.05):
        figures = inspect(cut_along(boss(0.0, under=under), 0.25), nominal, 20.0).as_json()
        assert figures["min_um"] == pytest.approx(-1e3 * under, abs=10.0)


def test_a_narrow_hole_too_deep_is_told_by_its_depth() -> None:
    def hole(depth: float) -> HeightMap:
        return cut_along(np.linspace([0.0, 0.0, 5.0], [0.0, 0.0, -depth], 100), 0.25)

    figures = inspect(hole(9.0), hole(4.0), 20.0).as_json()
    assert figures["min_um"] == pytest.approx(-5000.0, abs=5.0)


def test_material_beside_the_nominal_part_is_a_deviation(tmp_path: Path) -> None:
    small = trimesh.creation.box(bounds=[[-10, -10, -12], [10, 10, 0]])
    nominal = plate_with([small], tmp_path / "small.stl")
    found = inspect(cut_along(slot(0.0, aside=40.0), 0.25), nominal, 20.0)
    assert not found.holds
    assert found.most_standing_mm >= 7.9


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
