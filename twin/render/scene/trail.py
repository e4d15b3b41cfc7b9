"""The trail of the tool point, as a thin tube that turns with the part."""

import dataclasses

import mujoco
import numpy as np
import numpy.typing as npt

from twin.cutting.kernels.simplify import simplify
from twin.cutting.program_summary import ProgramSummary
from twin.nc.canonical import BoolArray, FloatArray, IntArray
from twin.recording.reader import Recording
from twin.render.drawing.canvas import Canvas
from twin.render.scene.live_mesh import LiveMesh, add_live_mesh
from twin.render.scene.placement import Placement

MOST_POINTS = 6000
"""Points of a whole trail; a longer one is drawn more coarsely."""

POINTS_PER_MESH = 200
"""Stretches in a piece of the trail; only the piece that grows is sent to OpenGL again."""

FINEST_MM = 0.02
"""Points within this of the trail between others are left out, to begin with [mm]."""

MOST_JOINED = 200
"""Samples that one stretch of the trail may stand for."""

FEED_RGB = (235, 94, 30)
RAPID_RGB = (60, 130, 200)
ERROR_COLOURS = 30
"""Steps of error that the trail can show; feed and rapid follow them in the palette."""
_PALETTE = ERROR_COLOURS + 2
SIDES = 3
"""Faces around the tube."""
MATERIAL = "trail"
ERROR_STOPS = ((0.0, (40, 170, 90)), (0.5, (245, 200, 40)), (1.0, (205, 25, 25)))
"""From no error to that of the scale."""


def error_palette(count: int) -> npt.NDArray[np.uint8]:
    """Colours from no error to the scale's, shape (count, 3)."""
    share = np.linspace(0.0, 1.0, count)
    stops = [stop for stop, _ in ERROR_STOPS]
    channels = [np.interp(share, stops, [rgb[i] for _, rgb in ERROR_STOPS]) for i in range(3)]
    return np.stack(channels, axis=1).round().astype(np.uint8)


@dataclasses.dataclass(frozen=True, slots=True)
class TrailPoints:
    """Where the tool point went, in the part's frame.

    Attributes:
        position: Shape (n, 3) [mm].
        sample: Number of the sample that each point is, shape (n,).
        rapid: Whether the stretch that ends here is a rapid, shape (n,).
        error: Greatest error of the stretch that ends here, shape (n,) [µm]; NaN where unknown.
    """

    position: FloatArray
    sample: IntArray
    rapid: BoolArray
    error: FloatArray

    def __getitem__(self, kept: IntArray) -> "TrailPoints":
        """A selection of the points by number; errors of those left out go to the next."""
        starts = np.append(0, kept[:-1] + 1)
        error = np.maximum.reduceat(self.error, starts) if len(kept) else self.error[:0]
        return TrailPoints(self.position[kept], self.sample[kept], self.rapid[kept], error)

    def thinned(self, tolerance: float) -> "TrailPoints":
        """Fewer points, none of those left out farther than ``tolerance`` [mm] from the trail."""
        if not len(self.position):
            return self
        group = self.rapid.astype(np.int64)
        return self[simplify(self.position[None], group, tolerance, np.inf, MOST_JOINED)]


def trail_points(recording: Recording, summary: ProgramSummary) -> TrailPoints:
    """The trail of a whole recording, with few enough points to be drawn.

    Args:
        recording: Of n samples; its contour errors colour the trail, where it has any.
        summary: What is in the spindle when, and which moves are rapids.
    """
    parts = []
    first, frame = 0, recording.header.part_frame
    for chunk in recording.chunks():
        position = frame.position(chunk.real(frame), summary.tools.lower(chunk.setpoint.move))
        sample = first + np.arange(len(chunk))
        first += len(chunk)
        error = recording.contour_um(first - len(chunk), first)
        if error is None:
            error = np.full(len(chunk), np.nan)
        rapid = summary.is_rapid(chunk.setpoint.move)
        parts.append(TrailPoints(position, sample, rapid, error).thinned(FINEST_MM))
    if not parts:
        return TrailPoints(
            np.zeros((0, 3)), np.zeros(0, np.int64), np.zeros(0, np.bool_), np.zeros(0)
        )
    points = TrailPoints(
        np.concatenate([part.position for part in parts]),
        np.concatenate([part.sample for part in parts]),
        np.concatenate([part.rapid for part in parts]),
        np.concatenate([part.error for part in parts]),
    )
    extent = float(np.ptp(points.position, axis=0).max())
    tolerance = FINEST_MM
    while len(points.position) > MOST_POINTS and tolerance < extent:
        tolerance *= 2
        points = points.thinned(tolerance)
    if len(points.position) > MOST_POINTS:
        points = points[np.linspace(0, len(points.position) - 1, MOST_POINTS).astype(np.int64)]
    return points


