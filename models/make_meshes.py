#!/usr/bin/env python3
"""Make the meshes of the shipped machines with trimesh: ``python models/make_meshes.py [MACHINE ...]``.

Every part is a join of convex bodies and bodies of revolution, written as one STL per body and
material into ``models/<machine>/assets``. All lengths are metres; parts are drawn where they are
with all axes at zero (z up from the floor, x to the right, y to the back, origin under the axis of
the rotary table) and moved into the frame of the body that carries them.
"""

import math
import pathlib
import sys

import numpy as np
import trimesh

Mesh = trimesh.Trimesh
Point = tuple[float, float, float]
MODELS = pathlib.Path(__file__).resolve().parent


def hull(points: np.ndarray | list[Point]) -> Mesh:
    """The convex body of points."""
    return Mesh(vertices=np.asarray(points, float), process=False).convex_hull


def box(
    x: tuple[float, float], y: tuple[float, float], z: tuple[float, float], edge: float = 0.006
) -> Mesh:
    """A box with broken edges."""
    low, high = np.array([x[0], y[0], z[0]]), np.array([x[1], y[1], z[1]])
    center, half = (low + high) / 2, (high - low) / 2
    edge = min(edge, 0.4 * float(half.min()))
    corners = np.array(np.meshgrid([-1, 1], [-1, 1], [-1, 1])).T.reshape(-1, 3)
    points = [center + corners * (half - edge * (1 - np.eye(3)[axis])) for axis in range(3)]
    return hull(np.concatenate(points))


def ring(x: tuple[float, float], y: tuple[float, float], z: float, radius: float) -> np.ndarray:
    """Points of a rounded rectangle at the height z."""
    angles = np.linspace(0.0, math.pi / 2, 6)
    points = []
    for quarter, (cx, cy) in enumerate(
        [(x[1] - radius, y[1] - radius), (x[0] + radius, y[1] - radius),
         (x[0] + radius, y[0] + radius), (x[1] - radius, y[0] + radius)]
    ):  # fmt: skip
        turn = angles + quarter * math.pi / 2
        points.append(
            np.column_stack([cx + radius * np.cos(turn), cy + radius * np.sin(turn), np.full(6, z)])
        )
    return np.concatenate(points)


def loft(*rings: np.ndarray) -> Mesh:
    """The convex body of several rings: a casting with drafted, rounded walls."""
    return hull(np.concatenate(rings))


def casting(
    x: tuple[float, float],
    y: tuple[float, float],
    z: tuple[float, float],
    radius: float = 0.04,
    edge: float = 0.012,
) -> Mesh:
    """An upright block with rounded corners and broken upper and lower edges."""

    def inner(v: tuple[float, float]) -> tuple[float, float]:
        return (v[0] + edge, v[1] - edge)

    return loft(
        ring(inner(x), inner(y), z[0], radius), ring(x, y, z[0] + edge, radius),
        ring(x, y, z[1] - edge, radius), ring(inner(x), inner(y), z[1], radius),
    )  # fmt: skip


def lathe(
    profile: list[tuple[float, float]], at: Point = (0.0, 0.0, 0.0), sections: int = 48
) -> Mesh:
    """A body of revolution about z; the profile gives (radius, z) from the axis to the axis."""
    mesh = trimesh.creation.revolve(np.array(profile), sections=sections)
    mesh.apply_translation(at)
    return mesh


def rod(radius: float, start: Point, end: Point, sections: int = 32, edge: float = 0.003) -> Mesh:
    """A cylinder with broken edges between two points."""
    length = math.dist(start, end)
    edge = min(edge, radius / 3, length / 3)
    mesh = lathe(
        [
            (0, 0),
            (radius - edge, 0),
            (radius, edge),
            (radius, length - edge),
            (radius - edge, length),
            (0, length),
        ],
        sections=sections,
    )
    direction = (np.array(end) - np.array(start)) / length
    mesh.apply_transform(trimesh.geometry.align_vectors([0, 0, 1], direction))
    mesh.apply_translation(start)
    return mesh


def prism(outline: list[tuple[float, float]], plane: str, low: float, high: float) -> Mesh:
    """A convex outline swept along the axis that its plane (``xz``, ``yz``, ``xy``) lacks."""
    columns = ["xyz".index(letter) for letter in plane]
    along = 3 - sum(columns)
    points = np.zeros((2 * len(outline), 3))
    points[:, columns] = [*outline, *outline]
    points[:, along] = [low] * len(outline) + [high] * len(outline)
    return hull(points)


