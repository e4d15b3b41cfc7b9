import math
from collections.abc import Callable

import numpy as np
import pytest

from tests.cutting.conftest import Motion
from twin.cutting.cut import Cutter
from twin.cutting.height_map_material import HeightMapMaterial
from twin.cutting.heights.height_map import blank
from twin.cutting.material import Points
from twin.cutting.tools import default_cell, profile
from twin.errors import ConfigError
from twin.job.job_file import StockTable, ToolTable
from twin.nc.canonical import FloatArray
from twin.toolpath.part_frame import PartFrame

FRAME = PartFrame(rotary=3, center=(0.0, 0.0))
ZERO = np.zeros(4)
TOOL = ToolTable(number=1, diameter=6.0, flute=8.0)
PLATE = StockTable(shape="box", size=(80.0, 60.0, 10.0))


def path(
    x: FloatArray | float, y: FloatArray | float, z: FloatArray | float, c: FloatArray | float = 0.0
) -> FloatArray:
    return np.stack(np.broadcast_arrays(np.float64(x), y, z, c), axis=1)


def plate(cell: float) -> StockTable:
    return PLATE.model_copy(update={"cell": cell})


def slot() -> tuple[FloatArray, float, float]:
    motion = path(np.linspace(-20.0, 20.0, 500), np.linspace(-3.0, 5.0, 500), -4.0)
    length = math.hypot(40.0, 8.0)
    return motion, (length * 6.0 + math.pi * 9.0) * 4.0, (2 * length + math.pi * 6.0) * 4.0


def hole() -> tuple[FloatArray, float, float]:
    motion = path(3.3, 1.7, np.linspace(2.0, -7.0, 200))
    return motion, math.pi * 9.0 * 7.0, math.pi * 6.0 * 7.0


def circular_pocket() -> tuple[FloatArray, float, float]:
    angle = np.linspace(0.0, 2 * math.pi, 4000)
    motion = path(2.5 * np.cos(angle), 2.5 * np.sin(angle), -3.0)
    return motion, math.pi * 5.5**2 * 3.0, math.pi * 11.0 * 3.0


def helix_bore() -> tuple[FloatArray, float, float]:
    angle = np.linspace(0.0, 8 * math.pi, 9000)
    depth = np.minimum(angle / (6 * math.pi), 1.0) * 5.0
    motion = path(2.0 * np.cos(angle), 2.0 * np.sin(angle), -depth)
    return motion, math.pi * 25.0 * 5.0, math.pi * 10.0 * 5.0


@pytest.mark.parametrize("shape", [slot, hole, circular_pocket, helix_bore])
def test_removed_volume_approaches_the_formula_with_the_cell(
    shape: Callable[[], tuple[FloatArray, float, float]], samples: Motion
) -> None:
    motion, exact, wall = shape()
    for cell in (0.4, 0.2, 0.1, 0.05):
        cutter = Cutter(plate(cell), TOOL, FRAME, ZERO)
        cutter.add(samples(motion), np.zeros(len(motion), np.bool_))
        result = cutter.result()
        assert abs(result.removed_mm3 - exact) < 0.2 * wall * cell
        assert result.cell_mm == cell
        assert cutter.map.volume == pytest.approx(80.0 * 60.0 * 10.0 - result.removed_mm3)


def test_turning_the_table_alone_cuts_a_ring(samples: Motion) -> None:
    stock = StockTable(shape="cylinder", diameter=240.0, height=20.0, cell=0.25)
    cutter = Cutter(stock, TOOL, FRAME, ZERO)
    motion = path(100.0, 0.0, -2.0, np.linspace(0.0, 360.0, 20_000))
    cutter.add(samples(motion), np.zeros(len(motion), np.bool_))
    radius = np.hypot(*np.meshgrid(cutter.map.x, cutter.map.y))
    cut = (cutter.map.heights == -2.0) & (radius < 120.0)
    assert radius[cut].min() == pytest.approx(97.0, abs=0.01)
    assert radius[cut].max() == pytest.approx(103.0, abs=0.01)
    assert cut[(radius > 97.01) & (radius < 102.99)].all()
    exact = 2 * math.pi * 100.0 * 6.0 * 2.0
    assert cutter.result().removed_mm3 == pytest.approx(exact, rel=1e-3)


