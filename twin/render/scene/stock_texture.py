"""The stock's texture: raw surface, machined surface with the cutter's marks, shade in the depths."""

import mujoco
import numpy as np

from twin.cutting.heights.colours import MACHINED_RGB, RAW_RGB, Colours
from twin.cutting.heights.height_map import HeightMap
from twin.cutting.heights.sweeping import Rectangle
from twin.nc.canonical import FloatArray
from twin.render.drawing.canvas import Canvas
from twin.render.scene.shading import blurred

MATERIAL = "stock"

MOST_TEXELS = 640
"""Texels along the longer side; a finer map is thinned."""

MARK_TEXELS = 4.0
"""Distance between the cutter's marks; the true one, the feed per tooth, is too fine to be seen."""
MARK_DEPTH = 0.045
"""Share of the brightness that the marks take or add."""

GRAIN = 0.02
"""Unevenness of the raw surface, as a share of its brightness."""

SHADE_MM = 5.0
"""How far around a place the surface is looked at to see how deep it lies [mm]."""
SHADE_DEPTH = 0.5
"""Share of the light that a place loses which lies as deep as it is far from the rim."""


def _texel_step(cells: int, mesh_step: int) -> int:
    """Cells from one texel to the next: a divisor of the mesh's step, so that vertices have one."""
    fewest = max(1, -(-cells // MOST_TEXELS))
    return min(
        step
        for step in range(1, mesh_step + 1)
        if mesh_step % step == 0 and step >= min(fewest, mesh_step)
    )


class StockTexture:
    """Paints a height map; ``add_to`` the specification, compile, ``bind``, then ``update``."""

    def __init__(
        self, height_map: HeightMap, marks: FloatArray, mesh_step: int, paint: Colours | None = None
    ) -> None:
        """Choose the texture's size.

        Args:
            mesh_step: Cells from one vertex of the drawn mesh to the next.
            marks: Path of the tool at the last cut, shape (ny, nx) [mm]; of no size: no marks.
            paint: Colours to use instead where the fourth channel is not 0, shape (ny, nx, 4).
        """
        self._map = height_map
        self._marks = marks
        self._paint = paint
        self._step = _texel_step(max(height_map.heights.shape), mesh_step)
        self._rows, self._columns = height_map.heights[:: self._step, :: self._step].shape
        random = np.random.default_rng(1)
        self._grain = 1.0 + GRAIN * random.standard_normal((self._rows, self._columns))

    def add_to(self, spec: mujoco.MjSpec) -> None:
        """Add texture and material to a machine's specification."""
        spec.add_texture(
            name=MATERIAL,
            type=mujoco.mjtTexture.mjTEXTURE_2D,
            width=self._columns,
            height=self._rows,
            builtin=mujoco.mjtBuiltin.mjBUILTIN_FLAT,
        )
        material = spec.add_material(
            name=MATERIAL, specular=0.45, shininess=0.55, metallic=1.0, roughness=0.35
        )
        material.textures[mujoco.mjtTextureRole.mjTEXROLE_RGB] = MATERIAL

    def bind(self, model: mujoco.MjModel) -> None:
        """Take over the compiled texture and paint all of it."""
        self._texture = int(model.texture(MATERIAL).id)
        first = int(model.tex_adr[self._texture])
        shape = (self._rows, self._columns, 3)
        self._texels = model.tex_data[first : first + self._rows * self._columns * 3].reshape(shape)
        self._set((0, self._map.heights.shape[0], 0, self._map.heights.shape[1]))

    def texels(self, x: FloatArray, y: FloatArray) -> FloatArray:
        """Places in the texture of points of the part's frame [mm], shape (..., 2) [0 to 1]."""
        size = self._step * self._map.cell
        column = np.clip((x - self._map.origin[0]) / size, 0, self._columns - 1)
        row = np.clip((y - self._map.origin[1]) / size, 0, self._rows - 1)
        return np.stack([(column + 0.5) / self._columns, (row + 0.5) / self._rows], -1)

    def update(self, canvas: Canvas, changed: Rectangle) -> None:
        """Paint the cells that changed, which there must be."""
        self._set(changed)
        canvas.upload_texture(self._texture)

    def _set(self, changed: Rectangle) -> None:
        step = self._step
        reach = max(1, round(SHADE_MM / (step * self._map.cell)))
        row, column = (max(0, changed[i] // step - reach) for i in (0, 2))
        row_end, column_end = (-(-changed[i] // step) + reach for i in (1, 3))
        rows, columns = slice(row, row_end), slice(column, column_end)
        # The shade looks further than what is painted, so that no seam is left.
        wide_row, wide_column = max(0, row - reach), max(0, column - reach)
        wide = self._map.heights[::step, ::step][
            wide_row : row_end + reach, wide_column : column_end + reach
        ]
        here = (
            slice(row - wide_row, row - wide_row + self._texels[rows].shape[0]),
            slice(column - wide_column, column - wide_column + self._texels[:, columns].shape[1]),
        )
        heights = wide[here]
        sunk = np.clip((blurred(wide, reach)[here] - heights) / SHADE_MM, 0.0, 1.0)
        uncut = self._map.uncut[::step, ::step][wide_row : row_end + reach][:, wide_column:]
        machined = heights < uncut[here]
        light = np.where(machined, self._marked(rows, columns), self._grain[rows, columns])
        light *= 1.0 - SHADE_DEPTH * sunk
        colours = np.where(machined[..., None], MACHINED_RGB, RAW_RGB) * light[..., None]
        if self._paint is not None:
            paint = self._paint[::step, ::step][rows, columns]
            colours = np.where(paint[..., 3:], paint[..., :3], colours)
        self._texels[rows, columns] = np.clip(colours, 0, 255).astype(np.uint8)

    def _marked(self, rows: slice, columns: slice) -> FloatArray:
        """Brightness that the cutter's marks give a machined surface."""
        if not self._marks.size:
            return np.ones_like(self._grain[rows, columns])
        travel = self._marks[:: self._step, :: self._step][rows, columns]
        pitch = MARK_TEXELS * self._step * self._map.cell
        return 1.0 + MARK_DEPTH * np.sin(2 * np.pi * travel / pitch)
