"""The drawn machine with its stock and trail, brought forward along a recording."""

import contextlib
import math
from collections.abc import Callable, Iterator
from typing import NamedTuple

import mujoco
import numpy as np

from twin.cutting.cut import Cutter
from twin.cutting.height_map_material import HeightMapMaterial
from twin.cutting.heights.colours import Colours
from twin.cutting.material import Material
from twin.cutting.tridexel.material import TriDexelMaterial
from twin.machine.description.kinematics import part_carrier
from twin.nc.canonical import FloatArray
from twin.recording.reader import Samples
from twin.render.drawing.canvas import Canvas, Focus, Pixels, Quality
from twin.render.drawing.chips import Chips, chips
from twin.render.drawing.renderer import Renderer, open_canvas, prepare
from twin.render.scene.cameras import PART_CAMERAS, SMALLEST_MM, add_part_cameras, framed
from twin.render.scene.dexel_surface import Deviations, DexelSurface
from twin.render.scene.placement import Joints, Placement, place, tip_position
from twin.render.scene.scene import RenderScene
from twin.render.scene.stock_surface import StockSurface
from twin.render.scene.stock_texture import StockTexture
from twin.render.scene.tool_body import ToolBodies
from twin.render.scene.trail import Trail, trail_points
from twin.render.scene.work_holding import add_work_holding
from twin.units import MM

WARNINGS = {
    "rapid": "rapid into stock",
    "standing": "feed with the spindle off",
    "arrival": "tool changed in the material",
    "flute": "deeper than the flutes",
    "shank": "shank in the material",
    "holder": "holder in the material",
}

OF_LATE_S = 0.02
"""What was cut within this time throws chips [s]."""

_NO_POINTS = np.zeros(0, np.int64)

BETWEEN_FIELDS = 255
"""Grey of the line between the fields of a split picture."""

SHADOWS_OVER_MACHINE = 0.55
"""Radius in which shadows fall, as a share of the machine's extent."""
SHADOWS_OVER_PART = 1.6
"""Radius of the shadows for the part's cameras, as a share of the radius around the part."""

TRAIL_SHARE = 0.003
"""Radius of the trail's tube, as a share of the trail's extent."""
TRAIL_MM = (0.1, 0.8)
"""Its smallest and largest radius [mm]."""


class _Props(NamedTuple):
    """What is drawn in addition to the machine, and where it is."""

    placement: Placement
    cutter: Cutter | None
    surface: StockSurface | DexelSurface | None
    trail: Trail
    tools: ToolBodies
    seen: tuple[FloatArray, float]
    """Middle and radius of what the part's cameras look at, in the part's frame [mm]."""

    def bind(self, model: mujoco.MjModel) -> None:
        """Find everything in the compiled model."""
        if self.surface is not None:
            self.surface.bind(model, self.placement)
        self.trail.bind(model, self.placement)
        self.tools.bind(model)


