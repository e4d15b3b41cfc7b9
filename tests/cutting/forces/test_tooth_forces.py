"""The forces of teeth against hand integration of the mechanistic model, on ideal engagements."""

import math
from typing import NamedTuple

import numpy as np
import pytest

from twin.cutting.forces.cutter_form import cutter_form, force_law
from twin.cutting.forces.materials import materials
from twin.cutting.heights.height_map import HeightMap, blank
from twin.cutting.heights.sweeping import sweep_lines
from twin.cutting.kernels.teeth import ANGLE_BINS, ToothScratch, add_force_between, tooth_bench
from twin.cutting.kernels.tooth_forces import tooth_forces
from twin.cutting.kernels.walls import WallArray, WalledMap, leave_walls, no_trace, no_walls
from twin.cutting.tools import profile
from twin.job.job_file import StockTable, ToolTable
from twin.nc.canonical import FloatArray

STEEL = materials()["C45"]
FEED = 0.08
"""Per tooth [mm]."""
QUADRANTS = [30.0, 120.0, 210.0, 300.0]
"""Directions of feed, one in each quadrant and none along the grid [deg]."""


class Plate(NamedTuple):
    """A height map and the walls in it."""

    map: HeightMap
    walls: WallArray

    @property
    def material(self) -> WalledMap:
        return WalledMap(self.map.heights, self.map.grid, self.walls)


def plate(cell: float = 0.1) -> Plate:
    stock = StockTable(shape="box", size=(60.0, 60.0, 30.0), position=(0.0, 0.0, 0.0), cell=cell)
    part = blank(stock, np.zeros(3), cell)
    return Plate(part, no_walls(part.heights))


def cut(part: Plate, tool: ToolTable, points: FloatArray) -> None:
    edge, trace = profile(tool), no_trace()
    sweep_lines(part.map, points, edge)
    for tip in points:
        leave_walls(part.material, trace, tip, edge.radius, cutter_form(tool).side_from)


def forces(part: Plate, tool: ToolTable, points: FloatArray, sense: float = 1.0) -> ToothScratch:
    """What the teeth feel at the end of a way that was cut."""
    cut(part, tool, points)
    scratch = tooth_bench()
    ahead = points[-1] - points[0]
    feed = FEED * ahead / np.linalg.norm(ahead)
    law = force_law(tool, STEEL)
    tooth_forces(part.material, points[-1], feed, cutter_form(tool), law, sense, scratch)
    return scratch


def along(direction: float, depth: float, aside: float = 0.0) -> FloatArray:
    """A level way to the middle of the plate and so far left of it, in a direction [deg]."""
    angle = math.radians(direction)
    ahead = np.array([math.cos(angle), math.sin(angle), 0.0])
    left = np.array([-ahead[1], ahead[0], 0.0])
    way = np.linspace(-50.0, 0.0, 501)[:, None] * ahead
    return way + aside * left - [0.0, 0.0, depth]


def by_hand(
    tool: ToolTable, depth: float, first: float, last: float, sense: float = 1.0
) -> tuple[FloatArray, float, float]:
    """Mean force (ahead, left, up), greatest level force and mean torque of an end mill's side.

    Teeth are followed through a turn in fine steps; angles count from the feed, left positive.
    """
    law = force_law(tool, STEEL)
    radius = 0.5 * tool.diameter
    helix = math.tan(math.radians(tool.helix_angle)) / radius
    z = (np.arange(200) + 0.5) / 200 * depth
    force = []
    torque = []
    for turned in np.arange(0.0, math.tau, math.tau / 1440):
        tip = turned + math.tau / tool.teeth * np.arange(tool.teeth)
        angle = (tip[:, None] + sense * helix * z + math.pi) % math.tau - math.pi
        cutting = (angle > first) & (angle < last) & (np.cos(angle) > 0.0)
        chip = np.where(cutting, FEED * np.cos(angle), 0.0)
        push = law.kc * np.maximum(chip, 1e-3) ** -law.mc * chip * depth / len(z)
        cosine, sine = np.cos(angle), np.sin(angle)
        level = (
            (push * (-sense * sine - law.radial * cosine)).sum(),
            (push * (sense * cosine - law.radial * sine)).sum(),
        )
        force.append([*level, -law.along * push.sum()])
        torque.append(radius * push.sum())
    found = np.array(force)
    return found.mean(axis=0), float(np.hypot(*found[:, :2].T).max()), float(np.mean(torque))


