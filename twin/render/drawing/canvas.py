"""What draws: the interface that the renderers share, and the passes that a picture is made of."""

import abc
import dataclasses
import math
from collections.abc import Callable

import mujoco
import numpy as np
import numpy.typing as npt

from twin.errors import RenderError
from twin.nc.canonical import FloatArray
from twin.render.drawing.chips import Chips

Pixels = npt.NDArray[np.uint8]

SHOWN_GROUPS = (0, 1, 2)
"""Geom groups that pictures show; collision shapes and hidden things lie in others."""
HIDDEN_GROUP = 5
"""Geom group of what is hidden for a while."""

LAMP_RADIUS = 0.22
"""Radius of the lamps over their distance: a photographer's large soft box."""
_GOLDEN_ANGLE = 2.399963
"""Turn from one place on a lamp to the next, which fills its disc evenly [rad]."""
_GRID_STEPS = np.array([0.7548776662, 0.5698402910])
"""Steps across a pixel from pass to pass that fill it evenly: powers of the plastic number."""

ROUNDNESS = 96
"""Sides that cylinders are drawn with."""

_LIGHT_FAR = 2.0
"""Distance of a light from the middle of its shadows, as a share of their radius."""

_SPARE_GEOMS = 200
"""Scene geoms in addition to the model's own, for lights' and frames' decoration."""


@dataclasses.dataclass(frozen=True, slots=True)
class Quality:
    """What a picture may cost.

    Attributes:
        passes: Pictures that are averaged, each with the lamps and the grid of pixels a little
            elsewhere: shadows become soft and edges smooth. One alone has neither.
        drawn_cells: Most vertices of the drawn stock along its longer side, where it is a height map.
        drawn_crossings: Edges of a tri-dexel stock's lattice that its drawn surface may cross at most.
        shadow_map: Side of the shadow map [px].
    """

    passes: int
    drawn_cells: int
    drawn_crossings: int
    shadow_map: int = 2048

    @property
    def shadows(self) -> bool:
        """Whether the lamps cast shadows."""
        return self.passes > 1

    @property
    def for_still(self) -> "Quality":
        """What a still may cost, which is looked at for longer than a film's frame."""
        if not self.shadows:
            return self
        return dataclasses.replace(self, passes=STILL_PASSES * self.passes)


STILL_PASSES = 4
"""Passes of a still for every one of a film's frame."""

DRAFT = Quality(passes=1, drawn_cells=160, drawn_crossings=40_000)
FINAL = Quality(passes=6, drawn_cells=640, drawn_crossings=120_000)
QUALITIES = {"draft": DRAFT, "final": FINAL}


def quality_named(name: str) -> Quality:
    """The quality of a name.

    Raises:
        RenderError: There is none.
    """
    if name not in QUALITIES:
        raise RenderError(f"no quality '{name}': there are {', '.join(QUALITIES)}")
    return QUALITIES[name]


def prepare_size(spec: mujoco.MjSpec, quality: Quality, size: tuple[int, int]) -> None:
    """Set what the model must say about any renderer's pictures before it is compiled."""
    spec.visual.global_.offwidth, spec.visual.global_.offheight = size
    spec.visual.quality.offsamples = 0
    spec.visual.quality.numslices = ROUNDNESS
    spec.visual.quality.shadowsize = quality.shadow_map


@dataclasses.dataclass(frozen=True, slots=True)
class Focus:
    """A ball in the world, in which shadows are drawn.

    Attributes:
        center: Shape (3,) [m].
        radius: [m].
    """

    center: FloatArray
    radius: float