def test_part_stands_where_its_zero_and_its_turn_say(samples: Motion) -> None:
    frame = PartFrame(rotary=3, center=(300.0, 200.0), turn_zero=30.0)
    zero = np.array([310.0, 190.0, -250.0, 30.0])
    stock = StockTable(shape="box", size=(40.0, 20.0, 5.0), position=(4.0, 6.0, 1.0), cell=0.5)
    cutter = Cutter(stock, TOOL, frame, zero)
    assert cutter.map.top == -249.0
    assert cutter.map.bottom == -254.0
    assert cutter.map.x[[0, -1]].mean() == pytest.approx(14.0, abs=1e-4)
    assert cutter.map.y[[0, -1]].mean() == pytest.approx(-4.0, abs=1e-4)
    target = np.array([10.0 + 4.0 + 8.0, -10.0 + 6.0 + 2.0])
    turned = np.deg2rad(-50.0)
    x = math.cos(turned) * target[0] - math.sin(turned) * target[1]
    y = math.sin(turned) * target[0] + math.cos(turned) * target[1]
    motion = path(300.0 + x, 200.0 + y, np.array([-240.0, -252.0]), 80.0)
    cutter.add(samples(motion), np.zeros(2, np.bool_))
    rows, columns = np.nonzero(cutter.map.heights == -252.0)
    assert cutter.map.x[columns].mean() == pytest.approx(target[0], abs=0.05)
    assert cutter.map.y[rows].mean() == pytest.approx(target[1], abs=0.05)


def test_chunks_make_no_difference(samples: Motion) -> None:
    motion, exact, _ = helix_bore()
    whole, pieces = (Cutter(plate(0.2), TOOL, FRAME, ZERO) for _ in range(2))
    whole.add(samples(motion), np.zeros(len(motion), np.bool_))
    for first in range(0, len(motion), 37):
        piece = motion[first : first + 37]
        pieces.add(samples(piece, start=first * 1e-3), np.zeros(len(piece), np.bool_))
    assert pieces.result().removed_mm3 == pytest.approx(whole.result().removed_mm3, rel=1e-3)
    assert whole.result().removed_mm3 == pytest.approx(exact, rel=1e-2)
    assert whole.add(samples(motion[:0]), np.zeros(0, np.bool_)) == 0.0


def test_air_is_the_share_of_the_feed_path_without_removal(samples: Motion) -> None:
    cutter = Cutter(plate(0.2), TOOL, FRAME, ZERO)
    # The edge meets the plate 3 mm before the axis does and leaves no wall behind the axis.
    motion = path(np.linspace(-83.0, 83.0, 4000), 0.0, -1.0)
    cutter.add(samples(motion), np.zeros(len(motion), np.bool_))
    assert cutter.result().air_share == pytest.approx(0.5, abs=0.02)
    cutter.add(samples(path(83.0, np.linspace(0, 99, 100), -1.0)), np.ones(100, np.bool_))
    assert cutter.result().air_share == pytest.approx(0.5, abs=0.02)


