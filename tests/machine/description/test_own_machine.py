"""A machine of one's own: other letters, two rotary axes, a quill, none of the twin's materials."""

import re
from pathlib import Path

import numpy as np
import pytest
from command_line import Twin

from tests.machine.machine_fixtures import line
from twin.errors import ConfigError, UsageError
from twin.machine.check import check_machine
from twin.machine.circle.circular_test import circular_test
from twin.machine.description.kinematics import in_words
from twin.machine.load import read_machine
from twin.machine.model.model import MachineModel, build_spec
from twin.machine.simulation.simulate import simulate

MODEL = """\
<mujoco model="five">
  <compiler angle="degree" autolimits="true"/>
  <worldbody>
    <body name="bed">
      <geom type="box" size=".5 .5 .05"/>
      <body name="cross">
        <inertial pos="0 0 0" mass="100" diaginertia="1 1 1"/>
        <joint name="jx" type="slide" axis="-1 0 0"/>
        <body name="table">
          <inertial pos="0 0 0" mass="80" diaginertia="1 1 1"/>
          <joint name="jy" type="slide" axis="0 -1 0"/>
          <body name="swing">
            <inertial pos="0 0 0" mass="30" diaginertia="1 1 1"/>
            <joint name="ja" type="hinge" axis="-1 0 0"/>
            <body name="rotary_table" pos="0 0 .1">
              <inertial pos="0 0 0" mass="10" diaginertia=".1 .1 .1"/>
              <joint name="jb" type="hinge" axis="0 0 -1"/>
              <geom name="plate" type="cylinder" size=".1 .01" group="3" contype="2" conaffinity="5" mass="0"/>
              <site name="table_top"/>
            </body>
          </body>
        </body>
      </body>
      <body name="head" pos="0 0 .8" gravcomp="1">
        <inertial pos="0 0 0" mass="50" diaginertia="1 1 1"/>
        <joint name="jz" type="slide" axis="0 0 1"/>
        <body name="quill" gravcomp="1">
          <inertial pos="0 0 0" mass="5" diaginertia=".1 .1 .1"/>
          <joint name="jw" type="slide" axis="0 0 1"/>
          <geom name="nose" type="cylinder" size=".05 .05" pos="0 0 .05" group="3" contype="1" conaffinity="6" mass="0"/>
          <site name="spindle_nose"/>
        </body>
      </body>
    </body>
  </worldbody>
  <actuator>
    <motor name="X" joint="jx"/>
    <motor name="Y" joint="jy"/>
    <motor name="Z" joint="jz"/>
    <motor name="A" joint="ja"/>
    <motor name="B" joint="jb"/>
    <motor name="W" joint="jw"/>
  </actuator>
</mujoco>
"""
AXES = {
    "X": ("jx", "linear", "travel = [-200.0, 200.0]"),
    "Y": ("jy", "linear", "travel = [-200.0, 200.0]"),
    "Z": ("jz", "linear", "travel = [-300.0, 0.0]"),
    "A": ("ja", "rotary", "travel = [-100.0, 100.0]"),
    "B": ("jb", "rotary", "periodic = true"),
    "W": ("jw", "linear", "travel = [-100.0, 0.0]"),
}
FILE = "".join(
    [
        'schema = 1\nname = "five"\nmodel = "five.xml"\n',
        *(
            f'[axes.{name}]\njoint = "{joint}"\nkind = "{kind}"\n{more}\nvelocity = 100.0\n'
            "acceleration = 1000.0\njerk = 10000.0\nkv = 5.0\n"
            for name, (joint, kind, more) in AXES.items()
        ),
        '[path]\nacceleration = 1000.0\njerk = 10000.0\n[table]\naxis = "B"\n',
    ]
)


def written(
    folder: Path, old: str = "", new: str = "", *, model: tuple[str, str] = ("", "")
) -> Path:
    """The machine in a folder, with a change of its file or of its model."""
    assert old in FILE
    assert model[0] in MODEL
    (folder / "five.xml").write_text(MODEL.replace(*model, 1) if model[0] else MODEL)
    path = folder / "five.toml"
    path.write_text(FILE.replace(old, new, 1) if old else FILE)
    return path


def test_it_is_read_and_every_axis_follows(tmp_path):
    machine = read_machine(written(tmp_path))
    assert machine.axes.names == ("X", "Y", "Z", "A", "B", "W")
    words = in_words(machine.axes.names, machine.kinematics)
    assert words == "the part turns on B, B on A, A on Y, Y on X; the tool moves in W and Z"
    for axis in range(6):
        points = line(axis, -20.0, 1.0, k=6)
        (samples,) = simulate(machine, MachineModel(machine), [points])
        lag = (samples.setpoint.position - samples.joint_position)[-1]
        assert lag[axis] == pytest.approx(-20.0 / (5000 / 60), rel=0.03)
        assert np.abs(np.delete(lag, axis)).max() < 1e-3