def slotted_disc(
    radius: float, bore: float, z: tuple[float, float], slots: int, width: float
) -> list[Mesh]:
    """A disc with radial slots, as the sectors between them."""
    sectors = []
    half = math.pi / slots
    edge = 0.003
    for index in range(slots):
        middle = 2 * math.pi * (index + 0.5) / slots

        def outline(outer: float, middle: float = middle) -> list[tuple[float, float]]:
            reach = half - math.asin(width / 2 / outer)
            rim = [
                (outer * math.cos(middle + a), outer * math.sin(middle + a))
                for a in np.linspace(-reach, reach, 9)
            ]
            root = half - math.asin(width / 2 / bore)
            return [
                *rim,
                *(
                    (bore * math.cos(middle + a), bore * math.sin(middle + a))
                    for a in (root, -root)
                ),
            ]

        rings = [(radius, z[0]), (radius, z[1] - edge), (radius - edge, z[1])]
        sectors.append(hull([(x, y, height) for outer, height in rings for x, y in outline(outer)]))
    return sectors


def slotted_table(
    x: tuple[float, float],
    y: tuple[float, float],
    z: tuple[float, float],
    slots: list[float],
    width: float,
    depth: float,
) -> list[Mesh]:
    """A table with T-slots along x: the slab, and the lands between the slots."""
    lands = [y[0], *(edge for slot in slots for edge in (slot - width / 2, slot + width / 2)), y[1]]
    undercut = width * 0.4
    parts = [box(x, y, (z[0], z[1] - depth), 0.004)]
    for first, (low, high) in enumerate(zip(lands[::2], lands[1::2], strict=True)):
        left = undercut if first else 0.0
        right = undercut if first < len(slots) else 0.0
        parts.append(box(x, (low, high), (z[1] - depth * 0.45, z[1]), 0.0015))
        parts.append(box(x, (low + left, high - right), (z[1] - depth, z[1] - depth * 0.45), 0.001))
    return parts


def cover(y: tuple[float, float], half_width: float, z: tuple[float, float], roof: float) -> Mesh:
    """One segment of a telescopic way cover: side walls and a shallow roof."""
    return prism(
        [(-half_width, z[0]), (half_width, z[0]), (half_width, z[1]), (half_width * 0.45, z[1] + roof),
         (-half_width * 0.45, z[1] + roof), (-half_width, z[1])],
        "xz", *y,
    )  # fmt: skip


def screws(points: list[Point], radius: float = 0.009, height: float = 0.006) -> list[Mesh]:
    """Heads of cap screws standing on points."""
    return [
        rod(radius, point, (point[0], point[1], point[2] + height), 12, 0.0015) for point in points
    ]


