"""A machine of a few boxes, and recordings of motion made by hand."""

import dataclasses
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path

import mujoco
import numpy as np
import pytest

from twin.cutting.program_summary import ProgramSummary
from twin.job.job_file import StockTable, ToolTable
from twin.machine.description.config import MachineConfig
from twin.machine.load import read_machine
from twin.motion.setpoints.setpoints import Setpoints
from twin.nc.canonical import FloatArray
from twin.recording.reader import Recording, RecordingHeader, Samples, open_recording, record
from twin.render.drawing.gl import BACKENDS, probe
from twin.render.scene.scene import RenderScene
from twin.toolpath.tool_plan import ToolPlan

MODEL = """
<mujoco>
  <compiler angle="degree"/>
  <statistic center="0 0 0.1" extent="0.6"/>
  <visual>
    <headlight ambient="0.5 0.5 0.5" diffuse="0.4 0.4 0.4" specular="0 0 0"/>
    <map znear="0.02" zfar="20"/>
  </visual>
  <worldbody>
    <light name="key" type="directional" pos="-0.3 -0.4 0.85" dir="0.3 0.4 -0.85" castshadow="true"/>
    <geom name="wall" type="box" size="0.5 0.01 0.5" pos="0 0.4 0.2" rgba="0.1 0.3 0.1 1"/>
    <camera name="overview" pos="0 -0.6 0.5" xyaxes="1 0 0 0 0.62 0.78" fovy="45"/>
    <camera name="top" pos="0 0 0.7" xyaxes="1 0 0 0 1 0" fovy="35"/>
    <body name="slide" pos="0.02 0.01 0">
      <joint name="X" type="slide" axis="-1 0 0"/>
      <joint name="Y" type="slide" axis="0 -1 0"/>
      <inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/>
      <body name="rotary_table" pos="-0.02 -0.01 0" euler="0 0 25">
        <joint name="C" type="hinge" axis="0 0 -1"/>
        <inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/>
        <geom name="plate" type="cylinder" size="0.12 0.005" pos="0 0 -0.005" rgba="0.2 0.2 0.4 1"/>
        <site name="table_top"/>
      </body>
    </body>
    <body name="head" pos="0 0 0.3">
      <joint name="Z" type="slide" axis="0 0 1"/>
      <inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/>
      <geom name="tool_cutter" type="cylinder" size="0.005 0.025" pos="0 0 -0.025" rgba="0.9 0.1 0.1 1"/>
      <site name="spindle_nose"/>
    </body>
  </worldbody>
</mujoco>
"""

AXIS = """
[axes.{name}]
joint = "{name}"
kind = "{kind}"
velocity = 500.0
acceleration = 4000.0
jerk = 50000.0
kv = 7.5
"""

TOOL = ToolTable(number=1, diameter=10.0, length=50.0)
STOCK = StockTable(shape="box", size=(120.0, 80.0, 20.0), cell=0.5)
ZERO = np.array([0.0, 0.0, -230.0, 15.0])
"""The table top is 250 mm below the tip of the tool at Z 0; the stock is on it."""
SOURCE = ("G0 X0 Y0 Z50", "G1 X-40 Z-5 ; прямая", "G1 X40", "G1 C90 ; kružnice")
SUMMARY = ProgramSummary(tools=ToolPlan((TOOL,)), rapid=np.array([True, False, False, False]))


@pytest.fixture(autouse=True, scope="session")
def opengl() -> None:
    if all(probe(backend).error for backend in BACKENDS):
        pytest.skip("no OpenGL draws without a screen here: see twin doctor")


@pytest.fixture(scope="session")
def machine(tmp_path_factory: pytest.TempPathFactory) -> MachineConfig:
    folder = tmp_path_factory.mktemp("boxes")
    (folder / "boxes.xml").write_text(MODEL)
    axes = "".join(
        AXIS.format(name=name, kind="rotary" if name == "C" else "linear") for name in "XYZC"
    )
    path = "[path]\nacceleration = 4000.0\njerk = 50000.0\n"
    head = 'schema = 1\nname = "boxes"\nmodel = "boxes.xml"\n'
    (folder / "machine.toml").write_text(f'{head}{axes}{path}[table]\naxis = "C"\n')
    return read_machine(folder / "machine.toml")


@pytest.fixture
def spec(machine: MachineConfig) -> mujoco.MjSpec:
    return mujoco.MjSpec.from_file(str(machine.model_path))


def program() -> tuple[FloatArray, FloatArray]:
    """Setpoints in program coordinates and their lines: approach, slot, quarter ring."""
    ends = ([0, 0, 50, 0], [-40, 0, -5, 0], [40, 0, -5, 0], [40, 0, -5, 90])
    start, parts, lines = np.array([0.0, 0.0, 60.0, 0.0]), [], []
    for line, end in enumerate(ends, 1):
        parts.append(np.linspace(start, end, 250, endpoint=False))
        lines.append(np.full(250, line))
        start = np.array(end, np.float64)
    parts.append(start[None])
    lines.append(np.array([4]))
    return np.concatenate(parts), np.concatenate(lines)


Record = Callable[..., Path]


@pytest.fixture
def make_recording(tmp_path: Path, machine: MachineConfig) -> Record:
    """Writes the program's recording, with contour errors and alarms if wanted."""

    def make(
        contour_um: FloatArray | None = None, alarms: Sequence[tuple[float, str]] = ()
    ) -> Path:
        path = tmp_path / "slot.h5"
        header, samples = slot(machine)
        with record(path, header) as writer:
            writer.append(samples, contour_um)
            writer.note_alarms(alarms)
        return path

    return make


@pytest.fixture
def recording(make_recording: Record) -> Iterator[Recording]:
    with open_recording(make_recording()) as opened:
        yield opened


@pytest.fixture
def scene(recording: Recording, spec: mujoco.MjSpec, machine: MachineConfig) -> RenderScene:
    return RenderScene(
        recording=recording, spec=spec, machine=machine, summary=SUMMARY, source=SOURCE, stock=STOCK
    )


def slot(machine: MachineConfig) -> tuple[RecordingHeader, Samples]:
    """The header and the samples of the program's recording; the joints are off a little."""
    position, line = program()
    position = position + ZERO
    velocity = np.gradient(position, 1e-3, axis=0)
    count = len(position)
    time = 1e-3 * np.arange(count, dtype=np.float64)
    line = line.astype(np.int64)
    setpoint = Setpoints(time, line, line - 1, np.zeros(count), position, velocity, 0 * position)
    joints = position - [0.003, 0.0, 0.004, 0.0]
    samples = Samples(setpoint, joints, velocity, 0 * position)
    header = RecordingHeader(
        axes=machine.axes,
        period_s=1e-3,
        part_zero=ZERO,
        part_frame=dataclasses.replace(machine.part_frame, turn_zero=ZERO[3]),
        program="slot.nc",
        program_text="\n".join(SOURCE),
        program_sha256="0" * 64,
        dialect="mefi",
        machine="boxes",
        twin_version="0",
        mujoco_version="4",
    )
    return header, samples
