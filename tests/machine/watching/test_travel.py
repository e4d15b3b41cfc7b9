import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.machine.machine_fixtures import shipped_machine
from twin.machine.watching.travel import move_bounds, soft_limit_alarm
from twin.nc.canonical import Axes, Motion, Moves, Shape

AXES = Axes(("X", "Y", "Z", "C"), ("linear", "linear", "linear", "rotary"))
NORMALS = {"G17": (0.0, 0.0, 1.0), "G18": (0.0, 1.0, 0.0), "G19": (1.0, 0.0, 0.0)}


def move(start, end, *, line=1, center=None, normal=None, sweep=0.0) -> Moves:
    arc = center is not None
    nowhere = (np.nan, np.nan, np.nan)
    start, end = np.array([start], float), np.array([end], float)
    return Moves(
        AXES,
        motion=np.array([Motion.FEED], np.uint8),
        shape=np.array([Shape.ARC if arc else Shape.LINE], np.uint8),
        line=np.array([line]),
        block=np.array([-1]),
        start=start,
        end=end,
        display=end,
        feed=np.array([1000.0]),
        feed_unit=np.array([0], np.uint8),
        length=np.array([1.0]),
        center=np.array([center or nowhere], float),
        normal=np.array([normal or nowhere], float),
        radius=np.array([np.linalg.norm(start[0, :3] - center) if center else np.nan]),
        sweep=np.array([sweep]),
        corner=np.zeros(1, np.uint8),
        corner_tolerance=np.array([np.nan]),
        acceleration=np.array([np.nan]),
        deceleration=np.array([np.nan]),
    )


def arc(center, normal, arm, sweep, advance) -> tuple[Moves, np.ndarray]:
    """An arc, and many points of it by Rodrigues' formula."""
    center, normal, arm = (np.asarray(v, float) for v in (center, normal, arm))
    share = np.linspace(0.0, 1.0, 20001)[:, None]
    angle = np.deg2rad(sweep) * share
    points = (
        center
        + np.cos(angle) * arm
        + np.sin(angle) * np.cross(normal, arm)
        + share * advance * normal
    )
    one = move(
        [*points[0], 0.0],
        [*points[-1], 90.0],
        center=tuple(center),
        normal=tuple(normal),
        sweep=sweep,
    )
    return one, points


@given(
    plane=st.sampled_from(sorted(NORMALS)),
    radius=st.floats(0.5, 200.0),
    begin=st.floats(0.0, 360.0),
    sweep=st.floats(0.5, 2000.0),
    clockwise=st.booleans(),
    advance=st.floats(-300.0, 300.0),
)
@settings(max_examples=80, deadline=None, derandomize=True)
def test_bounds_of_arcs_and_helices_agree_with_many_points(
    plane, radius, begin, sweep, clockwise, advance
):
    normal = np.array(NORMALS[plane])
    first = np.roll(normal, 1)
    turn = np.deg2rad(begin)
    arm = radius * (np.cos(turn) * first + np.sin(turn) * np.cross(normal, first))
    one, points = arc((10.0, -20.0, 30.0), normal, arm, -sweep if clockwise else sweep, advance)
    low, high = move_bounds(one)
    coarse = radius * (np.deg2rad(sweep) / 20000) ** 2 + 1e-9
    assert low[0, :3] == pytest.approx(points.min(axis=0), abs=coarse)
    assert high[0, :3] == pytest.approx(points.max(axis=0), abs=coarse)
    assert (low[0, 3], high[0, 3]) == (0.0, 90.0)


def test_a_tilted_helix_agrees_with_many_points():
    normal = np.array([1.0, 2.0, 2.0]) / 3.0
    arm = 30.0 * np.array([2.0, 1.0, -2.0]) / 3.0
    one, points = arc((0.0, 0.0, 0.0), normal, arm, 700.0, 90.0)
    low, high = move_bounds(one)
    assert low[0, :3] == pytest.approx(points.min(axis=0), abs=1e-4)
    assert high[0, :3] == pytest.approx(points.max(axis=0), abs=1e-4)


def test_the_first_move_that_leaves_the_travel_is_named():
    machine = shipped_machine()
    inside = move([0, 0, 0, 0], [100, 0, 0, 0], line=1)
    outside = move([100, 0, 0, 0], [100, 310, -600, 0], line=7)
    zero = np.array([0.0, 0.0, -20.0, 0.0])
    assert soft_limit_alarm(machine, inside, zero) is None
    alarm = soft_limit_alarm(machine, outside, zero)
    assert alarm is not None
    assert (alarm.code, alarm.line, alarm.time_s, alarm.axis) == ("soft-limit", 7, 0.0, "Z")
    assert "-620.000 mm" in alarm.message
    assert "-550 to 0" in alarm.message


def test_an_arc_whose_ends_lie_inside_may_still_leave():
    machine = shipped_machine()
    half, _ = arc((350.0, 0.0, -10.0), (0.0, 0.0, 1.0), (0.0, -60.0, 0.0), 180.0, 0.0)
    alarm = soft_limit_alarm(machine, half, np.zeros(4))
    assert alarm is not None
    assert alarm.axis == "X"
    assert "410.000 mm" in alarm.message
    other_way, _ = arc((350.0, 0.0, -10.0), (0.0, 0.0, 1.0), (0.0, -60.0, 0.0), -180.0, 0.0)
    assert soft_limit_alarm(machine, other_way, np.zeros(4)) is None


@pytest.mark.parametrize(("x", "fits"), [(400.0, True), (400.0 + 1e-7, True), (400.001, False)])
def test_the_limit_itself_belongs_to_the_travel(x, fits):
    alarm = soft_limit_alarm(shipped_machine(), move([0] * 4, [x, 0, 0, 0]), np.zeros(4))
    assert (alarm is None) == fits


def test_an_endless_axis_has_no_limit_and_no_moves_no_alarm():
    machine = shipped_machine()
    assert soft_limit_alarm(machine, move([0] * 4, [0, 0, 0, 1e6]), np.zeros(4)) is None
    assert soft_limit_alarm(machine, Moves.empty(AXES), np.zeros(4)) is None


def test_an_arc_of_no_sweep_is_its_point():
    one, _ = arc((10.0, 0.0, 0.0), (0.0, 0.0, 1.0), (5.0, 0.0, 0.0), 0.0, 0.0)
    low, high = move_bounds(one)
    assert low[0, :3].tolist() == high[0, :3].tolist() == [15.0, 0.0, 0.0]
