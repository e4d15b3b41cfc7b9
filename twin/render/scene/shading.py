"""Normals of the drawn stock: smooth on gentle slopes, sharp at steps, even along walls."""

import numpy as np

from twin.nc.canonical import FloatArray, IntArray

SMOOTH_COSINE = 0.8
"""Faces whose normal differs more than this from a vertex's are walls and keep their own slope, so
that steps look like steps."""

OPPOSED = -0.5
"""A wall's face takes the wall's direction unless it points the opposite way (cosine)."""

WALL_RADIUS = 3
"""Vertices on either side that the direction of a wall is taken from: the grid's stairs vanish."""


def corner_normals(
    heights: FloatArray, rows: slice, columns: slice, spacing: float, faces: FloatArray,
    corners: IntArray,
) -> FloatArray:  # fmt: skip
    """Normals for every corner of every face of a tile.

    Args:
        heights: Of the whole mesh, shape (my, mx) [mm].
        rows: The tile's rows of the mesh.
        columns: The tile's columns of the mesh.
        spacing: Between vertices [mm].
        faces: Normals of the tile's faces, shape (m, 3).
        corners: Numbers of their corners within the tile, shape (m, 3).

    Returns:
        Shape (m, 3, 3).
    """
    slope_x = _gentler(np.diff(heights[rows], axis=1), 1)[:, columns]
    slope_y = _gentler(np.diff(heights[:, columns], axis=0), 0)[rows]
    smooth = np.stack([-slope_x / spacing, -slope_y / spacing, np.ones_like(slope_x)], -1)
    smooth = (smooth / np.linalg.norm(smooth, axis=-1, keepdims=True)).reshape(-1, 3)[corners]
    cosine = (faces[:, None] * smooth).sum(axis=2, keepdims=True)
    walls = _wall_directions(heights, rows, columns)[corners]
    steepness = np.sqrt(np.maximum(1.0 - faces[:, 2] ** 2, 0.0))[:, None, None]
    upright = np.concatenate(
        [walls * steepness, np.broadcast_to(faces[:, None, 2:], (*walls.shape[:2], 1))], axis=2
    )
    agree = (upright * faces[:, None]).sum(axis=2, keepdims=True) > OPPOSED
    sharp = np.where(agree, upright, faces[:, None])
    return np.where(cosine > SMOOTH_COSINE, smooth, sharp)


def face_normals(corner: FloatArray) -> FloatArray:
    """Unit normals of faces with corners of shape (n, 3, 3); upwards where a face has no area."""
    normals = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
    length = np.linalg.norm(normals, axis=1, keepdims=True)
    return np.where(length > 0, normals / np.maximum(length, 1e-30), [0.0, 0.0, 1.0])


def blurred(values: FloatArray, radius: int) -> FloatArray:
    """Mean over a square of 2 radius + 1 cells, edges repeated outwards, same shape."""
    width = 2 * radius + 1
    for axis in (0, 1):
        pad = [(0, 0), (0, 0)]
        pad[axis] = (radius + 1, radius)
        total = np.cumsum(np.pad(values, pad, mode="edge"), axis=axis)
        count = values.shape[axis]
        upper = np.take(total, np.arange(width, width + count), axis=axis)
        lower = np.take(total, np.arange(count), axis=axis)
        values = (upper - lower) / width
    return values


def _wall_directions(heights: FloatArray, rows: slice, columns: slice) -> FloatArray:
    """Where the surface falls to around each vertex of a tile, unit vectors in X and Y, (n, 2)."""
    margin = WALL_RADIUS + 1
    first_row, first_column = max(0, rows.start - margin), max(0, columns.start - margin)
    around = heights[first_row : rows.stop + margin, first_column : columns.stop + margin]
    even = blurred(around, WALL_RADIUS)
    slope_y, slope_x = np.gradient(even, axis=0), np.gradient(even, axis=1)
    row, column = rows.start - first_row, columns.start - first_column
    here = (
        slice(row, row + rows.stop - rows.start),
        slice(column, column + columns.stop - columns.start),
    )
    direction = -np.stack([np.asarray(slope_x)[here], np.asarray(slope_y)[here]], -1).reshape(-1, 2)
    length = np.linalg.norm(direction, axis=1, keepdims=True)
    return direction / np.maximum(length, 1e-30)


def _gentler(steps: FloatArray, axis: int) -> FloatArray:
    """Per vertex the smaller of the height steps before and after it; 0 where they differ in sign."""
    edge = [(0, 0), (0, 0)]
    edge[axis] = (1, 0)
    before = np.pad(steps, edge, mode="edge")
    edge[axis] = (0, 1)
    after = np.pad(steps, edge, mode="edge")
    smaller = np.where(np.abs(before) < np.abs(after), before, after)
    return np.where(before * after > 0, smaller, 0.0)
