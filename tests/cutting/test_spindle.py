"""Whether the spindle turns, move by move."""

import numpy as np
import pytest

from twin.cutting.spindle import Spindle, speaks_of_spindle
from twin.motion.setpoints.setpoints import Setpoints
from twin.nc.canonical import Axes, Chunk, Dwell, Event, Function, Moves

AXES = Axes(("X", "Y", "Z"), ("linear", "linear", "linear"))


def chunk(moves: int, *events: Event) -> Chunk:
    """So many moves that nothing looks into, and events."""
    one = np.zeros(moves)
    three = np.zeros((moves, 3))
    code, number = np.zeros(moves, np.uint8), np.zeros(moves, np.int64)
    columns = Moves(
        AXES, code, code, number, number, three, three, three, one, code, one, three, three,
        one, one, code, one, one, one,
    )  # fmt: skip
    return Chunk(columns, events)


def standing(spindle: Spindle, *places: tuple[int, float]) -> list[bool]:
    move, fraction = np.array(places).T
    none = np.zeros((len(move), 3))
    points = Setpoints(
        move * 1.0, move.astype(np.int64), move.astype(np.int64), fraction, none, none, none
    )
    return spindle.standing(points).tolist()


def function(before: int, word: str, at: float = 0.0, **arguments: float) -> Function:
    return Function(before, 1, word, arguments, at)


@pytest.mark.parametrize(
    ("word", "speaks"), [("M3", True), ("M5", True), ("S", True), ("M19", True), ("M8", False)]
)
def test_which_words_speak_of_it(word: str, speaks: bool):
    assert speaks_of_spindle(chunk(1, Dwell(0, 1, 1.0), function(0, word))) == speaks


def test_a_program_that_never_speaks_of_it_runs_with_it_turning():
    spindle = Spindle(held_to_program=False)
    spindle.expect(chunk(3, function(0, "M5")))
    assert standing(spindle, (-1, 0.0), (0, 0.0), (2, 1.0)) == [False, False, False]


def test_it_stands_until_it_is_started_and_from_when_it_is_stopped():
    spindle = Spindle(held_to_program=True)
    spindle.expect(chunk(3, function(1, "M3", S=500.0)))
    spindle.expect(chunk(3, function(1, "M5"), function(2, "M4")))
    places = [(-1, 0.0), (0, 0.0), (0, 1.0), (1, 0.0), (3, 1.0), (4, 0.0), (4, 1.0), (5, 0.5)]
    assert standing(spindle, *places) == [True, True, True, False, False, True, True, False]


def test_a_switch_point_counts_from_where_it_lies_in_its_move():
    spindle = Spindle(held_to_program=True)
    spindle.expect(chunk(2, function(0, "M3"), function(1, "M5", at=0.4)))
    assert standing(spindle, (0, 0.0), (1, 0.0), (1, 0.39), (1, 0.41)) == [
        False,
        False,
        False,
        True,
    ]


def test_a_speed_alone_starts_nothing_and_a_speed_of_zero_stops():
    spindle = Spindle(held_to_program=True)
    spindle.expect(chunk(4, function(0, "S", S=800.0), function(1, "M3"), function(2, "S", S=0.0)))
    spindle.expect(chunk(1, function(0, "S", S=100.0)))
    places = [(0, 0.5), (1, 0.5), (2, 0.5), (3, 0.5), (4, 0.5)]
    assert standing(spindle, *places) == [True, False, True, True, False]
