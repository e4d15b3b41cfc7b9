"""The forces of teeth in a tri-dexel stock against hand integration, upright and leaning, and against a height map."""

import math
from typing import Literal

import numpy as np
import pytest

from tests.cutting.forces import test_tooth_forces as height_map
from tests.cutting.forces.test_tooth_forces import FEED, STEEL, ball_by_hand, by_hand
from twin.cutting.forces.cutter_form import cutter_form, force_law
from twin.cutting.kernels.teeth import ToothScratch, tooth_bench
from twin.cutting.tools import profile
from twin.cutting.tridexel.blanks import box
from twin.cutting.tridexel.dexels import TriDexel
from twin.cutting.tridexel.edge import Leaning
from twin.cutting.tridexel.edge_forces import edge_forces, empty_scratch
from twin.cutting.tridexel.engagement import cut
from twin.cutting.tridexel.solids.moving_solid import Poses
from twin.cutting.tridexel.solids.solids import cutting_edge, cylinder
from twin.job.job_file import ToolTable
from twin.nc.canonical import FloatArray

CELL = 0.2
ON = np.array([20.0, 0.0, 0.0])
"""To beyond the block [mm]."""
TILTS = [(0.0, 0.0), (50.0, 200.0)]
"""By how much the tool leans, and whither [deg]: upright, and in a block whose face leans as much."""


def frame(tilt: float, towards: float, direction: float) -> FloatArray:
    """X (ahead), Y and Z of a tool that leans and goes in a direction across its axis, as rows."""
    t, b, a = (math.radians(angle) for angle in (tilt, towards, direction))
    z = np.array([math.sin(t) * math.cos(b), math.sin(t) * math.sin(b), math.cos(t)])
    x = np.array([math.cos(a), math.sin(a), 0.0])
    x -= (x @ z) * z
    x /= np.linalg.norm(x)
    return np.stack([x, np.cross(z, x), z])


def block(axes: FloatArray) -> TriDexel:
    """A block, faced across a tool's axis through its middle."""
    stock = box(np.array([-12.0, -12.0, -12.0]), np.array([12.0, 12.0, 12.0]), CELL)
    face = Poses(np.zeros((2, 3)), np.tile(axes[2], (2, 1)))
    cut(stock, face, [cylinder(40.0, 0.0, 40.0)], 1)
    return stock


def mill(stock: TriDexel, tool: ToolTable, axes: FloatArray, tips: FloatArray) -> None:
    """Cut along tips that are told in the tool's frame."""
    poses = Poses(tips @ axes, np.tile(axes[2], (len(tips), 1)))
    cut(stock, poses, cutting_edge(profile(tool), tool.flute), 1)


def forces(
    stock: TriDexel, tool: ToolTable, axes: FloatArray, tips: FloatArray, sense: float = 1.0
) -> ToothScratch:
    """What the teeth feel at the end of a way that was cut, in the tool's frame."""
    mill(stock, tool, axes, tips)
    way = tips[-1] - tips[-2]
    feed = FEED * way / np.linalg.norm(way)
    # The tool's X is 7 degrees off the way: nothing begins at the border of a direction.
    turn = math.radians(7.0)
    cosine, sine = math.cos(turn), math.sin(turn)
    spin = np.array([[cosine, sine, 0.0], [-sine, cosine, 0.0], [0.0, 0.0, 1.0]])
    bench = tooth_bench()
    leaning = Leaning(tips[-1] @ axes, spin @ axes, spin @ feed, np.zeros(3), sense)
    edge_forces(
        stock.dexels,
        stock.lattice,
        leaning,
        cutter_form(tool),
        force_law(tool, STEEL),
        empty_scratch(),
        bench,
    )
    bench.mean[:] = spin.T @ bench.mean
    return bench


def straight(depth: float, aside: float = 0.0) -> FloatArray:
    """A way into the middle of the block along the tool's X, and so far left of it."""
    return np.linspace([-20.0, aside, -depth], [0.0, aside, -depth], 81)


def assert_like(bench: ToothScratch, expected: tuple[FloatArray, float, float], within: float):
    mean, peak, torque = expected
    np.testing.assert_allclose(bench.mean, mean, atol=within * float(np.linalg.norm(mean)))
    assert bench.figures[0] == pytest.approx(peak, rel=within)
    assert bench.figures[1] == pytest.approx(torque, rel=within)


@pytest.mark.parametrize(("tilt", "towards"), TILTS)
@pytest.mark.parametrize(("helix", "sense"), [(0.0, 1.0), (30.0, -1.0)])
def test_a_slot(tilt: float, towards: float, helix: float, sense: float) -> None:
    tool = ToolTable(number=1, diameter=10.0, teeth=4, helix=helix)
    axes = frame(tilt, towards, 20.0)
    bench = forces(block(axes), tool, axes, straight(4.0), sense)
    half = 0.5 * math.pi
    assert_like(bench, by_hand(tool, 4.0, -half, half, sense), 0.05)
    assert bench.figures[2] == pytest.approx(FEED, rel=0.01)


