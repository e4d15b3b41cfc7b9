"""The same cuts by the boolean operations of a mesh library (manifold)."""

import math

import numpy as np
import pytest
import trimesh

from twin.cutting.tools import profile
from twin.cutting.tridexel.blanks import box, round_bar
from twin.cutting.tridexel.engagement import cut, volume
from twin.cutting.tridexel.solids.moving_solid import Poses
from twin.cutting.tridexel.solids.solids import cutting_edge
from twin.cutting.tridexel.surface.mesh import part_mesh
from twin.job.job_file import ToolTable
from twin.nc.canonical import FloatArray

pytestmark = pytest.mark.oracle

SECTIONS = 256
"""Sides of the prism that stands for a cylinder; its radius is that of a circle of the same area."""
ROUND = math.sqrt(2.0 * math.pi / SECTIONS / math.sin(2.0 * math.pi / SECTIONS))
FLUTE_MM = 25.0
CELL_MM = 0.1
MESHED = (0, 3)
"""A bar and a block whose meshes are compared too: that takes ten seconds and a gigabyte for each."""


def revolved(tool: ToolTable) -> trimesh.Trimesh:
    edge = profile(tool)
    corner = np.linspace(0.0, math.pi / 2.0, 65)
    if edge.corner:
        radius, height = (
            edge.flat + edge.corner * np.sin(corner),
            edge.corner * (1.0 - np.cos(corner)),
        )
    else:
        radius = np.array([edge.flat, edge.radius])
        height = edge.slope * (radius - edge.flat)
    line = np.column_stack([[0.0, *radius, edge.radius, 0.0], [0.0, *height, FLUTE_MM, FLUTE_MM]])
    line = line[np.append(True, np.linalg.norm(np.diff(line, axis=0), axis=1) > 1e-9)]
    return trimesh.creation.revolve(line * [ROUND, 1.0], sections=SECTIONS)


def swept(tool: ToolTable, start: FloatArray, end: FloatArray, axis: FloatArray) -> trimesh.Trimesh:
    """A convex tool on a straight path: the hull of both ends."""
    mesh = revolved(tool)
    mesh.apply_transform(trimesh.geometry.align_vectors([0.0, 0.0, 1.0], axis))
    return trimesh.convex.convex_hull(np.concatenate([mesh.vertices + start, mesh.vertices + end]))


@pytest.mark.parametrize("seed", range(20))
def test_indexed_cuts(seed: int) -> None:
    random = np.random.default_rng(seed)
    if seed % 2:
        part = box(np.array([-10.0, -8.0, -6.0]), np.array([10.0, 8.0, 6.0]), CELL_MM)
        other = trimesh.creation.box(bounds=part.corners)
    else:
        part = round_bar(np.zeros(3), 0, 7.0, 20.0, CELL_MM)
        other = trimesh.creation.cylinder(7.0 * ROUND, 20.0, sections=SECTIONS)
        other.apply_transform(trimesh.geometry.align_vectors([0.0, 0.0, 1.0], [1.0, 0.0, 0.0]))
    before, other_before = volume(part), other.volume
    for number in range(1, 4):
        kind = str(random.choice(["flat", "ball", "bull", "drill", "chamfer"]))
        diameter = float(random.uniform(3.0, 7.0))
        tool = ToolTable.model_validate(
            {"number": 1, "kind": kind, "diameter": diameter}
            | ({"corner": 0.2 * diameter} if kind == "bull" else {})
        )
        axis, way = (vector / np.linalg.norm(vector) for vector in random.normal(size=(2, 3)))
        start = random.uniform([-8.0, -6.0, -4.0], [8.0, 6.0, 4.0])
        end = start + random.uniform(1.0, 8.0) * way
        poses = Poses(np.array([start, end]), np.array([axis, axis]))
        cut(part, poses, cutting_edge(profile(tool), FLUTE_MM), number)
        other = trimesh.boolean.difference(
            [other, swept(tool, start, end, axis)], engine="manifold"
        )
    removed, other_removed = before - volume(part), other_before - other.volume
    assert removed == pytest.approx(other_removed, rel=1e-3)
    if seed in MESHED:
        assert apart(part_mesh(part), other) < 3e-3 * other_removed


def apart(mesh: trimesh.Trimesh, other: trimesh.Trimesh) -> float:
    """Volume that one of two parts has and the other has not [mm³]."""
    assert mesh.is_watertight
    return sum(
        trimesh.boolean.difference(pair, engine="manifold").volume
        for pair in ([mesh, other], [other, mesh])
    )