def turned(scratch: ToothScratch, direction: float) -> FloatArray:
    """The mean force seen along the feed: ahead, left, up."""
    angle = math.radians(direction)
    cosine, sine = math.cos(angle), math.sin(angle)
    x, y, z = scratch.mean
    return np.array([cosine * x + sine * y, cosine * y - sine * x, z])


def assert_like(scratch: ToothScratch, direction: float, expected: tuple[FloatArray, float, float]):
    mean, peak, torque = expected
    size = float(np.linalg.norm(mean))
    np.testing.assert_allclose(turned(scratch, direction), mean, atol=0.05 * size)
    assert scratch.figures[0] == pytest.approx(peak, rel=0.1)
    assert scratch.figures[1] == pytest.approx(torque, rel=0.05)


@pytest.mark.seconds("the kernel of the tooth is loaded")
@pytest.mark.parametrize("direction", QUADRANTS)
@pytest.mark.parametrize("helix", [0.0, 30.0, 45.0])
def test_a_slot_is_what_hand_integration_gives(direction: float, helix: float) -> None:
    tool = ToolTable(number=1, diameter=10.0, teeth=4, helix=helix)
    scratch = forces(plate(), tool, along(direction, 4.0))
    half = 0.5 * math.pi
    assert_like(scratch, direction, by_hand(tool, 4.0, -half, half))
    assert scratch.figures[2] == pytest.approx(FEED, rel=0.01)
    ahead, left, up = turned(scratch, direction)
    assert ahead < 0.0 < left, "held back and pushed to the left"
    assert up <= 0.0, "a right-hand helix pulls the tool out"


@pytest.mark.parametrize("direction", QUADRANTS)
@pytest.mark.parametrize(("side", "name"), [(-1.0, "down"), (1.0, "up")])
@pytest.mark.parametrize("width", [5.0, 2.0])
def test_partial_immersion_up_and_down(
    direction: float, side: float, name: str, width: float
) -> None:
    # Everything up to ``width`` inside the cutter's edge on the one side has been milled off.
    tool, wide = ToolTable(number=1, diameter=10.0, teeth=2), 40.0
    part = plate()
    clearing = ToolTable(number=2, diameter=wide)
    way = along(direction, 6.0, -side * (0.5 * wide - 5.0 + width))
    ahead = (way[-1] - way[0]) / 50.0
    cut(part, clearing, np.concatenate([way, way[-1:] + 40.0 * ahead]))
    scratch = forces(part, tool, along(direction, 3.0))
    bound = math.asin(1.0 - width / 5.0)
    first, last = (bound, 0.5 * math.pi) if side > 0 else (-0.5 * math.pi, -bound)
    assert_like(scratch, direction, by_hand(tool, 3.0, first, last))
    away = -side * turned(scratch, direction)[1]
    assert (away > 0.0) == (name == "down"), (
        "climb milling pushes off, conventional milling draws in"
    )


def test_counter_clockwise_mirrors_the_slot() -> None:
    tool = ToolTable(number=1, diameter=10.0, teeth=3)
    scratch = forces(plate(), tool, along(30.0, 4.0), sense=-1.0)
    half = 0.5 * math.pi
    assert_like(scratch, 30.0, by_hand(tool, 4.0, -half, half, sense=-1.0))
    assert turned(scratch, 30.0)[1] < 0.0


