"""The one place that draws: a MuJoCo scene in an off-screen OpenGL context."""

import contextlib
import dataclasses
from collections.abc import Iterator
from typing import Any

import mujoco
import numpy as np
import numpy.typing as npt

from twin.errors import RenderError
from twin.nc.canonical import FloatArray
from twin.render.gl import choose_backend, open_context

Pixels = npt.NDArray[np.uint8]

SHOWN_GROUPS = (0, 1, 2)
"""Geom groups that pictures show; collision shapes and hidden things lie in others."""
HIDDEN_GROUP = 5
"""Geom group of what is hidden for a while."""

FILL_SHARE = 0.45
"""Share of a light that its shadows do not take away."""

SHADOWLESS = "trail"
"""What the names of geoms that cast no shadow begin with."""

_LIGHT_FAR = 2.0
"""Distance of a light from the middle of its shadows, as a share of their radius."""

_SPARE_GEOMS = 200
"""Scene geoms beside the model's own, for lights' and frames' decoration."""


@dataclasses.dataclass(frozen=True, slots=True)
class Quality:
    """What a picture may cost.

    Attributes:
        shadows: Whether the key light casts shadows.
        samples: Samples per pixel at edges; 0 draws the rough edge.
        drawn_cells: Most vertices of the drawn stock along its longer side.
        shadow_map: Side of the shadow map [px].
    """

    shadows: bool
    samples: int
    drawn_cells: int
    shadow_map: int = 4096


DRAFT = Quality(shadows=False, samples=0, drawn_cells=160)
FINAL = Quality(shadows=True, samples=4, drawn_cells=480)
QUALITIES = {"draft": DRAFT, "final": FINAL}


def quality_named(name: str) -> Quality:
    """The quality of a name.

    Raises:
        RenderError: There is none.
    """
    if name not in QUALITIES:
        raise RenderError(f"no quality '{name}': there are {', '.join(QUALITIES)}")
    return QUALITIES[name]


def prepare(spec: mujoco.MjSpec, quality: Quality, size: tuple[int, int]) -> None:
    """Set what the model must say about pictures before it is compiled."""
    spec.visual.global_.offwidth, spec.visual.global_.offheight = size
    spec.visual.quality.offsamples = quality.samples
    spec.visual.quality.shadowsize = quality.shadow_map
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


@dataclasses.dataclass(frozen=True, slots=True)
class Focus:
    """A ball in the world, in which shadows are drawn.

    Attributes:
        center: Shape (3,) [m].
        radius: [m].
    """

    center: FloatArray
    radius: float


