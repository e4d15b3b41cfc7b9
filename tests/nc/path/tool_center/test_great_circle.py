"""The direction of the tool interpolated as a vector: closed forms, random machines, and the pole."""

import math
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from tests.five_axes import head_and_table, on_machine, trunnion
from twin.kinematics import Kinematics
from twin.nc.canonical import FloatArray, Motion
from twin.nc.geometry.planes import Vector
from twin.nc.path.move_columns import Segment
from twin.nc.path.tool_center.great_circle import POLE
from twin.nc.path.tool_center.tip_curves import DIRECTION_ERROR
from twin.nc.path.tool_center.tool_center import ToolCenter

NOWHERE = 1e-9
"""[mm]."""

_PLACES = st.floats(-80.0, 80.0)
_TILTS, _TURNS = st.floats(-110.0, 110.0), st.floats(-400.0, 400.0)
_POSITIONS = st.tuples(_PLACES, _PLACES, _PLACES, _TILTS, _TURNS).map(list)
_ZERO = (15.0, 20.0, -430.0, 0.0, 0.0)


def _nutating(chain: Kinematics, lean: float) -> Kinematics:
    """The machine with its axis next to the tool leaning in its own plane."""
    axis = chain.axis.copy()
    first = int(np.flatnonzero(chain.rotary)[0])
    axis[first] = axis[first] * math.cos(lean) + np.array([0.0, 0.0, math.sin(lean)])
    return chain._replace(axis=axis)


@st.composite
def _machines(draw: st.DrawFn) -> ToolCenter:
    chain = draw(st.sampled_from((trunnion(), head_and_table())))
    lean = draw(st.sampled_from((0.0, 0.0, 0.3, -0.6)))
    return _machine(_nutating(chain, lean), draw(st.floats(-60.0, 200.0)))


def _machine(
    chain: Kinematics, longer: float = 8.0, tilt: tuple[float, float] = (-120.0, 120.0)
) -> ToolCenter:
    setup = on_machine(chain, _ZERO)
    travel = setup.travel.copy()
    travel[3] = tilt
    return ToolCenter(setup._replace(travel=travel), longer, [0.0] * 5)


def _parts(
    machine: ToolCenter,
    start: list[float],
    end: list[float],
    center: Vector | None = None,
    sweep: float = 0.0,
) -> list[Segment]:
    """The curves of a line, or of an arc about Z, that ends where the axes come to."""
    move = Segment(
        Motion.FEED, 3, 30, start, machine.reached(start, end), end, 500.0, in_plane=True
    )
    if center is not None:
        move.center, move.normal, move.sweep = center, (0.0, 0.0, 1.0), sweep
    return list(machine.moves_of(move))


def _places(part: Segment, fractions: FloatArray) -> FloatArray:
    assert part.curve is not None
    powers = fractions[:, None] ** np.arange(1, 6)
    return np.array(part.start) + powers @ part.curve.coefficients.T


def _directions(machine: ToolCenter, rows: FloatArray) -> FloatArray:
    return np.array([machine.direction(row.tolist()) for row in rows])


@settings(max_examples=15)
@given(_machines(), _POSITIONS, _POSITIONS)
def test_the_direction_turns_evenly_in_the_plane_of_both_ends(
    machine: ToolCenter, start: list[float], end: list[float]
) -> None:
    first, last = machine.direction(start), machine.direction(end)
    across = np.cross(first, last)
    angle = math.atan2(float(np.linalg.norm(across)), float(first @ last))
    assume(1e-3 < angle < math.pi - 1e-3)
    axis = across / np.linalg.norm(across)
    try:
        parts = _parts(machine, start, end)
    except ValueError:
        # The travel ends, or a leaning axis reaches no further.
        assume(False)
        return
    run = 0.0
    for part in parts:
        assert part.curve is not None
        if part.start[:3] != part.end[:3] and not part.curve.turning:
            fractions = np.array([0.1, 0.4, 0.9])
            rows = _places(part, fractions)
            share = (run + fractions * part.curve.length) / math.dist(start[:3], end[:3])
            turned = np.cos(share * angle)[:, None] * first + np.sin(share * angle)[
                :, None
            ] * np.cross(axis, first)
            assert np.abs(_directions(machine, rows) - turned).max() < 2.0 * POLE
            assert np.abs(_directions(machine, rows) @ axis).max() < 2.0 * POLE
            tips = np.array([machine.tip(row.tolist())[:3] for row in rows])
            straight = np.array(start[:3]) + share[:, None] * (np.array(end[:3]) - start[:3])
            assert np.abs(tips - straight).max() < NOWHERE
            run += part.curve.length
    at_pole = math.hypot(last[0], last[1]) < POLE
    assert np.abs(machine.direction(parts[-1].end) - last).max() < (POLE if at_pole else 1e-9)
    assert run == pytest.approx(math.dist(start[:3], end[:3]))


def test_a_circle_off_the_pole_keeps_its_bound_and_joins_smoothly() -> None:
    machine = _machine(trunnion())
    start, end = [10.0, 20.0, 5.0, 30.0, 0.0], [60.0, -10.0, -3.0, 40.0, 150.0]
    parts = _parts(machine, start, end)
    axis = np.cross(machine.direction(start), machine.direction(end))
    axis /= np.linalg.norm(axis)
    for part in parts:
        off = _directions(machine, _places(part, np.linspace(0.0, 1.0, 7))) @ axis
        assert np.abs(off).max() < DIRECTION_ERROR
    for before, after in pairwise(parts):
        assert before.end == after.start
        assert before.curve is not None
        assert after.curve is not None
        slopes = before.curve.coefficients @ np.arange(1, 6) / before.curve.length
        assert np.abs(slopes - after.curve.coefficients[:, 0] / after.curve.length).max() < 1e-8


