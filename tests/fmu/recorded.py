"""A run's setpoints and what its joints did, for the tests of this folder."""

from typing import NamedTuple

from twin.nc.canonical import FloatArray

START = (0.0, 0.0, -150.0, 0.0)
"""Where the axes are before."""


class Recorded(NamedTuple):
    position: FloatArray
    velocity: FloatArray
    acceleration: FloatArray
    joint_position: FloatArray
    joint_velocity: FloatArray
    force: FloatArray