def test_a_wall_that_was_cut_before_pushes_no_more() -> None:
    for direction in (17.0, 45.0, 90.0):
        for tool in (
            ToolTable(number=1),
            ToolTable(number=1, kind="ball"),
            ToolTable(number=1, kind="bull", corner=2.0),
        ):
            part, way = plate(), along(direction, 4.0)
            ahead = (way[-1] - way[0]) / 50.0
            cut(part, tool, np.concatenate([way, way[-1:] + 30.0 * ahead]))
            scratch = forces(part, tool, way)
            slot = forces(plate(), tool, way)
            share = np.linalg.norm(scratch.mean) / np.linalg.norm(slot.mean)
            assert share < 0.02, (direction, tool.kind)


def ball_by_hand(
    tool: ToolTable, ahead: FloatArray, normal: FloatArray, depth: float
) -> tuple[FloatArray, float]:
    """Mean force on a ball that cuts a plane of a normal to a depth, and the mean torque."""
    law = force_law(tool, STEEL)
    radius = 0.5 * tool.diameter
    lead = np.linspace(0.0, 0.5 * math.pi, 401)
    lead, step = 0.5 * (lead[1:] + lead[:-1]), lead[1] - lead[0]
    angle = (np.arange(1440) + 0.5) * math.tau / 1440
    out, rise = np.sin(lead)[:, None], np.cos(lead)[:, None]
    c, s = np.cos(angle), np.sin(angle)
    surface = np.stack([out * c, out * s, -rise + 0.0 * c])
    # The plane's surface is ``depth`` above the ball's lowest point along its normal.
    below = radius * np.tensordot(normal, surface, 1) < depth - radius
    chip = FEED * np.maximum(np.tensordot(ahead, surface, 1), 0.0) * below
    push = law.kc * np.maximum(chip, 1e-3) ** -law.mc * chip * radius * step
    inwards = push * (law.radial * out + law.along * rise)
    level_x = -s * push - c * inwards
    level_y = c * push - s * inwards
    up = push * (law.radial * rise - law.along * out)
    share = tool.teeth / len(angle)
    mean = share * np.array([level_x.sum(), level_y.sum(), up.sum()])
    return mean, share * float((push * radius * out).sum())


@pytest.mark.parametrize("direction", QUADRANTS)
@pytest.mark.parametrize("slope", [0.0, 20.0, -20.0])
def test_a_ball_on_a_slope(direction: float, slope: float) -> None:
    tool = ToolTable(number=1, diameter=10.0, kind="ball", teeth=2, flute=20.0)
    turn, steep = math.radians(direction), math.radians(slope)
    level = np.array([math.cos(turn), math.sin(turn), 0.0])
    ahead = math.cos(steep) * level + [0.0, 0.0, math.sin(steep)]
    normal = -math.sin(steep) * level + [0.0, 0.0, math.cos(steep)]
    part, depth, radius = plate(), 2.0, 5.0
    # A plane through the origin, of which the ball's lowest point along the normal is ``depth`` below.
    x, y = np.meshgrid(part.map.x, part.map.y)
    plane = -(normal[0] * x + normal[1] * y) / normal[2] - 10.0
    part.map.heights[:] = np.minimum(plane, part.map.top)
    center = (radius - depth) * normal - [0.0, 0.0, 10.0]
    tip = center - [0.0, 0.0, radius]
    scratch = forces(part, tool, tip + np.linspace(-20.0, 0.0, 201)[:, None] * ahead)
    mean, torque = ball_by_hand(tool, ahead, normal, depth)
    np.testing.assert_allclose(scratch.mean, mean, atol=0.1 * float(np.linalg.norm(mean)))
    assert scratch.figures[1] == pytest.approx(torque, rel=0.1)