def test_through_the_pole_the_tilt_goes_on_and_the_table_rests() -> None:
    machine = _machine(trunnion())
    start = [0.0, 0.0, 0.0, 30.0, 20.0]
    # The same direction as -25 and 20.
    parts = _parts(machine, start, [10.0, 0.0, 0.0, 25.0, 200.0])
    assert parts[-1].end[3:] == pytest.approx([-25.0, 20.0])
    assert not any(part.curve is not None and part.curve.turning for part in parts)


def test_where_the_tilt_cannot_go_on_the_table_turns_at_the_pole() -> None:
    machine = _machine(trunnion(), tilt=(-5.0, 120.0))
    parts = _parts(machine, [0.0, 0.0, 0.0, 30.0, 20.0], [11.0, 0.0, 0.0, 25.0, 200.0])
    # By a half turn either way.
    assert parts[-1].end[3:] == pytest.approx([25.0, -160.0])
    turns = [part for part in parts if part.curve is not None and part.curve.turning]
    assert sum(part.curve.length for part in turns if part.curve) == pytest.approx(180.0)
    # 30 of the 55 degrees lie before the pole; the tip rests there.
    for part in turns:
        assert machine.tip(part.start)[:3] == pytest.approx((6.0, 0.0, 0.0), abs=1e-9)


def test_from_the_pole_the_table_turns_first() -> None:
    machine = _machine(head_and_table())
    parts = _parts(machine, [0.0, 0.0, 0.0, 0.0, 0.0], [10.0, 0.0, 0.0, 30.0, 70.0])
    assert parts[0].curve is not None
    assert parts[0].curve.turning
    assert parts[-1].end[3:] == pytest.approx([30.0, 70.0])
    led = [part for part in parts if part.curve is not None and not part.curve.turning]
    assert {
        round(row[4], 9) for part in led for row in _places(part, np.array([0.0, 0.5, 1.0]))
    } == {70.0}


@pytest.mark.parametrize("aside", [0.6 * POLE, 2.2 * POLE, 1e-4, 1e-2])
def test_next_to_the_pole_the_table_turns_as_fast_as_the_circle_asks(aside: float) -> None:
    machine = _machine(trunnion())
    start = [0.0, 0.0, 0.0, 20.0, 0.0]
    end = [10.0, 0.0, 0.0, 20.0, 180.0 - math.degrees(aside) / math.sin(math.radians(20.0))]
    parts = _parts(machine, start, end)
    axis = np.cross(machine.direction(start), machine.direction(end))
    axis /= np.linalg.norm(axis)
    rows = np.concatenate([_places(part, np.linspace(0.0, 1.0, 5)) for part in parts])
    meets = abs(axis[2]) < POLE
    assert meets == (aside < POLE)
    assert np.abs(_directions(machine, rows) @ axis).max() < (POLE if meets else DIRECTION_ERROR)
    assert np.ptp(rows[:, 4]) == pytest.approx(0.0 if meets else end[4], abs=1e-2)
    assert len(parts) < 2_000


def test_opposite_directions_name_no_plane() -> None:
    machine = _machine(trunnion(), tilt=(-200.0, 200.0))
    with pytest.raises(ValueError, match="opposite"):
        machine.reached([0.0] * 5, [1.0, 0.0, 0.0, 180.0, 0.0])


def test_what_does_not_turn_the_tool_turns_no_axis() -> None:
    machine = _machine(trunnion())
    start = [0.0, 0.0, 0.0, 30.0, 20.0]
    assert machine.reached(start, [5.0, 0.0, 0.0, -30.0, 200.0]) == [5.0, 0.0, 0.0, 30.0, 20.0]
    assert machine.reached([0.0] * 5, [5.0, 0.0, 0.0, 0.0, 90.0]) == [5.0, 0.0, 0.0, 0.0, 90.0]


def test_on_an_arc_the_tip_keeps_it_and_the_direction_its_plane() -> None:
    machine = _machine(head_and_table())
    start, end = [10.0, 0.0, 0.0, 20.0, 10.0], [-10.0, 0.0, 4.0, 50.0, 100.0]
    parts = _parts(machine, start, end, (0.0, 0.0, 0.0), 180.0)
    axis = np.cross(machine.direction(start), machine.direction(end))
    for part in parts:
        rows = _places(part, np.linspace(0.0, 1.0, 4))
        tips = np.array([machine.tip(row.tolist())[:3] for row in rows])
        assert np.abs(np.hypot(tips[:, 0], tips[:, 1]) - 10.0).max() < NOWHERE
        assert np.abs(_directions(machine, rows) @ axis).max() < DIRECTION_ERROR


def test_a_single_axis_across_the_tool_turns_it_in_a_plane_anyway_and_no_other_does() -> None:
    chain, end = trunnion(), [0.0, 0.0, 0.0, 10.0, 0.0]
    fields = ("column", "rotary", "on_tool", "axis", "anchor")
    one = chain._replace(**{field: getattr(chain, field)[:-1] for field in fields})
    assert _machine(one).reached([0.0] * 5, end) == end
    with pytest.raises(ValueError, match="two rotary axes"):
        _machine(_nutating(one, 0.3)).reached([0.0] * 5, end)
