"""The cone test: a frustum's flank, milled on five axes, and the error of the tip explained from the drives.

After ISO 10791-7 and NAS 979: a cone of 15 degrees half its apex, its axis leaning 10 degrees to the table's, so that all five axes
go to and fro. All drives of mill5 are critically damped with w = 250 1/s and are told the force of their acceleration: they follow by
(s² + w²) / (s + w)², with a common delay of 2 / w and, of what goes to and fro, an amplitude that is too small by its share 2 (rate / w)².
"""

from pathlib import Path

import numpy as np
import pytest

from twin import api
from twin.motion.setpoints.setpoints import Setpoints
from twin.nc.canonical import FloatArray
from twin.recording.reader import open_recording

LOOP = 250.0
"""[1/s]"""
HALF_APEX, LEAN = np.deg2rad(15.0), np.deg2rad(10.0)
RADIUS, CENTER = 36.0, np.array([15.0, 8.0, -12.0])
"""Of the tip's circle, cutter included [mm]."""
LEANT = np.array(
    [[1, 0, 0], [0, np.cos(LEAN), -np.sin(LEAN)], [0, np.sin(LEAN), np.cos(LEAN)]], np.float64
)
STEPS = 1440
JOB = """
program = "cone.nc"
dialect = "fanuc"
machine = "mill5"
part_zero = { X = 0.0, Y = 0.0, Z = -440.0 }
[start]
Z = 150.0
[[tools]]
number = 1
diameter = 12.0
length = 100.0
[tolerance]
contour_um = 100.0
"""


def program(feed: float) -> str:
    """Once around the cone, the tool along its flank, the tip led."""
    turn = np.linspace(0.0, 2.0 * np.pi, STEPS + 1)
    around = np.stack([np.cos(turn), np.sin(turn), np.zeros_like(turn)], 1)
    tip = CENTER + RADIUS * around @ LEANT.T
    flank = (np.array([0.0, 0.0, np.cos(HALF_APEX)]) - np.sin(HALF_APEX) * around) @ LEANT.T
    a = -np.rad2deg(np.arccos(flank[:, 2]))
    c = np.rad2deg(np.unwrap(np.arctan2(-flank[:, 0], flank[:, 1])))
    lines = [
        f"X{x:.6f} Y{y:.6f} Z{z:.6f} A{i:.6f} C{k:.6f}"
        for (x, y, z), i, k in zip(tip, a, c, strict=True)
    ]
    return "\n".join(
        [
            "%",
            "O1",
            "T1 M6",
            "S6000 M3",
            "G43.4 H1",
            f"G0 {lines[0]}",
            f"G1 F{feed:g}",
            *lines[1:],
            "G49",
            "M30",
            "%",
        ]
    )


def followed(setpoints: Setpoints, period: float) -> FloatArray:
    """Where drives of (s² + w²) / (s + w)² are: behind by 2 / w of the velocity that w² / (s + w)² lets through, shape (n, k)."""
    time = period * np.arange(400)
    response = time * np.exp(-LOOP * time)
    response /= response.sum()
    rate = [np.convolve(each, response)[: len(setpoints)] for each in setpoints.velocity.T]
    return setpoints.position - 2.0 / LOOP * np.stack(rate, axis=1)


def off_circle(tip: FloatArray) -> FloatArray:
    """Distance from the circle of the tip [µm]."""
    seen = (tip - CENTER) @ LEANT
    return 1e3 * np.hypot(np.hypot(seen[:, 0], seen[:, 1]) - RADIUS, seen[:, 2])


@pytest.mark.thorough
@pytest.mark.parametrize("feed", [1200.0, 4000.0])
def test_the_error_of_the_cone_is_that_of_its_drives(tmp_path: Path, feed: float) -> None:
    (tmp_path / "cone.nc").write_text(program(feed))
    (tmp_path / "cone.toml").write_text(JOB)
    api.run(tmp_path / "cone.toml", out=tmp_path / "out")
    with open_recording(tmp_path / "out" / "recording.h5") as recording:
        header = recording.header
        (samples,) = recording.chunks(len(recording))
    frame, zero = header.part_frame, header.part_frame.program_zero(header.part_zero)
    line = samples.setpoint.line
    cut = (line > 8 + STEPS // 8) & (line < 8 + STEPS - STEPS // 8)
    asked = followed(samples.setpoint, header.period_s)
    explained = off_circle(frame.position(asked)[cut] - zero)
    found = off_circle(frame.position(samples.joint_position)[cut] - zero)
    for share in (50.0, 90.0, 99.0):
        assert np.percentile(found, share) == pytest.approx(
            np.percentile(explained, share), abs=0.03, rel=0.05
        )
    assert found.max() == pytest.approx(explained.max(), abs=0.1, rel=0.05)
