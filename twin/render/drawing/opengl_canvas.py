"""Draws with MuJoCo's OpenGL renderer, off-screen."""

import importlib
from typing import Any

import mujoco
import numpy as np
import numpy.typing as npt

from twin.errors import RenderError
from twin.nc.canonical import IntArray
from twin.render.drawing.canvas import (
    HIDDEN_GROUP,
    SHOWN_GROUPS,
    Canvas,
    Pixels,
    Quality,
    prepare_size,
)
from twin.render.drawing.chips import RGBA as CHIP_RGBA
from twin.render.drawing.chips import Chips
from twin.render.drawing.gl import choose_backend, open_context

FILL_SHARE = 0.2
"""Share of a light that its shadows do not take away."""


def prepare(spec: mujoco.MjSpec, quality: Quality, size: tuple[int, int]) -> None:
    """Set what the model must say about pictures before it is compiled."""
    prepare_size(spec, quality, size)
    if quality.shadows:
        _soften_shadows(spec)


def _soften_shadows(spec: mujoco.MjSpec) -> None:
    """Let a part of every light that casts shadows shine through, as from a bright workshop."""
    for light in [light for light in spec.lights if light.castshadow]:
        through = FILL_SHARE * np.array(light.diffuse)
        light.diffuse = np.array(light.diffuse) - through
        body = light.parent
        body.add_light(
            type=light.type,
            pos=light.pos,
            dir=light.dir,
            diffuse=through,
            specular=[0.0, 0.0, 0.0],
            castshadow=False,
        )


class OpenGLCanvas(Canvas):
    """Draws a model that ``prepare`` was applied to; one at a time in a process."""

    def __init__(self, model: mujoco.MjModel, size: tuple[int, int], quality: Quality) -> None:
        """Open it.

        Raises:
            RenderError: No OpenGL works here, or it has too little memory.
        """
        super().__init__(model, size, quality)
        self._scene.flags[mujoco.mjtRndFlag.mjRND_SHADOW] = quality.shadows
        self._scene.flags[mujoco.mjtRndFlag.mjRND_REFLECTION] = False
        self._window: Any = open_context(choose_backend().backend, *size)
        try:
            self._context = mujoco.MjrContext(model, mujoco.mjtFontScale.mjFONTSCALE_100)
        except mujoco.FatalError as error:
            self._window.free()
            raise RenderError(
                f"OpenGL cannot hold pictures of {size[0]} x {size[1]} pixels: {error}; "
                "try a smaller size or the draft quality"
            ) from error
        mujoco.mjr_setBuffer(mujoco.mjtFramebuffer.mjFB_OFFSCREEN, self._context)
        # PyOpenGL looks at its first import which library the context is of.
        self._perturbation = mujoco.MjvPerturb()
        self._flush = importlib.import_module("OpenGL.GL").glFlush

    def close(self) -> None:
        """Close the OpenGL context."""
        self._context.free()
        self._window.free()

    def draw_objects(self, data: mujoco.MjData, camera: int) -> npt.NDArray[np.int32]:
        """Which geom every pixel shows, as ``Canvas`` says."""
        self._camera.fixedcamid = camera
        self._send_changes()
        self._update(data)
        flags = self._scene.flags.copy()
        self._scene.flags[mujoco.mjtRndFlag.mjRND_SEGMENT] = True
        self._scene.flags[mujoco.mjtRndFlag.mjRND_IDCOLOR] = True
        self._render(*self._size)
        pixels = self._read(*self._size)
        self._scene.flags[:] = flags
        red, green, blue = np.moveaxis(pixels.astype(np.int64), 2, 0)
        number = red + 256 * green + 65536 * blue
        geoms = np.full(self._scene.ngeom + 1, -1, np.int32)
        for geom in self._scene.geoms[: self._scene.ngeom]:
            if geom.objtype == mujoco.mjtObj.mjOBJ_GEOM:
                geoms[geom.segid + 1] = geom.objid
        return geoms[number]

    def _send_mesh(self, mesh: int) -> None:
        mujoco.mjr_uploadMesh(self._model, self._context, mesh)

    def _send_texture(self, texture: int) -> None:
        mujoco.mjr_uploadTexture(self._model, self._context, texture)

    def _limit_shadows(self, radius: float) -> None:
        self._context.shadowClip = radius

    def _update(self, data: mujoco.MjData, spray: Chips | None = None) -> None:
        """Bring the scene to the state of ``data``, near geoms first: what they hide is not shaded.

        MuJoCo draws in the order in which geoms are added, and adds those of a group at a time.
        """
        groups = self._model.geom_group.copy()
        everything = mujoco.mjtCatBit.mjCAT_ALL
        self._model.geom_group[:] = self._near_first(data)
        self._option.geomgroup[:] = False
        for group in range(HIDDEN_GROUP):
            self._option.geomgroup[group] = True
            parts = (self._model, data, self._option)
            if group == 0:
                mujoco.mjv_updateScene(*parts, None, self._camera, everything, self._scene)
            else:
                mujoco.mjv_addGeoms(*parts, self._perturbation, everything, self._scene)
            self._option.geomgroup[group] = False
        self._model.geom_group[:] = groups
        if spray is not None:
            self._add_chips(spray)

    def _near_first(self, data: mujoco.MjData) -> IntArray:
        """A group for every geom, by its distance along the camera's axis; of those hidden the last."""
        model, camera = self._model, self._camera.fixedcamid
        axis = data.cam_xmat[camera].reshape(3, 3)[:, 2]
        distance = (data.cam_xpos[camera] - data.geom_xpos) @ axis
        distance[model.geom_type == mujoco.mjtGeom.mjGEOM_PLANE] = np.inf
        # The pieces of the stock are in one place, and go together.
        steps, rank = np.unique(distance.round(3), return_inverse=True)
        shown = np.isin(model.geom_group, SHOWN_GROUPS)
        return np.where(shown, rank * HIDDEN_GROUP // len(steps), HIDDEN_GROUP)

    def _add_chips(self, spray: Chips) -> None:
        scene = self._scene
        room = scene.maxgeom - scene.ngeom
        for position, rotation, half_size in list(
            zip(spray.position, spray.rotation, spray.half_size, strict=True)
        )[:room]:
            geom = scene.geoms[scene.ngeom]
            mujoco.mjv_initGeom(
                geom,
                mujoco.mjtGeom.mjGEOM_BOX,
                half_size,
                position,
                rotation.ravel(),
                np.array(CHIP_RGBA, np.float32),
            )
            geom.category = mujoco.mjtCatBit.mjCAT_DECOR
            geom.specular = 1.0
            scene.ngeom += 1

    def _render(self, width: int, height: int) -> None:
        mujoco.mjr_render(mujoco.MjrRect(0, 0, width, height), self._scene, self._context)
        self._flush()

    def _read(self, width: int, height: int) -> Pixels:
        pixels = np.zeros((height, width, 3), np.uint8)
        mujoco.mjr_readPixels(pixels, None, mujoco.MjrRect(0, 0, width, height), self._context)
        return pixels[::-1]
