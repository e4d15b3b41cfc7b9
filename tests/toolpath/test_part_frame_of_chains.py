"""The part's frame of any chain, and the path in it, against the closed form and against differences."""

import numpy as np
import pytest
from examples import examples
from hypothesis import given, settings
from hypothesis import strategies as st
from test_nearest import PART_ZERO, any_move, line, move_position, moves_of

from twin.kinematics import Kinematics
from twin.nc.canonical import FloatArray, Moves
from twin.toolpath.nearest import path_columns
from twin.toolpath.nearest_kernels import nearest_on_move
from twin.toolpath.part_frame import PartFrame, chain_from_text
from twin.toolpath.place_kernels import PathKind, derivatives

X, Y, Z = np.eye(3)
coordinate = st.floats(-500.0, 500.0)


def chain(axis: FloatArray, anchor: FloatArray, *, on_tool: bool) -> Kinematics:
    """X and Y under the part, Z at the tool, and a fourth joint next to the tool or to the part."""
    order = [3, 2, 1, 0] if on_tool else [2, 1, 0, 3]
    rows = np.array([X, Y, Z, axis / np.linalg.norm(axis)])
    column, anchors = np.array(order), np.zeros((4, 3))
    anchors[3] = anchor
    tool_side = (column == 2) | ((column == 3) & on_tool)
    table = np.array([0.0, 0.0, -300.0])
    return Kinematics(
        column, column == 3, tool_side, rows[order], anchors[order], Z, table, np.eye(3)
    )


FRAMES = [
    PartFrame(None, (0.0, 0.0), chain=chain(X, np.array([0.0, 7.0, -120.0]), on_tool=False)),
    PartFrame(None, (0.0, 0.0), chain=chain(Y + Z, np.array([3.0, 7.0, 90.0]), on_tool=True)),
    PartFrame(None, (0.0, 0.0), chain=chain(X + Y - Z, np.array([3.0, 7.0, 90.0]), on_tool=False)),
]


@settings(derandomize=True)
@given(*[coordinate] * 4, st.floats(-360.0, 360.0), st.tuples(coordinate, coordinate))
def test_a_table_about_z_is_the_chain_that_it_is(x, y, z, c, zero, center):
    joints, part_zero = np.array([[x, y, z, c]]), np.array([10.0, -20.0, 30.0, zero])
    closed = PartFrame(3, center).at(part_zero, 50.0)
    whole = chain(Z, np.array([*center, -40.0]), on_tool=False)
    frame = PartFrame(None, (0.0, 0.0), chain=whole).at(part_zero, 50.0)
    # The one counts X and Y from the axis, the other from machine zero.
    away = np.array([*center, 0.0])
    np.testing.assert_allclose(frame.position(joints), closed.position(joints) + away, atol=1e-9)
    lower = frame.position(joints, 12.0) - frame.position(joints)
    np.testing.assert_allclose(lower, [[0.0, 0.0, -12.0]], atol=1e-9)
    np.testing.assert_allclose(frame.direction(joints), closed.direction(joints), atol=1e-12)
    np.testing.assert_allclose(
        frame.program_zero(part_zero), closed.program_zero(part_zero) + away, atol=1e-9
    )
    assert not frame.tilts(joints)


def test_a_table_along_x_turns_the_part_under_the_tool():
    """Seen from the part a positive A carries the tool from above to its front: about X, from Z to -Y."""
    table = chain(X, np.array([0.0, 0.0, -200.0]), on_tool=False)
    frame = PartFrame(None, (0.0, 0.0), chain=table).at(np.array([5.0, 0.0, -150.0, 0.0]), 50.0)
    # The axis lies 50 mm above the tip of the first tool at Z-200, that is at Z-150 of its coordinates.
    above = np.array([[5.0, 0.0, -130.0, 90.0]])
    np.testing.assert_allclose(frame.position(above), [[5.0, -20.0, -150.0]], atol=1e-9)
    np.testing.assert_allclose(frame.tool_direction(above), [[0.0, -1.0, 0.0]], atol=1e-12)
    assert frame.tilts(above)
    # A tool that is 10 mm longer reaches so much deeper, towards the axis.
    np.testing.assert_allclose(frame.position(above, 10.0), [[5.0, -10.0, -150.0]], atol=1e-9)


