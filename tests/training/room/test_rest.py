"""A machine that is left alone: its clock goes on, and nothing is computed until something is asked for."""

import pytest

from twin.training.room.room import SLICE
from twin.training.scene.scene_file import read_scene, scene_path
from twin.training.session.session import SceneSession


@pytest.fixture
def session():
    return SceneSession(read_scene(scene_path("fagor_first_steps")))


def test_what_rests_is_not_stepped_and_is_awake_with_the_next_command(session, monkeypatch):
    room = session.room
    session.advance(200)
    assert room.rest.lasts
    steps: list[int] = []
    hold = room.machine.hold
    monkeypatch.setattr(room.machine, "hold", lambda ticks: steps.append(ticks) or hold(ticks))
    tick = room.tick
    session.advance(500)
    assert (steps, room.tick) == ([], tick + 500 * SLICE)
    assert not session.submit({"do": "feed_hold"})
    session.advance(1)
    assert not steps
    session.submit({"do": "override", "dial": "feed", "percent": 50})
    session.advance(1)
    assert steps == [SLICE]


@pytest.mark.seconds("some seconds of a program")
def test_a_spindle_that_turns_and_a_program_that_is_held_do_not_rest(session):
    session.submit({"do": "cycle_start"})
    session.advance(300)
    session.submit({"do": "feed_hold"})
    session.advance(300)
    assert session.room.slot.held
    assert not session.room.rest.lasts
    session.submit({"do": "reset"})
    session.advance(300)
    assert session.room.rest.lasts
    session.submit({"do": "spindle", "on": True, "speed": 1000.0})
    session.advance(300)
    assert not session.room.rest.lasts
