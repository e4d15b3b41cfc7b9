"""What the words of a program do to the spindle."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from twin.nc.canonical import Function
from twin.nc.functions import SpindleState


def said(word: str, speed: float | None = None) -> Function:
    return Function(0, 1, word, {} if speed is None else {"S": speed})


@pytest.mark.parametrize(
    ("words", "state", "turns"),
    [
        ([], SpindleState(), False),
        ([said("M3")], SpindleState(started=True), True),
        ([said("S", 800.0)], SpindleState(speed=800.0), False),
        (
            [said("S", 800.0), said("M4")],
            SpindleState(started=True, speed=800.0, counter_clockwise=True),
            True,
        ),
        (
            [said("M3", 900.0), said("M5"), said("M3")],
            SpindleState(started=True, speed=900.0),
            True,
        ),
        ([said("M3", 900.0), said("S", 0.0)], SpindleState(started=True, speed=0.0), False),
        ([said("M3", 900.0), said("M19")], SpindleState(speed=900.0), False),
        ([said("M3", 900.0), said("M30")], SpindleState(speed=900.0), False),
        ([said("M3", 900.0), said("M6")], SpindleState(speed=900.0), False),
        ([said("M8")], SpindleState(), False),
    ],
)
def test_words_start_stop_and_set_the_speed(words, state, turns):
    now = SpindleState()
    for word in words:
        now = now.after(word)
    assert now == state
    assert now.turns == turns


@settings(derandomize=True, max_examples=60)
@given(st.lists(st.sampled_from(["M3", "M4", "M5", "M19", "M8", "S"]), max_size=8))
def test_it_turns_when_the_last_word_for_it_was_a_start(words):
    now = SpindleState()
    for word in words:
        now = now.after(said(word, 500.0 if word == "S" else None))
    orders = [word for word in words if word in ("M3", "M4", "M5", "M19")]
    assert now.turns == (bool(orders) and orders[-1] in ("M3", "M4"))
    assert not now.stopped().turns
    assert now.stopped().speed == now.speed


@pytest.mark.parametrize(
    ("given", "turning"),
    [
        ({"has_word": True}, 0.0),
        ({"has_word": False}, None),
        ({"has_word": True, "tool_speed": 4000.0}, -4000.0),
        ({"tool_speed": 4000.0, "speed": 700.0}, -700.0),
        ({"speed": 9000.0, "fastest": 6000.0}, -6000.0),
        ({"tool_speed": 9000.0, "fastest": 6000.0}, -6000.0),
    ],
)
def test_a_start_without_s_and_what_the_machine_limits(given, turning):
    assert SpindleState(**given).after(said("M4")).turning == turning
    assert SpindleState(**given).turning == 0.0


def test_more_than_the_machine_gives_is_told_where_it_is_asked_for():
    spindle = SpindleState(fastest=6000.0)
    assert spindle.limited_by(said("M3", 6000.0)) == spindle.limited_by(said("M5", 7000.0)) == ""
    assert "S7000" in spindle.limited_by(said("S", 7000.0))
    assert SpindleState().limited_by(said("S", 7000.0)) == ""