def mill4() -> dict[str, dict[str, list[Mesh]]]:
    """Parts of ``mill4`` by body and material."""
    table_top, nose = 1.085, 1.705
    base = {
        "cast": [
            casting((-0.62, 0.62), (-1.0, 1.22), (0.05, 0.36), 0.08, 0.02),
            loft(ring((-0.50, 0.50), (-0.96, 1.18), 0.34, 0.06), ring((-0.40, 0.40), (-0.93, 0.75), 0.58, 0.04)),
            loft(
                ring((-0.46, 0.46), (0.60, 1.22), 0.30, 0.07), ring((-0.43, 0.43), (0.64, 1.20), 0.80, 0.07),
                ring((-0.36, 0.36), (0.66, 1.12), 2.52, 0.07), ring((-0.345, 0.345), (0.675, 1.105), 2.545, 0.06),
            ),
        ],
        "dark": [
            casting((-0.66, 0.66), (-1.04, 1.26), (0.05, 0.13), 0.08, 0.01),
            *(prism([(s * 0.61, 0.36), (s * 0.40, 0.50), (s * 0.40, 0.48), (s * 0.61, 0.34)], "xz", -0.95, 0.55) for s in (-1, 1)),
            box((-0.13, 0.13), (0.628, 0.68), (1.12, 2.50), 0.004),
            *(box((-0.15, 0.15), (0.618, 0.66), (1.15 + 0.035 * i, 1.165 + 0.035 * i), 0.003) for i in range(38)),
            casting((-0.14, 0.14), (0.72, 1.0), (2.545, 2.60), 0.03, 0.01),
        ],
        "steel": [
            *(box((s * 0.27 - 0.03, s * 0.27 + 0.03), (-0.90, 0.64), (0.57, 0.62), 0.004) for s in (-1, 1)),
            *(box((s * 0.235 - 0.03, s * 0.235 + 0.03), (0.62, 0.68), (1.10, 2.48), 0.004) for s in (-1, 1)),
            *(rod(0.045, (sx * 0.52, sy, 0.0), (sx * 0.52, sy, 0.05), 24) for sx in (-1, 1) for sy in (-0.9, 0.1, 1.1)),
        ],
        "cover": [
            cover((-0.94, -0.32), 0.345, (0.56, 0.655), 0.03),
            cover((-0.955, -0.52), 0.36, (0.56, 0.67), 0.032),
            cover((-0.97, -0.74), 0.375, (0.56, 0.685), 0.034),
            cover((0.32, 0.66), 0.345, (0.56, 0.655), 0.03),
        ],
        "panel": [
            hull([(x, y, z) for x in (0.70, 1.02) for y, z in [(-0.36, 1.42), (-0.30, 1.42), (-0.22, 1.86), (-0.30, 1.88)]]),
            hull([(x, y, z) for x in (0.68, 1.04) for y, z in [(-0.44, 1.33), (-0.43, 1.36), (-0.28, 1.44), (-0.28, 1.38)]]),
            rod(0.03, (0.40, 0.86, 2.10), (0.86, 0.86, 2.10), 24, 0.004), rod(0.03, (0.86, 0.89, 2.10), (0.86, -0.25, 2.10), 24, 0.004),
            rod(0.025, (0.86, -0.25, 2.12), (0.86, -0.25, 1.80), 24, 0.004),
        ],
        "screen": [
            hull([(x, y - 0.004, z) for x in (0.735, 0.985) for y, z in [(-0.345, 1.53), (-0.30, 1.53), (-0.295, 1.80), (-0.3015, 1.81)]]),
        ],
        "magazine": [
            lathe([(0, 1.985), (0.24, 1.985), (0.275, 2.0), (0.275, 2.03), (0.24, 2.045), (0, 2.045)], (-0.68, 0.34, 0.0), 48),
            casting((-0.745, -0.615), (0.275, 0.405), (2.045, 2.12), 0.03, 0.008),
            hull([(x, y, z) for z in (2.06, 2.10) for x, y in [(-0.66, 0.30), (-0.60, 0.36), (-0.38, 0.80), (-0.44, 0.90)]]),
            *(rod(0.0315, (-0.68 + 0.235 * math.cos(a), 0.34 + 0.235 * math.sin(a), 1.955), (-0.68 + 0.235 * math.cos(a), 0.34 + 0.235 * math.sin(a), 1.985), 20, 0.003) for a in np.radians(np.arange(0, 360, 30))),
            *(rod(0.018, (-0.68 + 0.235 * math.cos(a), 0.34 + 0.235 * math.sin(a), 1.90), (-0.68 + 0.235 * math.cos(a), 0.34 + 0.235 * math.sin(a), 1.955), 16, 0.003) for a in np.radians(np.arange(0, 360, 30))),
            *(rod(0.004 + 0.002 * (i % 4), (-0.68 + 0.235 * math.cos(a), 0.34 + 0.235 * math.sin(a), 1.82 + 0.01 * (i % 3)), (-0.68 + 0.235 * math.cos(a), 0.34 + 0.235 * math.sin(a), 1.90), 12, 0.001) for i, a in enumerate(np.radians(np.arange(0, 360, 30)))),
        ],
        "accent": [
            box((-0.4, 0.4), (-1.006, -0.99), (0.19, 0.30), 0.004),
            rod(0.075, (0.0, 0.86, 2.60), (0.0, 0.86, 2.76), 40, 0.008),
        ],
    }  # fmt: skip
    saddle = {
        "cast": [
            loft(ring((-0.36, 0.36), (-0.29, 0.29), 0.625, 0.03), ring((-0.44, 0.44), (-0.30, 0.30), 0.67, 0.03), ring((-0.46, 0.46), (-0.30, 0.30), 0.765, 0.03)),
            casting((0.44, 0.60), (-0.09, 0.09), (0.64, 0.76), 0.02, 0.008),
        ],
        "dark": [
            box((-0.385, 0.385), (-0.33, 0.33), (0.60, 0.635), 0.004),
            box((-0.45, 0.45), (-0.315, 0.315), (0.755, 0.768), 0.003),
        ],
        "accent": [rod(0.06, (0.60, 0.0, 0.70), (0.76, 0.0, 0.70), 40, 0.008)],
        "cover": [
            cover((-0.64, -0.29), 0.39, (0.575, 0.70), 0.036),
            cover((0.29, 0.55), 0.39, (0.575, 0.70), 0.036),
        ],
        "steel": [*(box((-0.46, 0.46), (s * 0.20 - 0.028, s * 0.20 + 0.028), (0.765, 0.80), 0.003) for s in (-1, 1))],
    }  # fmt: skip
    table = {
        "cast": [casting((-0.66, 0.66), (-0.285, 0.285), (0.795, 0.862), 0.02, 0.006)],
        "ground": slotted_table((-0.65, 0.65), (-0.275, 0.275), (0.862, 0.90), [-0.2, -0.1, 0.0, 0.1, 0.2], 0.018, 0.03),
        "dark": [
            box((-0.685, -0.655), (-0.285, 0.285), (0.81, 0.885), 0.004),
            box((0.655, 0.685), (-0.285, 0.285), (0.81, 0.885), 0.004),
            box((-0.68, 0.68), (-0.298, -0.28), (0.815, 0.88), 0.004),
            box((-0.68, 0.68), (0.28, 0.298), (0.815, 0.88), 0.004),
        ],
        "rotary": [
            casting((-0.215, 0.215), (-0.215, 0.215), (0.90, 0.985), 0.06, 0.01),
            lathe([(0, 0.97), (0.212, 0.97), (0.212, 1.035), (0.203, 1.045), (0, 1.045)], sections=64),
            casting((0.19, 0.36), (-0.085, 0.085), (0.905, 1.03), 0.03, 0.01),
            *(casting((sx * 0.205 - 0.03, sx * 0.205 + 0.03), (sy * 0.1 - 0.03, sy * 0.1 + 0.03), (0.90, 0.925), 0.012, 0.003) for sx in (-1,) for sy in (-1, 1)),
        ],
        "accent": [rod(0.062, (0.36, 0.0, 0.967), (0.49, 0.0, 0.967), 40, 0.008)],
        "steel": screws([(-0.222, sy * 0.1, 0.925) for sy in (-1, 1)] + [(sx * 0.185, sy * 0.185, 0.985) for sx in (-1, 1) for sy in (-1, 1)], 0.011, 0.01),
    }  # fmt: skip
    rotary = {
        "ground": [
            *slotted_disc(0.20, 0.045, (1.058, table_top), 8, 0.014),
            lathe([(0.0225, 1.058), (0.0435, 1.058), (0.0435, table_top - 0.001), (0.0425, table_top), (0.0235, table_top), (0.0225, table_top - 0.001), (0.0225, 1.058)], sections=48),
        ],
        "steel": [lathe([(0, 1.045), (0.196, 1.045), (0.2, 1.048), (0.2, 1.062), (0, 1.062)], sections=64)],
        "mark": [box((0.1965, 0.2015), (-0.003, 0.003), (1.05, table_top - 0.004), 0.0005)],
        "dark": [box((0.2 * math.cos(a) - 0.0012, 0.2 * math.cos(a) + 0.0012), (0.2 * math.sin(a) - 0.0012, 0.2 * math.sin(a) + 0.0012), (1.05, 1.058), 0.0003) for a in np.radians(np.arange(10, 360, 10))],
    }  # fmt: skip
    head = {
        "cast": [
            loft(
                ring((-0.17, 0.17), (-0.17, 0.40), 1.83, 0.06), ring((-0.20, 0.20), (-0.20, 0.60), 1.90, 0.07),
                ring((-0.20, 0.20), (-0.20, 0.60), 2.28, 0.07), ring((-0.18, 0.18), (-0.16, 0.60), 2.33, 0.06),
            ),
            casting((-0.31, 0.31), (0.545, 0.625), (1.80, 2.38), 0.015, 0.008),
        ],
        "dark": [
            box((-0.318, -0.15), (0.60, 0.655), (1.82, 1.92), 0.004), box((0.15, 0.318), (0.60, 0.655), (1.82, 1.92), 0.004),
            box((-0.318, -0.15), (0.60, 0.655), (2.26, 2.36), 0.004), box((0.15, 0.318), (0.60, 0.655), (2.26, 2.36), 0.004),
            casting((-0.12, 0.12), (-0.13, 0.11), (2.33, 2.39), 0.04, 0.008),
            *(box((s * 0.2 - 0.003, s * 0.2 + 0.003), (0.10, 0.42), (2.10 + 0.022 * i, 2.11 + 0.022 * i), 0.002) for s in (-1, 1) for i in range(7)),
            box((-0.11, 0.11), (-0.204, -0.19), (1.93, 1.965), 0.004),
        ],
        "accent": [
            casting((-0.105, 0.105), (-0.115, 0.095), (2.39, 2.66), 0.05, 0.012),
            box((-0.205, 0.205), (-0.10, 0.50), (1.985, 2.045), 0.004),
        ],
        "rotary": [
            lathe([(0, 1.775), (0.088, 1.775), (0.115, 1.81), (0.128, 1.84), (0, 1.84)], sections=64),
        ],
        "steel": [
            rod(0.006, (0.095, -0.06, 1.80), (0.078, -0.045, 1.725), 12, 0.001),
            rod(0.006, (-0.095, -0.06, 1.80), (-0.078, -0.045, 1.725), 12, 0.001),
        ],
    }  # fmt: skip
    spindle = {
        "ground": [
            lathe([(0.024, nose), (0.044, nose), (0.0445, nose + 0.002), (0.0445, nose + 0.028), (0.064, nose + 0.03), (0.066, nose + 0.032), (0.066, nose + 0.055), (0.075, nose + 0.071), (0, nose + 0.071), (0.0, nose + 0.05), (0.016, nose + 0.05), (0.024, nose)], sections=64),
        ],
    }  # fmt: skip
    return {
        "base": base,
        "saddle": saddle,
        "table": table,
        "rotary_table": rotary,
        "head": head,
        "spindle": spindle,
    }