def test_rapid_into_stock_names_the_line_once_per_move(samples: Motion) -> None:
    cutter = Cutter(plate(0.2), TOOL, FRAME, ZERO)
    over = path(np.linspace(-60.0, -41.0, 200), 0.0, -2.5)
    into = path(np.linspace(-41.0, 0.0, 400), 0.0, -2.5)
    up = path(0.0, 0.0, np.linspace(-2.5, 5.0, 100))
    down = path(20.0, 20.0, np.linspace(5.0, -1.0, 100))
    motion = np.concatenate([over, into, up, down])
    line = np.repeat([7, 7, 8, 9], [200, 400, 100, 100])
    rapid = np.repeat([True, True, True, True], [200, 400, 100, 100])
    for first in range(0, len(motion), 150):
        part = slice(first, first + 150)
        cutter.add(samples(motion[part], line[part], start=first * 1e-3), rapid[part])
    events = cutter.result().rapid_into_stock
    assert [event.line for event in events] == [7, 9]
    assert events[0].depth_mm == pytest.approx(2.5)
    assert events[1].depth_mm == pytest.approx(1.0)
    assert 0.14 < events[0].time_s < 0.24
    assert events[0].position[0] == pytest.approx(-43.0, abs=2.0)


def test_a_feed_that_ends_in_the_rapid_is_no_collision(samples: Motion) -> None:
    cutter = Cutter(plate(0.05), TOOL, FRAME, ZERO)
    feed = path(np.linspace(-20.0, 0.0, 500), 0.0, -5.0)
    rest = path(np.minimum(np.linspace(0.0, 1.0, 300), 0.15), 0.0, np.linspace(-5.0, 30.0, 300))
    cutter.add(samples(feed, 1), np.zeros(500, np.bool_))
    before = cutter.result().removed_mm3
    cutter.add(samples(rest, 2, start=0.5), np.ones(300, np.bool_))
    assert cutter.result().removed_mm3 > before
    assert cutter.result().rapid_into_stock == ()


def bore_twice() -> FloatArray:
    """Down a hole, up, and in rapid down the same hole again, some micrometres beside it."""
    down, up = np.linspace(2.0, -6.0, 300), np.linspace(-6.0, 2.0, 300)
    return np.concatenate(
        [path(3.0, 1.0, down), path(3.0, 1.0, up), path(3.004, 1.002, np.linspace(2.0, -5.9, 300))]
    )


@pytest.mark.parametrize("cell", [0.05, 0.2, 0.5])
def test_a_rapid_down_a_bored_hole_brushes_its_wall_and_is_no_collision(
    samples: Motion, cell: float
) -> None:
    motion = bore_twice()
    cutter = Cutter(plate(cell), TOOL, FRAME, ZERO, halts=True)
    cutter.add(samples(motion), np.repeat([False, True, True], 300))
    assert cutter.halted is None
    assert cutter.result().rapid_into_stock == ()


def test_a_feed_with_the_spindle_off_is_noted_where_it_meets_material(samples: Motion) -> None:
    cutter = Cutter(plate(0.2), TOOL, FRAME, ZERO)
    motion = path(np.linspace(-60.0, 60.0, 1200), 0.0, -2.5)
    off = np.zeros(1200, np.bool_)
    cutter.add(samples(motion, 3), off, off)
    assert cutter.result().spindle_off == ()
    motion = path(np.linspace(60.0, -60.0, 1200), 12.0, -2.5)
    cutter.add(samples(motion, 8, start=2.0), off, ~off)
    (event,) = cutter.result().spindle_off
    assert (event.line, event.what) == (8, "standing")
    assert event.depth_mm == pytest.approx(2.5)
    assert event.position[0] == pytest.approx(43.0, abs=2.0)
    assert event in cutter.events()


