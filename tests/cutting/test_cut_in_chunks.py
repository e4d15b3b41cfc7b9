"""However samples come in chunks, what is cut of them is the same, to the bit."""

import dataclasses
import functools
import itertools
import math

import hypothesis
import hypothesis.strategies as st
import numpy as np
import pytest
from examples import examples

from tests.cutting.conftest import samples
from twin.cutting.cut import Cutter
from twin.cutting.tridexel.material import TriDexelMaterial
from twin.cutting.watching.cut_log import CutResult
from twin.job.job_file import StockTable, ToolTable
from twin.nc.canonical import BoolArray, FloatArray
from twin.toolpath.part_frame import PartFrame

FRAME = PartFrame(rotary=None, center=(0.0, 0.0))
STOCK = StockTable(shape="box", size=(24.0, 20.0, 8.0), cell=0.4, material="C45")


def motion() -> tuple[FloatArray, FloatArray, BoolArray]:
    """Down into the plate in rapid and feed, a slot, an arc, a thin cut beside it, and up; with lines and rapids."""
    angle = np.linspace(0.0, math.pi, 260)
    arc = np.column_stack([4.0 * np.sin(angle), 4.0 * np.cos(angle) - 4.0, -2.0 - 0.2 * angle])
    ways = [
        np.linspace([-6.0, 0.0, 5.0], [-6.0, 0.0, 0.5], 25),
        np.linspace([-6.0, 0.0, 0.5], [-6.0, 0.0, -2.0], 150),
        np.linspace([-6.0, 0.0, -2.0], [0.0, 0.0, -2.0], 300),
        arc,
        np.linspace(arc[-1], [-6.0, -8.02, arc[-1, 2]], 200),
        np.linspace([-6.0, -8.02, arc[-1, 2]], [-6.0, -8.02, 5.0], 25),
    ]
    line = np.repeat(np.arange(6.0), [len(way) for way in ways])
    way = np.concatenate(ways)
    way += np.random.default_rng(3).uniform(-3e-4, 3e-4, way.shape)
    return way, line, (line == 0) | (line == 5)


def cut(kind: str, ends: list[int], *, tilts: bool) -> tuple[CutResult, bytes]:
    """What a tool cuts of the motion in chunks that end there."""
    fields = {"kind": kind, "diameter": 3.0, "flute": 7.0, "teeth": 2, "speed": 6000.0}
    tool = ToolTable.model_validate({"number": 1, **fields})
    cutter = Cutter(STOCK, tool, FRAME, np.zeros(3), tilts=tilts, halts=True)
    way, line, rapid = motion()
    run = samples(way, line)
    borders = [0, *sorted(ends), len(way)]
    for first, end in itertools.pairwise(borders):
        here = slice(first, end)
        cutter.add(run[here], rapid[here], goes_on=True)
    result, material = cutter.result(), cutter.material
    if isinstance(material, TriDexelMaterial):
        return result, material.stock.intervals()[0].tobytes()
    return result, cutter.map.heights.tobytes() + cutter.map.behind.tobytes()


KINDS = [("flat", False), ("ball", False), ("flat", True), ("ball", True)]
COUNT = len(motion()[0])


@functools.cache
def whole(kind: str, tilts: bool) -> tuple[CutResult, bytes]:
    """What it cuts in one chunk."""
    return cut(kind, [], tilts=tilts)


@pytest.mark.parametrize("kind", KINDS)
@hypothesis.settings(derandomize=True, max_examples=examples(24), deadline=None)
@hypothesis.given(ends=st.lists(st.integers(0, COUNT), max_size=60))
def test_any_division_of_the_samples_gives_the_same(
    kind: tuple[str, bool], ends: list[int]
) -> None:
    once, part = whole(*kind)
    result, material = cut(kind[0], ends, tilts=kind[1])
    assert dataclasses.asdict(result) == dataclasses.asdict(once)
    assert material == part
    assert result.removed_mm3 > 50.0
    assert result.blocks[2].force_n is not None
