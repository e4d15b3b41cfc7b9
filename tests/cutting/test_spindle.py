"""Whether the spindle turns, move by move."""

import numpy as np
import pytest

from twin.cutting.program_summary import SummaryBuilder
from twin.job.job_file import JobFile
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


def stands(chunks: list[Chunk], *places: tuple[int, float]) -> list[bool]:
    builder = SummaryBuilder(JobFile(program="p.nc"))
    for each in chunks:
        builder.add(each)
    move, fraction = np.array(places).T
    none = np.zeros((len(move), 3))
    points = Setpoints(
        move * 1.0, move.astype(np.int64), move.astype(np.int64), fraction, none, none, none
    )
    return builder.summary().standing(points).tolist()


def function(before: int, word: str, at: float = 0.0, **arguments: float) -> Function:
    return Function(before, 1, word, arguments, at)


@pytest.mark.parametrize(
    ("word", "speaks"), [("M3", True), ("M5", True), ("S", True), ("M19", True), ("M8", False)]
)
def test_a_program_that_speaks_of_it_is_held_to_it_from_the_first_move_on(word: str, speaks: bool):
    speed = {"S": 100.0} if word == "S" else {}
    found = chunk(1, Dwell(0, 1, 1.0), function(1, word, **speed))
    assert stands([found], (0, 0.5)) == [speaks]


def test_a_program_that_never_speaks_of_it_runs_with_it_turning():
    assert stands([chunk(3)], (-1, 0.0), (0, 0.0), (2, 1.0)) == [False, False, False]


def test_it_stands_until_it_is_started_and_from_when_it_is_stopped():
    found = [
        chunk(3, function(1, "M3", S=500.0)),
        chunk(3, function(1, "M5"), function(2, "M4")),
    ]
    places = [(-1, 0.0), (0, 0.0), (0, 1.0), (1, 0.0), (3, 1.0), (4, 0.0), (4, 1.0), (5, 0.5)]
    assert stands(found, *places) == [True, True, True, False, False, True, True, False]


def test_a_switch_point_counts_from_where_it_lies_in_its_move():
    found = [chunk(2, function(0, "M3"), function(1, "M5", at=0.4))]
    places = [(0, 0.0), (1, 0.0), (1, 0.39), (1, 0.41)]
    assert stands(found, *places) == [False, False, False, True]


def test_a_speed_alone_starts_nothing_and_a_speed_of_zero_stops():
    found = [
        chunk(4, function(0, "S", S=800.0), function(1, "M3"), function(2, "S", S=0.0)),
        chunk(1, function(0, "S", S=100.0)),
    ]
    places = [(0, 0.5), (1, 0.5), (2, 0.5), (3, 0.5), (4, 0.5)]
    assert stands(found, *places) == [True, False, True, True, False]
