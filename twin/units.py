"""Conversion between the shop's units and SI.

Outside MuJoCo lengths are millimetres and angles degrees; inside they are metres and radians.
"""

import math
from typing import Literal

AxisKind = Literal["linear", "rotary"]
"""``linear`` axes count in mm, ``rotary`` ones in degrees."""

MM = 1e-3
"""One millimetre [m]."""
DEGREE = math.pi / 180.0
"""One degree [rad]."""
SECONDS_PER_MINUTE = 60.0
UM_PER_MM = 1e3
MDEG_PER_DEGREE = 1e3

LARGEST_COORDINATE = 1e7
"""Ten kilometres, or 27 thousand turns: beyond it a coordinate is a slip of the pen [mm or deg]."""


def to_si(kind: AxisKind) -> float:
    """Factor from an axis's own unit (mm or degree) to SI (m or rad)."""
    return MM if kind == "linear" else DEGREE


def kv_per_second(kv: float) -> float:
    """Position-loop gain from the trade's unit to 1/s.

    Args:
        kv: Loop gain [(m/min)/mm] for linear axes, [(1000 deg/min)/deg] for rotary ones.

    Returns:
        The gain [1/s]: 1 (m/min)/mm is 1000/60 1/s for either kind.
    """
    return kv * 1000.0 / SECONDS_PER_MINUTE
