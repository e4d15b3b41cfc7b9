import math
from pathlib import Path

import hypothesis
import hypothesis.strategies as st
import numpy as np
import pytest
import trimesh

from tests.cutting.conftest import samples
from twin.cutting.cut import Cutter
from twin.cutting.heights.height_map import HeightMap, blank
from twin.cutting.heights.part import part_mesh, write_stl
from twin.cutting.heights.surface_mesh import surface_faces, surface_mesh
from twin.job.job_file import StockTable, ToolTable
from twin.nc.canonical import FloatArray
from twin.toolpath.part_frame import PartFrame

ORIGIN = np.zeros(3)
BOX = StockTable(shape="box", size=(30.0, 20.0, 8.0))
CYLINDER = StockTable(shape="cylinder", diameter=30.0, height=8.0)


def reloaded(height_map: HeightMap, folder: Path) -> trimesh.Trimesh:
    write_stl(height_map, folder / "part.stl")
    mesh = trimesh.load_mesh(folder / "part.stl")
    assert isinstance(mesh, trimesh.Trimesh)
    return mesh


@pytest.mark.parametrize(
    ("stock", "volume"), [(BOX, 30.0 * 20.0 * 8.0), (CYLINDER, math.pi * 15.0**2 * 8.0)]
)
def test_uncut_stock_has_its_own_size(stock: StockTable, volume: float, tmp_path: Path) -> None:
    mesh = reloaded(blank(stock, ORIGIN, 0.5), tmp_path)
    assert mesh.is_watertight
    assert mesh.is_winding_consistent
    assert mesh.volume == pytest.approx(volume, rel=2e-3)
    np.testing.assert_allclose(mesh.extents, stock.extent, atol=0.01)
    assert mesh.bounds[1, 2] == 0.0


@hypothesis.settings(derandomize=True, max_examples=25, deadline=None)
@hypothesis.given(
    st.sampled_from([BOX, CYLINDER]),
    st.floats(0.3, 2.3),
    st.lists(
        st.tuples(st.floats(-18.0, 18.0), st.floats(-14.0, 14.0), st.floats(-9.0, 0.0)),
        min_size=2,
        max_size=6,
    ),
)
def test_every_cut_part_is_watertight(
    stock: StockTable, cell: float, corners: list[tuple[float, float, float]]
) -> None:
    tool = ToolTable(number=1, diameter=4.0, kind="ball")
    cutter = Cutter(
        stock.model_copy(update={"cell": cell}), tool, PartFrame(None, (0.0, 0.0)), np.zeros(3)
    )
    cutter.add(samples(np.array(corners)), np.zeros(len(corners), np.bool_))
    mesh = part_mesh(cutter.map)
    mesh.merge_vertices()
    assert mesh.is_watertight
    assert mesh.is_winding_consistent
    wall = 2 * (30.0 + 20.0) * 8.0 + 120.0 * 2 * 8.0
    assert abs(mesh.volume - cutter.map.volume) < 0.5 * wall * cell


def test_touching_corners_are_separated() -> None:
    height_map = blank(BOX, ORIGIN, 1.0)
    height_map.heights[:10, :15] = height_map.bottom
    height_map.heights[10:, 15:] = height_map.bottom
    mesh = part_mesh(height_map)
    mesh.merge_vertices()
    assert mesh.is_watertight


def test_nothing_left_gives_an_empty_mesh() -> None:
    height_map = blank(BOX, ORIGIN, 1.0)
    height_map.heights[:] = height_map.bottom
    assert len(part_mesh(height_map).faces) == 0


@pytest.mark.seconds("a fine map is made")
def test_fine_map_is_thinned(tmp_path: Path) -> None:
    height_map = blank(BOX, ORIGIN, 0.03)
    mesh = reloaded(height_map, tmp_path)
    assert len(mesh.faces) < 2_000_000
    assert mesh.is_watertight
    assert mesh.volume == pytest.approx(30.0 * 20.0 * 8.0)


def test_failed_write_leaves_nothing(tmp_path: Path) -> None:
    (tmp_path / "part.stl").mkdir()
    with pytest.raises(OSError, match=r"part\.stl"):
        write_stl(blank(BOX, ORIGIN, 1.0), tmp_path / "part.stl")
    assert [path.name for path in tmp_path.iterdir()] == ["part.stl"]


@pytest.mark.parametrize("left", [0.05, 0.12, 0.3, 0.45])
@pytest.mark.parametrize("cell", [0.25, 0.5])
def test_a_thin_cut_around_a_cylinder_leaves_a_round_side(left: float, cell: float) -> None:
    cutter = Cutter(
        CYLINDER.model_copy(update={"cell": cell}),
        ToolTable(number=1, diameter=4.0),
        PartFrame(None, (0.0, 0.0)),
        np.zeros(3),
    )
    wall = 15.0 - left
    turn = np.linspace(0.0, 2 * np.pi, 721)
    path = np.column_stack(
        [(wall + 2.0) * np.cos(turn), (wall + 2.0) * np.sin(turn), np.full(len(turn), -3.0)]
    )
    cutter.add(samples(path), np.zeros(len(path), np.bool_))
    mesh = part_mesh(cutter.map)
    mesh.merge_vertices()
    assert mesh.is_watertight
    radius = np.hypot(mesh.vertices[:, 0], mesh.vertices[:, 1])
    top = mesh.vertices[:, 2] == 0.0
    assert radius[top].max() == pytest.approx(wall, abs=0.11 * cell)
    edge = radius > 15.0 - 1e-3
    assert set(np.unique(mesh.vertices[edge, 2])) == {-8.0, -3.0}
    ring = math.pi * (15.0**2 - wall**2) * 3.0
    assert mesh.volume == pytest.approx(math.pi * 15.0**2 * 8.0 - ring, abs=max(0.5 * ring, 5.0))