@pytest.mark.parametrize(("tilt", "towards"), TILTS)
@pytest.mark.parametrize("side", [1.0, -1.0])
@pytest.mark.parametrize("width", [5.0, 2.0, 0.5])
def test_a_shoulder_down_and_up(tilt: float, towards: float, side: float, width: float) -> None:
    tool, axes = ToolTable(number=1, diameter=10.0, teeth=2), frame(tilt, towards, 20.0)
    stock = block(axes)
    clearing = ToolTable(number=2, diameter=40.0)
    tips = straight(6.0, -side * (15.0 + width))
    mill(stock, clearing, axes, np.concatenate([tips, tips + ON]))
    bench = forces(stock, tool, axes, straight(3.0))
    bound = math.asin(1.0 - width / 5.0)
    first, last = (bound, 0.5 * math.pi) if side > 0 else (-0.5 * math.pi, -bound)
    assert_like(bench, by_hand(tool, 3.0, first, last), 0.05)


@pytest.mark.parametrize(("tilt", "towards"), TILTS)
def test_a_drill(tilt: float, towards: float) -> None:
    tool, axes = (
        ToolTable(number=1, kind="drill", diameter=8.0, teeth=2),
        frame(tilt, towards, 0.0),
    )
    bench = forces(block(axes), tool, axes, np.linspace([0.0, 0.0, 3.0], [0.0, 0.0, -8.0], 100))
    sine = math.sin(math.radians(59.0))
    kc = STEEL.kc * (FEED * sine) ** -STEEL.mc
    assert bench.mean[2] == pytest.approx(0.5 * kc * 4.0 * 2 * FEED * sine, rel=0.05)
    assert np.abs(bench.mean[:2]).max() < 0.01 * bench.mean[2]
    assert bench.figures[1] == pytest.approx(2 * kc * FEED * 4.0 * 2.0, rel=0.05)


@pytest.mark.parametrize("lead", [-20.0, 30.0])
@pytest.mark.parametrize(("tilt", "towards"), TILTS)
def test_a_ball_that_leans_on_a_plane(tilt: float, towards: float, lead: float) -> None:
    """The plane is across the axis of ``axes``; the tool leads by an angle in it, and its teeth cut on one side."""
    tool = ToolTable(number=1, diameter=10.0, kind="ball", teeth=2, flute=20.0)
    axes, depth = frame(tilt, towards, 20.0), 2.0
    stock, t = block(axes), math.radians(lead)
    tool_axes = (
        np.array(
            [[math.cos(t), 0.0, -math.sin(t)], [0.0, 1.0, 0.0], [math.sin(t), 0.0, math.cos(t)]]
        )
        @ axes
    )
    centers = straight(depth - 5.0) @ axes
    tips = (centers - 5.0 * tool_axes[2]) @ tool_axes.T
    bench = forces(stock, tool, tool_axes, tips)
    ahead, normal = tool_axes @ axes[0], tool_axes @ axes[2]
    mean, torque = ball_by_hand(tool, ahead, normal, depth)
    # ``forces`` turns by the tool's own X, which is not quite the way.
    np.testing.assert_allclose(bench.mean, mean, atol=0.05 * float(np.linalg.norm(mean)))
    assert bench.figures[1] == pytest.approx(torque, rel=0.05)


@pytest.mark.parametrize("kind", ["flat", "ball", "bull"])
def test_a_height_map_says_the_same(kind: Literal["flat", "ball", "bull"]) -> None:
    tool = ToolTable(
        number=1,
        diameter=10.0,
        teeth=3,
        kind=kind,
        helix=30.0,
        corner=2.0 if kind == "bull" else None,
    )
    axes = frame(0.0, 0.0, 20.0)
    bench = forces(block(axes), tool, axes, straight(4.0))
    other = height_map.forces(height_map.plate(), tool, height_map.along(20.0, 4.0))
    mean = height_map.turned(other, 20.0)
    np.testing.assert_allclose(bench.mean, mean, atol=0.05 * float(np.linalg.norm(mean)))
    np.testing.assert_allclose(bench.figures, other.figures, rtol=0.05)


def test_what_was_cut_before_pushes_no_more() -> None:
    tool, axes = ToolTable(number=1, diameter=10.0, teeth=3), frame(25.0, 40.0, 20.0)
    stock, slot = block(axes), block(axes)
    mill(stock, tool, axes, np.concatenate([straight(4.0), straight(4.0) + ON]))
    full = forces(slot, tool, axes, straight(4.0))
    again = forces(stock, tool, axes, straight(4.0))
    assert np.linalg.norm(again.mean) < 0.02 * np.linalg.norm(full.mean)


def test_a_cutter_that_slides_over_a_face_at_rapid_cuts_no_chip() -> None:
    """It stands where the program begins, at the blank's top: a part of a micrometre of it is in the material."""
    tool, axes = ToolTable(number=1, diameter=10.0, teeth=4), frame(0.0, 0.0, 20.0)
    slid = forces(block(axes), tool, axes, straight(1e-6)[[0, -1]])
    assert (slid.figures[0], slid.figures[2]) == (0.0, 0.0)
    assert forces(block(axes), tool, axes, straight(0.02)).figures[2] == pytest.approx(
        FEED, rel=0.01
    )