def along_x(meshes: list[Mesh], x: float, z: float) -> list[Mesh]:
    """Bodies of revolution about z laid along x, their origin moved to a place over the middle of the table."""
    place = trimesh.transformations.translation_matrix([x, 0.0, z])
    turn = trimesh.transformations.rotation_matrix(math.pi / 2, [0, 1, 0])
    return [mesh.apply_transform(place @ turn) for mesh in meshes]


def mill4a() -> dict[str, dict[str, list[Mesh]]]:
    """What ``mill4a`` has besides the parts of ``mill4``: rotary table along x and tailstock."""
    axis, face = 1.06, -0.15
    table = {
        "rotary": [
            casting((-0.38, -0.21), (-0.14, 0.14), (0.90, 0.94), 0.02, 0.006),
            casting((-0.37, -0.215), (-0.13, 0.13), (0.93, 1.19), 0.05, 0.012),
            *along_x([lathe([(0, 0), (0.115, 0), (0.115, 0.02), (0.108, 0.026), (0, 0.026)], sections=64)], -0.218, axis),
            casting((0.30, 0.42), (-0.07, 0.07), (0.90, 0.935), 0.015, 0.005),
            casting((0.315, 0.41), (-0.055, 0.055), (0.93, 1.12), 0.03, 0.010),
            rod(0.030, (0.262, 0, axis), (0.32, 0, axis), 40, 0.004),
        ],
        "accent": [
            rod(0.062, (-0.295, 0.13, axis), (-0.295, 0.29, axis), 40, 0.008),
            rod(0.045, (0.41, 0, axis), (0.425, 0, axis), 32, 0.003),
        ],
        "steel": [
            *screws([(x, sy * 0.12, 0.94) for x in (-0.36, -0.23) for sy in (-1, 1)] + [(0.36, sy * 0.06, 0.935) for sy in (-1, 1)], 0.010, 0.01),
            rod(0.007, (0.425, -0.03, axis), (0.47, -0.03, axis), 16, 0.002),
        ],
    }  # fmt: skip
    rotary = {
        "ground": along_x(slotted_disc(0.10, 0.025, (-0.027, 0.0), 4, 0.012), face, axis),
        "steel": [
            *along_x([lathe([(0, -0.042), (0.097, -0.042), (0.1, -0.039), (0.1, -0.024), (0.030, -0.024), (0.030, -0.002), (0, -0.002)], sections=64)], face, axis),
            rod(0.016, (0.232, 0, axis), (0.262, 0, axis), 40, 0.002),
            *along_x([lathe([(0, -0.032), (0.012, 0.0), (0.012, 0.012), (0, 0.012)], sections=40)], 0.222, axis),
        ],
        "mark": [box((face - 0.038, face - 0.004), (-0.003, 0.003), (axis + 0.0965, axis + 0.1015), 0.0005)],
    }  # fmt: skip
    return {"table": table, "rotary_table": rotary}