def test_a_drill_feels_the_thrust_of_its_formula() -> None:
    tool = ToolTable(number=1, kind="drill", diameter=8.0, teeth=2)
    scratch = forces(plate(), tool, np.linspace([0.0, 0.0, 1.0], [0.0, 0.0, -10.0], 200))
    sine = math.sin(math.radians(59.0))
    kc = STEEL.kc * (FEED * sine) ** -STEEL.mc
    assert scratch.mean[2] == pytest.approx(0.5 * kc * 4.0 * 2 * FEED * sine, rel=0.05)
    assert np.abs(scratch.mean[:2]).max() < 1e-6
    # Every tooth pushes with kc h b at half of the radius.
    assert scratch.figures[1] == pytest.approx(2 * kc * FEED * 4.0 * 2.0, rel=0.05)


def test_force_over_a_turn_is_the_mean_and_over_little_the_force_of_the_teeth_there() -> None:
    tool = ToolTable(number=1, diameter=10.0, teeth=3)
    scratch, cutter = forces(plate(), tool, along(30.0, 4.0)), cutter_form(tool)
    for angle, turned_by in ((0.0, -1.0), (0.3, -1.0 / 3.0), (0.9, 1.0), (0.2, -7.0 / 3.0)):
        force = np.zeros(3)
        add_force_between(cutter, scratch, angle, turned_by, force)
        np.testing.assert_allclose(force, scratch.mean, rtol=1e-9)
    for bin_ in (0, 5, 23):
        force = np.zeros(3)
        add_force_between(cutter, scratch, (bin_ + 0.5) / ANGLE_BINS, 0.0, force)
        at = (bin_ + ANGLE_BINS // 3 * np.arange(3)) % ANGLE_BINS
        np.testing.assert_allclose(force, scratch.tooth[at].sum(axis=0), rtol=1e-6, atol=1e-6)


def test_in_the_air_there_is_none() -> None:
    tool, part = ToolTable(number=1, diameter=10.0), plate()
    scratch = forces(part, tool, along(30.0, -1.0))
    assert not scratch.mean.any()
    assert not scratch.figures.any()


@pytest.mark.parametrize("direction", [0.0, 17.0])
@pytest.mark.parametrize("side", [-1.0, 1.0])
@pytest.mark.parametrize("width", [0.1, 0.2, 1.0])
def test_a_cut_narrower_than_a_cell_is_what_hand_integration_gives(
    direction: float, side: float, width: float
) -> None:
    # Cells of half a millimetre: two of these widths lie within one.
    tool, clearing = ToolTable(number=1, diameter=10.0, teeth=4), ToolTable(number=2, diameter=40.0)
    part = plate(cell=0.5)
    way = along(direction, 6.0, -side * (15.0 + width))
    cut(part, clearing, np.concatenate([way, way[-1:] + 40.0 * (way[-1] - way[0]) / 50.0]))
    scratch = forces(part, tool, along(direction, 3.0)[-120:])
    bound = math.asin(1.0 - width / 5.0)
    bounds = (bound, 0.5 * math.pi) if side > 0 else (-0.5 * math.pi, -bound)
    assert_like(scratch, direction, by_hand(tool, 3.0, *bounds))


def test_the_greatest_force_of_straight_edges_is_that_of_the_thickest_chip() -> None:
    tool, part = ToolTable(number=1, diameter=10.0, teeth=4, helix=0.0), plate(cell=0.5)
    way = along(17.0, 6.0, -15.2)
    cut(part, ToolTable(number=2, diameter=40.0), np.concatenate([way, way + (way[-1] - way[0])]))
    scratch = forces(part, tool, along(17.0, 3.0)[-120:])
    law, chip = force_law(tool, STEEL), FEED * math.sqrt(1.0 - 0.96**2)
    push = law.kc * chip ** (1.0 - law.mc) * 3.0
    assert scratch.figures[0] == pytest.approx(push * math.hypot(1.0, law.radial), rel=0.02)
    assert scratch.figures[2] == pytest.approx(chip, rel=0.02)
