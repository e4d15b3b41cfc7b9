"""What the axes and the path of a machine can do.

**Where the junction steps come from.** A drive with velocity feed-forward and a position loop of
natural frequency w, critically damped (w twice the loop gain), answers a step dv of the commanded
velocity with an error ``dv t exp(-w t)``, whose peak is ``dv / (e w)``. With w = 250 1/s (a gain of
125 1/s, 7.5 (m/min)/mm), 1 mm/s costs 1.5 µm at the corner, and 0.5 deg/s of a table 0.74 mdeg, 1.3
µm at a radius of 100 mm: as much as a good machine's own geometry. A step da of the acceleration,
fed forward, is a step of the drive's force by m da; a tenth of the axis's acceleration takes a
tenth of the force that the drive has for it, well within what its current loop follows in a servo
period. A machine's README derives its own from its own gains by these rules.
"""

import dataclasses
import math
from typing import NamedTuple

import numpy as np

from twin.errors import ConfigError
from twin.nc.canonical import FloatArray


class MachineLimits(NamedTuple):
    """``MotionLimits``, for compiled code.

    Attributes:
        velocity: Of each axis, shape (k,).
        acceleration: Of each axis, shape (k,).
        jerk: Of each axis, shape (k,).
        path: Acceleration and jerk of the path, and of one of rotary axes alone.
    """

    velocity: FloatArray
    acceleration: FloatArray
    jerk: FloatArray
    path: tuple[float, float, float, float]


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
    """Of a path of rotary axes alone [deg/s²]."""

    rotary_path_jerk: float = math.inf
    """Of a path of rotary axes alone [deg/s³]."""

    junction_velocity_step: FloatArray | float = 0.0
    """Largest step of each axis's velocity where the path is kept through a corner, shape (k,) or one
    for all [mm/s or deg/s]; 0: stop there."""

    junction_acceleration_step: FloatArray | float = 0.0
    """Largest step of each axis's acceleration where only the curvature steps [mm/s² or deg/s²]."""

    corner_tolerance: float = 0.01
    """Of a continuous corner whose program names none: distance from the path [mm]."""

    further_corner_tolerance: float = 0.01
    """Of axes other than X Y Z in any continuous corner [mm or deg]; the default is that of the path:
    a hundredth of a degree is a hundredth of a millimetre at a radius of 57 mm."""

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

    def arrays(self) -> MachineLimits:
        """Limits of the axes and the path, for compiled code."""
        return MachineLimits(
            self.velocity, self.acceleration, self.jerk,
            (self.path_acceleration, self.path_jerk,
             self.rotary_path_acceleration, self.rotary_path_jerk),
        )  # fmt: skip

    def __len__(self) -> int:
        return len(self.velocity)