def mill5() -> dict[str, dict[str, list[Mesh]]]:
    """What ``mill5`` has besides the parts of ``mill4``: trunnion, cradle and rotary table."""
    axis, top = 1.10, 1.075
    table = {
        "rotary": [
            casting((-0.37, -0.21), (-0.12, 0.12), (0.90, 0.935), 0.02, 0.006),
            loft(ring((-0.36, -0.22), (-0.11, 0.11), 0.93, 0.03), ring((-0.36, -0.22), (-0.085, 0.085), 1.14, 0.05), ring((-0.35, -0.23), (-0.06, 0.06), 1.175, 0.04)),
            casting((0.215, 0.32), (-0.10, 0.10), (0.90, 0.935), 0.02, 0.006),
            loft(ring((0.22, 0.31), (-0.09, 0.09), 0.93, 0.03), ring((0.22, 0.31), (-0.075, 0.075), 1.14, 0.03), ring((0.23, 0.30), (-0.05, 0.05), 1.165, 0.03)),
        ],
        "accent": [
            rod(0.055, (-0.50, 0, axis), (-0.36, 0, axis), 40, 0.008),
            rod(0.060, (0.31, 0, axis), (0.322, 0, axis), 40, 0.004),
        ],
        "steel": screws([(x, sy * 0.105, 0.935) for x in (-0.34, -0.24) for sy in (-1, 1)] + [(0.268, sy * 0.09, 0.935) for sy in (-1, 1)], 0.010, 0.01),
    }  # fmt: skip
    arm = [(-0.07, 1.03), (0.07, 1.03), (0.07, 1.10), (0.045, 1.14), (-0.045, 1.14), (-0.07, 1.10)]
    cradle = {
        "cast": [
            *(hull([(x, y, z) for x in (s * 0.14, s * 0.20) for y, z in arm]) for s in (-1, 1)),
            *(hull([(s * 0.14, y, z) for y in (-0.085, 0.085) for z in (0.97, 1.012)] + [(s * 0.20, y, z) for y in (-0.07, 0.07) for z in (1.0, 1.05)]) for s in (-1, 1)),
            casting((-0.145, 0.145), (-0.09, 0.09), (0.97, 1.012), 0.03, 0.006),
        ],
        "dark": [*(rod(0.05, (s * 0.199, 0, axis), (s * 0.222, 0, axis), 48, 0.003) for s in (-1, 1))],
        "steel": [lathe([(0, 1.008), (0.098, 1.008), (0.098, 1.040), (0.094, 1.044), (0, 1.044)], sections=64)],
    }  # fmt: skip
    rotary = {
        "ground": [
            *slotted_disc(0.105, 0.03, (1.052, top), 6, 0.012),
            lathe([(0.0125, 1.052), (0.0285, 1.052), (0.0285, top), (0.0125, top), (0.0125, 1.052)], sections=40),
        ],
        "steel": [lathe([(0, 1.045), (0.102, 1.045), (0.105, 1.047), (0.105, 1.055), (0, 1.055)], sections=64)],
        "mark": [box((0.1025, 0.1062), (-0.0025, 0.0025), (1.048, top - 0.003), 0.0004)],
    }  # fmt: skip
    return {"table": table, "cradle": cradle, "rotary_table": rotary}


