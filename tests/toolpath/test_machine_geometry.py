"""Errors of geometry against what rigid bodies do, exactly turned and shifted."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from twin.files.shipped import machine_file
from twin.machine.description.config import MachineConfig
from twin.machine.load import read_machine
from twin.toolpath.machine_geometry import geometry_from_text
from twin.toolpath.part_frame import PartFrame

ZERO = np.array([30.0, -20.0, -300.0, 40.0])
place = st.tuples(
    st.floats(-300, 300), st.floats(-250, 250), st.floats(-500, 0), st.floats(-720, 720)
).map(np.array)


def frame_of(**geometry: object) -> PartFrame:
    shipped = read_machine(machine_file("mill4"))
    data = shipped.file.model_dump(by_alias=True) | {"geometry": geometry}
    machine = MachineConfig(shipped.path, type(shipped.file).model_validate(data))
    return machine.part_frame.at(ZERO, 0.0)


def turned(point: np.ndarray, axis: str, angle: float) -> np.ndarray:
    c, s = math.cos(angle), math.sin(angle)
    matrix = {
        "X": [[1, 0, 0], [0, c, -s], [0, s, c]],
        "Y": [[c, 0, s], [0, 1, 0], [-s, 0, c]],
        "Z": [[c, -s, 0], [s, c, 0], [0, 0, 1]],
    }[axis]
    return np.array(matrix) @ point


@given(place)
def test_a_machine_without_errors_has_its_tool_where_its_axes_say(joints: np.ndarray):
    frame = frame_of()
    assert not frame.geometry
    assert frame.real(joints[None]) is not None
    assert np.array_equal(frame.real(joints[None])[0], joints)


@given(place)
def test_nothing_is_off_at_the_part_zero(joints: np.ndarray):
    machine = read_machine(machine_file("mill4/as_built"))
    assert machine.part_frame.at(joints, 0.0).real(joints[None])[0] == pytest.approx(
        joints, abs=1e-9
    )


@given(place)
def test_axes_out_of_square_shear_what_they_draw(joints: np.ndarray):
    frame = frame_of(squareness={"XY": 20.0, "YZ": -30.0, "ZX": 50.0})
    x, y, z, _ = joints - ZERO
    shift = np.array([-20e-6 * y - 50e-6 * z, 30e-6 * z, 0.0, 0.0])
    assert frame.real(joints[None])[0] - joints == pytest.approx(shift, abs=1e-9)
    assert x == x


@given(place)
def test_a_center_that_lies_elsewhere_turns_the_part_about_another_point(joints: np.ndarray):
    offset = np.array([0.015, -0.007, 0.0])
    frame = frame_of(table={"offset_um": (15.0, -7.0)})
    seen = frame.position(frame.real(joints[None]))[0]
    angle = np.deg2rad(joints[3] - ZERO[3])
    assert seen == pytest.approx(turned(joints[:3] - offset, "Z", angle) + offset, abs=1e-9)


@given(place)
def test_a_tilted_table_axis_turns_the_part_about_it(joints: np.ndarray):
    tilt = 20e-6
    frame = frame_of(table={"tilt_um_per_m": (20.0, 0.0)})
    seen = frame.position(frame.real(joints[None]))[0]
    angle = np.deg2rad(joints[3] - ZERO[3])
    height = np.array([0.0, 0.0, ZERO[2]])
    upright = turned(joints[:3] - height, "X", -tilt)
    exact = turned(turned(upright, "Z", angle), "X", tilt) + height
    assert seen == pytest.approx(exact, abs=1e-6)


def test_what_the_control_compensates_is_taken_off():
    table = {"at": (-400.0, 400.0), "um": (-8.0, 8.0)}
    frame = frame_of(errors={"EXX": table}, compensation={"EXX": table})
    joints = np.array([[200.0, 0.0, 0.0, 0.0]])
    assert frame.real(joints) == pytest.approx(joints, abs=1e-12)
    half = {"at": (-400.0, 400.0), "um": (-4.0, 4.0)}
    left = frame_of(errors={"EXX": table}, compensation={"EXX": half})
    assert (left.real(joints) - joints)[0, 0] == pytest.approx(0.004 * 170 / 400)


def test_indexing_repeats_after_a_turn():
    frame = frame_of(
        errors={"ECC": {"at": (0.0, 90.0, 180.0, 270.0), "mdeg": (0.0, 3.0, 0.0, -3.0)}}
    )
    at = np.zeros((3, 4))
    at[:, 3] = [45.0, 405.0, -315.0]
    added = (frame.real(at) - at)[:, 3]
    assert added == pytest.approx(np.full(3, (1.5 - 3.0 * 40 / 90) * 1e-3))


def test_the_shares_add_up_to_what_the_tool_is_off():
    frame = read_machine(machine_file("mill4/as_built")).part_frame.at(ZERO, 0.0)
    joints = np.array([-120.0, 80.0, -420.0, 123.0])
    shares = frame.shares(joints, {})
    assert {"squareness XY", "positioning EXX", "straightness EYX", "indexing ECC"} <= set(shares)
    assert {"run-out EXC", "centre of the table", "tilt of the table"} <= set(shares)
    off = frame.position(frame.real(joints[None]))[0] - frame.position(joints[None])[0]
    assert sum(shares.values()) == pytest.approx(off, abs=1e-6)


def test_a_recording_gives_the_geometry_back():
    geometry = read_machine(machine_file("mill4/as_built")).part_frame.at(ZERO, 0.0).geometry
    assert geometry_from_text(geometry.as_text()) == geometry
    assert geometry_from_text("") == frame_of().geometry.__class__()


@pytest.mark.parametrize(
    ("geometry", "message"),
    [
        ({"errors": {"EXW": {"at": (0.0,), "um": (1.0,)}}}, "'EXW' is no error of these axes"),
        ({"errors": {"EAX": {"at": (0.0,), "um": (1.0,)}}}, "'EAX' is no error of these axes"),
        ({"errors": {"EXX": {"at": (0.0,), "mdeg": (1.0,)}}}, "'EXX' is given in 'um'"),
        ({"errors": {"ECC": {"at": (0.0,), "um": (1.0,)}}}, "'ECC' is given in 'mdeg'"),
        ({"errors": {"EXX": {"at": (0.0,)}}}, "needs either 'um' or 'mdeg'"),
        ({"errors": {"EXX": {"at": (0.0, 0.0), "um": (1.0, 2.0)}}}, "'at' must rise"),
        ({"errors": {"EXX": {"at": (0.0, 1.0), "um": (1.0,)}}}, "2 places in 'at', but 1 errors"),
        ({"errors": {"EXC": {"at": (0.0, 360.0), "um": (1.0, 1.0)}}}, "within 360 degrees"),
    ],
)
def test_what_is_wrong_is_refused(geometry: dict[str, object], message: str):
    with pytest.raises(ValueError, match=message):
        frame_of(**geometry)
