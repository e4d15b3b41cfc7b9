"""Events as columns are the objects that they stand for."""

import math

import numpy as np

from twin.nc.canonical import Dwell, Function
from twin.nc.path.event_columns import (
    AUXILIARY,
    DWELL,
    FUNCTION,
    SPEED,
    TOOL,
    EventRows,
    Events,
)

ROWS = EventRows(
    np.array(
        [
            [0, 1, FUNCTION, 8],
            [0, 2, FUNCTION, 3],
            [1, 3, FUNCTION, 4],
            [1, 4, SPEED, 0],
            [2, 5, TOOL, 0],
            [2, 6, AUXILIARY, 0],
            [3, 7, DWELL, 0],
        ]
    ),
    np.array([math.nan, 900.0, math.nan, 500.0, 7.0, 9.0, 1.5]),
)
OBJECTS = (
    Function(0, 1, "M8", {}),
    Function(0, 2, "M3", {"S": 900.0}),
    Function(1, 3, "M4", {}),
    Function(1, 4, "S", {"S": 500.0}),
    Function(2, 5, "T7", {}),
    Function(2, 6, "H9", {}),
    Dwell(3, 7, 1.5),
)


def test_each_kind_becomes_its_object() -> None:
    assert tuple(ROWS) == OBJECTS
    assert len(ROWS) == len(OBJECTS)


def test_parts_are_joined_in_order() -> None:
    last = Dwell(9, 10, 2.0)
    events = Events([ROWS, [last]])
    assert events == (*OBJECTS, last)
    assert events != OBJECTS
    assert len(events) == 8
    assert events[-1] is last
    assert events[5:] == (OBJECTS[5], OBJECTS[6], last)
    assert not Events([])


def test_columns_that_were_handed_on_change_no_more() -> None:
    rows = EventRows(ROWS.rows.copy(), ROWS.amounts.copy())
    behind = rows.behind(10)
    rows.rows[:] = 0
    rows.amounts[:] = 0.0
    assert [event.before for event in behind] == [10 + event.before for event in OBJECTS]
    assert [event.line for event in behind.part(2, 4)] == [3, 4]