@pytest.mark.parametrize("size", [37, 150, 2000])
def test_a_cutter_that_halts_leaves_the_part_as_it_was_at_that_moment(
    samples: Motion, size: int
) -> None:
    feed = path(np.linspace(-60.0, 0.0, 600), 0.0, -2.5)
    rapid = path(np.linspace(0.0, 60.0, 200), 0.0, -2.5)
    motion = np.concatenate([feed, rapid])
    fast = np.arange(800) >= 600
    cutter = Cutter(plate(0.2), TOOL, FRAME, ZERO, halts=True, keep_marks=True)
    for first in range(0, 800, size):
        here = slice(first, first + size)
        cutter.add(samples(motion[here], 1, start=first * 1e-3), fast[here])
    event = cutter.halted
    assert event is not None
    assert 0.6 < event.time_s < 0.62
    assert cutter.result().rapid_into_stock == (event,)
    same = Cutter(plate(0.2), TOOL, FRAME, ZERO)
    until = round(event.time_s / 1e-3) + 1
    same.add(samples(motion[:until]), fast[:until])
    assert np.array_equal(cutter.map.heights, same.map.heights)
    assert cutter.result().removed_mm3 == pytest.approx(same.result().removed_mm3, rel=1e-4)
    uncut = cutter.map.heights == cutter.map.top
    assert not cutter.marks[uncut].any()


def test_cut_deeper_than_the_flutes_is_a_gouge(samples: Motion) -> None:
    cutter = Cutter(plate(0.2), TOOL, FRAME, ZERO)
    motion = path(np.linspace(-20.0, 20.0, 500), 0.0, np.linspace(-7.0, -9.0, 500))
    cutter.add(samples(motion, 4), np.zeros(500, np.bool_))
    (gouge,) = cutter.result().gouges
    assert gouge.line == 4
    assert gouge.depth_mm == pytest.approx(1.0, abs=0.01)
    assert cutter.result().as_json()["gouges"][0]["line"] == 4


def test_grid_follows_the_tool_and_refuses_what_memory_cannot_hold() -> None:
    assert Cutter(PLATE, TOOL, FRAME, ZERO).map.cell == pytest.approx(0.3)
    small = ToolTable(number=1, diameter=0.5)
    assert Cutter(PLATE, small, FRAME, ZERO).map.cell == 0.1
    with pytest.raises(ConfigError, match=r"stock\.cell = 0\.001 .* 80000 x 60000"):
        Cutter(plate(0.001), TOOL, FRAME, ZERO)


@pytest.mark.parametrize("pitch", [0.4, 0.6, 1.0])
@pytest.mark.parametrize("shift", [0.0, 0.25, 0.5])
def test_a_ridge_between_ball_passes_reads_low_by_its_slope_over_half_a_cell_at_most(
    samples: Motion, pitch: float, shift: float
) -> None:
    """h = R - sqrt(R² - s²/4); e off the ridge it is R - sqrt(R² - (s/2 - e)²), less by s e/(2 R) and a little."""
    cell, radius = 0.1, 3.0
    ball = ToolTable(number=1, kind="ball", diameter=2 * radius, flute=8.0)
    cutter = Cutter(PLATE.model_copy(update={"cell": cell}), ball, FRAME, ZERO)
    across = shift * cell + pitch * np.arange(-3, 4)
    for y in across:
        motion = path(np.linspace(-10.0, 10.0, 200), y, -1.0)
        cutter.add(samples(motion), np.zeros(200, np.bool_))
        lift = path(np.linspace(10.0, -10.0, 200), y, 5.0)
        cutter.add(samples(lift), np.zeros(200, np.bool_))
    column = int(np.argmin(np.abs(cutter.map.x)))
    within = np.abs(cutter.map.y - across[3]) <= pitch
    read = float(cutter.map.heights[within, column].max()) + 1.0
    exact = radius - math.sqrt(radius**2 - pitch**2 / 4)
    most = exact - (radius - math.sqrt(radius**2 - (pitch / 2 - cell / 2) ** 2))
    assert most == pytest.approx(pitch * cell / (4 * radius), rel=0.26)
    assert exact - most - 1e-9 <= read <= exact + 1e-9


