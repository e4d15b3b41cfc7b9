"""Deflection and strength of tools against the formulas of beams."""

import math

import numpy as np
import pytest

from twin.cutting.forces.tool_strength import (
    FLUTED_SHARE,
    HOLDER_MODULUS,
    MODULUS,
    STRENGTH,
    tool_strength,
)
from twin.job.job_file import ToolTable


def inertia(diameter: float) -> float:
    return math.pi * diameter**4 / 64.0


def test_a_plain_bar_bends_by_the_cantilever_formula() -> None:
    # Flutes down to the holder, and a holder that is next to rigid.
    tool = ToolTable(
        number=1, diameter=10.0, flute=40.0, free_length=40.0, length=41.0, holder=500.0
    )
    meant = 40.0**3 / (3 * MODULUS["carbide"] * inertia(FLUTED_SHARE * 10.0))
    assert tool_strength(tool).compliance == pytest.approx(meant, rel=1e-4)


@pytest.mark.parametrize("made_of", ["carbide", "hss"])
def test_a_stepped_tool_bends_by_the_integral_of_its_moment(made_of: str) -> None:
    tool = ToolTable.model_validate(
        {"number": 1, "diameter": 8.0, "shank": 10.0, "flute": 20.0, "free_length": 35.0,
         "length": 90.0, "holder": 28.0, "made_of": made_of}
    )  # fmt: skip
    x = (np.arange(90_000) + 0.5) * 1e-3
    stiffness = np.where(x < 20.0, MODULUS[made_of] * inertia(FLUTED_SHARE * 8.0), 0.0)
    stiffness += np.where((x >= 20.0) & (x < 35.0), MODULUS[made_of] * inertia(10.0), 0.0)
    stiffness += np.where(x >= 35.0, HOLDER_MODULUS * inertia(28.0), 0.0)
    meant = float((x**2 / stiffness).sum() * 1e-3)
    assert tool_strength(tool).compliance == pytest.approx(meant, rel=1e-6)


def test_it_breaks_where_the_stress_is_greatest() -> None:
    thin = ToolTable(number=1, diameter=6.0, shank=6.0, flute=20.0, free_length=50.0)
    # At the holder 50 mm act on 6 mm, at the end of the flutes 20 mm on 4.8 mm.
    stress = max(32 * 50.0 / (math.pi * 6.0**3), 32 * 20.0 / (math.pi * 4.8**3))
    assert tool_strength(thin).force == pytest.approx(STRENGTH["carbide"] / stress)
    strength = tool_strength(
        ToolTable(number=1, force_limit=70.0, chip_limit=0.2, speed_limit=9000.0)
    )
    assert (strength.force, strength.chip, strength.speed) == (70.0, 0.2, 9000.0)
    assert tool_strength(ToolTable(number=1, diameter=10.0)).chip == pytest.approx(0.5)


def test_it_is_twisted_off_and_buckles_by_the_formulas_of_bars() -> None:
    tool = ToolTable(number=1, kind="drill", diameter=5.0, flute=40.0, free_length=50.0)
    core = FLUTED_SHARE * 5.0
    shear = STRENGTH["carbide"] / math.sqrt(3.0)
    assert tool_strength(tool).torque == pytest.approx(1e-3 * shear * math.pi * core**3 / 16.0)
    euler = math.pi**2 * MODULUS["carbide"] * inertia(core) / 35.0**2
    assert tool_strength(tool).thrust == pytest.approx(euler)
    told = tool_strength(tool.model_copy(update={"torque_limit": 2.0, "thrust_limit": 300.0}))
    assert (told.torque, told.thrust) == (2.0, 300.0)
