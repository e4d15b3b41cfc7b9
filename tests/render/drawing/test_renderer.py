"""The Filament renderer behind the same interface as the OpenGL one."""

import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import mujoco
import numpy as np
import pytest
from PIL import Image

from twin.errors import RenderError
from twin.recording.reader import open_recording
from twin.render.drawing import gl
from twin.render.drawing import renderer as renderers
from twin.render.drawing.canvas import DRAFT, Canvas, Pixels, Quality
from twin.render.drawing.filament_mesh import mesh_corners, tangent_frames
from twin.render.drawing.gl import Probe, probe
from twin.render.drawing.opengl_canvas import OpenGLCanvas
from twin.render.drawing.renderer import Renderer, open_canvas, prepare
from twin.render.drawing.studio_light import (
    LAMP_LUX,
    SOFT_BOXES,
    brightness,
    cube_directions,
    environment,
    light_studio,
)
from twin.render.scene.scene import RenderScene
from twin.render.scene.stage import stage
from twin.render.still import Shot, stills

pytestmark = pytest.mark.thorough

Record = Callable[..., Path]
SIZE = (160, 120)


@pytest.fixture
def filament_driver() -> None:
    if probe(gl.FILAMENT).error:
        pytest.skip("no Vulkan driver for Filament here: see twin doctor")


BALLS = """
<mujoco>
  <worldbody>
    <light type="directional" dir="0 0.6 -0.8" castshadow="true"/>
    <camera name="front" pos="0 -3 0" xyaxes="1 0 0 0 0 1" fovy="60"/>
    <geom name="high_right" type="sphere" size="0.3" pos="0.8 0 0.6" rgba="1 0 0 1"/>
    <geom name="low_left" type="box" size="0.3 0.3 0.3" pos="-0.8 0 -0.6" rgba="0 0 1 1"/>
    <geom name="hidden" type="sphere" size="0.5" group="3"/>
  </worldbody>
</mujoco>
"""


def balls(renderer: Renderer, quality: Quality = DRAFT) -> tuple[mujoco.MjModel, mujoco.MjData]:
    spec = mujoco.MjSpec.from_string(BALLS)
    prepare(spec, renderer, quality, SIZE)
    model = spec.compile()
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    return model, data


def middle(mask: np.ndarray) -> list[float]:
    """Mean row and column of what is set."""
    return [float(places.mean()) for places in np.nonzero(mask)]


@pytest.mark.usefixtures("filament_driver")
def test_pictures_stand_upright_and_colours_stay() -> None:
    model, data = balls("filament")
    with open_canvas(model, "filament", SIZE, DRAFT) as canvas:
        pixels = canvas.draw(data, 0).astype(int)
        small = canvas.draw(data, 0, size=(80, 60))
    red = (pixels[..., 0] > 120) & (pixels[..., 1:].max(axis=2) < 100)
    blue = (pixels[..., 2] > 120) & (pixels[..., :2].max(axis=2) < 100)
    # 104 px a metre at 3 m: half the height over tan 30 degrees, over the distance.
    scale = 60 / np.tan(np.deg2rad(30)) / 3
    for mask, across, up in ((red, 0.8, 0.6), (blue, -0.8, -0.6)):
        row, column = middle(mask)
        assert abs(row - (59.5 - scale * up)) < 3
        assert abs(column - (79.5 + scale * across)) < 3
    assert small.shape == (60, 80, 3)


@pytest.mark.usefixtures("filament_driver")
def test_geoms_are_told_apart_and_groups_may_change() -> None:
    model, data = balls("filament")
    ball, box, hidden = (model.geom(name).id for name in ("high_right", "low_left", "hidden"))
    with open_canvas(model, "filament", SIZE, DRAFT) as canvas:
        assert set(np.unique(canvas.draw_objects(data, 0))) == {-1, ball, box}
        model.geom_group[[ball, hidden]] = [3, 0]
        assert set(np.unique(canvas.draw_objects(data, 0))) == {-1, box, hidden}
        model.geom_group[[ball, hidden]] = [0, 3]
        assert set(np.unique(canvas.draw_objects(data, 0))) == {-1, ball, box}