@pytest.mark.parametrize("diameter", [6.0, 8.0, 10.0, 12.0])
@pytest.mark.parametrize("size", [100.0, 100.4, 101.0])
def test_a_slot_along_the_grid_takes_no_row_too_many(
    samples: Motion, diameter: float, size: float
) -> None:
    """At its default cell its sides go through the middles of cells, or between them."""
    stock = StockTable(shape="box", size=(size, size, 20.0))
    cutter = Cutter(stock, ToolTable(number=1, diameter=diameter), FRAME, np.zeros(3))
    way = np.linspace([-80.0, 0.0, -3.0, 0.0], [80.0, 0.0, -3.0, 0.0], 400)
    cutter.add(samples(way), np.zeros(400, np.bool_))
    assert cutter.result().removed_mm3 == pytest.approx(3.0 * diameter * size, rel=3e-3)


@pytest.mark.parametrize("diameter", [3.0, 8.0, 20.0])
@pytest.mark.parametrize("turn", [0.0, 17.0, 45.0])
@pytest.mark.parametrize("off", [0.0, 0.5, 0.71])
def test_a_slot_is_as_exact_along_the_grid_as_across_it(
    samples: Motion, diameter: float, turn: float, off: float
) -> None:
    """At its default cell, and by a machine that is 2 µm off its way."""
    stock = StockTable(shape="box", size=(150.0, 140.0, 20.0))
    cutter = Cutter(stock, ToolTable(number=1, diameter=diameter), FRAME, np.zeros(3))
    cell = cutter.material.cell
    along = 30.0 * np.array([math.cos(math.radians(turn)), math.sin(math.radians(turn))])
    way = np.linspace(off * cell - along, off * cell + along, 3000)
    way += np.random.default_rng(1).uniform(-2e-3, 2e-3, way.shape)
    cutter.add(samples(path(way[:, 0], way[:, 1], -3.0)), np.zeros(len(way), np.bool_))
    exact = 3.0 * (60.0 * diameter + math.pi * diameter**2 / 4)
    assert cutter.result().removed_mm3 == pytest.approx(exact, rel=2e-3)


@pytest.mark.parametrize("slice_of", [30, 500])
def test_turns_below_each_other_share_their_walls(samples: Motion, slice_of: int) -> None:
    turns = np.linspace(0.0, 4.0, 4189)
    angle = 2.0 * np.pi * turns
    motion = path(10.0 * np.cos(angle), 10.0 * np.sin(angle), -2.0 * turns)
    cutter = Cutter(plate(0.4), ToolTable(number=1, diameter=8.0, flute=10.0), FRAME, ZERO)
    removed = 0.0
    for begin in range(0, len(motion) - 1, slice_of):
        part = motion[begin : begin + slice_of + 1]
        removed += cutter.add(samples(part, start=begin * 1e-3), np.zeros(len(part), np.bool_))

    # A place is as deep as the tool was when its rim left it, or 8 mm where it covers it in the end.
    radius = np.linspace(6.0, 14.0, 20_001)
    covers = np.arccos(np.minimum((radius**2 + 84.0) / (20.0 * radius), 1.0))
    left = 2.0 * (np.pi - covers)
    around = 8.0 * 2.0 * covers + (6.0 + (np.pi + covers) / np.pi) * left
    assert removed == pytest.approx(np.trapezoid(around * radius, radius), rel=1e-3)


def test_what_the_machine_is_off_its_path_is_no_chip(samples: Motion) -> None:
    angle = np.linspace(0.0, 4.0 * np.pi, 6001)
    radius = 20.0 + np.where(angle > 2.0 * np.pi, 6e-3 * np.sin(3.0 * angle), 0.0)
    motion = path(radius * np.cos(angle), radius * np.sin(angle), -1.0)
    wanted = path(20.0 * np.cos(angle), 20.0 * np.sin(angle), -1.0)
    cutter = Cutter(plate(0.4), ToolTable(number=1, diameter=10.0, flute=10.0), FRAME, ZERO)
    for begin in range(0, 6000, 500):
        part = slice(begin, begin + 501)
        moved = samples(motion[part], start=begin * 1e-3, commanded=wanted[part])
        cutter.add(moved, np.zeros(len(moved), np.bool_))
    assert cutter.result().air_share == pytest.approx(0.5, abs=0.01)


