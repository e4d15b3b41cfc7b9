"""The stock as it is drawn where it is cut from several sides: the surface of its intervals, laid again when it was cut."""

from collections.abc import Callable

import mujoco
import numpy as np

from twin.cutting.heights.colours import MACHINED_RGB, RAW_RGB, deviation_colours
from twin.cutting.tridexel.material import TriDexelMaterial
from twin.cutting.tridexel.normals import OWN, normals, tools
from twin.cutting.tridexel.surface.mesh import MOST_VERTICES, TRIANGLES, Surface, surface
from twin.nc.canonical import BoolArray, FloatArray
from twin.render.drawing.canvas import Canvas
from twin.render.scene.live_mesh import LiveMesh, add_live_mesh
from twin.render.scene.placement import Placement
from twin.render.scene.shading import SMOOTH_COSINE, face_normals
from twin.render.scene.stock_texture import MATERIAL

MESH = "stock_from_all_sides"
RAW, MACHINED = 0, 1
"""Texels of raw and machined surface."""
_SKIN = np.array([RAW_RGB, MACHINED_RGB], np.uint8)
_ROWS = 2
"""Of the texture, all alike."""
_DEVIATIONS = np.linspace(-1.0, 1.0, 255)
"""Shares of the scale whose colours are distinguished."""

Deviations = Callable[[Surface], FloatArray]
"""How far the vertices of a surface are off, as shares of a scale, shape (n,); NaN: as metal looks."""
_ROOM_TO_GROW = 0.6
"""Share of the crossings that the blank may take up: cuts add to them, and a mesh that becomes coarser is seen."""


class DexelSurface:
    """Draws a tri-dexel stock on the body that carries the part.

    Use in this order: make it, ``add_to`` the specification, compile, ``bind``, then ``note_cut`` after
    every cut and ``update`` before every picture.
    """

    def __init__(
        self, material: TriDexelMaterial, crossings: int, paint: Deviations | None = None
    ) -> None:
        """Choose how finely the stock is drawn, and how.

        Args:
            material: The stock before it is cut.
            crossings: Edges of the lattice that the drawn surface may cross; nodes are left out until
                it does not cross more.
            paint: What colours it; None: all looks like metal.
        """
        self._material, self._paint = material, paint
        self._colours = _SKIN
        if paint is not None:
            self._colours = np.concatenate([_SKIN, deviation_colours(_DEVIATIONS, 1.0)])
        self._crossings = crossings
        self._step = surface(material.stock, int(_ROOM_TO_GROW * crossings)).step
        self._changed = False

    def add_to(self, spec: mujoco.MjSpec) -> None:
        """Add mesh, geom, texture and material to a machine's specification."""
        spec.add_texture(
            name=MATERIAL,
            type=mujoco.mjtTexture.mjTEXTURE_2D,
            width=len(self._colours),
            height=_ROWS,
            builtin=mujoco.mjtBuiltin.mjBUILTIN_FLAT,
        )
        material = spec.add_material(
            name=MATERIAL, specular=0.45, shininess=0.55, metallic=1.0, roughness=0.35
        )
        material.textures[mujoco.mjtTextureRole.mjTEXROLE_RGB] = MATERIAL
        vertices = int(MOST_VERTICES * self._crossings)
        texels = np.full((vertices, 2), 0.5)
        count = len(self._colours)
        texels[:count, 0] = (np.arange(count) + 0.5) / count
        first = np.arange(TRIANGLES * self._crossings)
        stand_in = np.stack([first, first + 1, first + 2], 1) % vertices
        add_live_mesh(spec, MESH, MATERIAL, texels, stand_in)

    def bind(self, model: mujoco.MjModel, placement: Placement) -> None:
        """Take over the compiled mesh, lay it where the part's frame is and give it the blank's form."""
        first = int(model.tex_adr[model.texture(MATERIAL).id])
        colours = np.tile(self._colours, (_ROWS, 1)).ravel()
        model.tex_data[first : first + len(colours)] = colours
        self._mesh = LiveMesh(model, MESH, placement)
        self._set()

    def note_cut(self) -> None:
        """Remember whether the last chunk took anything off."""
        self._changed = self._changed or self._material.changed

    def update(self, canvas: Canvas) -> None:
        """Draw the stock as it is now, if it was cut since the last time."""
        if self._changed:
            self._changed = False
            self._set()
            canvas.upload_mesh(self._mesh.id)

    def _set(self) -> None:
        found = surface(self._material.stock, self._crossings, self._step)
        self._step = found.step
        texels = np.where(machined(found), MACHINED, RAW)
        if self._paint is not None:
            share = self._paint(found)[found.faces[:, 0]]
            colour = np.rint(0.5 * (np.clip(share, -1.0, 1.0) + 1.0) * (len(_DEVIATIONS) - 1))
            known = np.isfinite(share)
            texels[known] = len(_SKIN) + colour[known].astype(np.int64)
        self._mesh.fill(found.points, found.faces, corner_normals(found), texels)


def machined(found: Surface) -> BoolArray:
    """Which faces a tool left, shape (m,): of a face's first corner, a crossing, it is known."""
    return tools(found.facet[found.faces[:, 0]]) != OWN


def corner_normals(found: Surface) -> FloatArray:
    """Normals of the corners of faces, shape (m, 3, 3): the surface's own, across an edge of it the face's."""
    faces = face_normals(found.points[found.faces])[:, None]
    smooth = normals(found.facet)[found.faces]
    agree = (smooth * faces).sum(axis=2, keepdims=True) > SMOOTH_COSINE
    return np.where(agree, smooth, faces)
