"""The machined part as a closed mesh, and as a picture from above."""

import io
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from twin.cutting.heights.colours import RAW_RGB, Colours, surface_colours
from twin.cutting.heights.height_map import HeightMap
from twin.cutting.heights.outline import BoolArray
from twin.cutting.heights.surface_mesh import all_corners, open_edges, surface_faces, surface_mesh
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

    Walls are upright where their place is known; where the cut went through, there is a hole.
    A map of more than ``MESH_CELLS`` cells is thinned first. Nothing left gives an empty mesh.

    Args:
        colours: One for each cell, shape (ny, nx, 3); the underside is raw. None: no colours.
    """
    import trimesh

    vertices, faces, painted = _mesh(height_map, colours)
    return trimesh.Trimesh(vertices, faces, vertex_colors=painted, process=False)


def _mesh(
    height_map: HeightMap, colours: Colours | None
) -> tuple[FloatArray, IntArray, Colours | None]:
    """Corners, shape (n, 3) [mm], faces, shape (m, 3), and colours of the corners."""
    step = 1
    while height_map.heights[::step, ::step].size > MESH_CELLS:
        step += 1
    surface = surface_mesh(height_map, step)
    vertices = surface.vertices(height_map)
    heights = vertices[..., 2]
    patches = surface.patches & all_corners(heights > height_map.bottom)
    _separate_pinches(patches)
    top_faces = surface_faces(patches, heights)
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
    top = vertices.reshape(-1, 3)
    beside_holes = surface_faces(surface.patches & ~patches, heights).ravel()
    plan[beside_holes] = top[beside_holes, :2]
    bottom = np.column_stack([plan, np.full(below, height_map.bottom)])
    used, renumbered = np.unique(faces, return_inverse=True)
    middle = [*height_map.outline.center, height_map.bottom]
    painted = None
    if colours is not None:
        facet = np.where(surface.cell.ravel() < 0, 0, surface.cell.ravel())
        raw = np.tile(np.array(RAW_RGB, np.uint8), (below + 1, 1))
        painted = np.concatenate([colours.reshape(-1, 3)[facet], raw])[used]
    return (
        np.concatenate([top, bottom, [middle]])[used],
        renumbered.reshape(faces.shape),
        painted,
    )


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
        colours: One for each cell, shape (ny, nx, 3); None: raw and machined surfaces differ.

    Raises:
        OSError: The file cannot be written.
    """
    colours = surface_colours(height_map) if colours is None else colours
    export_glb(part_mesh(height_map, colours), path)


def export_glb(mesh: "trimesh.Trimesh", path: Path) -> None:
    """Write a mesh [mm], which is changed, as binary glTF, complete or not at all.

    Raises:
        OSError: The file cannot be written.
    """
    mesh.apply_transform(_TO_GLTF)
    with complete_or_absent(path) as temporary:
        mesh.export(temporary, file_type="glb")


def write_stl(height_map: HeightMap, path: Path, zero: ArrayLike = (0.0, 0.0, 0.0)) -> None:
    """Write the part as binary STL [mm], complete or not at all.

    Args:
        zero: Where the file's coordinates have their origin in the part's frame, shape (3,) [mm].

    Raises:
        OSError: The file cannot be written.
    """
    vertices, faces, _ = _mesh(height_map, None)
    text = stl_text((vertices - np.asarray(zero))[faces])
    with complete_or_absent(path) as temporary:
        temporary.write_bytes(text)


_LONGEST = 640
"""Pixels of the picture's longer side."""
_LIGHT = np.array([-0.45, 0.45, 0.77])
"""Towards the light, of length 1: from the upper left, as drawings are lit."""
_AMBIENT = 0.35
_DEEP = 0.25
"""How much darker the lowest place is than the highest, as a share."""


def part_picture(height_map: HeightMap) -> bytes:
    """A PNG of the part from above, +X to the right and +Y up; where there is no material it is clear."""
    from PIL import Image

    step = max(1, -(-max(height_map.heights.shape) // _LONGEST))
    heights = height_map.heights[::step, ::step]
    slope_y, slope_x = (
        np.gradient(heights, height_map.cell * step)
        if min(heights.shape) > 1
        else (np.zeros_like(heights),) * 2
    )
    normal = np.stack([-slope_x, -slope_y, np.ones_like(heights)], axis=-1)
    normal /= np.linalg.norm(normal, axis=-1, keepdims=True)
    light = _AMBIENT + (1.0 - _AMBIENT) * np.clip(normal @ _LIGHT, 0.0, 1.0) / _LIGHT[2]
    depth = (height_map.top - heights) / max(height_map.top - height_map.bottom, 1e-9)
    shade = np.clip(light * (1.0 - _DEEP * np.clip(depth, 0.0, 1.0)), 0.0, 1.15)
    colours = surface_colours(height_map)[::step, ::step] * shade[..., None]
    solid = height_map.solid()[::step, ::step]
    pixels = np.dstack([np.clip(colours, 0.0, 255.0), np.where(solid, 255.0, 0.0)])
    image = Image.fromarray(pixels[::-1].astype(np.uint8), "RGBA")
    larger = max(1, _LONGEST // max(image.size))
    image = image.resize((image.width * larger, image.height * larger), Image.Resampling.NEAREST)
    file = io.BytesIO()
    image.save(file, "PNG")
    return file.getvalue()
