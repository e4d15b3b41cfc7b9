"""Tool centre point control: the tip of the tool is where the program wants it, at every instant."""

import math
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.five_axes import HEAD_AXES, head_and_table, on_machine, trunnion
from twin.nc.canonical import Corner, Motion
from twin.nc.path.move_columns import Segment
from twin.nc.path.moves import SMALLEST_MOVE
from twin.nc.path.tool_center.tool_center import ToolCenter

NOWHERE = 1e-9
"""[mm]."""

_PLACES = st.floats(-150.0, 150.0)
_ANGLES = st.floats(-110.0, 110.0)
_POSITIONS = st.tuples(_PLACES, _PLACES, _PLACES, _ANGLES, st.floats(-400.0, 400.0)).map(list)
_CENTERS = st.tuples(_PLACES, _PLACES, st.floats(-600.0, -300.0))
_LENGTHS = st.floats(-60.0, 200.0)


@st.composite
def _machines(draw: st.DrawFn) -> ToolCenter:
    make = draw(st.sampled_from((trunnion, head_and_table)))
    chain = make(draw(_CENTERS), draw(_CENTERS))
    zero = (*draw(st.tuples(_PLACES, _PLACES)), -430.0, draw(_ANGLES), draw(_ANGLES))
    return ToolCenter(on_machine(chain, zero), draw(_LENGTHS), [0.0, 0.0, 0.0, 3.0, -7.0])


def _segment(start: list[float], end: list[float], **arc: object) -> Segment:
    return Segment(Motion.FEED, 3, 30, start, end, end, 500.0, Corner.CONTINUOUS, **arc)  # type: ignore[arg-type]


def _axes_along(parts: list[Segment], fractions: np.ndarray) -> list[tuple[float, list[float]]]:
    """Fractions of the whole move, and where the axes are."""
    found = []
    for number, part in enumerate(parts):
        assert part.curve is not None
        for u in fractions:
            powers = u ** np.arange(1, 6)
            place = np.array(part.start) + part.curve.coefficients @ powers
            found.append(((number + u) / len(parts), place.tolist()))
    return found


@given(_machines(), _POSITIONS)
def test_the_tip_and_the_axes_are_inverse(machine: ToolCenter, axes: list[float]) -> None:
    assert machine.axes(machine.tip(axes)) == pytest.approx(axes, abs=1e-9)


@settings(max_examples=30)
@given(_machines(), _POSITIONS, _POSITIONS)
def test_the_tip_goes_straight(machine: ToolCenter, start: list[float], end: list[float]) -> None:
    parts = list(machine.moves_of(_segment(start, end)))
    if parts[0].curve is None:
        assert start[3:] == end[3:]
        return
    for share, axes in _axes_along(parts, np.linspace(0.0, 1.0, 6)):
        expected = np.array(start) + share * (np.array(end) - np.array(start))
        assert np.abs(np.array(machine.tip(axes)) - expected).max() < NOWHERE
    assert parts[0].start == pytest.approx(machine.axes(start), abs=NOWHERE)
    assert parts[-1].end == pytest.approx(machine.axes(end), abs=NOWHERE)
    way = math.dist(start[:3], end[:3])
    # The control makes no move of the tip that is shorter.
    wanted = way if way >= SMALLEST_MOVE else math.dist(start[3:], end[3:])
    lengths = [part.curve.length for part in parts if part.curve]
    assert sum(lengths) == pytest.approx(wanted) or 0.0 < way < SMALLEST_MOVE


@settings(max_examples=12)
@given(_machines(), _POSITIONS, st.floats(-720.0, 720.0), st.floats(1.0, 80.0), _ANGLES, _ANGLES)
def test_the_tip_goes_on_its_arc(
    machine: ToolCenter, start: list[float], sweep: float, radius: float, a: float, c: float
) -> None:
    center = (start[0] - radius, start[1], start[2])
    turn = math.radians(sweep)
    end = [
        center[0] + radius * math.cos(turn),
        center[1] + radius * math.sin(turn),
        start[2] + 4.0,
        a,
        c,
    ]
    move = _segment(start, end, center=center, normal=(0.0, 0.0, 1.0), sweep=sweep)
    parts = list(machine.moves_of(move))
    if parts[0].curve is None:
        return
    for share, axes in _axes_along(parts, np.linspace(0.0, 1.0, 4)):
        at = turn * share
        expected = (
            center[0] + radius * math.cos(at),
            center[1] + radius * math.sin(at),
            start[2] + 4.0 * share,
        )
        assert np.abs(np.array(machine.tip(axes)[:3]) - expected).max() < NOWHERE


