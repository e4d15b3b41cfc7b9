"""A part that is cut from several sides is drawn as it is cut, and turns with what carries it."""

from unittest.mock import create_autospec

import mujoco
import numpy as np
import pytest
import trimesh

from twin.cutting.material import Points
from twin.cutting.tools import profile
from twin.cutting.tridexel.blanks import blank
from twin.cutting.tridexel.engagement import volume
from twin.cutting.tridexel.material import TriDexelMaterial
from twin.files.shipped import machine_file
from twin.job.job_file import StockTable, ToolTable
from twin.machine.load import read_machine
from twin.machine.model.model import build_spec
from twin.nc.canonical import FloatArray, IntArray
from twin.render.drawing.canvas import Canvas
from twin.render.scene.dexel_surface import MACHINED, MESH, RAW, DexelSurface
from twin.render.scene.placement import Joints, place
from twin.units import MM

CROSSINGS = 12_000
TOOL = ToolTable(number=1, diameter=6.0, length=100.0, flute=20.0)
ZERO = np.array([3.0, 4.0, -440.0, 0.0, 0.0])
BOX = StockTable(shape="box", size=(60.0, 60.0, 50.0), cell=1.0)
BAR = StockTable(shape="cylinder", diameter=60.0, height=50.0, cell=1.0)


class Drawn:
    """A stock on the trunnion, and what pictures would have of it."""

    def __init__(self, stock: StockTable, crossings: int = CROSSINGS) -> None:
        self.machine = read_machine(machine_file("mill5"))
        self.frame = self.machine.part_frame.at(ZERO, TOOL.length)
        self.corner = self.frame.program_zero(ZERO)
        self.material = TriDexelMaterial(blank(stock, self.corner, stock.cell or 1.0))
        self.surface = DexelSurface(self.material, crossings)
        spec = build_spec(self.machine)
        placement = place(self.machine, spec.compile(), TOOL.length, self.frame)
        self.surface.add_to(spec)
        self.model = spec.compile()
        self.surface.bind(self.model, placement)
        self.canvas = create_autospec(Canvas, instance=True)

    def slot(self, axis: tuple[float, float, float], off: float = 0.0) -> None:
        """Cut a slot across the blank, 4 mm below the top or a side."""
        middle, direction = self.corner - [0.0, 0.0, 25.0], np.array(axis)
        depth = (21.0 if direction[2] else 26.0) * direction
        way = np.array([[0.0, y, 0.0] for y in np.arange(-36.0, 36.5, 0.5)])
        tip = middle + depth + way + off * direction
        ends = Points(tip, np.tile([1.0, 0.0], (len(way), 1)), np.tile(direction, (len(way), 1)))
        self.material.begin_chunk()
        self.material.take_off(ends, TOOL, profile(TOOL), np.zeros(len(way) - 1), stood=False)
        self.surface.note_cut()

    def faces(self) -> tuple[FloatArray, IntArray, IntArray]:
        """Vertices in the carrier's frame [mm], the faces that have an area, and their texels."""
        mesh = self.model.mesh(MESH)
        first, count = int(mesh.vertadr[0]), int(mesh.vertnum[0])
        points = self.model.mesh_vert[first : first + count] / MM
        rows = slice(int(mesh.faceadr[0]), int(mesh.faceadr[0]) + int(mesh.facenum[0]))
        faces, texels = self.model.mesh_face[rows], self.model.mesh_facetexcoord[rows, 0]
        seen = faces[:, 0] != faces[:, 1]
        return (
            points.astype(np.float64),
            faces[seen].astype(np.int64),
            texels[seen].astype(np.int64),
        )

    def mesh(self) -> trimesh.Trimesh:
        points, faces, _ = self.faces()
        return trimesh.Trimesh(points, faces)


@pytest.mark.seconds("the model of a five-axis machine is built")
@pytest.mark.parametrize("stock", [BOX, BAR], ids=lambda stock: stock.shape)
def test_the_blank_is_where_the_part_s_frame_says(stock: StockTable) -> None:
    drawn = Drawn(stock)
    data = mujoco.MjData(drawn.model)
    points, faces, _ = drawn.faces()
    used = points[np.unique(faces)]
    geom = drawn.model.geom(MESH).id
    for joints in (ZERO, ZERO + np.array([10.0, -20.0, 30.0, -90.0, 200.0])):
        Joints(drawn.machine, drawn.model).set(data, joints)
        mujoco.mj_kinematics(drawn.model, data)
        # Seen from the part the tip is so far from the middle of the blank as it is in the world.
        away = np.linalg.norm(
            drawn.frame.position(joints[None])[0] - drawn.corner + [0.0, 0.0, 25.0]
        )
        nose = data.site("spindle_nose")
        tip = nose.xpos - TOOL.length * MM * nose.xmat.reshape(3, 3)[:, 2]
        middle = 0.5 * (used.min(axis=0) + used.max(axis=0)) * MM
        there = data.geom_xpos[geom] + data.geom_xmat[geom].reshape(3, 3) @ middle
        assert np.linalg.norm(tip - there) / MM == pytest.approx(away, abs=2e-3)


def test_slots_from_two_sides_are_drawn_once_each_was_cut() -> None:
    drawn = Drawn(BOX)
    before = drawn.mesh()
    assert before.is_watertight
    assert before.volume == pytest.approx(60.0 * 60.0 * 50.0, rel=1e-3)
    for done, axis in enumerate(((0.0, 0.0, 1.0), (1.0, 0.0, 0.0)), 1):
        drawn.slot(axis)
        drawn.surface.update(drawn.canvas)
        after = drawn.mesh()
        assert after.is_watertight
        assert after.volume == pytest.approx(volume(drawn.material.stock), rel=2e-3)
        assert before.volume - after.volume == pytest.approx(done * 6.0 * 4.0 * 60.0, rel=0.03)
    assert drawn.canvas.upload_mesh.call_count == 2


def test_what_a_tool_left_is_told_from_the_blank_s_skin() -> None:
    drawn = Drawn(BOX)
    assert set(drawn.faces()[2].tolist()) == {RAW}
    drawn.slot((1.0, 0.0, 0.0))
    drawn.surface.update(drawn.canvas)
    points, faces, texels = drawn.faces()
    middle = points[faces].mean(axis=1) - points[np.unique(faces)].mean(axis=0)
    corner = points[faces]
    area = 0.5 * np.linalg.norm(
        np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0]), axis=1
    )
    # Floor and both sides of the slot: 6 + 4 + 4 mm times 60 mm.
    assert area[texels == MACHINED].sum() == pytest.approx(14.0 * 60.0, rel=0.08)
    assert np.ptp(middle[texels == MACHINED], axis=0).min() < 8.0


def test_air_sends_nothing_to_the_renderer() -> None:
    drawn = Drawn(BOX)
    drawn.slot((0.0, 0.0, 1.0), off=10.0)
    drawn.surface.update(drawn.canvas)
    drawn.canvas.upload_mesh.assert_not_called()


@pytest.mark.parametrize("crossings", [600, 3000])
def test_a_net_that_would_be_too_fine_is_coarser_and_closed(crossings: int) -> None:
    drawn = Drawn(BOX, crossings)
    for number in range(6):
        drawn.slot((0.0, 0.0, 1.0), off=-5.0 * number)
        drawn.slot((1.0, 0.0, 0.0), off=-5.0 * number)
    drawn.surface.update(drawn.canvas)
    mesh = drawn.mesh()
    assert 0 < len(mesh.faces) <= 4 * crossings
    assert mesh.is_watertight
    assert mesh.volume == pytest.approx(volume(drawn.material.stock), rel=0.2)
