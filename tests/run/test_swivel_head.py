"""A part whose contour leans: a swivel head B carries the tool, a table C the part."""

import json
from pathlib import Path

import mujoco
import numpy as np
import pytest

from tests.command_line import Twin
from twin.files.shipped import machine_file, resource_root
from twin.machine.load import read_machine
from twin.recording.reader import open_recording
from twin.units import MM

JOB = resource_root("programs") / "sinumerik" / "leaning_contour.toml"
LENGTH_MM = 100.0
TOP_MM = 70.0
"""Height of the blank's top over the table: 40 mm of work holding and 30 mm of blank."""
SIDES = {16: 38.0, 19: -14.0}
"""Line of a straight side of the contour, and its X."""
BENDS = {18: 15.0, 20: -15.0}
"""Line of a half circle of 26 mm about X12, and the Y of its middle."""


@pytest.mark.thorough
def test_the_tip_is_on_its_contour_as_mujoco_places_the_bodies(twin: Twin, tmp_path: Path) -> None:
    assert twin("run", str(JOB), "--out", str(tmp_path)).code == 0
    result = json.loads((tmp_path / "result.json").read_text())
    assert result["scope"]["stock"] == "tri-dexel"
    # 39,760 mm³ by counting voxels of 0.75 mm along the recorded motion.
    assert result["cut"]["removed_mm3"] == pytest.approx(39_760.0, rel=3e-3)
    with open_recording(tmp_path / "recording.h5") as recording:
        for samples in recording.chunks():
            lines = samples.setpoint.line
            for line, x in SIDES.items():
                tip = _tips(samples.setpoint.position[lines == line][::50])
                assert len(tip)
                # An exact path but where G64 rounds the sides' ends.
                inner = tip[np.abs(tip[:, 1]) < 14.5]
                assert np.abs(inner[:, 0] - x).max() < 1e-6
                assert np.abs(inner[:, 2] + 14.0).max() < 1e-6
            for line, y in BENDS.items():
                tip = _tips(samples.setpoint.position[lines == line][10:-10:50])
                radius = np.hypot(tip[:, 0] - 12.0, tip[:, 1] - y)
                assert np.abs(radius - 26.0).max() < 1e-6


def _tips(joints: np.ndarray) -> np.ndarray:
    """Tips of the tool, seen from the table, program zero as origin [mm]."""
    machine = read_machine(machine_file("mill5h"))
    model = mujoco.MjModel.from_xml_path(str(machine.model_path))
    data, tips = mujoco.MjData(model), []
    for row in joints * machine.joint_scale:
        for name, value in zip(machine.axes.names, row, strict=True):
            data.joint(name).qpos[0] = value
        mujoco.mj_kinematics(model, data)
        table, nose = data.site("table_top"), data.site("spindle_nose")
        tip = nose.xpos - LENGTH_MM * MM * nose.xmat.reshape(3, 3)[:, 2]
        tips.append(table.xmat.reshape(3, 3).T @ (tip - table.xpos) / MM)
    return np.array(tips) - [0.0, 0.0, TOP_MM]
