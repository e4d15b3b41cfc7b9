"""The edge finder: it finds the sides of the part, gives way, lights, and breaks where it is pushed too far."""

import math

import numpy as np
import pytest

from twin.cutting.heights.height_map import blank
from twin.job.job_file import StockTable
from twin.training.room.setup.edge_finder import OVERTRAVEL_MM, TIP_MM, EdgeFinder, edge_finder
from twin.training.room.setup.touch import CONTACT_MM, Touch, touch
from twin.training.scene.scene_file import read_scene, scene_path
from twin.training.session.session import SceneSession

BLOCK = StockTable(shape="box", size=(40.0, 30.0, 20.0), cell=0.2)
ROUND = StockTable(shape="cylinder", diameter=40.0, height=20.0, cell=0.2)
BELOW = -5.0


def held(session: SceneSession, **what: object) -> None:
    assert session.submit(what), session.refusal
    room = session.room
    for _ in range(3000):
        session.advance()
        if room.slot.run is None and not room.machine.moving:
            return
    raise AssertionError("the axes never came to rest")


def jog(session: SceneSession, axis: str, way: float, feed: float = 6000.0) -> None:
    direction = 1 if way > 0.0 else -1
    held(session, do="jog", axis=axis, direction=direction, step=abs(way), feed=feed)


def beside_the_part() -> SceneSession:
    """The finder in the spindle, left of the part, 3 mm before it touches, its tip below the top face."""
    session = SceneSession(read_scene(scene_path("gost_part_zero")))
    held(session, do="mode", mode="jog")
    held(session, do="change_tool", number=99)
    jog(session, "X", -68.0)
    tip = session.room.setup.tip[2] - session.room.setup.part_frame.program_zero(session.room.setup.tables.true_zero)[2]  # fmt: skip
    jog(session, "Z", BELOW - float(tip))
    assert not session.snapshot().touches
    return session


@pytest.mark.seconds("a room is stepped")
def test_zero_is_set_by_touching_a_side():
    session = beside_the_part()
    jog(session, "X", 3.0, 300.0)
    seen = session.snapshot()
    assert seen.touches
    assert seen.alarm is None
    held(session, do="set_zero", axis="X", reading=-60.0 - TIP_MM / 2.0)
    tables = session.room.setup.tables
    assert tables.zero[0] == pytest.approx(tables.true_zero[0], abs=CONTACT_MM)


@pytest.mark.seconds("a room is stepped")
def test_it_gives_way_and_breaks_and_a_new_one_is_sound():
    session = beside_the_part()
    jog(session, "X", 4.5, 300.0)
    seen = session.snapshot()
    assert seen.touches
    assert seen.finder == pytest.approx((-1.5, 0.0), abs=0.1)
    jog(session, "X", 5.0, 300.0)
    seen = session.snapshot()
    assert seen.alarm is not None
    assert (seen.alarm.code, seen.alarm.line) == ("tool-broken", 0)
    assert seen.broken is not None
    assert not seen.touches
    assert seen.finder == ()
    assert session.room.setup.work is not None
    assert session.room.setup.work.removed == 0.0
    held(session, do="reset")
    jog(session, "X", -20.0)
    held(session, do="change_tool", number=99)
    seen = session.snapshot()
    assert (seen.broken, seen.alarm, seen.finder) == (None, None, (0.0, 0.0))


@pytest.mark.seconds("a room is stepped")
def test_it_must_stand_when_it_touches():
    session = beside_the_part()
    held(session, do="spindle", on=True, speed=500.0)
    jog(session, "X", 4.0, 300.0)
    alarm = session.snapshot().alarm
    assert alarm is not None
    assert "while the spindle turned" in alarm.message


def test_a_length_is_not_measured_by_another_tool():
    session = SceneSession(read_scene(scene_path("codesys_tool_length")))
    held(session, do="mode", mode="jog")
    held(session, do="change_tool", number=99)
    session.submit({"do": "finish"})
    assert session.room.judge.verdicts[0].state == "failed"


def test_the_finder_takes_the_first_free_number():
    assert edge_finder([1, 2]).number == 99
    assert edge_finder([1, 99, 100]).number == 101


@pytest.mark.parametrize("gap", [-1.0, 0.0, 0.01, 0.5])
@pytest.mark.parametrize("turn", np.linspace(0.0, 2.0 * math.pi, 7))
def test_the_gap_to_a_round_blank_is_that_of_two_circles(gap, turn):
    stock = blank(ROUND, np.zeros(3), 0.2)
    away = 20.0 + TIP_MM / 2.0 + gap
    found = touch(stock, np.array([away * math.cos(turn), away * math.sin(turn), BELOW]), TIP_MM)
    assert found.gap == pytest.approx(gap, abs=1e-9)
    assert found.meets == (gap <= CONTACT_MM)
    if found.meets:
        assert found.away == pytest.approx((math.cos(turn), math.sin(turn)), abs=0.05)


@pytest.mark.parametrize(
    ("place", "gap"),
    [
        ((-25.0, 3.0, -5.0), 0.0),
        ((-25.3, 3.0, -5.0), 0.3),
        ((3.0, 19.0, -5.0), -1.0),
        ((3.0, 3.0, 0.0), 0.0),
        ((3.0, 3.0, -0.7), -0.7),
        ((24.0, 19.0, -5.0), math.hypot(4.0, 4.0) - 5.0),
    ],
)
def test_the_gap_to_a_block(place, gap):
    assert touch(blank(BLOCK, np.zeros(3), 0.2), np.array(place), TIP_MM).gap == pytest.approx(gap)


def test_what_was_cut_off_is_not_met_and_a_cut_wall_is_met_to_half_a_cell():
    stock = blank(BLOCK, np.zeros(3), 0.2)
    stock.heights[:, stock.x < 0.0] = -10.0
    assert not touch(stock, np.array([-24.0, 0.0, BELOW]), TIP_MM).meets
    for gap in (-1.0, 0.0):
        found = touch(stock, np.array([-5.0 - gap, 0.0, BELOW]), TIP_MM)
        assert found.gap == pytest.approx(gap, abs=0.1)
        assert found.away == pytest.approx((-1.0, 0.0), abs=1e-3)
    assert not touch(stock, np.array([-5.3, 0.0, BELOW]), TIP_MM).meets


def test_it_bears_its_overtravel_and_no_more():
    finder = EdgeFinder(99)
    assert not finder.push(Touch(-OVERTRAVEL_MM, (0.0, 1.0)), turns=False)
    assert finder.deflection == (0.0, OVERTRAVEL_MM)
    assert finder.push(Touch(-OVERTRAVEL_MM - 0.01, (0.0, 1.0)), turns=False)
    assert finder.broken