class Trail:
    """Draws the trail up to a moment.

    Use in this order: make it, ``add_to`` the specification, compile, ``bind``, then ``show``
    before every picture.
    """

    def __init__(self, points: TrailPoints, radius: float, error_scale_um: float) -> None:
        """Take the points.

        Args:
            radius: Of the tube [mm]; it lies on the trail, so that a floor does not hide it.
            error_scale_um: Error that has the last colour [µm].
        """
        self._scale = max(error_scale_um, 1e-9)
        self._lift = np.array([0.0, 0.0, radius])
        self._points = points = dataclasses.replace(points, position=points.position + self._lift)
        self._radius = radius
        self._vertices = _tube_vertices(points.position, radius)
        self._pieces = range(0, len(self._vertices), POINTS_PER_MESH)
        self._meshes: list[LiveMesh] = []
        self._shown = 0

    def add_to(self, spec: mujoco.MjSpec) -> None:
        """Add the trail's meshes and their palette to a machine's specification."""
        spec.add_texture(
            name=MATERIAL,
            type=mujoco.mjtTexture.mjTEXTURE_2D,
            width=_PALETTE,
            height=2,
            builtin=mujoco.mjtBuiltin.mjBUILTIN_FLAT,
        )
        material = spec.add_material(name=MATERIAL, emission=0.6, specular=0.0, shininess=0.0)
        material.metallic, material.roughness = 0.0, 1.0
        material.textures[mujoco.mjtTextureRole.mjTEXROLE_RGB] = MATERIAL
        places = (self._colours() + 0.5) / _PALETTE
        for first in self._pieces:
            across = np.repeat(places[first : first + POINTS_PER_MESH], 2 * SIDES)
            texels = np.stack([across, np.full(len(across), 0.5)], 1)
            faces = _tube_faces(len(across) // (2 * SIDES))
            add_live_mesh(spec, f"{MATERIAL}_{first}", MATERIAL, texels, faces, shadow=False)

    def _colours(self) -> IntArray:
        """Each stretch's column of the palette, shape (n - 1,)."""
        error, rapid = self._points.error[1:], self._points.rapid[1:]
        known = np.isfinite(error)
        share = np.clip(np.nan_to_num(error) / self._scale, 0.0, 1.0)
        column = np.round(share * (ERROR_COLOURS - 1)).astype(np.int64)
        column = np.where(known, column, ERROR_COLOURS)
        return np.where(rapid, ERROR_COLOURS + 1, column)

    def bind(self, model: mujoco.MjModel, placement: Placement) -> None:
        """Take over the compiled meshes; nothing is shown yet."""
        texture = int(model.texture(MATERIAL).id)
        first = int(model.tex_adr[texture])
        row = np.concatenate([error_palette(ERROR_COLOURS), [FEED_RGB, RAPID_RGB]])
        colours = np.tile(row.astype(np.uint8).ravel(), 2)
        model.tex_data[first : first + len(colours)] = colours
        self._meshes = [LiveMesh(model, f"{MATERIAL}_{first}", placement) for first in self._pieces]
        for piece in range(len(self._meshes)):
            self._put(piece, 0, None)

    def show(self, canvas: Canvas, samples: int, tip: FloatArray) -> None:
        """Draw the trail as far as the first ``samples`` of the recording go.

        Args:
            canvas: What draws the model that was bound.
            samples: How many samples lie behind.
            tip: Where the tool point is now, in the part's frame, shape (3,) [mm].
        """
        shown = max(0, int(np.searchsorted(self._points.sample, samples)) - 1)
        for piece, first in enumerate(self._pieces):
            if first <= shown and first + POINTS_PER_MESH > self._shown:
                self._put(piece, shown, tip)
                canvas.upload_mesh(self._meshes[piece].id)
        self._shown = shown

    def _put(self, piece: int, shown: int, tip: FloatArray | None) -> None:
        """Draw one piece as far as ``shown`` stretches of the whole trail go, then to the tip."""
        first = self._pieces[piece]
        tubes = self._vertices[first : first + POINTS_PER_MESH].copy()
        growing = max(0, shown - first)
        tubes[growing:] = tubes[0, 0]
        if tip is not None and shown >= first and growing < len(tubes):
            direction = np.stack([self._points.position[shown], tip + self._lift])
            tubes[growing] = _tube_vertices(direction, self._radius)[0]
        axis = tubes.mean(axis=2, keepdims=True)
        outwards = tubes - axis
        corner = _tube_faces(len(tubes))
        normals = outwards.reshape(-1, 3)[corner]
        length = np.linalg.norm(normals, axis=2, keepdims=True)
        normals = np.where(length > 0, normals / np.maximum(length, 1e-30), [0.0, 0.0, 1.0])
        self._meshes[piece].put(tubes.reshape(-1, 3), normals)
        self._meshes[piece].show(tip is not None and shown >= first)


def _tube_vertices(points: FloatArray, radius: float) -> FloatArray:
    """Rings around both ends of every stretch, shape (n - 1, 2, SIDES, 3) [mm]."""
    if len(points) < 2:
        return np.zeros((0, 2, SIDES, 3))
    direction = np.diff(points, axis=0)
    length = np.linalg.norm(direction, axis=1, keepdims=True)
    direction = np.where(length > 0, direction / np.maximum(length, 1e-30), [1.0, 0.0, 0.0])
    upright = np.abs(direction[:, 2:]) > 0.9
    aside = np.cross(direction, np.where(upright, [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]))
    aside /= np.linalg.norm(aside, axis=1, keepdims=True)
    up = np.cross(aside, direction)
    angle = np.pi / 2 + 2 * np.pi * np.arange(SIDES) / SIDES
    ring = radius * (
        np.cos(angle)[None, :, None] * aside[:, None] + np.sin(angle)[None, :, None] * up[:, None]
    )
    ends = np.stack([points[:-1], points[1:]], 1)
    return ends[:, :, None] + ring[:, None]


def _tube_faces(count: int) -> IntArray:
    """Faces around ``count`` stretches, as numbers of ``_tube_vertices``, shape (2 SIDES n, 3)."""
    side = np.arange(SIDES)
    following = (side + 1) % SIDES
    around = np.concatenate(
        [
            np.stack([side, following, following + SIDES], 1),
            np.stack([side, following + SIDES, side + SIDES], 1),
        ]
    )
    return (2 * SIDES * np.arange(count)[:, None, None] + around).reshape(-1, 3)
