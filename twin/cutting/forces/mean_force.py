"""Cutting force by Kienzle, from what a stretch of motion took off."""

import dataclasses
import math

import numpy as np

from twin.cutting.forces.materials import Kienzle
from twin.cutting.kernels.teeth import THINNEST_CHIP_MM
from twin.cutting.watching.events import Stretches
from twin.job.job_file import ToolTable
from twin.nc.canonical import FloatArray
from twin.units import SECONDS_PER_MINUTE


@dataclasses.dataclass(frozen=True, slots=True)
class SpindleLoad:
    """What each of n stretches asks of the spindle.

    Attributes:
        force: Mean tangential force of all teeth, shape (n,) [N].
        power: Mean cutting power, shape (n,) [W].
    """

    force: FloatArray
    power: FloatArray


def cutting_load(
    stretches: Stretches, duration: FloatArray, tool: ToolTable, material: Kienzle
) -> SpindleLoad:
    """Mean cutting force and power.

    The width of cut ae is what was removed over path and depth. The engagement angle is
    phi = arccos(1 - 2 ae / D), the mean chip thickness h = 2 ae fz / (D phi), the power
    kc1.1 h^-mc times the material removed per second, the force the power over the cutting speed
    (mean values over the engagement; Klocke, Fertigungsverfahren 1, milling).

    Args:
        stretches: n stretches.
        duration: How long each took, shape (n,) [s].
        tool: Its ``speed`` must be given.
    """
    assert tool.speed is not None
    turns_per_second = tool.speed / SECONDS_PER_MINUTE
    seconds = np.maximum(duration, 1e-9)
    per_tooth = stretches.path / seconds / (turns_per_second * tool.teeth)
    width = cutting_width(stretches, tool.diameter)
    share = np.clip(width / tool.diameter, 1e-9, 1.0)
    engaged = np.arccos(1.0 - 2.0 * share)
    chip = np.maximum(2.0 * share * per_tooth / engaged, THINNEST_CHIP_MM)
    power = 1e-3 * material.kc * chip**-material.mc * stretches.removed / seconds
    speed = 1e-3 * math.pi * tool.diameter * turns_per_second
    return SpindleLoad(power / speed, power)


def cutting_width(stretches: Stretches, diameter: float) -> FloatArray:
    """Mean width of cut of each stretch: removed over path and depth, shape (n,) [mm].

    Args:
        diameter: Of the tool, which the width cannot exceed [mm].
    """
    area = stretches.path * stretches.depth
    wide = np.divide(stretches.removed, area, out=np.zeros_like(area), where=area > 0)
    return np.minimum(wide, diameter)
