"""The machined part as a closed mesh."""

import dataclasses
from pathlib import Path
from typing import Any

import numpy as np
import trimesh

from twin.cutting.height_map import HeightMap
from twin.cutting.outline import BoolArray
from twin.files import complete_or_absent
from twin.nc.canonical import FloatArray, IntArray

MESH_CELLS = 400_000
"""Cells of the finest mesh that is written; a finer map is thinned to it."""

_NEIGHBOURS = ((0, 1), (1, 0), (0, -1), (-1, 0), (1, 1), (1, -1), (-1, 1), (-1, -1))


@dataclasses.dataclass(frozen=True, slots=True)
class Lattice:
    """The top surface as a net of vertices, with a frame around the cells that lies on the edge.

    Attributes:
        x: Shape (my, mx) [mm].
        y: Shape (my, mx) [mm].
        z: Height, shape (my, mx) [mm].
        patches: Which squares between four vertices belong to the part, shape (my - 1, mx - 1).
    """

    x: FloatArray
    y: FloatArray
    z: FloatArray
    patches: BoolArray


def lattice(height_map: HeightMap, step: int = 1) -> Lattice:
    """The net of a height map's surface.

    Args:
        height_map: The cut stock.
        step: Take every ``step``-th cell.
    """
    x, y = height_map.x[::step], height_map.y[::step]
    spacing = step * height_map.cell
    x = np.concatenate([[x[0] - spacing], x, [x[-1] + spacing]])
    y = np.concatenate([[y[0] - spacing], y, [y[-1] + spacing]])
    grid_x, grid_y = np.meshgrid(x, y)
    inside = height_map.outline.contains(grid_x, grid_y)
    inside[[0, -1]] = False
    inside[:, [0, -1]] = False
    heights = np.pad(height_map.heights[::step, ::step], 1, constant_values=height_map.bottom)
    snapped_x, snapped_y = height_map.outline.snap(grid_x, grid_y)
    edge_height, edge = _nearest_inside(inside, heights, grid_x, grid_y, snapped_x, snapped_y)
    z = np.where(inside, heights, edge_height)
    solid = (inside | edge) & (z > height_map.bottom)
    patches = _all_corners(solid) & ~_all_corners(~inside)
    _separate_pinches(patches)
    return Lattice(
        np.where(inside, grid_x, snapped_x), np.where(inside, grid_y, snapped_y), z, patches
    )


def _nearest_inside(
    inside: BoolArray,
    heights: FloatArray,
    x: FloatArray,
    y: FloatArray,
    snapped_x: FloatArray,
    snapped_y: FloatArray,
) -> tuple[FloatArray, BoolArray]:
    """Heights for the vertices on the edge, from the nearest cell, and which these are."""
    best = np.full(x.shape, np.inf)
    result = heights.copy()
    for row, column in _NEIGHBOURS:
        moved = [np.roll(array, (row, column), (0, 1)) for array in (inside, heights, x, y)]
        distance = np.hypot(moved[2] - snapped_x, moved[3] - snapped_y)
        better = ~inside & moved[0].astype(np.bool_) & (distance < best)
        best[better] = distance[better]
        result[better] = moved[1][better]
    return result, np.isfinite(best)


def _all_corners(vertices: BoolArray) -> BoolArray:
    return vertices[:-1, :-1] & vertices[1:, :-1] & vertices[:-1, 1:] & vertices[1:, 1:]


def _separate_pinches(patches: BoolArray) -> None:
    """Take away patches that hang together at one corner only, where a solid has no thickness."""
    while True:
        a, b = patches[:-1, :-1], patches[1:, 1:]
        c, d = patches[:-1, 1:], patches[1:, :-1]
        rising, falling = a & b & ~c & ~d, c & d & ~a & ~b
        if not (rising.any() or falling.any()):
            return
        b &= ~rising
        d &= ~falling


def part_mesh(height_map: HeightMap) -> trimesh.Trimesh:
    """The cut stock as a closed mesh: its surface, walls down to the underside, the underside.

    Steps between cells become faces one cell wide; where the cut went through, there is a hole.
    A map of more than ``MESH_CELLS`` cells is thinned first. Nothing left gives an empty mesh.
    """
    step = 1
    while height_map.heights[::step, ::step].size > MESH_CELLS:
        step += 1
    net = lattice(height_map, step)
    columns = net.x.shape[1]
    row, column = np.nonzero(net.patches)
    corner = row * columns + column
    a, b, c, d = corner, corner + 1, corner + columns + 1, corner + columns
    surface = np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)])
    below = net.x.size
    open_ = _open_edges(net.patches, columns)
    start, end = open_[:, 0], open_[:, 1]
    walls = np.concatenate(
        [
            np.stack([end, start, start + below], 1),
            np.stack([end, start + below, end + below], 1),
        ]
    )
    faces = np.concatenate([surface, surface[:, ::-1] + below, walls])
    flat = np.stack([net.x.ravel(), net.y.ravel()], 1)
    top = np.column_stack([flat, net.z.ravel()])
    bottom = np.column_stack([flat, np.full(len(flat), height_map.bottom)])
    used, renumbered = np.unique(faces, return_inverse=True)
    vertices = np.concatenate([top, bottom])[used]
    return trimesh.Trimesh(vertices, renumbered.reshape(faces.shape), process=False)


def _open_edges(patches: BoolArray, columns: int) -> IntArray:
    """Edges with a patch on their left only, as vertex numbers, shape (n, 2)."""
    padded = np.pad(patches, 1)
    sides: tuple[tuple[BoolArray, tuple[int, int], tuple[int, int]], ...] = (
        (padded[:-2, 1:-1], (0, 0), (0, 1)),
        (padded[1:-1, 2:], (0, 1), (1, 1)),
        (padded[2:, 1:-1], (1, 1), (1, 0)),
        (padded[1:-1, :-2], (1, 0), (0, 0)),
    )
    edges: list[Any] = []
    for neighbour, first, last in sides:
        row, column = np.nonzero(patches & ~neighbour)
        start = (row + first[0]) * columns + column + first[1]
        end = (row + last[0]) * columns + column + last[1]
        edges.append(np.stack([start, end], 1))
    return np.concatenate(edges)


def write_stl(height_map: HeightMap, path: Path) -> None:
    """Write the part as binary STL [mm], complete or not at all.

    Raises:
        OSError: The file cannot be written.
    """
    mesh = part_mesh(height_map)
    with complete_or_absent(path) as temporary:
        mesh.export(temporary, file_type="stl")
