"""The stock as it is drawn: tiles of a mesh on the rotary table, of which only changed ones move.

A tile that is still level is drawn as two triangles; one that was cut, as a fine mesh. So the
cost of a picture follows what was machined, not the size of the stock. Normals are smooth on
gentle slopes and sharp at steps.
"""

import dataclasses

import mujoco
import numpy as np
import numpy.typing as npt

from twin.cutting.height_map_material import HeightMapMaterial
from twin.cutting.heights.colours import RAW_RGB
from twin.cutting.heights.outline import BoolArray
from twin.cutting.heights.surface_mesh import (
    SurfaceMesh,
    open_edges,
    surface_faces,
    surface_mesh,
)
from twin.cutting.heights.sweeping import Rectangle, union
from twin.nc.canonical import FloatArray, IntArray
from twin.render.drawing.canvas import Canvas
from twin.render.scene.live_mesh import LiveMesh, add_live_mesh
from twin.render.scene.placement import Placement
from twin.render.scene.shading import corner_normals, face_normals
from twin.render.scene.stock_texture import MATERIAL, StockTexture

TILE = 24
"""Squares along a tile's side."""

STEEP = 0.5
"""Cosine with the vertical below which a face is a wall, all of which looks as its foot."""

SIDE = "stock_side"
FLAT_FACES = np.array([[0, 1, 2], [0, 2, 3]])


@dataclasses.dataclass(frozen=True, slots=True)
class _Tile:
    """A rectangle of the mesh, drawn by one of two geoms.

    Attributes:
        rows: Rows of the mesh, borders included.
        columns: Columns of the mesh, borders included.
        patches: Which of its squares belong to the blank.
        whole: Whether every square of it belongs to the blank.
    """

    rows: slice
    columns: slice
    patches: BoolArray
    whole: bool
    name: str

    @property
    def flat_name(self) -> str:
        """Of its mesh of two triangles."""
        return f"{self.name}_flat"

    @property
    def ends(self) -> list[int]:
        """Its four corners, counter-clockwise from above, numbered as its vertices are."""
        width = self.columns.stop - self.columns.start
        last = (self.rows.stop - self.rows.start) * width - 1
        return [0, width - 1, last, last - width + 1]