def mill5h() -> dict[str, dict[str, list[Mesh]]]:
    """What ``mill5h`` has besides the parts of ``mill4``: a shorter head, and the swivel that carries the spindle."""
    axis = 1.905
    head = {
        "cast": [
            casting((-0.18, 0.18), (0.145, 0.60), (1.76, 2.33), 0.06, 0.02),
            casting((-0.31, 0.31), (0.545, 0.625), (1.80, 2.38), 0.015, 0.008),
        ],
        "dark": [
            *(box((min(s * 0.15, s * 0.318), max(s * 0.15, s * 0.318)), (0.60, 0.655), z, 0.004) for s in (-1, 1) for z in ((1.82, 1.92), (2.26, 2.36))),
            *(box((s * 0.18 - 0.003, s * 0.18 + 0.003), (0.24, 0.46), (2.10 + 0.022 * i, 2.11 + 0.022 * i), 0.002) for s in (-1, 1) for i in range(7)),
            rod(0.13, (0, 0.14, axis), (0, 0.155, axis), 64, 0.002),
        ],
        "accent": [
            casting((-0.09, 0.09), (0.22, 0.40), (2.325, 2.50), 0.04, 0.012),
            box((-0.184, 0.184), (0.22, 0.52), (1.985, 2.045), 0.004),
        ],
        "rotary": [rod(0.14, (0, 0.132, axis), (0, 0.146, axis), 64, 0.002)],
    }  # fmt: skip
    swivel = {
        "cast": [
            lathe([(0, 1.775), (0.085, 1.775), (0.105, 1.80), (0.105, 2.07), (0.09, 2.10), (0, 2.10)], sections=64),
            casting((-0.095, 0.095), (0.0, 0.085), (axis - 0.085, axis + 0.105), 0.02, 0.006),
        ],
        "dark": [
            lathe([(0, 2.10), (0.075, 2.10), (0.075, 2.112), (0.068, 2.119), (0, 2.119)], sections=48),
            lathe([(0.10, 1.85), (0.1056, 1.85), (0.1056, 1.853), (0.10, 1.853), (0.10, 1.85)], sections=64),
        ],
        "rotary": [rod(0.14, (0, 0.06, axis), (0, 0.13, axis), 64, 0.004)],
        "steel": [
            *(rod(0.006, (s * 0.08, -0.045, 1.79), (s * 0.066, -0.035, 1.73), 12, 0.001) for s in (-1, 1)),
            *(rod(0.007, (0.122 * math.cos(a), 0.056, axis + 0.122 * math.sin(a)), (0.122 * math.cos(a), 0.062, axis + 0.122 * math.sin(a)), 12, 0.001) for a in np.radians(np.arange(15, 360, 30))),
        ],
        "mark": [box((-0.003, 0.003), (0.08, 0.128), (axis + 0.1385, axis + 0.1406), 0.0005)],
    }  # fmt: skip
    return {"head": head, "swivel": swivel}


