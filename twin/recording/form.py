"""What a recording holds: its header, its columns, and how exactly they are kept."""

import dataclasses
from collections.abc import Mapping

from twin.columns import Columns
from twin.motion.setpoints.setpoints import Setpoints
from twin.nc.canonical import Axes, FloatArray
from twin.toolpath.part_frame import PartFrame


@dataclasses.dataclass(frozen=True, slots=True)
class Samples(Columns):
    """A chunk of n samples over k axes: what was asked for and what the joints did.

    Attributes:
        setpoint: The setpoints of the same instants, machine coordinates.
        joint_position: Shape (n, k) [mm or deg], machine coordinates.
        joint_velocity: Shape (n, k) [mm/s or deg/s].
        drive_force: Shape (n, k) [N or N m].
    """

    setpoint: Setpoints
    joint_position: FloatArray
    joint_velocity: FloatArray
    drive_force: FloatArray


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
CONTOUR = "contour"
"""Dataset of the contour error, shape (n,) [µm]; missing where nobody compared."""

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
    CONTOUR: 2.0**-14,
}
"""What columns are rounded to, in their units: positions to 0.06 nm.

It is far below what any figure shows, and the zero bits behind it leave a third of the file and
half of the time that writing takes.
"""

LONGEST_TEXT = 16 << 20
"""Bytes of a program up to which its text is kept in the recording."""
