"""How a tool bends, and what it breaks at: a cantilever of holder, shank and flutes."""

import math
from typing import NamedTuple

from twin.job.job_file import ToolTable

MODULUS = {"carbide": 600e3, "hss": 215e3}
"""Young's modulus of tools [N/mm²]: cemented carbide of 10 % cobalt, high-speed steel."""
STRENGTH = {"carbide": 2500.0, "hss": 2500.0}
"""Bending stress at which a fluted tool breaks [N/mm²]: two thirds of the transverse rupture strength of
ground bars (ISO 3327: 3500 to 4000), for flutes are notches."""
HOLDER_MODULUS = 210e3
"""Of the holder's steel [N/mm²]."""
FLUTED_SHARE = 0.8
"""Diameter of a round bar as stiff as the flutes, as a share of theirs (Kops and Vo, 1990)."""
LED_SHARE = 0.7
"""Length over which a bar buckles that is clamped at one end and led at the other, as a share of its own."""
THICKEST_CHIP = 0.05
"""Chip that breaks an edge where the job says nothing of it, as a share of the diameter: two to five
times the feed per tooth that tool makers recommend."""


class ToolStrength(NamedTuple):
    """What a tool deflects and breaks under.

    Attributes:
        compliance: Deflection of the tip per force across it [mm/N].
        force: Level force at the tip that breaks it [N].
        chip: Chip that breaks it [mm].
        torque: That twists it off [N m].
        thrust: Force along its axis under which it buckles [N].
        speed: Speed beyond which it flies apart [1/min]; infinite: none is known.
    """

    compliance: float
    force: float
    chip: float
    torque: float
    thrust: float
    speed: float


def tool_strength(tool: ToolTable) -> ToolStrength:
    """What a tool of the job deflects and breaks under.

    A force F at the tip bends a stepped cantilever by the sum of F (b³ - a³) / (3 E I) over its parts,
    a and b their ends' distances from the tip, I = pi d⁴/64; the greatest stress 32 F b / (pi d³) is
    where flutes or shank end. A torque twists off the flutes, as stiff as they are taken for, at the shear
    stress that equals the strength after von Mises: T = pi d³ / 16 / sqrt(3) of it. Under a thrust the free
    length buckles, clamped in the holder and led by its point: F = pi² E I / (0.7 b)² (Euler's third case).
    """
    shank = tool.diameter if tool.shank is None else tool.shank
    flutes_end = min(tool.flute, tool.below_holder)
    cutter = MODULUS[tool.made_of]
    parts = (
        (0.0, flutes_end, FLUTED_SHARE * tool.diameter, cutter),
        (flutes_end, tool.below_holder, shank, cutter),
        (tool.below_holder, tool.length, max(tool.holder, shank), HOLDER_MODULUS),
    )
    compliance = sum(
        (end**3 - begin**3) / (3.0 * modulus * math.pi * diameter**4 / 64.0)
        for begin, end, diameter, modulus in parts
    )
    stress = max(
        32.0 * end / (math.pi * diameter**3) for begin, end, diameter, _ in parts[:2] if end > begin
    )
    core = FLUTED_SHARE * tool.diameter
    torque = 1e-3 * STRENGTH[tool.made_of] / math.sqrt(3.0) * math.pi * core**3 / 16.0
    slender = math.pi**2 * cutter * math.pi * core**4 / 64.0 / (LED_SHARE * tool.below_holder) ** 2
    return ToolStrength(
        compliance=compliance,
        force=tool.force_limit or STRENGTH[tool.made_of] / stress,
        chip=tool.chip_limit or THICKEST_CHIP * tool.diameter,
        torque=tool.torque_limit or torque,
        thrust=tool.thrust_limit or slender,
        speed=tool.speed_limit or math.inf,
    )
