"""A solid of any shape as convex parts, which is how MuJoCo holds meshes against each other.

Where the hull of a part stands out of its surface, the part is cut in two by the level or upright plane through the
place at which it stands out most that leaves the smallest hulls; so what is made of plates and blocks is cut at
their faces, and its parts are exact.
"""

import functools
import itertools
from pathlib import Path

import mujoco
import numpy as np

from twin.errors import ConfigError
from twin.files.stl import read_stl
from twin.nc.canonical import FloatArray, IntArray
from twin.units import MM

STANDS_OUT = 0.05
"""How far a part's hull may stand out of the solid [mm]: the gap that a run must tell from contact."""
MOST_PARTS = 64
"""Of one solid: each is held against all that moves."""
FLAT = 1e-6
"""Corners this near to a plane lie in it [mm]."""


@functools.cache
def convex_parts(path: Path) -> tuple[FloatArray, ...]:
    """The corners of the convex parts of an STL file's solid.

    Returns:
        For each part, shape (n, 3) [mm], in the file's coordinates; treat them as constant.

    Raises:
        ConfigError: The file cannot be read, holds no solid, or one too hollow for ``MOST_PARTS``.
    """
    mesh = read_stl(path)
    triangles = np.asarray(mesh.triangles, dtype=np.float64)
    if mesh.volume < 0.0:
        triangles = triangles[:, ::-1]
    done: list[FloatArray] = []
    waiting = [triangles]
    while waiting:
        part = waiting.pop()
        corners, faces = _hull(part)
        place, depth = _deepest(part, corners, faces)
        if depth <= STANDS_OUT:
            done.append(corners)
            continue
        halves = _cut(part, place)
        if halves is None or len(done) + len(waiting) + 2 > MOST_PARTS:
            x, y, z = place
            raise ConfigError(
                f"{path}: is hollow at {x:.2f} {y:.2f} {z:.2f} and {MOST_PARTS} convex parts do not "
                f"follow within {STANDS_OUT:g} mm: leave out bores and curved hollows, or make it of several files"
            )
        waiting += halves
    return tuple(done)


def _hull(triangles: FloatArray) -> tuple[FloatArray, IntArray]:
    """Corners of the convex hull of triangles, and its faces as rows of three corners."""
    points = np.unique(np.round(triangles.reshape(-1, 3), 9), axis=0)
    spec = mujoco.MjSpec()
    mesh = spec.add_mesh(name="part", uservert=(points * MM).ravel().tolist())
    # Of a thin plate's mesh MuJoCo would want a volume.
    mesh.inertia = mujoco.mjtMeshInertia.mjMESH_INERTIA_SHELL
    spec.worldbody.add_geom(type=mujoco.mjtGeom.mjGEOM_MESH, meshname="part", mass=0.0)
    model = spec.compile()
    graph = model.mesh_graph[int(model.mesh_graphadr[0]) :]
    vertices, faces = int(graph[0]), int(graph[1])
    used = graph[2 + vertices : 2 + 2 * vertices]
    first = 2 + 3 * vertices + 3 * faces
    of_points = graph[first : first + 3 * faces].reshape(-1, 3)
    number = np.zeros(len(points), np.int64)
    number[used] = np.arange(vertices)
    return points[used], number[of_points]


def _planes(corners: FloatArray, faces: IntArray) -> tuple[FloatArray, FloatArray]:
    """Outward normals of a hull's faces, shape (m, 3), and how far they lie from zero, shape (m,)."""
    a, b, c = (corners[faces[:, side]] for side in range(3))
    normal = np.cross(b - a, c - a)
    size = np.linalg.norm(normal, axis=1)
    a, normal = a[size > FLAT**2], normal[size > FLAT**2] / size[size > FLAT**2, None]
    inwards = np.sum(normal * (corners.mean(axis=0) - a), axis=1) > 0.0
    normal[inwards] *= -1.0
    return normal, np.sum(normal * a, axis=1)


def _deepest(
    triangles: FloatArray, corners: FloatArray, faces: IntArray
) -> tuple[FloatArray, float]:
    """The place of a surface that lies deepest within its hull, and how deep [mm]."""
    middles = [triangles.mean(axis=1)]
    middles += [
        0.5 * (triangles[:, one] + triangles[:, two]) for one, two in ((0, 1), (1, 2), (2, 0))
    ]
    points = np.concatenate([triangles.reshape(-1, 3), *middles])
    normal, away = _planes(corners, faces)
    depth = np.full(len(points), np.inf)
    for n, d in zip(normal, away, strict=True):
        np.minimum(depth, d - points @ n, out=depth)
    deepest = int(np.argmax(depth))
    return points[deepest], float(depth[deepest])


def _cut(triangles: FloatArray, place: FloatArray) -> list[FloatArray] | None:
    """Both sides of the plane through a place that leaves the smallest hulls; None if none cuts."""
    best, least = None, np.inf
    for axis in range(3):
        halves = [_side(triangles, axis, float(place[axis]), sign) for sign in (1.0, -1.0)]
        if all(len(half) and np.ptp(half.reshape(-1, 3), axis=0).min() > FLAT for half in halves):
            volume = sum(_volume(*_hull(half)) for half in halves)
            if volume < least:
                best, least = halves, volume
    return best


def _volume(corners: FloatArray, faces: IntArray) -> float:
    middle = corners.mean(axis=0)
    a, b, c = (corners[faces[:, side]] - middle for side in range(3))
    return float(np.abs(np.sum(a * np.cross(b, c), axis=1)).sum()) / 6.0


def _side(triangles: FloatArray, axis: int, at: float, sign: float) -> FloatArray:
    """What of triangles lies on one side of a plane; the cut is left open, as no hull needs it."""
    above = sign * (triangles[:, :, axis] - at)
    inside = np.all(above >= -FLAT, axis=1)
    # A face in the plane belongs to the side on which the solid is.
    level = np.all(np.abs(above) <= FLAT, axis=1)
    a, b, c = (triangles[:, corner] for corner in range(3))
    inside &= ~level | (sign * np.cross(b - a, c - a)[:, axis] < 0.0)
    crossing = np.any(above > FLAT, axis=1) & np.any(above < -FLAT, axis=1)
    parts = [triangles[inside]]
    for triangle, height in zip(triangles[crossing], above[crossing], strict=True):
        polygon: list[FloatArray] = []
        for one, two in ((0, 1), (1, 2), (2, 0)):
            if height[one] >= 0.0:
                polygon.append(triangle[one])
            if (height[one] < 0.0) != (height[two] < 0.0):
                share = height[one] / (height[one] - height[two])
                polygon.append(triangle[one] + share * (triangle[two] - triangle[one]))
        corners = np.array(polygon)
        parts.append(np.stack([[corners[0], *pair] for pair in itertools.pairwise(corners[1:])]))
    return np.concatenate(parts)