@pytest.mark.parametrize("plane", ["XY", "ZX", "YZ", "XYC"])
def test_its_circles_are_round(tmp_path, plane):
    result = circular_test(read_machine(written(tmp_path)), 20.0, 600.0, plane)
    assert result.circular_deviation_um < 0.01
    assert result.hysteresis_um < 0.01


def test_a_program_that_moves_an_axis_that_it_lacks_is_refused_with_those_it_has(
    twin: Twin, tmp_path: Path
):
    path = written(tmp_path)
    program = tmp_path / "a.nc"
    program.write_text("%A\nN10 G90 G17\nN20 G01 A10 C30 W-20 F500\nN30 M30\n")
    done = twin(
        "run", program, "--machine", path, "--dialect", "fagor8070", "--out", tmp_path / "o"
    )
    assert done.code == 3
    assert "a.nc:3:13: error no-such-axis: this machine has no axis C" in done.stderr
    assert "axes: X, Y, Z, A, B, W" in done.stderr


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("velocity = 100.0", "velocty = 100.0", "did you mean 'velocity'?"),
        ("[path]", "[pth]", "unknown key 'pth'; did you mean 'path'?"),
        ("kv = 5.0", "kv = nan", "'axes.X.kv': Input should be a finite number"),
        ("kv = 5.0", 'kv = "5"', "'axes.X.kv': a number is written without quotes: 5 (got '5')"),
        ("kv = 5.0", "kv = 1e9", "kv up to 600 works"),
        ("schema = 1", "schema = 1\nservo_period_s = 1e-9", "greater than or equal to 0.0001"),
        ("schema = 1", "schema = 1\nservo_period_s = 10", "less than or equal to 0.02"),
        ("schema = 1", "schema = 2", "'schema': Input should be 1 (got 2)"),
        ('joint = "jw"', 'joint = "jz"', "joint 'jz' is named twice"),
        ('joint = "jw"', 'joint = "ju"', "no joint 'ju'; it has jx, jy, ja, jb, jz, jw"),
        ('kind = "rotary"', 'kind = "linear"', "joint 'ja' does not move as axis A"),
        ("periodic = true", "periodic = true\ntravel = [0.0, 9.0]", "periodic, that is endless"),
        ('axis = "B"', 'axis = "W"', "table.axis 'W' is not rotary"),
        ("five.xml", "none.xml", "model 'none.xml' does not exist"),
        ("five.xml", ".", "model '.' does not exist"),
        ("[table]", "[path]\njerk = 1.0\n[table]", "is not TOML"),
    ],
)  # fmt: skip
def test_a_wrong_file_is_refused_with_place_and_hint(tmp_path, old, new, message):
    with pytest.raises(UsageError, match=re.escape(message)) as raised:
        build_spec(read_machine(written(tmp_path, old, new)))
    assert "five." in str(raised.value)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ('<site name="table_top"/>', "", "has no site 'table_top'; it has spindle_nose"),
        ('mass="5"', 'mass="0"', "mass and inertia of moving bodies"),
        ('type="box"', 'type="mesh" mesh="cast"', "mesh 'cast' not found"),
        ("<worldbody>", '<asset><mesh name="c" file="c.stl"/></asset><worldbody>', "c.stl'"),
        ('name="plate"', 'name="tool_nut"', "repeated name 'tool_nut'"),
        ("</mujoco>", "", "is not an MJCF model"),
        (MODEL, "", "is not an MJCF model"),
    ],
)  # fmt: skip
def test_a_wrong_model_is_refused_with_what_it_lacks(tmp_path, old, new, message):
    with pytest.raises(ConfigError, match=re.escape(message)) as raised:
        build_spec(read_machine(written(tmp_path, model=(old, new))))
    assert "five.xml" in str(raised.value)


@pytest.mark.parametrize(
    ("old", "new", "fault"),
    [
        ('<joint name="jw"', '<joint name="jv" type="slide" axis="1 0 0"/><joint name="jw"', "joint 'jv' belongs to no"),
        ('<motor name="W"', '<motor name="V" joint="jw"/><motor name="W"', "actuator 'V' belongs to no"),
        ("<worldbody>", '<worldbody><geom name="holder\'s nut" size="1"/>', "repeated name"),
    ],
)  # fmt: skip
def test_the_check_finds_what_would_run_all_the_same(tmp_path, old, new, fault):
    findings = check_machine(read_machine(written(tmp_path, model=(old, new))))
    assert fault in " ".join(text for finding in findings for text in finding.faults)


def test_a_home_outside_the_travel_is_no_hard_limit(tmp_path):
    path = written(tmp_path, "travel = [-200.0, 200.0]", "travel = [50.0, 200.0]")
    kept = {finding.point for finding in check_machine(read_machine(path)) if not finding.faults}
    assert "the machine holds still at home" in kept


@pytest.mark.parametrize("wrong", ["kv = 1e-9", "kv = 5.0\ndry_friction = 1e7"])
def test_axes_that_do_not_follow_draw_no_circle(tmp_path, wrong):
    machine = read_machine(written(tmp_path, "kv = 5.0", wrong))
    with pytest.raises(UsageError, match="degrees of the circle and no more"):
        circular_test(machine, 20.0, 1000.0)