class ScenePlayer:
    """Plays a scene; open it with ``stage``."""

    def __init__(
        self,
        scene: RenderScene,
        model: mujoco.MjModel,
        props: _Props,
        drawing: Canvas,
        size: tuple[int, int],
    ) -> None:
        self.model = model
        self.data = mujoco.MjData(model)
        self.placement, self._cutter, self._surface, self._trail, self._tools, self._seen = props
        self._scene = scene
        self._drawing = drawing
        self._size = size
        self._tool = scene.summary.tools.tools[0]
        self._move = 0
        self._joints = Joints(scene.machine, model)
        self._samples = 0
        self._rate = 0.0
        self._position = self._start = np.zeros(len(scene.machine.axes))
        mujoco.mj_forward(model, self.data)

    def advance(self, samples: Samples) -> None:
        """Go on by samples that follow the last ones: move the axes, cut the stock."""
        if not len(samples):
            return
        if not self._samples:
            self._start = samples.joint_position[0]
        self._samples += len(samples)
        self._position = samples.joint_position[-1]
        self._move = int(samples.setpoint.move[-1])
        self._tool = self._scene.summary.tools.at(self._move)
        if self._cutter is not None:
            period = self._scene.recording.header.period_s
            late = min(len(samples), max(1, round(OF_LATE_S / period)))
            self._cut(samples[:-late])
            self._rate = self._cut(samples[-late:]) / (late * period)

    def clear_view(self) -> None:
        """Take the tool back to where it was at the start, so that it does not hide the part."""
        self._position, self._rate = self._start, 0.0

    def _cut(self, samples: Samples) -> float:
        """Take the samples' material off; returns how much [mm³]."""
        assert self._cutter is not None
        assert self._surface is not None
        removed = self._cutter.add(samples, self._scene.summary.is_rapid(samples.setpoint.move))
        self._surface.note_cut()
        return removed

    def warning(self, line: int) -> str:
        """What the running block does to the part that it must not; empty for nothing."""
        if self._cutter is not None:
            for event in self._cutter.events():
                if event.line == line:
                    return f"{WARNINGS[event.what]}: {event.depth_mm:.2f} mm"
        return ""

    def picture(self, *cameras: str) -> Pixels:
        """Draw what cameras see now, side by side in equal fields, shape (height, width, 3)."""
        self.refresh()
        return self.begin_picture(*cameras)()

    def begin_picture(self, *cameras: str) -> Callable[[], Pixels]:
        """Begin to draw what cameras see, as of the last ``refresh``.

        Returns:
            What waits for the picture and gives it; to be called once, before anything else is drawn.
        """
        spray = self._spray()
        if len(cameras) == 1:
            return self._begin(cameras[0], self._size, spray)
        width, height = self._size
        columns = math.ceil(math.sqrt(len(cameras)))
        rows = -(-len(cameras) // columns)
        field = (width // columns, height // rows)
        whole = np.full((height, width, 3), BETWEEN_FIELDS, np.uint8)
        for number, camera in enumerate(cameras):
            view = self._begin(camera, field, spray)()
            top, left = field[1] * (number // columns), field[0] * (number % columns)
            edge = (field[1] - (1 if rows > 1 else 0), field[0] - 1)
            whole[top : top + edge[0], left : left + edge[1]] = view[: edge[0], : edge[1]]
        return lambda: whole

    def _begin(self, camera: str, size: tuple[int, int], spray: Chips) -> Callable[[], Pixels]:
        number = int(self.model.camera(camera).id)
        return self._drawing.begin(self.data, number, size, self._focus(camera), spray)

    def objects(self, camera: str) -> np.ndarray[tuple[int, int], np.dtype[np.int32]]:
        """Number of the geom that every pixel shows now, -1 for none, shape (height, width)."""
        self.refresh()
        return self._drawing.draw_objects(self.data, int(self.model.camera(camera).id))

    @property
    def _tip(self) -> FloatArray:
        """Where the tool point is, in the part's frame, shape (3,) [mm]."""
        frame, length_difference = (
            self._scene.recording.header.part_frame,
            self._scene.summary.tools.length_difference,
        )
        return frame.position(self._position[None], length_difference(self._tool))[0]

    def _spray(self) -> Chips:
        """Chips of what was removed last; out of a slot of a height map they fly from its upper edge."""
        tip = tip_position(self.model, self.data, self._tool.length)
        if self._cutter is not None and not self._cutter.tilts:
            tip[2] += MM * max(0.0, self._cutter.map.top - self._tip[2])
        return chips(tip, MM * self._tool.diameter, self._rate, self._samples)

    def _focus(self, camera: str) -> Focus:
        """Where a camera needs shadows: around the part, or all over the machine."""
        if camera not in PART_CAMERAS:
            stat = self.model.stat
            return Focus(stat.center.copy(), SHADOWS_OVER_MACHINE * float(stat.extent))
        table = self.data.body(part_carrier(self.model))
        middle, radius = self._seen
        center = table.xpos + table.xmat.reshape(3, 3) @ self.placement.points(middle[None])[0]
        return Focus(center, SHADOWS_OVER_PART * MM * max(radius, SMALLEST_MM))

    def refresh(self) -> None:
        """Bring what is drawn to where the machine and the stock are now."""
        turns = self._scene.summary.spindle.at(self._move)
        self._tools.show(self._tool, 1.0 if turns is None else float(np.sign(turns)))
        self._joints.set(self.data, self._position)
        mujoco.mj_forward(self.model, self.data)
        if self._surface is not None:
            self._surface.update(self._drawing)
        if self._samples:
            self._trail.show(self._drawing, self._samples, self._tip)


@contextlib.contextmanager
def stage(
    scene: RenderScene,
    size: tuple[int, int],
    quality: Quality,
    *,
    renderer: Renderer = "opengl",
    paint: Colours | Deviations | None = None,
    trail: bool = True,
) -> Iterator[ScenePlayer]:
    """Build the drawn machine and open the canvas.

    Args:
        size: Width and height of the pictures [px].
        paint: Colours of the stock's cells, shape (ny, nx, 4), as metal looks where the fourth is 0; or, of one
            that is cut from several sides, what colours its surface; None: all looks like metal.

    Raises:
        RenderError: The renderer does not work here.
        ConfigError: The stock is too large for its grid.
    """
    spec = scene.spec.copy()
    props = _build_props(spec, scene, quality, paint, trail=trail)
    prepare(spec, renderer, quality, size)
    model = spec.compile()
    props.bind(model)
    with open_canvas(model, renderer, size, quality) as drawing:
        yield ScenePlayer(scene, model, props, drawing, size)


def _build_props(
    spec: mujoco.MjSpec,
    scene: RenderScene,
    quality: Quality,
    paint: Colours | Deviations | None,
    *,
    trail: bool,
) -> _Props:
    """Add stock, work holding, cameras, trail and tools to a machine's specification."""
    header = scene.recording.header
    length = scene.summary.tools.tools[0].length
    placement = place(scene.machine, spec.compile(), length, header.part_frame)
    cutter = surface = None
    corner = header.part_frame.program_zero(header.part_zero)
    if scene.stock is not None:
        cutter = Cutter(
            scene.stock,
            scene.summary.tools,
            header.part_frame,
            header.part_zero,
            keep_marks=True,
            tilts=scene.summary.tilts,
        )
        surface = _stock_surface(cutter.material, quality, paint)
        surface.add_to(spec)
        add_work_holding(spec, scene.stock, placement, corner)
    points = trail_points(scene.recording, scene.summary)
    seen = framed(points.position if cutter is None else cutter.material.corners)
    add_part_cameras(spec, placement, *seen)
    tool_trail = Trail(
        points if trail else points[_NO_POINTS], _trail_radius(points.position), scene.error_scale
    )
    tool_trail.add_to(spec)
    tools = ToolBodies(scene.summary.tools, scene.machine.file.spindle.flange_diameter)
    tools.add_to(spec)
    return _Props(placement, cutter, surface, tool_trail, tools, seen)


def _stock_surface(
    material: Material, quality: Quality, paint: Colours | Deviations | None
) -> StockSurface | DexelSurface:
    """What draws the stock, by what describes it."""
    if isinstance(material, TriDexelMaterial):
        assert paint is None or callable(paint)
        return DexelSurface(material, quality.drawn_crossings, paint)
    assert isinstance(material, HeightMapMaterial)
    assert not callable(paint)
    cells = material.map.heights.shape
    step = max(1, -(-max(cells) // quality.drawn_cells))
    return StockSurface(material, StockTexture(material.map, material.marks, step, paint), step)


def _trail_radius(points: FloatArray) -> float:
    if not len(points):
        return TRAIL_MM[0]
    return float(np.clip(TRAIL_SHARE * np.ptp(points, axis=0).max(), *TRAIL_MM))
