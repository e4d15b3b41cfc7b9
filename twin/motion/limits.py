"""What the axes and the path of a machine can do."""

import dataclasses
import math

import numpy as np

from twin.errors import ConfigError
from twin.nc.canonical import FloatArray


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class MotionLimits:
    """Limits of k axes and of the path.

    Raises:
        ConfigError: A limit is not a positive number, or the arrays differ in length.
    """

    velocity: FloatArray
    """Of each axis, shape (k,) [mm/s or deg/s]."""

    acceleration: FloatArray
    """Of each axis, shape (k,) [mm/s² or deg/s²]."""

    jerk: FloatArray
    """Of each axis, shape (k,) [mm/s³ or deg/s³]."""

    path_acceleration: float = math.inf
    """Of X Y Z together, along the path and towards its centre of curvature, each [mm/s²]."""

    path_jerk: float = math.inf
    """Of X Y Z along the path [mm/s³]."""

    rotary_path_acceleration: float = math.inf
    """The same for a path of rotary axes alone [deg/s²]."""

    rotary_path_jerk: float = math.inf
    """[deg/s³]."""

    junction_velocity_step: FloatArray | float = 0.0
    """Largest step of each axis's velocity where the path is kept through a knee, shape (k,) or one
    for all [mm/s or deg/s]; 0: stop there."""

    junction_acceleration_step: FloatArray | float = 0.0
    """The same of its acceleration where only the curvature steps [mm/s² or deg/s²]."""

    corner_tolerance: float = 0.01
    """Of a continuous corner whose program names none: distance from the path [mm]."""

    further_corner_tolerance: float = 0.01
    """Of axes other than X Y Z in any continuous corner [mm or deg]."""

    def __post_init__(self) -> None:
        for field in dataclasses.fields(self):
            values = np.atleast_1d(getattr(self, field.name))
            if field.name.startswith("junction"):
                if not np.all(values >= 0.0):
                    raise ConfigError(
                        f"motion limit '{field.name}' must be zero or positive, not {values}"
                    )
            elif not np.all(values > 0.0):
                raise ConfigError(f"motion limit '{field.name}' must be positive, not {values}")
        widths = {len(self.velocity), len(self.acceleration), len(self.jerk)}
        if len(widths) != 1:
            raise ConfigError(f"velocity, acceleration and jerk have {widths} axes")
        for name in ("velocity", "acceleration", "jerk"):
            if not np.all(np.isfinite(getattr(self, name))):
                raise ConfigError(f"motion limit '{name}' must be finite")

    def __len__(self) -> int:
        return len(self.velocity)