class Canvas:
    """Draws a model; open it with ``canvas``."""

    def __init__(self, model: mujoco.MjModel, size: tuple[int, int], quality: Quality) -> None:
        self._model = model
        self._scene = mujoco.MjvScene(model, model.ngeom + _SPARE_GEOMS)
        self._scene.flags[mujoco.mjtRndFlag.mjRND_SHADOW] = quality.shadows
        self._scene.flags[mujoco.mjtRndFlag.mjRND_REFLECTION] = quality.shadows
        self._option = mujoco.MjvOption()
        self._option.geomgroup[:] = False
        self._option.geomgroup[list(SHOWN_GROUPS)] = True
        self._camera = mujoco.MjvCamera()
        self._camera.type = mujoco.mjtCamera.mjCAMERA_FIXED
        self.context = mujoco.MjrContext(model, mujoco.mjtFontScale.mjFONTSCALE_100)
        mujoco.mjr_setBuffer(mujoco.mjtFramebuffer.mjFB_OFFSCREEN, self.context)
        self._view = mujoco.MjrRect(0, 0, *size)
        self._shadowless = {
            number
            for number in range(model.ngeom)
            if quality.shadows and model.geom(number).name.startswith(SHADOWLESS)
        }

    def draw(
        self,
        data: mujoco.MjData,
        camera: int,
        size: tuple[int, int] | None = None,
        focus: Focus | None = None,
    ) -> Pixels:
        """Draw one frame, top row first.

        Args:
            data: Positions of everything (after ``mj_forward`` or the like).
            camera: Number of the camera in the model.
            size: Width and height, at most those of the canvas [px]; None: all of it.
            focus: Where shadows fall; None: as the model says.

        Returns:
            Shape (height, width, 3).
        """
        if focus is not None:
            self._aim_shadows(data, focus)
        self._update(data, camera)
        view = self._view if size is None else mujoco.MjrRect(0, 0, *size)
        mujoco.mjr_render(view, self._scene, self.context)
        return self._read(view)

    def draw_objects(self, data: mujoco.MjData, camera: int) -> npt.NDArray[np.int32]:
        """Which geom every pixel shows: its number in the model, -1 for none.

        Returns:
            Shape (height, width).
        """
        self._update(data, camera)
        flags = self._scene.flags.copy()
        self._scene.flags[mujoco.mjtRndFlag.mjRND_SEGMENT] = True
        self._scene.flags[mujoco.mjtRndFlag.mjRND_IDCOLOR] = True
        mujoco.mjr_render(self._view, self._scene, self.context)
        self._scene.flags[:] = flags
        red, green, blue = np.moveaxis(self._read(self._view).astype(np.int64), 2, 0)
        number = red + 256 * green + 65536 * blue
        geoms = np.full(self._scene.ngeom + 1, -1, np.int32)
        for geom in self._scene.geoms[: self._scene.ngeom]:
            if geom.objtype == mujoco.mjtObj.mjOBJ_GEOM:
                geoms[geom.segid + 1] = geom.objid
        return geoms[number]

    def _aim_shadows(self, data: mujoco.MjData, focus: Focus) -> None:
        """Spread the shadow map over the focus alone: the smaller, the sharper the shadows."""
        self.context.shadowClip = focus.radius
        for light in np.flatnonzero(self._model.light_castshadow):
            data.light_xpos[light] = (
                focus.center - _LIGHT_FAR * focus.radius * data.light_xdir[light]
            )

    def _update(self, data: mujoco.MjData, camera: int) -> None:
        self._camera.fixedcamid = camera
        mujoco.mjv_updateScene(
            self._model,
            data,
            self._option,
            None,
            self._camera,
            mujoco.mjtCatBit.mjCAT_ALL,
            self._scene,
        )
        for geom in self._scene.geoms[: self._scene.ngeom]:
            if geom.objid in self._shadowless and geom.objtype == mujoco.mjtObj.mjOBJ_GEOM:
                geom.category = mujoco.mjtCatBit.mjCAT_DECOR

    def _read(self, view: mujoco.MjrRect) -> Pixels:
        pixels = np.zeros((view.height, view.width, 3), np.uint8)
        mujoco.mjr_readPixels(pixels, None, view, self.context)
        return pixels[::-1]

    def upload_mesh(self, mesh: int) -> None:
        """Send a mesh of the model that was changed to OpenGL."""
        mujoco.mjr_uploadMesh(self._model, self.context, mesh)

    def upload_texture(self, texture: int) -> None:
        """Send a texture of the model that was changed to OpenGL."""
        mujoco.mjr_uploadTexture(self._model, self.context, texture)


@contextlib.contextmanager
def canvas(model: mujoco.MjModel, size: tuple[int, int], quality: Quality) -> Iterator[Canvas]:
    """Open a canvas for a model that ``prepare`` was applied to; one at a time in a process.

    Raises:
        RenderError: No OpenGL works here, or it has too little memory.
    """
    context: Any = open_context(choose_backend().backend, *size)
    try:
        try:
            drawing = Canvas(model, size, quality)
        except mujoco.FatalError as error:
            raise RenderError(
                f"OpenGL cannot hold pictures of {size[0]} x {size[1]} pixels: {error}; "
                "try a smaller size or the draft quality"
            ) from error
        try:
            yield drawing
        finally:
            drawing.context.free()
    finally:
        context.free()