class Canvas(abc.ABC):
    """Draws a model that was prepared for it; ``open_canvas`` opens one."""

    def __init__(self, model: mujoco.MjModel, size: tuple[int, int], quality: Quality) -> None:
        self._model = model
        self._size = size
        self._passes = quality.passes
        self._scene = mujoco.MjvScene(model, model.ngeom + _SPARE_GEOMS)
        self._option = mujoco.MjvOption()
        self._option.geomgroup[:] = False
        self._option.geomgroup[list(SHOWN_GROUPS)] = True
        self._camera = mujoco.MjvCamera()
        self._camera.type = mujoco.mjtCamera.mjCAMERA_FIXED
        self._changed_meshes: set[int] = set()
        self._changed_textures: set[int] = set()

    def draw(
        self,
        data: mujoco.MjData,
        camera: int,
        size: tuple[int, int] | None = None,
        focus: Focus | None = None,
        spray: Chips | None = None,
    ) -> Pixels:
        """Draw one frame: ``begin`` it and wait for it.

        Returns:
            Shape (height, width, 3), top row first.
        """
        return self.begin(data, camera, size, focus, spray)()

    def begin(
        self,
        data: mujoco.MjData,
        camera: int,
        size: tuple[int, int] | None = None,
        focus: Focus | None = None,
        spray: Chips | None = None,
    ) -> Callable[[], Pixels]:
        """Begin to draw one frame, while which the caller goes on to the next.

        Args:
            data: Positions of everything (after ``mj_forward`` or the like).
            size: Width and height, at most those of the canvas [px]; None: all of it.
            focus: Where shadows fall; None: as the model says.
            spray: Chips in the air; they cast no shadows.

        Returns:
            What waits for the frame and gives its pixels, shape (height, width, 3), top row first; to be
            called once, before anything else is drawn.
        """
        width, height = size or self._size
        self._camera.fixedcamid = camera
        self._send_changes()
        if self._passes == 1:
            self._update(data, spray)
            self._render(width, height)
            return lambda: self._read(width, height)
        total = np.zeros((height, width, 3), np.uint16)
        directions = data.light_xdir.copy()
        for number in range(self._passes):
            if number:
                total += self._read(width, height)
            self._aim_lamps(data, directions, number, focus)
            self._update(data, spray)
            self._shift(height, (number * _GRID_STEPS) % 1.0 - 0.5)
            self._render(width, height)
        data.light_xdir[:] = directions

        def mean() -> Pixels:
            sums = total + self._read(width, height)
            return ((sums + self._passes // 2) // self._passes).astype(np.uint8)

        return mean

    def upload_mesh(self, mesh: int) -> None:
        """Send a mesh of the model that was changed to the renderer, with the next picture."""
        self._changed_meshes.add(mesh)

    def upload_texture(self, texture: int) -> None:
        """Send a texture of the model that was changed to the renderer, with the next picture."""
        self._changed_textures.add(texture)

    def _send_changes(self) -> None:
        for mesh in self._changed_meshes:
            self._send_mesh(mesh)
        for texture in self._changed_textures:
            self._send_texture(texture)
        self._changed_meshes.clear()
        self._changed_textures.clear()

    @abc.abstractmethod
    def draw_objects(self, data: mujoco.MjData, camera: int) -> npt.NDArray[np.int32]:
        """Which geom every pixel shows: its number in the model, -1 for none.

        Returns:
            Shape (height, width).
        """

    @abc.abstractmethod
    def _send_mesh(self, mesh: int) -> None:
        """Send a mesh of the model that was changed to the renderer."""

    @abc.abstractmethod
    def _send_texture(self, texture: int) -> None:
        """Send a texture of the model that was changed to the renderer."""

    @abc.abstractmethod
    def close(self) -> None:
        """Give back what the renderer holds."""

    @abc.abstractmethod
    def _update(self, data: mujoco.MjData, spray: Chips | None = None) -> None:
        """Bring the renderer's scene, and the cameras of ``_scene``, to the state of ``data``."""

    @abc.abstractmethod
    def _render(self, width: int, height: int) -> None:
        """Begin to draw the scene once."""

    @abc.abstractmethod
    def _read(self, width: int, height: int) -> Pixels:
        """Wait for what was rendered, shape (height, width, 3), top row first."""

    @abc.abstractmethod
    def _limit_shadows(self, radius: float) -> None:
        """Spread the shadow map over a ball of a radius [m], where the renderer has a setting for it."""

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
            direction = straight + reach * (math.cos(turn) * aside + math.sin(turn) * upwards)
            data.light_xdir[light] = direction / np.linalg.norm(direction)
            if focus is not None:
                self._limit_shadows(focus.radius)
                data.light_xpos[light] = (
                    focus.center - _LIGHT_FAR * focus.radius * data.light_xdir[light]
                )

    def _shift(self, height: int, pixels: FloatArray) -> None:
        """Move the scene's camera by parts of a pixel, across and up."""
        for eye in self._scene.camera:
            pixel = (eye.frustum_top - eye.frustum_bottom) / height
            eye.frustum_center += pixel * pixels[0]
            eye.frustum_top += pixel * pixels[1]
            eye.frustum_bottom += pixel * pixels[1]
