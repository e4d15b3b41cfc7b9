"""Where offset paths meet: the tool touches both elements of the contour there, on its side."""

import math

import pytest
from examples import examples
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from twin.nc.dialects.linuxcnc.offset_paths import (
    QUARTER,
    OffsetArc,
    along,
    arc_meets_arc,
    arc_meets_line,
    line_meets_arc,
)
from twin.nc.geometry.arcs import Point, distance

_RADII = st.floats(5.0, 50.0)
_ANGLES = st.floats(0.0, 2.0 * math.pi)
_TOOLS = st.floats(0.1, 4.0)
_START: Point = (3.0, -7.0)


def _arc_at_start(radius: float, towards: float, tool: float, inside: bool, ccw: bool) -> OffsetArc:
    """The tool's path beside an arc through ``_START``, whose centre lies in a direction from there."""
    center = along(_START, towards, radius)
    return OffsetArc(center, radius - tool if inside else radius + tool, inside, ccw)


def _aside(point: Point, heading: float) -> float:
    """How far left of a line through ``_START`` a point lies."""
    x, y = point[0] - _START[0], point[1] - _START[1]
    return math.cos(heading) * y - math.sin(heading) * x


@settings(max_examples=examples(200))
@given(_RADII, _ANGLES, _ANGLES, _TOOLS, st.booleans(), st.booleans())
def test_behind_an_arc_the_tool_touches_the_line(
    radius: float, towards: float, heading: float, tool: float, inside: bool, ccw: bool
) -> None:
    arc = _arc_at_start(radius, towards, tool, inside, ccw)
    try:
        meeting = arc_meets_line(arc, tool, _START, heading)
    except ValueError:
        assume(False)
        return
    side = 1.0 if inside == ccw else -1.0
    assert distance(meeting, arc.center) == pytest.approx(arc.radius, abs=1e-9)
    assert _aside(meeting, heading) == pytest.approx(side * tool, abs=1e-9)


@settings(max_examples=examples(200))
@given(_RADII, _ANGLES, _ANGLES, _TOOLS, st.booleans(), st.booleans())
def test_behind_a_line_the_tool_touches_the_arc(
    radius: float, towards: float, before: float, tool: float, inside: bool, ccw: bool
) -> None:
    arc = _arc_at_start(radius, towards, tool, inside, ccw)
    side = 1.0 if inside == ccw else -1.0
    heading = towards - QUARTER if ccw else towards + QUARTER
    try:
        meeting = line_meets_arc(before, side * (before - heading), arc, tool, radius)
    except ValueError:
        assume(False)
        return
    assert distance(meeting, arc.center) == pytest.approx(arc.radius, abs=1e-9)
    assert _aside(meeting, before) == pytest.approx(side * tool, abs=1e-9)


@settings(max_examples=examples(100))
@given(_RADII, _RADII, _ANGLES, _ANGLES, _TOOLS, st.booleans(), st.booleans())
def test_between_two_arcs_the_tool_touches_both(
    one: float, other: float, to_one: float, to_other: float, tool: float, inside: bool, ccw: bool
) -> None:
    first = _arc_at_start(one, to_one, tool, inside, ccw)
    second = _arc_at_start(other, to_other, tool, inside, ccw)
    try:
        meeting = arc_meets_arc(first, second)
    except ValueError:
        assume(False)
        return
    assert distance(meeting, first.center) == pytest.approx(first.radius, abs=1e-6)
    assert distance(meeting, second.center) == pytest.approx(second.radius, abs=1e-6)


def test_arcs_that_lie_too_far_from_each_other_do_not_meet() -> None:
    first = OffsetArc((0.0, 0.0), 5.0, inside=True, counter_clockwise=True)
    with pytest.raises(ValueError, match="does not fit"):
        arc_meets_arc(first, first._replace(center=(11.0, 0.0)))
    with pytest.raises(ValueError, match="same centre"):
        arc_meets_arc(first, first)