def mill4_light() -> dict[str, dict[str, list[Mesh]]]:
    """Parts of ``mill4_light`` by body and material: a router on a bench, the tool moves over the bed."""
    table_top, nose, gantry_y = 0.18, 0.35, 0.14

    base = {
        "alu": [
            *(box((s * 0.28 - 0.02, s * 0.28 + 0.02), (-0.42, 0.42), (0.03, 0.11), 0.003) for s in (-1, 1)),
            *(box((-0.26, 0.26), (y - 0.02, y + 0.02), (0.03, 0.09), 0.003) for y in (-0.40, 0.0, 0.40)),
            *slotted_bed((-0.25, 0.25), (-0.38, 0.38), (0.09, 0.13), [-0.2, -0.15, -0.1, -0.05, 0.0, 0.05, 0.1, 0.15, 0.2], 0.008, 0.012),
        ],
        "steel": [
            *(rod(0.010, (s * 0.28, -0.41, 0.122), (s * 0.28, 0.41, 0.122), 24, 0.001) for s in (-1, 1)),
            *(box((s * 0.28 - 0.012, s * 0.28 + 0.012), (-0.41, 0.41), (0.108, 0.116), 0.001) for s in (-1, 1)),
        ],
        "dark": [
            *(rod(0.022, (sx * 0.28, sy * 0.38, 0.0), (sx * 0.28, sy * 0.38, 0.03), 24, 0.004) for sx in (-1, 1) for sy in (-1, 1)),
            *(box((s * 0.28 - 0.021, s * 0.28 + 0.021), (sy * 0.42 - 0.004, sy * 0.42 + 0.004), (0.028, 0.112), 0.002) for s in (-1, 1) for sy in (-1, 1)),
            *(box((s * 0.3006 - 0.0006, s * 0.3006 + 0.0006), (-0.41, 0.41), (z - 0.004, z + 0.004), 0.0003) for s in (-1, 1) for z in (0.05, 0.09)),
            casting((-0.105, -0.048), (-0.028, 0.028), (0.131, 0.162), 0.004, 0.002),
            casting((-0.175, -0.105), (-0.028, 0.028), (0.131, 0.187), 0.004, 0.002),
        ],
        "accent": [
            casting((-0.062, 0.062), (-0.062, 0.062), (0.13, 0.150), 0.012, 0.003),
            lathe([(0, 0.148), (0.056, 0.148), (0.056, 0.161), (0.053, 0.164), (0, 0.164)], sections=48),
        ],
    }  # fmt: skip
    rotary = {
        "alu": [
            *slotted_disc(0.06, 0.018, (0.170, table_top), 4, 0.006),
            lathe([(0.008, 0.170), (0.017, 0.170), (0.017, table_top), (0.008, table_top), (0.008, 0.170)], sections=32),
        ],
        "steel": [lathe([(0, 0.164), (0.058, 0.164), (0.06, 0.166), (0.06, 0.172), (0, 0.172)], sections=48)],
        "mark": [box((0.058, 0.0608), (-0.0015, 0.0015), (0.167, table_top - 0.001), 0.0002)],
    }  # fmt: skip
    low, high = 0.46, 0.56
    gantry = {
        "accent": [
            hull([(x, y, z) for x in (s * 0.322, s * 0.334) for y, z in
                  [(gantry_y - 0.075, 0.10), (gantry_y + 0.075, 0.10), (gantry_y + 0.075, 0.20), (gantry_y + 0.05, 0.59),
                   (gantry_y - 0.05, 0.59), (gantry_y - 0.075, 0.20)]])
            for s in (-1, 1)
        ],
        "alu": [box((-0.322, 0.322), (gantry_y - 0.03, gantry_y + 0.03), (low, high), 0.003)],
        "steel": [
            *(box((-0.315, 0.315), (gantry_y - 0.042, gantry_y - 0.03), (z - 0.008, z + 0.008), 0.001) for z in (0.48, 0.54)),
            *(box((s * 0.28 - 0.022, s * 0.28 + 0.022), (gantry_y - 0.07, gantry_y + 0.07), (0.108, 0.145), 0.003) for s in (-1, 1)),
            *(box((min(s * 0.30, s * 0.324), max(s * 0.30, s * 0.324)), (gantry_y - 0.06, gantry_y + 0.06), (0.112, 0.142), 0.002) for s in (-1, 1)),
        ],
        "dark": [
            *(casting((s * 0.352 - 0.018, s * 0.352 + 0.018), (gantry_y - 0.028, gantry_y + 0.028), (0.13, 0.186), 0.004, 0.002) for s in (-1, 1)),
            box((-0.32, 0.32), (gantry_y - 0.036, gantry_y - 0.031), (0.506, 0.514), 0.0005),
            casting((0.255, 0.311), (gantry_y - 0.028, gantry_y + 0.028), (0.56, 0.63), 0.004, 0.002),
            box((-0.30, 0.25), (gantry_y - 0.015, gantry_y + 0.025), (0.562, 0.585), 0.004),
        ],
    }  # fmt: skip
    front = gantry_y - 0.044
    carriage = {
        "accent": [box((-0.075, 0.075), (front - 0.012, front), (0.42, 0.62), 0.004)],
        "steel": [
            *(box((sx * 0.05 - 0.02, sx * 0.05 + 0.02), (front - 0.001, front + 0.012), (z - 0.016, z + 0.016), 0.002) for sx in (-1, 1) for z in (0.48, 0.54)),
            *(rod(0.006, (sx * 0.055, front - 0.022, 0.42), (sx * 0.055, front - 0.022, 0.64), 20, 0.001) for sx in (-1, 1)),
            rod(0.005, (0, front - 0.022, 0.42), (0, front - 0.022, 0.64), 20, 0.001),
        ],
        "dark": [
            box((-0.078, 0.078), (front - 0.036, front), (0.635, 0.65), 0.003),
            casting((-0.028, 0.028), (front - 0.050, front + 0.006), (0.65, 0.72), 0.004, 0.002),
            box((-0.078, 0.078), (front - 0.036, front), (0.41, 0.422), 0.003),
        ],
    }  # fmt: skip
    head = {
        "accent": [box((-0.062, 0.062), (0.050, 0.064), (0.385, 0.545), 0.004)],
        "dark": [
            *(box((-0.05, 0.05), (0.0, 0.055), (z - 0.014, z + 0.014), 0.006) for z in (0.42, 0.50)),
            rod(0.034, (0, 0, 0.545), (0, 0, 0.575), 40, 0.006),
            *(box((sx * 0.055 - 0.012, sx * 0.055 + 0.012), (0.060, 0.088), (z - 0.018, z + 0.018), 0.002) for sx in (-1, 1) for z in (0.42, 0.51)),
        ],
        "cast": [
            lathe([(0, 0.383), (0.03, 0.383), (0.036, 0.392), (0.0365, 0.54), (0.032, 0.548), (0, 0.548)], sections=64),
        ],
    }  # fmt: skip
    spindle = {
        "steel": [lathe([(0, nose + 0.001), (0.004, nose), (0.010, nose), (0.0125, nose + 0.004), (0.0125, nose + 0.016), (0.017, nose + 0.02), (0.017, nose + 0.034), (0, nose + 0.034)], sections=48)],
    }  # fmt: skip
    return {
        "base": base,
        "rotary_table": rotary,
        "gantry": gantry,
        "carriage": carriage,
        "head": head,
        "spindle": spindle,
    }


