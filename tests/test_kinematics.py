"""The chain of joints against homogeneous matrices, on chains that no machine has."""

import math

import numpy as np
from examples import examples
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from twin.kinematics import Kinematics, tool_direction, tool_point, with_rotary_at_rest
from twin.nc.canonical import FloatArray
from twin.toolpath.pose_kernels import tool_poses

number = st.floats(-400.0, 400.0)
angle = st.floats(-400.0, 400.0)
unit = (
    st.tuples(*[st.floats(-1.0, 1.0)] * 3)
    .filter(lambda v: math.hypot(*v) > 0.2)
    .map(lambda v: np.array(v) / math.hypot(*v))
)


@st.composite
def chains(draw: st.DrawFn) -> Kinematics:
    """X, Y, Z and up to three rotary axes in any order and in any direction."""
    turning = draw(st.integers(0, 3))
    column = np.array(draw(st.permutations(range(3 + turning))), np.int64)
    rotary = column >= 3
    axis = np.array(
        [draw(unit) if turns else np.eye(3)[at] for at, turns in zip(column, rotary, strict=True)]
    )
    anchor = np.array([[draw(number) if turns else 0.0 for _ in range(3)] for turns in rotary])
    on_tool = np.arange(len(column)) < draw(st.integers(0, len(column)))
    return Kinematics(column, rotary, on_tool, axis, anchor, draw(unit), np.zeros(3), np.eye(3))  # fmt: skip


def by_matrices(chain: Kinematics, joints: FloatArray) -> FloatArray:
    """Tool to part, shape (4, 4): every joint a matrix, multiplied."""
    found = np.eye(4)
    for column, rotary, axis, anchor in zip(*(chain[at] for at in (0, 1, 3, 4)), strict=True):
        step, value = np.eye(4), joints[column]
        if rotary:
            x, y, z = axis
            cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
            c, s = math.cos(math.radians(value)), math.sin(math.radians(value))
            step[:3, :3] = np.eye(3) + s * cross + (1 - c) * cross @ cross
            step[:3, 3] = anchor - step[:3, :3] @ anchor
        else:
            step[:3, 3] = value * axis
        found = step @ found
    return found


@settings(derandomize=True, max_examples=examples(100), deadline=None)
@given(chains(), st.lists(angle, min_size=6, max_size=6), number)
def test_point_and_direction_are_those_of_the_matrices(chain, values, length):
    joints = np.array(values[: len(chain.column)])
    expected = by_matrices(chain, joints)
    tip = expected @ np.append(-length * chain.tool, 1.0)
    np.testing.assert_allclose(tool_point(chain, joints[None], length)[0], tip[:3], atol=1e-9)
    direction = tool_direction(chain, joints[None])[0]
    np.testing.assert_allclose(direction, expected[:3, :3] @ chain.tool, atol=1e-12)
    poses = tool_poses(chain, joints[None], length)
    np.testing.assert_allclose(poses.tip[0], tip[:3], atol=1e-9)
    np.testing.assert_allclose(poses.along_x[0], expected[:3, 0], atol=1e-12)
    np.testing.assert_allclose(poses.axis[0], expected[:3, :3] @ chain.tool, atol=1e-12)


@settings(derandomize=True, max_examples=examples(100), deadline=None)
@given(chains(), st.lists(angle, min_size=6, max_size=6), st.tuples(number, number, number), number)
def test_linear_axes_bring_the_tip_where_it_is_meant_to_be(chain, values, point, length):
    joints, target = np.array([values[: len(chain.column)]]), np.array([point])
    at_zero, steps = with_rotary_at_rest(chain, joints, length)
    assume(abs(np.linalg.det(steps[0])) > 1e-6)
    solved = joints.copy()
    solved[0, :3] = np.linalg.solve(steps[0], (target - at_zero)[0])
    scale = 1.0 + np.abs(solved).max()
    np.testing.assert_allclose(tool_point(chain, solved, length), target, atol=1e-11 * scale)


def test_a_table_between_two_linear_axes_may_leave_a_direction_short():
    """X beyond a table that turns by 90 degrees is what Y before it was."""
    chain = Kinematics(
        column=np.array([2, 1, 3, 0]),
        rotary=np.array([False, False, True, False]),
        on_tool=np.array([True, False, False, False]),
        axis=np.array([[0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]]),
        anchor=np.zeros((4, 3)),
        tool=np.array([0.0, 0.0, 1.0]),
        table=np.zeros(3),
        table_axes=np.eye(3),
    )
    _, steps = with_rotary_at_rest(chain, np.array([[0.0, 0.0, 0.0, 90.0]]))
    assert abs(np.linalg.det(steps[0])) < 1e-12