class StockSurface:
    """Draws a height map on the rotary table.

    Use in this order: make it, ``add_to`` the specification, compile, ``bind``, then ``note_cut``
    after every cut and ``update`` before every picture.
    """

    def __init__(self, material: HeightMapMaterial, texture: StockTexture, step: int) -> None:
        """Make the drawn mesh.

        Args:
            material: The stock before it is cut.
            step: Cells from one vertex to the next.
        """
        self._material = material
        self._map = material.map
        self._changed: Rectangle = (0, 0, 0, 0)
        self._texture = texture
        self._step = step
        self._mesh = surface_mesh(self._map, step)
        self._vertices = self._mesh.vertices(self._map)
        self._tiles = _tiles(self._mesh)
        self._edges = open_edges(self._mesh.patches)
        self._side_normals = _side_normals(self._mesh, self._edges)
        self._meshes: dict[str, LiveMesh] = {}

    def add_to(self, spec: mujoco.MjSpec) -> None:
        """Add the stock's meshes, geoms and texture to a machine's specification."""
        self._texture.add_to(spec)
        raw = [value / 255 for value in (*RAW_RGB, 255)]
        spec.add_material(
            name=SIDE, rgba=raw, specular=0.45, shininess=0.55, metallic=0.3, roughness=0.45
        )
        texels = self._texture.texels(self._mesh.x, self._mesh.y)
        for tile in self._tiles:
            block = texels[tile.rows, tile.columns].reshape(-1, 2)
            add_live_mesh(spec, tile.name, MATERIAL, block, self._faces(tile))
            if tile.whole:
                add_live_mesh(spec, tile.flat_name, MATERIAL, block[tile.ends], FLAT_FACES)
        quads = np.arange(4 * len(self._edges)).reshape(-1, 4)
        self._side_faces = np.concatenate([quads[:, [1, 0, 2]], quads[:, [1, 2, 3]]])
        nowhere = np.zeros((4 * len(self._edges), 2))
        add_live_mesh(spec, SIDE, SIDE, nowhere, self._side_faces)

    def bind(self, model: mujoco.MjModel, placement: Placement) -> None:
        """Take over the compiled meshes and lay them where the part's frame is."""
        names = [SIDE, *(tile.name for tile in self._tiles)]
        names += [tile.flat_name for tile in self._tiles if tile.whole]
        self._meshes = {name: LiveMesh(model, name, placement) for name in names}
        self._texture.bind(model)
        for tile in self._tiles:
            self._set_tile(tile)
        self._set_side()

    def note_cut(self) -> None:
        """Remember which cells the last chunk changed."""
        self._changed = union(self._changed, self._material.changed)

    def update(self, canvas: Canvas) -> None:
        """Draw the map as it is now, where it was cut since the last time."""
        changed, self._changed = self._changed, (0, 0, 0, 0)
        row, row_end, column, column_end = changed
        if row >= row_end:
            return
        # Walls are looked for so far around what was cut.
        first_row, last_row = row // self._step - 1, row_end // self._step + 3
        first_column, last_column = column // self._step - 1, column_end // self._step + 3
        before = self._side_vertices()
        self._vertices = self._mesh.vertices(self._map)
        for tile in self._tiles:
            if (
                tile.rows.stop >= first_row
                and tile.rows.start <= last_row
                and tile.columns.stop >= first_column
                and tile.columns.start <= last_column
            ):
                canvas.upload_mesh(self._set_tile(tile))
        if not np.array_equal(self._side_vertices(), before):
            canvas.upload_mesh(self._set_side())
        self._texture.update(canvas, changed)

    def _faces(self, tile: _Tile) -> IntArray:
        """Vertices of a tile's faces as they are now, numbered within it, shape (n, 3)."""
        return surface_faces(tile.patches, self._vertices[tile.rows, tile.columns, 2])

    def _set_tile(self, tile: _Tile) -> int:
        """Bring one tile up to date; returns the mesh that is shown now."""
        here = (tile.rows, tile.columns)
        vertices = self._vertices[here].reshape(-1, 3)
        heights = vertices[:, 2]
        unmoved = np.stack([self._mesh.x[here].ravel(), self._mesh.y[here].ravel()], 1)
        level = tile.whole and float(np.ptp(heights)) == 0.0
        level = level and np.array_equal(vertices[:, :2], unmoved)
        fine = self._meshes[tile.name]
        fine.show(not level)
        if tile.whole:
            left = float(heights.max()) > self._map.bottom
            self._meshes[tile.flat_name].show(level and left)
        if level:
            flat = self._meshes[tile.flat_name]
            flat.put(vertices[tile.ends], np.tile([0.0, 0.0, 1.0], (6, 1)))
            return flat.id
        faces = self._faces(tile)
        corner = vertices[faces]
        solid = np.any(corner[..., 2] > self._map.bottom, axis=1)
        upwards = face_normals(corner)
        rise = corner[..., 2] - corner[..., 2].min(axis=1, keepdims=True)
        foot = np.take_along_axis(faces, rise.argmin(axis=1)[:, None], axis=1)
        above = rise > 0.5 * rise.max(axis=1, keepdims=True)
        texels = np.where((upwards[:, 2:] < STEEP) & above, foot, faces)
        fine.put_faces(np.where(solid[:, None], faces, 0), texels)
        spacing = self._step * self._map.cell
        normals = corner_normals(self._vertices[..., 2], *here, spacing, upwards, faces)
        fine.put(vertices, normals)
        return fine.id

    def _side_vertices(self) -> FloatArray:
        start, end = self._edges.T
        x, y, z = np.moveaxis(self._vertices.reshape(-1, 3), 1, 0)
        bottom = np.full(len(start), self._map.bottom)
        corners = [
            np.stack([x[start], y[start], z[start]], 1),
            np.stack([x[end], y[end], z[end]], 1),
            np.stack([x[start], y[start], bottom], 1),
            np.stack([x[end], y[end], bottom], 1),
        ]
        return np.stack(corners, 1).reshape(-1, 3)

    def _set_side(self) -> int:
        normals = np.repeat(np.concatenate([self._side_normals] * 2), 3, axis=0)
        self._meshes[SIDE].put(self._side_vertices(), normals)
        return self._meshes[SIDE].id


def _tiles(grid: SurfaceMesh) -> list[_Tile]:
    tiles = []
    rows, columns = grid.patches.shape
    for row in range(0, rows, TILE):
        for column in range(0, columns, TILE):
            patches = grid.patches[row : row + TILE, column : column + TILE]
            if not patches.any():
                continue
            height, width = patches.shape
            tiles.append(
                _Tile(
                    slice(row, row + height + 1),
                    slice(column, column + width + 1),
                    patches,
                    bool(patches.all()),
                    f"{MATERIAL}_{row}_{column}",
                )
            )
    return tiles


def _side_normals(grid: SurfaceMesh, edges: IntArray) -> npt.NDArray[np.float64]:
    """Horizontal normals of the walls below the edges, shape (n, 3)."""
    start, end = edges.T
    x, y = grid.x.ravel(), grid.y.ravel()
    normals = np.stack([y[end] - y[start], x[start] - x[end], np.zeros(len(start))], 1)
    length = np.linalg.norm(normals, axis=1, keepdims=True)
    return normals / np.maximum(length, 1e-30)
