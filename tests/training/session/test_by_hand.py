"""Axes driven by hand: jog, handwheel, reference point, back to the path; one way after the other."""

import numpy as np
import pytest

from tests.training.session.commanding import do, refused
from twin.training.scene.scene_file import read_scene, scene_path
from twin.training.session.session import SceneSession

MOST_SLICES = 4000
WRITTEN = 1e-6
"""To what a jog's block is written [mm]."""


@pytest.fixture
def session() -> SceneSession:
    """A machine in manual jog."""
    made = SceneSession(read_scene(scene_path("fagor_first_steps")))
    do(made, "mode", mode="jog")
    return made


def rest(session: SceneSession) -> None:
    """Until nothing runs and nothing moves."""
    for _ in range(MOST_SLICES):
        session.advance()
        if session.room.slot.run is None and not session.room.machine.moving:
            return
    raise AssertionError("the axes never came to rest")


def held(session: SceneSession) -> None:
    """A program that was held in its cut and may be left by jogging."""
    do(session, "mode", mode="auto")
    do(session, "cycle_start")
    while session.room.line < 5:
        session.advance()
    do(session, "feed_hold")
    while session.room.machine.moving:
        session.advance()
    do(session, "mode", mode="jog")


@pytest.mark.seconds("axes are driven to their reference points in turn")
def test_between_the_ways_to_the_reference_point_nothing_else_begins(session):
    do(session, "jog", axis="X", direction=1, step=20.0)
    rest(session)
    do(session, "reference")
    while session.room.manual.moves:
        assert session.room.slot.running == "jog"
        for what, given in (
            ("cycle_start", {}),
            ("mode", {"mode": "auto"}),
            ("set_zero", {"axis": "X"}),
            ("jog", {"axis": "Y", "direction": 1}),
            ("handwheel", {"axis": "Y", "clicks": 1, "step": 0.1}),
            ("change_tool", {"number": 1}),
        ):
            assert refused(session, what, **given)
        session.advance()
    assert session.room.machine.position == pytest.approx(np.zeros(4), abs=1e-3)


def test_a_hold_ends_what_is_driven_by_hand(session):
    do(session, "reference")
    session.advance(5)
    do(session, "feed_hold")
    rest(session)
    assert not session.room.manual.moves
    assert abs(session.room.machine.position).max() > 1.0
    assert not session.room.slot.held


def test_a_held_program_keeps_its_tool_its_blank_and_its_line(session):
    held(session)
    assert session.room.slot.suspended is not None
    assert session.snapshot().line == 5
    do(session, "spindle", on=False)
    assert "while something runs" in refused(session, "change_tool", number=1)
    assert "while something runs" in refused(session, "new_blank")
    do(session, "jog", axis="Z", direction=1, step=2.0)
    assert session.snapshot().line == 5


def test_every_click_of_the_handwheel_counts(session):
    before = session.room.standing_setpoint[0]
    for clicks in (1, 1, 1, 7, -3, 1, 1, 1):
        do(session, "handwheel", axis="X", clicks=clicks, step=0.001)
    rest(session)
    assert session.room.standing_setpoint[0] == pytest.approx(before + 0.010, abs=WRITTEN)


def test_a_handwheel_that_is_turned_back_turns_the_axis_back_at_once(session):
    before = session.room.standing_setpoint[0]
    do(session, "handwheel", axis="X", clicks=50, step=1.0)
    session.advance(30)
    there = session.room.standing_setpoint[0]
    assert there - before > 5.0
    do(session, "handwheel", axis="X", clicks=-50, step=1.0)
    farthest = there
    for _ in range(MOST_SLICES):
        session.advance()
        farthest = max(farthest, session.room.standing_setpoint[0])
        if session.room.slot.run is None:
            break
    assert farthest - there < 2.0
    assert session.room.standing_setpoint[0] == pytest.approx(before, abs=WRITTEN)


def test_a_handwheel_beyond_the_travel_comes_back_with_the_first_click(session):
    do(session, "jog", axis="X", direction=1, feed=30000)
    rest(session)
    end = session.room.standing_setpoint[0]
    do(session, "handwheel", axis="X", clicks=30, step=1.0)
    do(session, "handwheel", axis="X", clicks=-1, step=0.1)
    rest(session)
    assert session.room.standing_setpoint[0] == pytest.approx(end - 0.1, abs=WRITTEN)


def test_a_jog_that_is_refused_leaves_the_drives_of_an_axis_on_its_switch_off():
    session = SceneSession(read_scene(scene_path("fagor_overtravel")))
    do(session, "mode", mode="jog")
    for given in ({"axis": "X", "direction": 1}, {"axis": "Y", "direction": 1}):
        assert refused(session, "jog", **given)
        assert session.room.machine.alarm is not None


def test_a_reset_stops_a_way_off_the_switch_and_leaves_the_alarm():
    session = SceneSession(read_scene(scene_path("fagor_overtravel")))
    do(session, "mode", mode="jog")
    do(session, "jog", axis="X", direction=-1)
    session.advance(5)
    do(session, "reset")
    rest(session)
    assert session.room.alarm is not None
    assert not session.room.manual.moves