def slotted_bed(
    x: tuple[float, float],
    y: tuple[float, float],
    z: tuple[float, float],
    slots: list[float],
    width: float,
    depth: float,
) -> list[Mesh]:
    """A bed with slots along y: the slab and the lands between the slots."""
    lands = [x[0], *(edge for slot in slots for edge in (slot - width / 2, slot + width / 2)), x[1]]
    parts = [box(x, y, (z[0], z[1] - depth), 0.002)]
    return parts + [
        box(pair, y, (z[1] - depth, z[1]), 0.001)
        for pair in zip(lands[::2], lands[1::2], strict=True)
    ]


ORIGINS = {
    "mill4": {
        "base": (0, 0, 0), "saddle": (0, 0, 0.625), "table": (0, 0, 0.8),
        "rotary_table": (0, 0, 1.085), "head": (0, 0.6, 2.09), "spindle": (0, 0, 1.705),
    },
    "mill4a": {"table": (0, 0, 0.8), "rotary_table": (-0.15, 0, 1.06)},
    "mill5": {"table": (0, 0, 0.8), "cradle": (0, 0, 1.1), "rotary_table": (0, 0, 1.075)},
    "mill5h": {"head": (0, 0.6, 2.09), "swivel": (0, 0, 1.905)},
    "mill4_light": {
        "base": (0, 0, 0), "rotary_table": (0, 0, 0.18), "gantry": (0, 0.14, 0.46),
        "carriage": (0, 0.096, 0.52), "head": (0, 0.05, 0.46), "spindle": (0, 0, 0.35),
    },
}  # fmt: skip
"""Frames of the bodies, as in the MJCF file."""
MACHINES = {
    "mill4": mill4,
    "mill4a": mill4a,
    "mill5": mill5,
    "mill5h": mill5h,
    "mill4_light": mill4_light,
}


def main(names: list[str]) -> None:
    """Write the meshes of the named machines, or of all."""
    for name in names or MACHINES:
        folder = MODELS / name / "assets"
        folder.mkdir(parents=True, exist_ok=True)
        for old in folder.glob("*.stl"):
            old.unlink()
        for body, materials in MACHINES[name]().items():
            for material, parts in materials.items():
                mesh = trimesh.util.concatenate(parts)
                mesh.apply_translation(-np.array(ORIGINS[name][body]))
                (folder / f"{body}_{material}.stl").write_bytes(
                    trimesh.exchange.stl.export_stl(mesh)
                )
        size = sum(path.stat().st_size for path in folder.glob("*.stl"))
        print(f"{name}: {size / 1e6:.2f} MB in {folder}")


if __name__ == "__main__":
    main(sys.argv[1:])
