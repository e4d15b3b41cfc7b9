"""The machined part as a closed mesh."""

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from twin.cutting.colours import RAW_RGB, Colours, surface_colours
from twin.cutting.height_map import HeightMap
from twin.cutting.net import all_corners, net, open_edges, surface_faces
from twin.cutting.outline import BoolArray
from twin.files.atomic import complete_or_absent
from twin.files.stl import stl_text
from twin.nc.canonical import FloatArray, IntArray
from twin.units import MM

if TYPE_CHECKING:
    import trimesh

_TO_GLTF = MM * np.array([[1.0, 0, 0, 0], [0, 0, 1, 0], [0, -1, 0, 0], [0, 0, 0, 1 / MM]])
"""From mm with Z up to m with Y up."""

MESH_CELLS = 400_000
"""Cells of the finest mesh that is written; a finer map is thinned to it."""


def part_mesh(height_map: HeightMap, colours: Colours | None = None) -> "trimesh.Trimesh":
    """The cut stock as a closed mesh: its surface, walls down to the underside, the underside.

    Steps between cells become faces one cell wide; where the cut went through, there is a hole.
    A map of more than ``MESH_CELLS`` cells is thinned first. Nothing left gives an empty mesh.

    Args:
        height_map: The cut stock.
        colours: One for each cell, shape (ny, nx, 3); the underside is raw. None: no colours.
    """
    import trimesh

    vertices, faces, painted = _net(height_map, colours)
    return trimesh.Trimesh(vertices, faces, vertex_colors=painted, process=False)


def _net(
    height_map: HeightMap, colours: Colours | None
) -> tuple[FloatArray, IntArray, Colours | None]:
    """Corners, shape (n, 3) [mm], faces, shape (m, 3), and colours of the corners."""
    step = 1
    while height_map.heights[::step, ::step].size > MESH_CELLS:
        step += 1
    surface = net(height_map, step)
    heights = surface.heights(height_map)
    patches = surface.patches & all_corners(heights > height_map.bottom)
    _separate_pinches(patches)
    top_faces = surface_faces(patches)
    below = heights.size
    start, end = open_edges(patches).T
    walls = np.concatenate(
        [
            np.stack([end, start, start + below], 1),
            np.stack([end, start + below, end + below], 1),
        ]
    )
    if np.array_equal(patches, surface.patches) and height_map.outline.convex:
        apex = np.full(len(start), 2 * below)
        underside = np.stack([end + below, start + below, apex], 1)
    else:
        underside = top_faces[:, ::-1] + below
    faces = np.concatenate([top_faces, underside, walls])
    plan = np.stack([surface.x.ravel(), surface.y.ravel()], 1)
    top = np.column_stack(
        [*(place.ravel() for place in surface.places(height_map)), heights.ravel()]
    )
    bottom = np.column_stack([plan, np.full(below, height_map.bottom)])
    used, renumbered = np.unique(faces, return_inverse=True)
    middle = [*height_map.outline.center, height_map.bottom]
    vertices = np.concatenate([top, bottom, [middle]])[used]
    painted = None
    if colours is not None:
        skin = np.where(surface.cell.ravel() < 0, 0, surface.cell.ravel())
        raw = np.tile(np.array(RAW_RGB, np.uint8), (below + 1, 1))
        painted = np.concatenate([colours.reshape(-1, 3)[skin], raw])[used]
    return vertices, renumbered.reshape(faces.shape), painted


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


def write_glb(height_map: HeightMap, path: Path, colours: Colours | None = None) -> None:
    """Write the part as binary glTF, which browsers and viewers show in colours.

    Lengths are metres and Y points up, as glTF has it.

    Args:
        height_map: The cut stock.
        path: The file, complete or not at all.
        colours: One for each cell, shape (ny, nx, 3); None: raw and machined surfaces differ.

    Raises:
        OSError: The file cannot be written.
    """
    mesh = part_mesh(height_map, surface_colours(height_map) if colours is None else colours)
    mesh.apply_transform(_TO_GLTF)
    with complete_or_absent(path) as temporary:
        mesh.export(temporary, file_type="glb")


def write_stl(height_map: HeightMap, path: Path, zero: ArrayLike = (0.0, 0.0, 0.0)) -> None:
    """Write the part as binary STL [mm], complete or not at all.

    Args:
        height_map: The cut stock.
        path: The file.
        zero: Where the file's coordinates have their origin in the part's frame, shape (3,) [mm].

    Raises:
        OSError: The file cannot be written.
    """
    vertices, faces, _ = _net(height_map, None)
    text = stl_text((vertices - np.asarray(zero))[faces])
    with complete_or_absent(path) as temporary:
        temporary.write_bytes(text)
