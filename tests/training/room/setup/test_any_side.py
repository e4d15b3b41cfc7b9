"""A part in the room that is cut from any side: the tool's gap to it, places measured on it, its view from above."""

import math
import struct
import zlib

import numpy as np
import pytest

from twin.cutting.tridexel.blanks import box
from twin.cutting.tridexel.surface.mesh import MESH, mesh_message
from twin.job.job_file import ToolTable
from twin.training.room.setup.any_side import seen_from_above, surface_off, touch_any_side
from twin.training.scene.scene_file import read_scene, scene_path
from twin.training.session.session import SceneSession

BLOCK = box(np.array([-20.0, -15.0, -20.0]), np.array([20.0, 15.0, 0.0]), 0.5)
TOOL = ToolTable(number=1, diameter=10.0, length=60.0, flute=16.0)
UP, BACK = np.array([0.0, 0.0, 1.0]), np.array([0.0, 1.0, 0.0])


@pytest.mark.parametrize(
    ("tip", "axis", "gap"),
    [
        ((-25.0, 3.0, -5.0), UP, 0.0),
        ((-24.0, 3.0, -5.0), UP, -1.0),
        ((3.0, -21.0, -5.0), UP, None),
        ((3.0, 3.0, -0.7), UP, -0.7),
        ((3.0, 3.0, 0.1), UP, None),
        ((3.0, 14.0, -8.0), BACK, -1.0),
        ((3.0, 15.1, -8.0), BACK, None),
    ],
)
def test_the_gap_to_a_block(tip, axis, gap):
    found = touch_any_side(BLOCK, np.array(tip), axis, TOOL)
    assert found.meets == (gap is not None)
    if gap is not None:
        assert found.gap == pytest.approx(gap, abs=0.01)


def test_the_tip_is_pushed_out_of_the_part():
    found = touch_any_side(BLOCK, np.array([-24.0, 3.0, -5.0]), UP, TOOL)
    assert found.away == (-1.0, 0.0)


@pytest.mark.parametrize(
    ("place", "off"),
    [((1.0, 1.0, -0.3), 0.3), ((1.0, 1.0, 0.2), -0.2), ((19.0, 0.0, -10.0), 1.0), ((20.0, 0.0, -10.0), 0.0)],
)  # fmt: skip
def test_a_place_is_measured_along_the_nearest_axis(place, off):
    assert surface_off(BLOCK, np.array(place)) == pytest.approx(off, abs=1e-9)


def test_a_place_far_from_the_part_has_no_surface():
    assert math.isinf(surface_off(BLOCK, np.array([60.0, 0.0, 0.0])))


def test_the_view_from_above_is_that_of_the_block():
    seen = seen_from_above(BLOCK)
    assert seen.shape == tuple(BLOCK.lattice.shape[1::-1])
    assert seen.max() == 0.0
    assert (seen == 0.0).sum() * 0.25 == pytest.approx(40.0 * 30.0, rel=0.05)


def test_the_mesh_of_a_block_has_its_volume():
    message = mesh_message(BLOCK, 4000)
    kind, vertices, faces = struct.unpack_from("<BxxxII", message)
    assert kind == MESH
    content = zlib.decompress(message[12:])
    points = np.frombuffer(content, "<f4", 3 * vertices).reshape(-1, 3).astype(float)
    corners = np.frombuffer(content, "<u4", 3 * faces, 12 * vertices).reshape(-1, 3)
    by = np.frombuffer(content, np.uint8, faces, 12 * (vertices + faces))
    assert len(content) == 12 * (vertices + faces) + faces
    a, b, c = points[corners].transpose(1, 0, 2)
    assert (a * np.cross(b, c)).sum() / 6.0 == pytest.approx(40.0 * 30.0 * 20.0, rel=0.01)
    assert not by.any()


@pytest.mark.seconds("a room is stepped")
def test_going_back_brings_the_part_back_as_it_was():
    session = SceneSession(read_scene(scene_path("fanuc_second_side")))
    session.submit({"do": "cycle_start"})
    for _ in range(800):
        session.advance()
    work = session.room.setup.work
    assert work is not None
    assert work.dexels is not None
    assert work.removed > 500.0
    before, tick = seen_from_above(work.dexels), session.room.tick
    cut = work.removed
    for _ in range(200):
        session.advance()
    assert session.room.setup.work is not None
    assert session.room.setup.work.removed > cut
    session.rewind(2.0)
    again = session.room.setup.work
    assert again is not None
    assert again.dexels is not None
    assert (session.room.tick, again.removed) == (tick, cut)
    assert (seen_from_above(again.dexels) == before).all()