@pytest.mark.parametrize("frame", FRAMES)
def test_the_part_lies_as_the_machine_where_its_zero_is(frame):
    zero = np.array([10.0, -20.0, 30.0, 77.0])
    there = frame.at(zero, 60.0)
    joints = zero + np.array([[0.0, 0.0, 0.0, 0.0], [5.0, 6.0, 7.0, 0.0]])
    moved = np.diff(there.position(joints), axis=0)[0]
    np.testing.assert_allclose(moved, [5.0, 6.0, 7.0], atol=1e-9)


@pytest.mark.parametrize("frame", FRAMES)
def test_a_frame_is_read_as_it_was_written(frame):
    there = frame.at(np.array([10.0, -20.0, 30.0, 77.0]), 60.0)
    found, zero = chain_from_text(there.as_text())
    joints = np.array([[1.0, 2.0, 3.0, 40.0]])
    again = PartFrame(None, (0.0, 0.0), chain=found, zero=zero)
    np.testing.assert_array_equal(again.position(joints), there.position(joints))
    assert PartFrame(3, (0.0, 0.0)).as_text() == ""


@pytest.mark.parametrize("frame", FRAMES)
@settings(max_examples=examples(50), derandomize=True, deadline=None)
@given(moves=any_move(), u=st.floats(0.01, 0.99))
def test_derivatives_in_any_chain_agree_with_differences(frame: PartFrame, moves: Moves, u: float):
    there = frame.at(PART_ZERO, 60.0)
    path = path_columns(moves, there, PART_ZERO, 15.0)
    values = np.array(derivatives(path, 0, u)).reshape(3, 3)
    step = 1e-4
    joints = move_position(moves, 0, u + step * np.array([-1, 0, 1])) + PART_ZERO
    around = there.position(joints, 15.0)
    scale = 1.0 + np.abs(values).max()
    assert values[0] == pytest.approx(around[1], abs=1e-9)
    assert values[1] == pytest.approx((around[2] - around[0]) / (2 * step), abs=2e-5 * scale)
    second = (around[0] - 2 * around[1] + around[2]) / step**2
    assert values[2] == pytest.approx(second, abs=1e-3 * scale)


@pytest.mark.parametrize("frame", FRAMES)
@settings(max_examples=examples(30), derandomize=True, deadline=None)
@given(moves=any_move(), u=st.floats(0.0, 1.0), aside=st.tuples(*[st.floats(-5.0, 5.0)] * 3))
def test_no_place_of_a_dense_scan_is_nearer(frame: PartFrame, moves: Moves, u: float, aside):
    there = frame.at(PART_ZERO, 60.0)
    path = path_columns(moves, there, PART_ZERO)
    point = there.position(move_position(moves, 0, np.array([u])) + PART_ZERO)[0] + np.array(aside)
    distance, place = nearest_on_move(path, 0, 0.0, 1.0, 0.5, *point)
    scan = there.position(move_position(moves, 0, np.linspace(0.0, 1.0, 4001)) + PART_ZERO)
    assert distance <= np.linalg.norm(scan - point, axis=1).min() + 1e-7
    there_too = there.position(move_position(moves, 0, np.array([place])) + PART_ZERO)[0]
    assert np.linalg.norm(there_too - point) == pytest.approx(distance, abs=1e-7)


def test_what_a_chain_turns_is_told_apart():
    moves = moves_of(line(np.zeros(4), np.array([0.0, 0.0, 0.0, 90.0])))
    assert path_columns(moves, FRAMES[0].at(PART_ZERO, 0.0), PART_ZERO).kind.tolist() == [
        PathKind.CHAIN
    ]
