"""Cutting force by Kienzle, from what a stretch of motion took off."""

import dataclasses
import math

import numpy as np

from twin.cutting.events import Stretches
from twin.errors import ConfigError
from twin.job.job_file import StockTable, ToolTable
from twin.nc.canonical import FloatArray
from twin.units import SECONDS_PER_MINUTE

THINNEST_CHIP_MM = 1e-3
"""Chips thinner than this are rubbed, not cut; the formula is not followed below [mm]."""


@dataclasses.dataclass(frozen=True, slots=True)
class Kienzle:
    """How a material resists: kc = kc1.1 h^-mc (Kienzle, 1952).

    Attributes:
        kc: Specific cutting force of a chip 1 mm wide and 1 mm thick [N/mm²].
        mc: Its fall with the chip's thickness.
    """

    kc: float
    mc: float


MATERIALS = {
    "C45": Kienzle(2220.0, 0.14),
    "C60": Kienzle(2130.0, 0.18),
    "E335": Kienzle(2110.0, 0.17),
    "16MnCr5": Kienzle(2100.0, 0.26),
    "42CrMo4": Kienzle(2500.0, 0.26),
    "EN-GJL-250": Kienzle(1160.0, 0.26),
    "AlMgSi": Kienzle(650.0, 0.25),
}
"""Steels and cast iron: Kienzle's constants as tabulated in König and Klocke,
Fertigungsverfahren 1; those of C45, E335, 16MnCr5, 42CrMo4 and EN-GJL-250 give the specific forces
of Röhm's table (Reference RN 1391, table 2) within 7 %, to which the tests hold them. AlMgSi, aged:
the value of tool makers' tables for ISO group N1.2."""


def kienzle(stock: StockTable) -> Kienzle | None:
    """The constants of a stock's material, or None where the job names none.

    Raises:
        ConfigError: The material is not known.
    """
    if stock.material is None:
        return None
    if stock.material not in MATERIALS:
        known = ", ".join(sorted(MATERIALS))
        raise ConfigError(f"stock.material = '{stock.material}' is not known: there are {known}")
    return MATERIALS[stock.material]


@dataclasses.dataclass(frozen=True, slots=True)
class Load:
    """What each of n stretches asks of the spindle.

    Attributes:
        force: Mean tangential force of all teeth, shape (n,) [N].
        power: Mean cutting power, shape (n,) [W].
    """

    force: FloatArray
    power: FloatArray


def cutting_load(
    stretches: Stretches, duration: FloatArray, tool: ToolTable, material: Kienzle
) -> Load:
    """Mean cutting force and power.

    The width of cut ae is what was removed over path and depth. The engagement angle is
    phi = arccos(1 - 2 ae / D), the mean chip thickness h = 2 ae fz / (D phi), the power
    kc1.1 h^-mc times the material removed per second, the force the power over the cutting speed
    (mean values over the engagement; Klocke, Fertigungsverfahren 1, milling).

    Args:
        stretches: n stretches.
        duration: How long each took, shape (n,) [s].
        tool: Its ``speed`` must be given.
        material: What is cut.
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
    return Load(power / speed, power)


def cutting_width(stretches: Stretches, diameter: float) -> FloatArray:
    """Mean width of cut of each stretch: removed over path and depth, shape (n,) [mm].

    Args:
        stretches: n stretches.
        diameter: Of the tool, which the width cannot exceed [mm].
    """
    area = stretches.path * stretches.depth
    wide = np.divide(stretches.removed, area, out=np.zeros_like(area), where=area > 0)
    return np.minimum(wide, diameter)