@pytest.mark.usefixtures("filament_driver")
@pytest.mark.parametrize("camera", ["overview", "top", "part", "riding"])
def test_both_renderers_frame_the_same_objects(scene: RenderScene, camera: str) -> None:
    seen = {}
    for renderer in ("opengl", "filament"):
        with stage(scene, SIZE, DRAFT, renderer=renderer) as play:
            for samples in scene.recording.chunks():
                play.advance(samples)
            seen[renderer] = play.objects(camera)
    differ = seen["opengl"] != seen["filament"]
    assert differ.mean() < 0.005  # two columns aside it is 0.03
    assert len(np.unique(seen["filament"])) >= 5


@pytest.mark.usefixtures("filament_driver")
def test_cut_stock_and_trail_are_seen(scene: RenderScene) -> None:
    with stage(scene, SIZE, DRAFT, renderer="filament") as play:
        before = play.picture("top").astype(int)
        trail = {play.model.geom(i).id for i in range(play.model.ngeom)
                 if play.model.geom(i).name.startswith("trail")}  # fmt: skip
        assert not trail & set(np.unique(play.objects("top")))
        for samples in scene.recording.chunks():
            play.advance(samples)
        after = play.picture("top").astype(int)
        assert trail & set(np.unique(play.objects("top")))
        again = play.picture("top").astype(int)
    changed = np.abs(after - before).max(axis=2) > 12
    assert 0.02 < changed.mean() < 0.7
    # The spindle turns between pictures; all else stands still.
    assert (np.abs(again - after).max(axis=2) > 12).mean() < 0.02


@pytest.mark.usefixtures("filament_driver")
def test_a_picture_is_bright_but_not_burnt_out(scene: RenderScene) -> None:
    with stage(
        scene, SIZE, Quality(passes=2, drawn_cells=60, drawn_crossings=6_000), renderer="filament"
    ) as play:
        pixels: Pixels = play.picture("part")
        machine = pixels[play.objects("part") >= 0]
    assert 60 < machine.mean() < 220
    assert (machine.min(axis=1) >= 254).mean() < 0.2
    assert (machine.max(axis=1) <= 2).mean() < 0.1


@pytest.mark.usefixtures("filament_driver")
def test_canvases_are_given_back() -> None:
    model, data = balls("filament")
    pictures = []
    for _ in range(3):
        with open_canvas(model, "filament", SIZE, DRAFT) as canvas:
            pictures.append(canvas.draw(data, 0).astype(int))
    assert np.abs(pictures[2] - pictures[0]).mean() < 1.0


@pytest.mark.usefixtures("filament_driver")
def test_nothing_is_printed(capfd: pytest.CaptureFixture[str]) -> None:
    model, data = balls("filament")
    with open_canvas(model, "filament", SIZE, DRAFT) as canvas:
        canvas.draw(data, 0)
    print("heard again")
    out, error = capfd.readouterr()
    assert out == "heard again\n"
    assert not error


@pytest.mark.usefixtures("filament_driver")
def test_a_still_has_the_display_over_it(make_recording: Record, scene: RenderScene) -> None:
    path = make_recording()
    picture = path.with_suffix(".png")
    with open_recording(path) as recording:
        stills(
            scene,
            [Shot(picture, len(recording))],
            size=(640, 360),
            quality="draft",
            renderer="filament",
        )
    with Image.open(picture) as image:
        pixels = np.asarray(image.convert("RGB")).astype(int)
    assert pixels.shape == (360, 640, 3)
    panel = pixels[215:345, 500:630]
    assert (panel.min(axis=2) > 200).mean() > 0.4  # its paper