@pytest.mark.parametrize("tilts", [False, True])
@pytest.mark.parametrize("kind", ["flat", "ball"])
def test_a_finishing_pass_of_a_hundredth_is_no_air(samples: Motion, kind: str, tilts: bool) -> None:
    """By a machine that is 1 µm off its path; the same pass again is air."""
    frame = PartFrame(rotary=None, center=(0.0, 0.0))
    tool = ToolTable.model_validate({"number": 1, "kind": kind, "diameter": 6.0})
    cutter = Cutter(plate(0.4), tool, frame, np.zeros(3), tilts=tilts)
    x, air = np.linspace(-60.0, 60.0, 3000), []
    for n, y in enumerate((20.0, 20.01, 20.01)):
        wanted = path(x * (-1.0) ** n, y, -3.0)[:, :3]
        way = wanted + np.array([0.0, 1e-3 * math.sin(n), 0.0])
        before = cutter.result().air_share * n
        cutter.add(samples(way, n + 1, n * 3.0, wanted), np.zeros(len(way), np.bool_))
        air.append(cutter.result().air_share * (n + 1) - before)
    rough, finishing, again = air
    assert rough == pytest.approx(1.0 - 86.0 / 120.0, abs=0.03)
    assert finishing == pytest.approx(1.0 - 80.0 / 120.0, abs=0.02)
    assert again == pytest.approx(1.0, abs=1e-3)


@pytest.mark.parametrize("diameter", [2.0, 8.0, 20.0])
@pytest.mark.parametrize("turn", [0.0, 17.0, 45.0])
@pytest.mark.parametrize(("share", "off"), [(1.0, 0.075), (0.25, 0.18)])
def test_what_a_stretch_takes_off_is_known_however_short_it_is(
    diameter: float, turn: float, share: float, off: float
) -> None:
    """In a slot, in steps of a share of the default cell."""
    stock = StockTable(shape="box", size=(100.0, 100.0, 20.0))
    tool = ToolTable(number=1, diameter=diameter, flute=20.0)
    cell = default_cell((tool,), stock)
    material = HeightMapMaterial(blank(stock, np.zeros(3), cell))
    step, ahead = (
        share * cell,
        np.array([math.cos(math.radians(turn)), math.sin(math.radians(turn))]),
    )
    along = step * np.arange(40)[:, None] * ahead + [0.0, 0.13]
    way = Points(np.column_stack([along, np.full(40, -3.0)]), np.tile([1.0, 0.0], (40, 1)))
    found = material.take_off(way, tool, profile(tool), np.zeros(39), stood=False)
    assert found.volume[1:] == pytest.approx(np.full(38, 3.0 * step * diameter), rel=off)
    assert found.depth[1:] == pytest.approx(np.full(38, 3.0), abs=2e-3)


@pytest.mark.parametrize("diameter", [6.0, 8.0, 12.0])
@pytest.mark.parametrize("width", [0.1, 1.0, 2.64])
def test_a_shoulder_is_as_wide_as_it_is_cut(samples: Motion, diameter: float, width: float) -> None:
    """Less than a cell wide, or no multiple of one, along a side that does not end with a cell."""
    stock = StockTable(shape="box", size=(100.0, 100.0, 20.0))
    cutter = Cutter(stock, ToolTable(number=1, diameter=diameter), FRAME, np.zeros(3))
    y, blank = 50.0 - width + 0.5 * diameter, cutter.map.volume
    for depth in (2.0, 5.0):
        way = path(np.linspace(-70.0, 70.0, 3000), y, -depth)
        cutter.add(samples(way), np.zeros(len(way), np.bool_))
    removed = cutter.result().removed_mm3
    assert removed == pytest.approx(100.0 * width * 5.0, rel=4e-3)
    assert blank - cutter.map.volume == pytest.approx(removed, rel=1e-4)