def test_a_slot_through_the_edge_keeps_the_edge_beside_it() -> None:
    cutter = Cutter(
        CYLINDER.model_copy(update={"cell": 0.25}),
        ToolTable(number=1, diameter=4.0),
        PartFrame(None, (0.0, 0.0)),
        np.zeros(3),
    )
    cutter.add(samples(np.array([[-20.0, 0.1, -3.0], [20.0, 0.1, -3.0]])), np.zeros(2, np.bool_))
    vertices = part_mesh(cutter.map).vertices
    edge = (np.hypot(vertices[:, 0], vertices[:, 1]) > 15.0 - 1e-3) & (vertices[:, 2] > -8.0)
    beside = np.abs(vertices[:, 1] - 0.1) > 2.25
    assert (vertices[edge & beside, 2] == 0.0).all()
    assert (vertices[edge & (np.abs(vertices[:, 1] - 0.1) < 1.75), 2] == -3.0).all()


def test_a_helix_across_the_edge_leaves_the_edge_as_low_as_its_floor() -> None:
    tool = ToolTable(number=1, diameter=4.0)
    cutter = Cutter(
        BOX.model_copy(update={"cell": 0.5}), tool, PartFrame(None, (0.0, 0.0)), np.zeros(3)
    )
    turn = np.linspace(0.0, 4 * np.pi, 1441)
    path = np.column_stack(
        [9.0 * np.cos(turn) - 15.0, 9.0 * np.sin(turn), -3.0 + 0.2 * turn / np.pi]
    )
    cutter.add(samples(path), np.zeros(len(path), np.bool_))
    mesh = surface_mesh(cutter.map)
    vertices = mesh.vertices(cutter.map)[mesh.cell >= 0]
    assert vertices[:, 2].min() == pytest.approx(-3.0, abs=0.05)


def test_the_flank_of_a_groove_has_no_slivers_where_it_is_drawn_coarsely() -> None:
    tool, ahead = ToolTable(number=1, diameter=6.0, kind="ball"), np.array([0.94, 0.342, 0.0])
    cutter = Cutter(BOX.model_copy(update={"cell": 0.3}), tool, PartFrame(None, (0.0, 0.0)), ORIGIN)
    ends = np.outer([-25.0, 25.0], ahead) - [0.0, 0.0, 3.0]
    cutter.add(samples(ends), np.zeros(2, np.bool_))
    mesh = surface_mesh(cutter.map, 4)
    vertices = mesh.vertices(cutter.map)
    corners = vertices.reshape(-1, 3)[surface_faces(mesh.patches, vertices[..., 2])]
    inner = corners[np.hypot(*corners.mean(axis=1)[:, :2].T) < 7.0]
    normals = np.cross(inner[:, 1] - inner[:, 0], inner[:, 2] - inner[:, 0])
    along = normals @ ahead / np.linalg.norm(normals, axis=1)
    assert np.abs(along).max() < 0.4


def wall_points(mesh: trimesh.Trimesh) -> FloatArray:
    """Corners of the upright faces inside of the blank's sides, shape (n, 3) [mm]."""
    steep = mesh.triangles[np.abs(mesh.face_normals[:, 2]) < 0.5].reshape(-1, 3)
    return steep[np.abs(steep[:, :2]).max(axis=1) < 14.0]


@pytest.mark.parametrize("cell", [0.2, 0.4])
def test_walls_lie_where_the_tool_left_them(cell: float) -> None:
    def cut(corners: FloatArray) -> FloatArray:
        stock = StockTable(shape="box", size=(30.0, 30.0, 8.0), cell=cell)
        tool = ToolTable(number=1, diameter=4.0)
        cutter = Cutter(stock, tool, PartFrame(None, (0.0, 0.0)), np.zeros(3))
        path = np.column_stack([corners, np.full(len(corners), -3.0)])
        cutter.add(samples(path), np.zeros(len(path), np.bool_))
        mesh = part_mesh(cutter.map)
        mesh.merge_vertices()
        assert mesh.is_watertight
        return wall_points(mesh)

    turn = np.linspace(0.0, 2 * np.pi, 721)
    ring = cut(np.array([0.013, 0.007]) + 10.0 * np.column_stack([np.cos(turn), np.sin(turn)]))
    radius = np.hypot(ring[:, 0] - 0.013, ring[:, 1] - 0.007)
    assert np.abs(np.abs(radius - 10.0) - 2.0).max() < 0.03 * cell
    ahead = np.array([np.cos(np.pi / 6), np.sin(np.pi / 6)])
    slot = cut(np.array([-40.0, 40.0])[:, None] * ahead)
    across = slot[:, 1] * ahead[0] - slot[:, 0] * ahead[1]
    assert np.abs(np.abs(across) - 2.0).max() < 0.002 * cell
