"""What the planner gets from a machine file."""

import math

import numpy as np

from twin.machine.description.config import Machine
from twin.motion.limits import MotionLimits


def motion_limits(machine: Machine) -> MotionLimits:
    """The planner's view of a machine file."""
    axes = [machine.axis(name) for name in machine.axes.names]
    path = machine.file.path
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
