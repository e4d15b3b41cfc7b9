"""Draws with Filament, MuJoCo's physically based renderer, through Vulkan and without a screen.

Metals reflect a studio, shadows are filled by its walls. It takes several times as long as OpenGL.
"""

import contextlib
import importlib
import os
import sys
from collections.abc import Iterator
from typing import Any

import mujoco
import numpy as np
import numpy.typing as npt

from twin.render.drawing.canvas import SHOWN_GROUPS, Canvas, Pixels, Quality, prepare_size
from twin.render.drawing.chips import RGBA as CHIP_RGBA
from twin.render.drawing.chips import Chips
from twin.render.drawing.filament_mesh import FilamentMesh
from twin.render.drawing.studio_light import light_studio

FLAGS = {"cg.exposure": 0.45, "cg.contrast": 1.05}
"""Filament's options, where the model does not set them: a bright picture [stops], clear darks."""

STREAMS = (1, 2)
"""File descriptors of standard output and standard error."""


@contextlib.contextmanager
def muted() -> Iterator[None]:
    """Drop what this process prints meanwhile, libraries past Python included."""
    sys.stdout.flush()
    sys.stderr.flush()
    kept = [os.dup(stream) for stream in STREAMS]
    nowhere = os.open(os.devnull, os.O_WRONLY)
    try:
        for stream in STREAMS:
            os.dup2(nowhere, stream)
        yield
    finally:
        for stream, copy in zip(STREAMS, kept, strict=True):
            os.dup2(copy, stream)
            os.close(copy)
        os.close(nowhere)


def prepare(spec: mujoco.MjSpec, quality: Quality, size: tuple[int, int]) -> None:
    """Set what the model must say about pictures before it is compiled."""
    prepare_size(spec, quality, size)
    light_studio(spec)
    for name, value in FLAGS.items():
        if spec.numeric(f"filament.{name}") is None:
            spec.add_numeric(name=f"filament.{name}", data=[value], size=1)
    for material in spec.materials:
        # What glows is white to Filament, whatever the texture: it would bleach the trail.
        if any(material.textures):
            material.emission = 0.0


