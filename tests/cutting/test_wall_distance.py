"""Walls that were cut before are known to half a cell, and who stays where tools have been meets nothing."""

import itertools
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest
import trimesh

from tests.cutting.conftest import Motion
from twin.cutting.cut import Cutter
from twin.cutting.material import Head
from twin.job.job_file import StockTable, ToolTable
from twin.nc.canonical import FloatArray
from twin.toolpath.part_frame import PartFrame
from twin.toolpath.tool_plan import ToolChange, ToolPlan

FRAME = PartFrame(rotary=3, center=(0.0, 0.0))
ZERO = np.zeros(4)
SLIM = ToolTable(number=1, diameter=6.0, length=60.0, flute=20.0, holder=6.0, free_length=40.0)
WIDE = ToolTable(number=1, diameter=10.0, length=60.0, flute=20.0, holder=10.0, free_length=40.0)
SHANK = SLIM.model_copy(update={"number": 2, "flute": 6.0, "shank": 10.0, "holder": 10.0})
HOLDER = SLIM.model_copy(update={"number": 2, "flute": 6.0, "holder": 10.0, "free_length": 6.0})


class Box:
    """A head that is as wide as the wide tool, 6 mm above the tip."""

    name, round, half, offset, above = "head", False, (2.0, 5.0), (0.0, 0.0), 6.0
    height, beyond = 50.0, ()


BODIES = {"edge": SLIM, "shank": SHANK, "holder": HOLDER, "head": HOLDER}
LATER = 7
"""Source line of the way that must not meet the wall."""


def along(*corners: Sequence[float] | FloatArray, step: float = 0.25) -> FloatArray:
    """A way from corner to corner, shape (n, 3) [mm]."""
    parts = [np.array(corners[:1], np.float64)]
    for begin, end in itertools.pairwise(np.array(corners, np.float64)):
        count = max(1, int(np.ceil(np.linalg.norm(end - begin) / step)))
        parts.append(begin + (end - begin) * np.arange(1, count + 1)[:, None] / count)
    return np.concatenate(parts)


def ring(radius: float, z: float, begin: float = 0.0, end: float = 2.0 * np.pi) -> FloatArray:
    angle = np.linspace(begin, end, 200)
    return np.column_stack([radius * np.cos(angle), radius * np.sin(angle), np.full(200, z)])


def cut_and_come_back(wall: str, gap: float, body: str) -> tuple[FloatArray, FloatArray]:
    """A wall 4 mm high, and a way beside it with a gap (negative: overlap) [mm]."""
    radius, above = (3.0, 0.0) if body == "edge" else (5.0, 6.0)
    floor, z = -4.0 - above, -2.0 - above
    if wall == "slot":
        cut = along((-9, 0, 5), (-9, 0, floor), (9, 0, floor), (9, 0, 5))
        return cut, along((9, 0, 5), (-5, -gap, 5), (-5, -gap, z), (5, -gap, z))
    out = {"pocket": -1.0, "boss": 1.0}[wall]
    wall_radius = 14.0 if wall == "pocket" else 8.0
    cut = ring(wall_radius + out * radius, floor)
    back = ring(wall_radius + out * (radius + gap), z, 1.0, 2.0)
    (x, y), (back_x, back_y) = cut[-1, :2].tolist(), back[0, :2].tolist()
    lift = along((x, y, floor), (x, y, 5.0), (back_x, back_y, 5.0), (back_x, back_y, z))
    return np.concatenate([along((x, y, 5.0), (x, y, floor)), cut]), np.concatenate([lift, back])


def above(watched: ToolTable) -> Head:
    """A head that is above one tool alone."""
    return lambda tool: [Box()] if tool is watched else []


def meets(
    samples: Motion, wall: str, gap: float, body: str, cell: float, angle: float, chunk: int
) -> bool:
    tool = BODIES[body]
    change = ToolChange(LATER - 1, LATER, tool)
    plan = ToolPlan((WIDE, tool), (0, LATER - 1), (change,)) if body != "edge" else tool
    stock = StockTable(shape="box", size=(44.0, 44.0, 30.0), cell=cell)
    cutter = Cutter(
        stock, plan, FRAME, ZERO, halts=True, head=above(tool) if body == "head" else None
    )
    cut, back = cut_and_come_back(wall, gap, body)
    cosine, sine = np.cos(angle), np.sin(angle)
    way = np.concatenate([cut, back]) @ np.array([[cosine, sine, 0], [-sine, cosine, 0], [0, 0, 1]])
    way += [0.37 * cell, 0.11 * cell, 0.0]
    position = np.column_stack([way, np.zeros(len(way))])
    line = np.array([1] * len(cut) + [LATER] * len(back))
    for first in range(0, len(way), chunk):
        rows = slice(first, first + chunk)
        rapid = (line[rows] == LATER) & (body == "edge")
        cutter.add(samples(position[rows], line[rows]), rapid)
    if cutter.halted is None:
        return False
    assert cutter.halted.line == LATER
    assert cutter.halted.depth_mm > 0.0
    return True


