"""The one place that draws: a MuJoCo scene in an off-screen OpenGL context."""

import contextlib
import dataclasses
import math
from collections.abc import Iterator
from typing import Any

import mujoco
import numpy as np
import numpy.typing as npt

from twin.errors import RenderError
from twin.nc.canonical import FloatArray
from twin.render.chips import RGBA as CHIP_RGBA
from twin.render.chips import Chips
from twin.render.gl import choose_backend, open_context

Pixels = npt.NDArray[np.uint8]

SHOWN_GROUPS = (0, 1, 2)
"""Geom groups that pictures show; collision shapes and hidden things lie in others."""
HIDDEN_GROUP = 5
"""Geom group of what is hidden for a while."""

FILL_SHARE = 0.2
"""Share of a light that its shadows do not take away."""

LAMP_RADIUS = 0.22
"""Radius of the lamps over their distance: a photographer's large soft box."""
_GOLDEN_ANGLE = 2.399963
"""Turn from one place on a lamp to the next, which fills its disc evenly [rad]."""
_GRID_STEPS = np.array([0.7548776662, 0.5698402910])
"""Steps across a pixel from pass to pass that fill it evenly: powers of the plastic number."""

SHADOWLESS = "trail"
"""What the names of geoms that cast no shadow begin with."""

ROUNDNESS = 96
"""Sides that cylinders are drawn with."""

_LIGHT_FAR = 2.0
"""Distance of a light from the middle of its shadows, as a share of their radius."""

_SPARE_GEOMS = 200
"""Scene geoms beside the model's own, for lights' and frames' decoration."""


@dataclasses.dataclass(frozen=True, slots=True)
class Quality:
    """What a picture may cost.

    Attributes:
        passes: Pictures that are averaged, each with the lamps and the grid of pixels a little
            elsewhere: shadows become soft and edges smooth. One alone has neither.
        drawn_cells: Most vertices of the drawn stock along its longer side.
        shadow_map: Side of the shadow map [px].
    """

    passes: int
    drawn_cells: int
    shadow_map: int = 2048

    @property
    def shadows(self) -> bool:
        """Whether the lamps cast shadows."""
        return self.passes > 1

    @property
    def for_still(self) -> "Quality":
        """The same for a picture that is looked at for longer than a film's."""
        if not self.shadows:
            return self
        return dataclasses.replace(self, passes=STILL_PASSES * self.passes)


STILL_PASSES = 4
"""Passes of a still for every one of a film's frame."""

DRAFT = Quality(passes=1, drawn_cells=160)
FINAL = Quality(passes=6, drawn_cells=640)
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
    spec.visual.quality.offsamples = 0
    spec.visual.quality.numslices = ROUNDNESS
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
        self._scene.flags[mujoco.mjtRndFlag.mjRND_REFLECTION] = False
        self._passes = quality.passes
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
        spray: Chips | None = None,
    ) -> Pixels:
        """Draw one frame, top row first.

        Args:
            data: Positions of everything (after ``mj_forward`` or the like).
            camera: Number of the camera in the model.
            size: Width and height, at most those of the canvas [px]; None: all of it.
            focus: Where shadows fall; None: as the model says.
            spray: Chips in the air; they cast no shadows.

        Returns:
            Shape (height, width, 3).
        """
        view = self._view if size is None else mujoco.MjrRect(0, 0, *size)
        if self._passes == 1:
            self._update(data, camera, spray)
            mujoco.mjr_render(view, self._scene, self.context)
            return self._read(view)
        total = np.zeros((view.height, view.width, 3), np.uint16)
        directions = data.light_xdir.copy()
        for number in range(self._passes):
            self._aim_lamps(data, directions, number, focus)
            self._update(data, camera, spray)
            self._shift(view, (number * _GRID_STEPS) % 1.0 - 0.5)
            mujoco.mjr_render(view, self._scene, self.context)
            total += self._read(view)
        data.light_xdir[:] = directions
        return ((total + self._passes // 2) // self._passes).astype(np.uint8)

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

    def _aim_lamps(
        self, data: mujoco.MjData, directions: FloatArray, number: int, focus: Focus | None
    ) -> None:
        """Let the lamps that cast shadows shine from one place of their discs.

        The shadow map is spread over the focus alone: the smaller, the sharper the shadows.
        """
        reach = LAMP_RADIUS * math.sqrt((number + 0.5) / self._passes)
        turn = _GOLDEN_ANGLE * number
        for light in np.flatnonzero(self._model.light_castshadow):
            straight = directions[light]
            aside = np.cross(straight, np.eye(3)[np.argmin(np.abs(straight))])
            aside /= np.linalg.norm(aside)
            upwards = np.cross(aside, straight)
            way = straight + reach * (math.cos(turn) * aside + math.sin(turn) * upwards)
            data.light_xdir[light] = way / np.linalg.norm(way)
            if focus is not None:
                self.context.shadowClip = focus.radius
                data.light_xpos[light] = (
                    focus.center - _LIGHT_FAR * focus.radius * data.light_xdir[light]
                )

    def _shift(self, view: mujoco.MjrRect, pixels: FloatArray) -> None:
        """Move the scene's camera by parts of a pixel, across and up."""
        for eye in self._scene.camera:
            height = eye.frustum_top - eye.frustum_bottom
            pixel = height / view.height
            eye.frustum_center += pixel * pixels[0]
            eye.frustum_top += pixel * pixels[1]
            eye.frustum_bottom += pixel * pixels[1]

    def _update(self, data: mujoco.MjData, camera: int, spray: Chips | None = None) -> None:
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
        if spray is not None:
            self._add_chips(spray)

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