def test_without_a_driver_the_message_names_the_packages(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(renderers, "probe", lambda name: Probe(name, error="no Vulkan instance"))
    with pytest.raises(RenderError, match=r"no Vulkan instance.*mesa-vulkan-drivers.*'opengl'"):
        renderers.require_filament()


def test_the_probe_outlives_a_missing_driver(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("VK_ICD_FILENAMES", "/nonexistent.json")
    monkeypatch.setenv("VK_DRIVER_FILES", "/nonexistent.json")
    found = gl.probe.__wrapped__(gl.FILAMENT)
    assert found.error
    assert not found.renderer


def test_canvases_share_their_interface() -> None:
    from twin.render.drawing.filament_canvas import FilamentCanvas

    for kind in (OpenGLCanvas, FilamentCanvas):
        assert issubclass(kind, Canvas)
        assert not kind.__abstractmethods__
        own = {name for name in vars(kind) if not name.startswith("_")}
        assert own <= {name for name in dir(Canvas) if not name.startswith("_")}
        assert kind.draw is Canvas.draw


def test_tangent_frames_turn_z_to_the_normals() -> None:
    normals = np.random.default_rng(3).standard_normal((50, 3))
    normals = np.concatenate([normals, [[0, 0, 1], [0, 0, -1], [1, 0, 0]]])
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    for (x, y, z, w), normal in zip(tangent_frames(normals), normals, strict=True):
        turned = np.zeros(3)
        mujoco.mju_rotVecQuat(turned, np.array([0.0, 0.0, 1.0]), np.array([w, x, y, z]))
        assert turned == pytest.approx(normal, abs=1e-9)


def test_corners_are_those_of_the_models_mesh() -> None:
    spec = mujoco.MjSpec()
    spec.add_mesh(
        name="wedge",
        uservert=[0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1],
        userface=[0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3],
    )
    spec.worldbody.add_geom(type=mujoco.mjtGeom.mjGEOM_MESH, meshname="wedge")
    model = spec.compile()
    corners = mesh_corners(model, 0)
    assert corners.shape == (12, 9)
    for face in range(4):
        for corner in range(3):
            vertex = model.mesh_vert[model.mesh_face[face][corner]]
            assert corners[3 * face + corner, :3] == pytest.approx(vertex)
    assert np.linalg.norm(corners[:, 3:7], axis=1) == pytest.approx(1.0)


def test_the_studio_is_brightest_at_its_soft_boxes() -> None:
    directions = cube_directions(16)
    assert directions.shape == (6, 16, 16, 3)
    assert np.linalg.norm(directions, axis=-1) == pytest.approx(1.0)
    assert directions[2].reshape(-1, 3).mean(axis=0)[2] > 0.7  # the third face lies overhead
    light = brightness(directions).reshape(-1)
    key = np.array(SOFT_BOXES[0][0]) / np.linalg.norm(SOFT_BOXES[0][0])
    assert directions.reshape(-1, 3)[np.argmax(light)] @ key > np.cos(np.deg2rad(30))
    assert environment(8).shape == (48, 8, 3)


def test_lamps_get_an_intensity_unless_the_model_has_one() -> None:
    spec = mujoco.MjSpec.from_string(BALLS)
    spec.stat.center[:] = 0.0
    spec.worldbody.add_light(
        name="spot",
        type=mujoco.mjtLightType.mjLIGHT_SPOT,
        pos=[0.0, 0.0, 2.0],
        dir=[0.0, 0.0, -1.0],
    )
    light_studio(spec)
    lamp, spot, _ = (light.intensity for light in spec.lights)
    assert lamp == LAMP_LUX
    assert spot == pytest.approx(4 * LAMP_LUX)
    before = [light.intensity for light in spec.lights]
    light_studio(spec)
    assert [light.intensity for light in spec.lights] == before


@pytest.mark.usefixtures("filament_driver")
def test_filament_says_in_a_process_of_its_own_what_it_draws_through() -> None:
    done = subprocess.run(
        [sys.executable, "-m", "twin.render.drawing.probe", gl.FILAMENT],
        capture_output=True,
        text=True,
        check=True,
        timeout=120,
    )
    assert done.stdout.rstrip().endswith('{"renderer": "Vulkan"}')
