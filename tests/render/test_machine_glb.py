"""The machine as a page draws it: where its nodes are, against MuJoCo's own kinematics."""

import io

import mujoco
import numpy as np
import pytest
import trimesh
from trimesh.transformations import rotation_matrix

from twin.files.shipped import machine_file
from twin.job.job_file import StockTable, ToolTable
from twin.machine.load import read_machine
from twin.render.machine_glb import COLLISION_PREFIX, drawn_machine
from twin.render.scene.placement import Joints, tip_position

POSITION = np.array([83.0, -41.0, -120.0, 37.0])


@pytest.fixture(scope="module", params=["mill4", "mill4_light"])
def drawn(request):
    machine = read_machine(machine_file(request.param))
    stock = StockTable(shape="box", size=(120.0, 80.0, 30.0))
    zero = np.array([0.0, 0.0, -300.0, 0.0])
    return drawn_machine(
        machine, ToolTable(number=1, diameter=10.0), machine.part_frame, stock, zero
    )


def moved(drawn) -> trimesh.Scene:
    """The file, with its nodes moved as the description says."""
    scene = trimesh.load_scene(io.BytesIO(drawn.glb()), file_type="glb")
    described = drawn.description()
    for joint, value in zip(described["joints"], POSITION, strict=True):
        name = joint["body"]
        parent = scene.graph.transforms.parents[name]
        matrix = scene.graph.get(name, parent)[0].copy()
        way = joint["scale"] * value
        if joint["slides"]:
            matrix[:3, 3] += way * np.array(joint["direction"])
        else:
            matrix = matrix @ rotation_matrix(way, joint["direction"])
        scene.graph.update(frame_to=name, frame_from=parent, matrix=matrix)
    return scene


def test_bodies_part_and_tip_are_where_mujoco_has_them(drawn):
    scene, model = moved(drawn), drawn.model
    data = mujoco.MjData(model)
    Joints(drawn.machine, model).set(data, POSITION)
    mujoco.mj_kinematics(model, data)
    for body in range(1, model.nbody):
        matrix = scene.graph.get(model.body(body).name)[0]
        assert np.allclose(matrix[:3, 3], data.xpos[body], atol=1e-5)
        assert np.allclose(matrix[:3, :3], data.xmat[body].reshape(3, 3), atol=1e-5)
    described = drawn.description()
    tip = described["tip"]
    place = scene.graph.get(tip["body"])[0] @ np.reshape(tip["matrix"], (4, 4)).T
    assert np.allclose(place[:3, 3], tip_position(model, data, drawn.tool.length), atol=1e-5)
    part = described["part"]
    frame = scene.graph.get(part["body"])[0] @ np.reshape(part["matrix"], (4, 4)).T
    # Where the tool point lies in the part's frame, by the machine's own geometry.
    header = drawn.machine.part_frame
    point = header.position(POSITION[None])[0]
    assert np.allclose((frame @ [*point, 1.0])[:3], place[:3, 3], atol=1e-4)


def test_the_file_is_small_and_tells_what_only_collides(drawn):
    content = drawn.glb()
    assert len(content) < 2_000_000
    scene = trimesh.load_scene(io.BytesIO(content), file_type="glb")
    names = list(scene.geometry)
    assert any(name.startswith(COLLISION_PREFIX) for name in names)
    assert any(name.startswith("cutter_1") for name in names)