class FilamentCanvas(Canvas):
    """Draws a model that ``prepare`` was applied to.

    Where Vulkan has no driver, Filament ends the process: ``open_filament`` looks for one first.
    """

    def __init__(
        self,
        model: mujoco.MjModel,
        size: tuple[int, int],
        quality: Quality,
        *,
        quiet: bool = True,
    ) -> None:
        """Send the model to Filament.

        Args:
            size: Width and height of the pictures [px].
            quiet: Whether to drop what Filament reports on standard output and error: its start,
                and at a thousand meshes where its memory lies.

        Raises:
            ImportError: MuJoCo was installed without Filament.
        """
        super().__init__(model, size, quality)
        self._mute = muted if quiet else contextlib.nullcontext
        with self._mute():
            self._start()

    def _start(self) -> None:
        model = self._model
        importlib.import_module("mujoco.studio")  # has Filament's materials on board
        self._filament: Any = importlib.import_module("mujoco.mjrf")
        vulkan = self._filament.GraphicsApi.GRAPHICS_API_VULKAN
        self._context = self._filament.Context(self._filament.ContextConfig(graphics_api=vulkan))
        self._stage = self._context.create_scene(self._filament.SceneParams())
        self._stage.configure_from_model(model)
        self._resources = self._filament.ModelResources(self._context, model)
        self._lights = self._filament.ModelLights(self._stage, self._resources)
        self._bodies = self._filament.ModelRenderables(self._stage, self._resources)
        self._bodies.set_options(self._option)
        self._groups = model.geom_group.copy()
        self._meshes: dict[int, FilamentMesh] = {}
        self._targets: dict[tuple[int, int], Any] = {}
        self._chips: list[Any] = []
        self._flying = 0
        self._in_transfer: list[Any] = []
        # Its own thread works on, and may report something, until a frame was waited for.
        self._context.wait_for_frame(self._context.render([], []))

    def close(self) -> None:
        """Give back what Filament holds, users before what they use."""
        self._chips.clear()
        self._targets.clear()
        self._in_transfer.clear()
        del self._bodies, self._lights
        self._meshes.clear()
        del self._resources, self._stage, self._context

    def draw_objects(self, data: mujoco.MjData, camera: int) -> npt.NDArray[np.int32]:
        """Which geom every pixel shows, as ``Canvas`` says."""
        self._camera.fixedcamid = camera
        self._send_changes()
        self._update(data)
        mode = self._filament.DrawMode.DRAW_MODE_SEGMENTATION_BY_ID
        red, green, blue = np.moveaxis(self._take(*self._size, mode).astype(np.int64), 2, 0)
        number = red + 256 * green + 65536 * blue
        geoms = np.full(int(number.max()) + 1, -1, np.int32)
        for geom in range(self._model.ngeom):
            body = self._body(geom)
            if body is not None:
                known = body.get_material().segmentation_id
                if 0 < known < len(geoms):
                    geoms[known] = geom
        return geoms[number]

    def _send_changes(self) -> None:
        with self._mute():
            super()._send_changes()

    def _send_mesh(self, mesh: int) -> None:
        if mesh not in self._meshes:
            self._meshes[mesh] = self._own_mesh(mesh)
        self._in_transfer.append(self._meshes[mesh].send())

    def _send_texture(self, texture: int) -> None:
        model = self._model
        materials = np.flatnonzero((model.mat_texid == texture).any(axis=1))
        geoms = np.flatnonzero(np.isin(model.geom_matid, materials))
        if not len(geoms):
            return
        first = int(model.tex_adr[texture])
        size = model.tex_height[texture] * model.tex_width[texture] * model.tex_nchannel[texture]
        data = self._filament.TextureData()
        data.set_image(model.tex_data[first : first + int(size)].tobytes())
        # Filament has each texture of the model once: that of one geom is that of all.
        self._body(int(geoms[0])).get_material().color_texture.upload(data)
        self._in_transfer.append(data)

    def _own_mesh(self, mesh: int) -> FilamentMesh:
        """A mesh that can change, in the place of the one that Filament made of the model's."""
        own = FilamentMesh(self._filament, self._context, self._model, mesh)
        shown = self._model.geom_type == mujoco.mjtGeom.mjGEOM_MESH
        for geom in np.flatnonzero(shown & (self._model.geom_dataid == mesh)):
            self._body(int(geom)).set_mesh(own.handle, 0, own.corners)
        return own

    def _body(self, geom: int) -> Any:
        """Filament's object for a geom of the model; None where it has none."""
        return self._bodies.get_renderable(mujoco.mjtObj.mjOBJ_GEOM, geom, -1)

    def _limit_shadows(self, radius: float) -> None:
        """Nothing to tell: Filament fits its shadow map to what the camera sees."""

    def _update(self, data: mujoco.MjData, spray: Chips | None = None) -> None:
        mujoco.mjv_updateCamera(self._model, data, self._camera, self._scene)
        with self._mute():
            self._regroup()
            self._lights.update(data)
            self._bodies.update(data)
            self._show_chips(spray)

    def _regroup(self) -> None:
        """Show and hide the geoms whose group changed; Filament looks at groups only once."""
        groups = self._model.geom_group
        for geom in np.flatnonzero(groups != self._groups):
            was_shown, shown = (int(kind[geom]) in SHOWN_GROUPS for kind in (self._groups, groups))
            body = self._body(int(geom))
            if shown and not was_shown:
                self._stage.add_renderable(body)
            elif was_shown and not shown:
                self._stage.remove_renderable(body)
        self._groups = groups.copy()

    def _show_chips(self, spray: Chips | None) -> None:
        for chip in self._chips[: self._flying]:
            self._stage.remove_renderable(chip)
        self._flying = 0 if spray is None else len(spray.position)
        if spray is None:
            return
        while len(self._chips) < self._flying:
            self._chips.append(self._new_chip())
        for chip, position, rotation, half_size in zip(
            self._chips, spray.position, spray.rotation, spray.half_size, strict=False
        ):
            chip.set_pose(position.astype(np.float32), rotation.ravel().astype(np.float32))
            chip.set_size(half_size.astype(np.float32))
            self._stage.add_renderable(chip)

    def _new_chip(self) -> Any:
        chip = self._context.create_renderable(
            self._filament.RenderableParams(cast_shadow=False, receive_shadow=False)
        )
        chip.set_geom_mesh(mujoco.mjtGeom.mjGEOM_BOX, 1, 1, 1)
        color = np.array(CHIP_RGBA, np.float32)
        chip.set_material(self._filament.Material(color=color, metallic=1.0, roughness=0.3))
        return chip

    def _render(self, width: int, height: int) -> None:
        self._pixels = self._take(width, height)

    def _read(self, width: int, height: int) -> Pixels:
        assert self._pixels.shape[:2] == (height, width)
        return self._pixels

    def _take(self, width: int, height: int, mode: Any = None) -> Pixels:
        filament = self._filament
        if (width, height) not in self._targets:
            self._targets[width, height] = self._context.create_render_target(
                filament.RenderTargetConfig(
                    width=width, height=height, color_format=filament.PixelFormat.PIXEL_FORMAT_RGB8
                )
            )
        target = self._targets[width, height]
        request = filament.RenderRequest(
            scene=self._stage,
            camera=self._eye(),
            viewport=filament.Rect(0, 0, width, height),
            target=target,
            draw_mode=mode or filament.DrawMode.DRAW_MODE_DEFAULT,
            reflections=False,
        )
        pixels = np.zeros((height, width, 3), np.uint8)
        read = filament.ReadRequest(target=target)
        read.set_buffer(pixels)
        with self._mute():
            self._context.wait_for_frame(self._context.render([request], [read]))
        for sent in self._in_transfer:
            sent.free()
        self._in_transfer.clear()
        return pixels

    def _eye(self) -> Any:
        """The scene's camera; MuJoCo's scene has two for stereo, which lie side by side."""
        left, right = self._scene.camera
        return self._filament.Camera(
            pos=(left.pos + right.pos) / 2,
            forward=left.forward,
            up=left.up,
            frustum_center=(left.frustum_center + right.frustum_center) / 2,
            frustum_bottom=left.frustum_bottom,
            frustum_top=left.frustum_top,
            frustum_near=left.frustum_near,
            frustum_far=left.frustum_far,
        )
