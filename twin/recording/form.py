"""What a recording holds: its header, its columns, and how exactly they are kept."""

import dataclasses
from collections.abc import Mapping

import numpy as np
import numpy.typing as npt

from twin.columns import Columns
from twin.motion.setpoints.setpoints import Setpoints
from twin.nc.canonical import Axes, FloatArray
from twin.toolpath.part_frame import PartFrame


@dataclasses.dataclass(frozen=True, slots=True)
class ToolLoad(Columns):
    """What loaded the tool at n samples, machine axes.

    Attributes:
        force: On the tool, in the mean of the period, shape (n, 3) [N].
        peak_force: Greatest level force in a turn, shape (n,) [N].
        power: Of the cut, shape (n,) [W].
        chip: Thickest chip, shape (n,) [mm].
        deflection: Of the tool's tip off where it would be, were the tool rigid, shape (n, 3) [mm].
        spindle_speed: Shape (n,) [1/min], negative counter-clockwise.
        spindle_load: Torque as a share of what the spindle can give, shape (n,).
        broken: Whether the tool has lost its edge, shape (n,).
    """

    force: FloatArray
    peak_force: FloatArray
    power: FloatArray
    chip: FloatArray
    deflection: FloatArray
    spindle_speed: FloatArray
    spindle_load: FloatArray
    broken: npt.NDArray[np.bool_]


@dataclasses.dataclass(frozen=True, slots=True)
class Samples(Columns):
    """A chunk of n samples over k axes: what was asked for and what the joints did.

    Attributes:
        setpoint: The setpoints of the same instants, machine coordinates.
        joint_position: Shape (n, k) [mm or deg], machine coordinates.
        joint_velocity: Shape (n, k) [mm/s or deg/s].
        drive_force: Shape (n, k) [N or N m].
        tool: Force and torque on the tool; None where the force of the cut was not simulated.
        growth: How far the warm machine has shifted the tool along X, Y, Z, shape (n, 3) [mm]; None: it
            does not grow.
        contour_um: Contour error, shape (n,) [µm]; None: nobody has compared.
    """

    setpoint: Setpoints
    joint_position: FloatArray
    joint_velocity: FloatArray
    drive_force: FloatArray
    tool: ToolLoad | None = None
    growth: FloatArray | None = None
    contour_um: FloatArray | None = None

    def real(self, frame: PartFrame) -> FloatArray:
        """Machine coordinates at which an ideal machine with a rigid tool would have the tool.

        Args:
            frame: How far the machine is from straight and square.

        Returns:
            Shape (n, k) [mm or deg].
        """
        joints = frame.real(self.joint_position)
        shifts = [] if self.tool is None else [self.tool.deflection]
        shifts += [] if self.growth is None else [self.growth]
        if not shifts:
            return joints
        shifted = joints.copy()
        for shift in shifts:
            shifted[:, :3] += shift
        return shifted


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class RecordingHeader:
    """What a recording says about itself; the attributes of the file."""

    axes: Axes
    period_s: float
    part_zero: FloatArray
    """Machine coordinates of program zero, shape (k,) [mm or deg]."""
    part_frame: PartFrame
    program: str
    program_text: str
    """Empty where the program is longer than ``LONGEST_TEXT``."""
    program_sha256: str
    dialect: str
    machine: str
    twin_version: str
    mujoco_version: str
    job: str = ""
    """The job as JSON, files in it as whole paths; empty in recordings that were made without."""
    machine_file: str = ""
    """Where the machine file lay."""


COLUMNS: Mapping[str, tuple[str, str]] = {
    "time": ("time", "s"),
    "line": ("line", ""),
    "move": ("move", ""),
    "fraction": ("fraction", ""),
    "setpoint/position": ("position", "mm or deg"),
    "setpoint/velocity": ("velocity", "mm/s or deg/s"),
    "setpoint/acceleration": ("acceleration", "mm/s^2 or deg/s^2"),
}
"""Datasets, the fields of ``Setpoints`` that they keep, and their units."""
JOINT_COLUMNS: Mapping[str, tuple[str, str]] = {
    "joint/position": ("joint_position", "mm or deg"),
    "joint/velocity": ("joint_velocity", "mm/s or deg/s"),
    "drive/force": ("drive_force", "N or N m"),
}
"""Datasets, the fields of ``Samples`` that they keep, and their units."""
TOOL_COLUMNS: Mapping[str, tuple[str, str, int]] = {
    "tool/force": ("force", "N", 3),
    "tool/peak_force": ("peak_force", "N", 0),
    "tool/power": ("power", "W", 0),
    "tool/chip": ("chip", "mm", 0),
    "tool/deflection": ("deflection", "mm", 3),
    "tool/spindle_speed": ("spindle_speed", "1/min", 0),
    "tool/spindle_load": ("spindle_load", "", 0),
    "tool/broken": ("broken", "", 0),
}
"""Datasets, the fields of ``ToolLoad`` that they keep, their units and their widths (0: one value a
sample); missing where the force of the cut was not simulated."""
GROWTH = "thermal/growth"
"""Dataset of ``Samples.growth``, shape (n, 3) [mm]; missing where the machine does not grow."""
CONTOUR = "contour"
"""Dataset of the contour error, shape (n,) [µm]; missing where no comparison was made."""

TEXT_ATTRIBUTES = (
    "program",
    "program_sha256",
    "dialect",
    "machine",
    "twin_version",
    "mujoco_version",
)
LATER_ATTRIBUTES = ("job", "machine_file")
"""Recordings of earlier versions lack them."""

STEPS: Mapping[str, float] = {
    "fraction": 2.0**-24,
    "setpoint/position": 2.0**-24,
    "setpoint/velocity": 2.0**-20,
    "setpoint/acceleration": 2.0**-10,
    "joint/position": 2.0**-24,
    "joint/velocity": 2.0**-20,
    "drive/force": 2.0**-14,
    "tool/force": 2.0**-14,
    "tool/peak_force": 2.0**-14,
    "tool/power": 2.0**-10,
    "tool/chip": 2.0**-24,
    "tool/deflection": 2.0**-24,
    GROWTH: 2.0**-24,
    "tool/spindle_speed": 2.0**-10,
    "tool/spindle_load": 2.0**-20,
    CONTOUR: 2.0**-14,
}
"""What columns are rounded to, in their units: positions to 0.06 nm.

It is far below what any figure shows, and the zero bits behind it leave a third of the file and
half of the time that writing takes.
"""

LONGEST_TEXT = 16 << 20
"""Bytes of a program up to which its text is kept in the recording."""