@pytest.mark.parametrize("wall", ["slot", "pocket", "boss"])
@pytest.mark.parametrize("body", ["edge", "shank", "holder"])
def test_a_wall_that_was_cut_is_known_to_half_a_cell(samples: Motion, body: str, wall: str):
    """In any direction, whether it was cut in an earlier chunk or in this one."""
    for cell, angle, chunk in itertools.product((0.2, 0.4), (0.0, 0.3, np.pi / 4), (300, 9999)):
        here = (body, cell, angle, chunk)
        assert meets(samples, wall, -0.5 * cell - 0.05, *here), here
        assert not meets(samples, wall, 0.0, *here), here


@pytest.mark.parametrize("angle", [0.0, np.pi])
def test_a_head_knows_such_a_wall_too(samples: Motion, angle: float):
    for cell in (0.2, 0.4):
        assert meets(samples, "slot", -0.5 * cell - 0.05, "head", cell, angle, 300)
        assert not meets(samples, "slot", 0.0, "head", cell, angle, 300)


@pytest.mark.parametrize("gap", [-0.25, 0.0])
def test_a_round_blank_is_known_to_half_a_cell_all_around(samples: Motion, gap: float):
    stock = StockTable(shape="cylinder", diameter=30.2, height=20.0, cell=0.4)
    for angle in np.linspace(0.0, 2.0 * np.pi, 25):
        cutter = Cutter(stock, SLIM, FRAME, ZERO, halts=True)
        aside, ahead = np.array([np.cos(angle), np.sin(angle)]), np.linspace(-2.0, 2.0, 60)
        way = aside * (15.1 + 3.0 + gap) + ahead[:, None] * [-aside[1], aside[0]]
        position = np.column_stack([way, np.full(60, -2.0), np.zeros(60)])
        cutter.add(samples(position), np.ones(60, np.bool_))
        assert (cutter.halted is not None) == (gap < 0.0)


@pytest.mark.parametrize("size", [30.7, 30.9, 31.0])
def test_who_passes_a_blank_of_an_stl_file_does_not_meet_it(
    samples: Motion, tmp_path: Path, size: float
):
    file = tmp_path / "block.stl"
    trimesh.creation.box(extents=(size, size, 20.0)).export(file)
    cutter = Cutter(
        StockTable(shape="stl", file=str(file), cell=0.4), SLIM, FRAME, ZERO, halts=True
    )
    aside = 0.5 * size + 3.0
    way = along(
        (aside + 2, -20, 5), (aside + 2, -20, -2), (aside, -12, -2), (aside, 12, -2), step=0.1
    )
    cutter.add(samples(np.column_stack([way, np.zeros(len(way))])), np.ones(len(way), np.bool_))
    assert cutter.halted is None


KINDS = {
    "flat": {},
    "ball": {"kind": "ball"},
    "bull": {"kind": "bull", "corner": 1.0},
    "chamfer": {"kind": "chamfer"},
}


@pytest.mark.parametrize("level", [True, False])
@pytest.mark.parametrize("kind", list(KINDS))
def test_who_stays_where_tools_have_been_meets_nothing(samples: Motion, kind: str, level: bool):
    """Two tools cut at random, terraces or slopes, and the second goes its way again, at rapid."""
    shape = SLIM.model_dump(include={"length", "flute", "free_length"}) | {"holder": 5.0}
    second = ToolTable.model_validate({"number": 2, "diameter": 5.0, **shape, **KINDS[kind]})
    plan = ToolPlan((SLIM, second), (0, 1), (ToolChange(1, 2, second),))
    for seed in range(10):
        random = np.random.default_rng(seed)
        places = random.uniform([-11, -11, -6], [11, 11, -1], (6, 3))
        if level:
            places[:, 2] = places[:, 2].round()
            ends = [(*after[:2], before[2]) for before, after in itertools.pairwise(places)]
            places = np.stack([places[:-1], ends], axis=1).reshape(-1, 3)
        again = places + random.uniform([-1.5, -1.5, -1.5], [1.5, 1.5, 0.5])
        ways = [
            along((*way[0, :2], 6.0), *way, (*way[-1, :2], 6.0), step=0.5)
            for way in (places, again, again)
        ]
        line = np.repeat([1, 2, 3], [len(way) for way in ways])
        position = np.column_stack([np.concatenate(ways), np.zeros(len(line))])
        stock = StockTable(shape="box", size=(24.0, 24.0, 30.0), cell=[0.2, 0.4, 0.7][seed % 3])
        cutter = Cutter(stock, plan, FRAME, ZERO, halts=True)
        cutter.add(samples(position, line), line == 3)
        assert cutter.halted is None, seed
