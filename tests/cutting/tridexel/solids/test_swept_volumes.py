"""What tools take off whose volumes have formulas."""

import math
from collections.abc import Callable

import numpy as np
import pytest

from twin.cutting.tools import profile
from twin.cutting.tridexel.blanks import box, round_bar
from twin.cutting.tridexel.dexels import TriDexel
from twin.cutting.tridexel.engagement import cut, volume
from twin.cutting.tridexel.solids.moving_solid import Poses
from twin.cutting.tridexel.solids.solids import cutting_edge
from twin.cutting.tridexel.surface.mesh import part_mesh
from twin.job.job_file import ToolTable
from twin.nc.canonical import FloatArray

SHARE = 1e-3
"""Of the removed volume that it may be off."""
CELL_MM = 0.1
FLUTE_MM = 25.0

Case = tuple[TriDexel, ToolTable, Poses, float]


def tool(kind: str, diameter: float, **more: float) -> ToolTable:
    return ToolTable.model_validate({"number": 1, "kind": kind, "diameter": diameter, **more})


def directions(angle: FloatArray) -> FloatArray:
    """Across X, turned about it from +Z, shape (n, 3)."""
    return np.stack([np.zeros_like(angle), np.sin(angle), np.cos(angle)], axis=1)


def straight(start: tuple[float, ...], end: tuple[float, ...], axis: tuple[float, ...]) -> Poses:
    share = np.linspace(0.0, 1.0, 20)[:, None]
    way = np.array(start) + share * (np.array(end) - np.array(start))
    return Poses(way, np.tile(np.array(axis) / np.linalg.norm(axis), (len(way), 1)))


def turned_bar(size: float) -> Case:
    """A flat end mill, its axis through that of a bar that turns once: a neck as wide as the tool."""
    bar = round_bar(np.zeros(3), 0, 5.0 * size, 14.0 * size, CELL_MM)
    axis = directions(np.linspace(0.0, 2.0 * math.pi, 241))
    removed = math.pi * (25.0 - 16.0) * 8.0 * size**3
    return bar, tool("flat", 8.0 * size), Poses(4.0 * size * axis, axis), removed


def groove(size: float) -> Case:
    """A ball whose middle goes around a bar: a groove by Pappus' rule, of which a circle's segment lies within the bar."""
    radius, ball = 6.0 * size, 2.0 * size
    bar = round_bar(np.zeros(3), 0, radius, 10.0 * size, CELL_MM)
    axis = directions(np.linspace(0.0, 2.0 * math.pi, 721))
    removed = 2.0 * math.pi * radius * math.pi * ball**2 / 2.0 - 2.0 * math.pi * 2.0 * ball**3 / 3.0
    return bar, tool("ball", 2.0 * ball), Poses((radius - ball) * axis, axis), removed


def ball_on_five_axes(size: float) -> Case:
    """A ball along a straight path while its axis swings and turns: a cylinder's segment."""
    block = box(np.array([-8.0, -6.0, -5.0]) * size, np.array([8.0, 6.0, 0.0]) * size, CELL_MM)
    share = np.linspace(0.0, 1.0, 400)
    radius, deep = 3.0 * size, 1.5 * size
    tilt, turn = np.radians(25.0) * np.sin(7.0 * share), 9.0 * share
    axis = np.stack(
        [np.sin(tilt) * np.cos(turn), np.sin(tilt) * np.sin(turn), np.cos(tilt)], axis=1
    )
    middle = np.stack([size * (24.0 * share - 12.0), 0.3 + share, np.full(400, radius - deep)], 1)
    slant = math.hypot(24.0 * size, 1.0) / (24.0 * size)
    angle = math.acos((radius - deep) / radius)
    section = radius**2 * angle - (radius - deep) * math.sqrt(radius**2 - (radius - deep) ** 2)
    return (
        block,
        tool("ball", 2.0 * radius),
        Poses(middle - radius * axis, axis),
        (section * 16.0 * size * slant),
    )


def indexed_flat(size: float) -> Case:
    """A flat that a tool at 30 degrees mills on a bar: a circle's segment."""
    radius, depth = 5.0 * size, 1.2 * size
    bar = round_bar(np.zeros(3), 0, radius, 12.0 * size, CELL_MM)
    angle = math.radians(30.0)
    way = straight(
        (-14.0 * size, 0.0, 0.0), (14.0 * size, 0.0, 0.0), tuple(directions(np.array([angle]))[0])
    )
    poses = Poses(way.tip + (radius - depth) * way.axis, way.axis)
    half = math.acos((radius - depth) / radius)
    section = radius**2 * (half - math.sin(2.0 * half) / 2.0)
    return bar, tool("flat", 12.0 * size), poses, section * 12.0 * size


def undercut(size: float) -> Case:
    """A hole from the side below a roof, with the cone of a drill's point: nothing of it is seen from above."""
    block = box(np.array([-6.0, -6.0, -8.0]) * size, np.array([6.0, 6.0, 0.0]) * size, CELL_MM)
    radius, deep = 2.0 * size, 8.0 * size
    poses = straight(
        (10.0 * size, 0.4, -4.03 * size), (6.0 * size - deep, 0.4, -4.03 * size), (1.0, 0.0, 0.0)
    )
    point = radius / math.tan(math.radians(59.0))
    removed = math.pi * radius**2 * (deep - point) + math.pi * radius**2 * point / 3.0
    return block, tool("drill", 2.0 * radius), poses, removed


def oblique_slot(size: float) -> Case:
    """A slot with round corners across a tilted tool: from one side of a block to the other."""
    block = box(np.array([-5.0, -9.0, -9.0]) * size, np.array([5.0, 9.0, 0.0]) * size, CELL_MM)
    radius, corner, tilt = 2.0 * size, 0.5 * size, math.radians(20.0)
    up = (0.0, math.sin(tilt), math.cos(tilt))
    start = (-8.0 * size, -3.0 * math.sin(tilt) * size, -3.0 * math.cos(tilt) * size)
    poses = straight(start, (8.0 * size, *start[1:]), up)
    section = 2.0 * radius * 3.0 * size - 2.0 * corner**2 * (1.0 - math.pi / 4.0)
    return block, tool("bull", 2.0 * radius, corner=corner), poses, section * 10.0 * size


CASES = [turned_bar, groove, ball_on_five_axes, indexed_flat, undercut, oblique_slot]


@pytest.mark.parametrize("make", CASES, ids=lambda make: make.__name__)
def test_volumes_keep_to_their_formulas(make: Callable[[float], Case]) -> None:
    check(make(1.0))


@pytest.mark.thorough
@pytest.mark.parametrize("make", CASES, ids=lambda make: make.__name__)
def test_volumes_of_large_parts_keep_to_their_formulas(make: Callable[[float], Case]) -> None:
    check(make(4.0))


def check(case: Case) -> None:
    part, cutter, poses, exact = case
    before = volume(part)
    found = cut(part, poses, cutting_edge(profile(cutter), FLUTE_MM), 1)
    removed = float(found.volume.sum())
    assert removed == pytest.approx(exact, rel=SHARE)
    assert before - volume(part) == pytest.approx(removed, abs=1e-6 * before)
    mesh = part_mesh(part)
    assert mesh.is_watertight
    assert mesh.is_winding_consistent
    assert mesh.volume == pytest.approx(volume(part), rel=SHARE)
