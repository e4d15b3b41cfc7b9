"""A machine as other packages see it: its file and what its model says."""

import functools
import math
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from twin.errors import ConfigError
from twin.files.toml import checked
from twin.job.fixture import Weight
from twin.kinematics import Kinematics, is_turntable
from twin.machine.description.machine_file import AxisTable, MachineFile
from twin.motion.limits import MotionLimits
from twin.nc.canonical import FloatArray
from twin.toolpath.part_frame import PartFrame
from twin.units import to_si

if TYPE_CHECKING:
    from twin.machine.description.kinematics import ModelAtZero

_CENTER_MM = 1e-3
"""How far the centre of a table in a machine file may be from that of the model [mm]."""


class Blank(NamedTuple):
    """The uncut stock on the table.

    Attributes:
        size: Of the box around it [mm].
        center: Of that box over the middle of the table [mm].
        round: A cylinder; else the box itself.
        weight: What it weighs, seen from the middle of the table; None: not known.
        on_post: A post carries it where it does not lie on the table; else two parallels.
        direction: Of the cylinder's axis: 0, 1, 2 for X, Y, Z.
        relief: So deep below it that leaves room for tools [mm].
    """

    size: tuple[float, float, float]
    center: tuple[float, float, float]
    round: bool
    weight: Weight | None = None
    on_post: bool = False
    direction: int = 2
    relief: float = 0.0


class MachineConfig:
    """A machine file that was read, with what other packages need of it.

    Attributes:
        axes: Names and kinds in the order of every column.
    """

    def __init__(self, path: Path, file: MachineFile) -> None:
        fixtures = tuple(fixture.in_folder(path.parent) for fixture in file.fixtures)
        self.path = path
        self.file = file.model_copy(update={"fixtures": fixtures}) if fixtures else file
        self.axes = file.ordered_axes()

    @property
    def model_path(self) -> Path:
        """The MJCF file."""
        return self.path.parent / self.file.model

    @functools.cached_property
    def at_zero(self) -> "ModelAtZero":
        """The chain of joints from tool to part and the height of the spindle, as the model has them.

        Raises:
            ConfigError: The model is no mill; the message says why.
        """
        from twin.machine.description.kinematics import Joint, read_model

        axes = [self.file.axes[name] for name in self.axes.names]
        joints = [Joint(axis.joint, axis.direction) for axis in axes]
        return read_model(self.model_path, self.axes, joints)

    @property
    def kinematics(self) -> Kinematics:
        """How the axes carry the tool against the part; raises as ``at_zero``."""
        return self.at_zero.kinematics

    @functools.cached_property
    def part_frame(self) -> PartFrame:
        """How the part turns under the tool.

        Raises:
            ConfigError: The model is no mill, or its table is not where the machine file says.
        """
        chain, geometry = self.kinematics, self.file.geometry.of(self.axes)
        turning = chain.rotary & ~chain.on_tool
        names = [self.axes.names[column] for column in chain.column[turning].tolist()]
        innermost = chain.anchor[turning][-1] if names else np.zeros(3)
        table = self.file.table
        if table is not None and (
            table.axis not in names[-1:] or np.abs(innermost[:2] - table.center).max() > _CENTER_MM
        ):
            found = (
                f"{names[-1]} about X {innermost[0]:g} Y {innermost[1]:g}" if names else "nothing"
            )
            raise ConfigError(
                f"{self.path}: [table] does not fit the model, where {found} turns the part"
            )
        if geometry.has_table and not (names and is_turntable(chain)):
            raise ConfigError(
                f"{self.path}: geometry.table: no rotary table turns the part about Z alone"
            )
        if not is_turntable(chain):
            return PartFrame(None, (0.0, 0.0), geometry=geometry, chain=chain)
        if not names:
            return PartFrame(None, (0.0, 0.0), geometry=geometry)
        center = (float(innermost[0]), float(innermost[1]))
        return PartFrame(self.axes.index(names[0]), center, geometry=geometry)

    @property
    def joint_scale(self) -> FloatArray:
        """What a joint moves per machine coordinate, shape (k,) [m/mm or rad/deg], with its sign."""
        axes = [self.file.axes[name] for name in self.axes.names]
        return np.array([axis.direction * to_si(axis.kind) for axis in axes])

    @property
    def motion_limits(self) -> MotionLimits:
        """What the planner has to know."""
        axes = [self.axis(name) for name in self.axes.names]
        path = self.file.path
        return MotionLimits(
            velocity=np.array([axis.velocity for axis in axes]),
            acceleration=np.array([axis.acceleration for axis in axes]),
            jerk=np.array([axis.jerk for axis in axes]),
            junction_velocity_step=np.array([axis.junction_velocity_step for axis in axes]),
            junction_acceleration_step=np.array([axis.junction_acceleration_step for axis in axes]),
            corner_tolerance=path.corner_tolerance,
            path_acceleration=path.acceleration,
            path_jerk=path.jerk,
            rotary_path_acceleration=path.rotary_acceleration or math.inf,
            rotary_path_jerk=path.rotary_jerk or math.inf,
        )

    def axis(self, name: str) -> AxisTable:
        """The table of one axis."""
        return self.file.axes[name]

    def changed(self, axis: str, **fields: Any) -> "MachineConfig":
        """A copy of the machine with some fields of one axis changed.

        Args:
            fields: Keys of ``AxisTable`` and their values.

        Raises:
            ConfigError: The machine lacks the axis, or a key or a value is wrong.
        """
        if axis not in self.axes.names:
            raise ConfigError(f"{self.file.name} has the axes {', '.join(self.axes.names)}")
        data = self.file.model_dump(by_alias=True)
        data["axes"][axis].update(fields)
        return MachineConfig(self.path, checked(data, MachineFile, self.file.name))