def test_parts_join_without_a_step_of_slope_or_curvature() -> None:
    machine = ToolCenter(on_machine(trunnion()), 8.0, [0.0] * 5)
    start, end = [10.0, 20.0, 5.0, -40.0, 0.0], [60.0, -10.0, -3.0, 50.0, 200.0]
    parts = list(machine.moves_of(_segment(start, end)))
    assert len(parts) > 50
    for before, after in pairwise(parts):
        assert before.curve is not None
        assert after.curve is not None
        assert before.end == after.start
        slope = before.curve.coefficients @ np.arange(1, 6)
        bend = before.curve.coefficients @ (np.arange(1, 6) * np.arange(0, 5))
        assert np.abs(slope - after.curve.coefficients[:, 0]).max() < NOWHERE
        assert np.abs(bend - 2.0 * after.curve.coefficients[:, 1]).max() < NOWHERE
        assert before.corner is Corner.EXACT_PATH
    assert parts[-1].corner is Corner.CONTINUOUS


def test_with_rotary_axes_at_rest_a_line_stays_a_line_and_an_arc_an_arc() -> None:
    machine = ToolCenter(on_machine(trunnion()), 8.0, [0.0] * 5)
    start = [10.0, 0.0, 0.0, 30.0, 45.0]
    arc = _segment(start, [-10.0, 0.0, 2.0, 30.0, 45.0], center=(0.0, 0.0, 0.0), normal=(0.0, 0.0, 1.0), sweep=180.0)  # fmt: skip
    (part,) = machine.moves_of(arc)
    assert part.curve is None
    assert part.center is not None
    assert math.dist(part.center, part.start[:3]) == pytest.approx(10.0)
    assert machine.tip([*part.center, 30.0, 45.0])[:3] == pytest.approx((0.0, 0.0, 0.0), abs=1e-9)
    (line,) = machine.moves_of(_segment(start, [0.0, 30.0, 4.0, 30.0, 45.0]))
    assert machine.tip(line.end) == pytest.approx([0.0, 30.0, 4.0, 30.0, 45.0], abs=1e-9)


def test_a_turn_with_the_tip_at_rest_counts_degrees() -> None:
    machine = ToolCenter(on_machine(head_and_table()), 0.0, [0.0] * 5)
    here = [10.0, 20.0, 5.0, 0.0, 0.0]
    parts = list(machine.moves_of(_segment(here, [*here[:3], 30.0, 40.0])))
    assert all(part.curve is not None and part.curve.turning for part in parts)
    assert sum(part.curve.length for part in parts if part.curve) == pytest.approx(50.0)
    assert HEAD_AXES.names[3] == "B"


def test_a_tilted_tool_moves_no_rotary_axis() -> None:
    machine = ToolCenter(on_machine(trunnion()), 0.0, [0.0] * 5, tilted=True)
    with pytest.raises(ValueError, match="tilted plane"):
        list(machine.moves_of(_segment([0.0] * 5, [1.0, 0.0, 0.0, 5.0, 0.0])))


def test_a_work_offset_turns_the_frame_of_the_part_with_it() -> None:
    offset = [0.0, 0.0, 0.0, 0.0, 30.0]
    machine = ToolCenter(on_machine(trunnion()), 0.0, offset)
    at_zero = machine.tip([12.0, 7.0, 3.0, 0.0, 30.0])
    assert at_zero[:3] == pytest.approx((12.0, 7.0, 3.0))


def test_the_arc_of_a_part_is_told_from_the_tip() -> None:
    machine = ToolCenter(on_machine(trunnion()), 0.0, [0.0, 0.0, 0.0, 0.0, 30.0])
    arc = _segment([10.0, 0.0, 0.0, 0.0, 0.0], [-10.0, 0.0, 0.0, 20.0, 0.0], center=(0.0, 0.0, 0.0), normal=(0.0, 0.0, 1.0), sweep=180.0)  # fmt: skip
    first = next(iter(machine.moves_of(arc)))
    # Seen from the part at its own zero, 30 degrees before that of the work offset.
    assert first.center is not None
    turned = (-10.0 * math.cos(math.radians(30.0)), -10.0 * math.sin(math.radians(30.0)), 0.0)
    assert first.center == pytest.approx(turned, abs=1e-9)
