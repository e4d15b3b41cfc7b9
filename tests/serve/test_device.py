"""The chain of joints that a probe tells, against MuJoCo's own bodies."""

import json
import xml.etree.ElementTree as ET

import mujoco
import numpy as np
import pytest

from twin.files.shipped import machine_file, machine_names
from twin.kinematics import turned
from twin.machine.description.kinematics import SPINDLE_NOSE, TABLE_TOP
from twin.machine.load import read_machine
from twin.nc.canonical import FloatArray
from twin.serve.agent import Agent, Clock
from twin.serve.device import device_of, motions_of
from twin.serve.forms import JSON
from twin.units import MM


def probe_of(name: str) -> ET.Element:
    machine = read_machine(machine_file(name))
    endless = {each for each in machine.axes.names if machine.axis(each).periodic}
    motions = motions_of(machine.axes, machine.kinematics, endless)
    return Agent(device_of(name, machine.axes, motions), Clock(), "made up", 100).probe()


def vector(motion: ET.Element, part: str) -> FloatArray:
    return np.array([float(value) for value in motion.findtext(part, "").split()])


@pytest.mark.parametrize("name", machine_names())
def test_what_follows_from_the_motions_is_where_mujoco_has_tool_and_table(name: str) -> None:
    """One motion after the other, from the frame outwards, at random positions."""
    machine = read_machine(machine_file(name))
    model = mujoco.MjModel.from_xml_path(str(machine.model_path))
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    nose, top = data.site(SPINDLE_NOSE), data.site(TABLE_TOP)
    frame = machine.kinematics.table_axes @ top.xmat.reshape(3, 3).T
    zero = nose.xpos.copy()
    table = frame @ (top.xpos - zero) / MM
    motions = {each.attrib["id"]: each for each in probe_of(name).iter("Motion")}
    names = machine.axes.names
    assert set(motions) == {f"{axis}_motion" for axis in names}
    position = np.random.default_rng(7).uniform(-40.0, 40.0, len(names))
    for axis, value in zip(names, position * machine.joint_scale, strict=True):
        data.joint(machine.axis(axis).joint).qpos[0] = value
    mujoco.mj_kinematics(model, data)

    def carried(point: FloatArray, end: str) -> FloatArray:
        while end:
            motion = motions[end]
            direction, value = vector(motion, "Axis"), position[names.index(end[0])]
            if motion.attrib["type"] == "PRISMATIC":
                point = point + value * direction
            else:
                origin = vector(motion, "Origin")
                point = turned((point - origin)[None], direction, value)[0] + origin
            end = motion.attrib.get("parentIdRef", "")
        return point

    parents = {motion.attrib.get("parentIdRef") for motion in motions.values()}
    ends = sorted(set(motions) - parents)
    on_tool = {names[c] for c in machine.kinematics.column[machine.kinematics.on_tool]}
    for site, start in ((nose, np.zeros(3)), (top, table)):
        tool = site is nose
        (end,) = [each for each in ends if (each[0] in on_tool) is tool] or [""]
        expected = frame @ (site.xpos - zero) / MM
        assert carried(start, end) == pytest.approx(expected, abs=1e-3)


def test_the_json_of_motions_holds_vectors() -> None:
    probe = probe_of("mill5")
    (device,) = json.loads(JSON.written(probe))["MTConnectDevices"]["Devices"]["Device"]
    (axes,) = device["Components"]["Axes"]
    rotary = {each["id"]: each for each in axes["Components"]["Rotary"]}
    motion = rotary["C"]["Configuration"]["Motion"]
    assert (motion["type"], motion["parentIdRef"]) == ("CONTINUOUS", "A_motion")
    assert motion["Axis"] == [0.0, 0.0, -1.0]
    assert "Configuration" not in rotary["S"]
