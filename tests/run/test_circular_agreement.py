"""A circle of a program and the circular test of the machine come to the same figures."""

import math
from pathlib import Path

import pytest

from twin.files.shipped import machine_file
from twin.machine.circle.circular_test import circular_test
from twin.machine.load import read_machine
from twin.run.preparing.preparation import prepare
from twin.run.progress import no_progress
from twin.run.run import Run

RADIUS, FEED = 40.0, 600.0


def both_ways() -> str:
    """Each full circle begins and ends within a longer arc, so that it is run at full feed."""
    c = RADIUS * math.sqrt(0.5)
    lower, upper, beyond = f"X{c:.6f} Y{-c:.6f}", f"X{c:.6f} Y{c:.6f}", f"X{-c:.6f} Y{c:.6f}"
    return "\n".join(
        [
            f"N1 {lower} Z0 C0 G00",
            f"N2 G01 F{FEED:g}",
            f"N3 G03 {upper} I{-c:.6f} J{c:.6f}",
            f"N4 G03 {upper} I{-c:.6f} J{-c:.6f}",
            f"N5 G03 {beyond} I{-c:.6f} J{-c:.6f}",
            f"N6 G02 {upper} I{c:.6f} J{-c:.6f}",
            f"N7 G02 {upper} I{-c:.6f} J{-c:.6f}",
            f"N8 G02 {lower} I{-c:.6f} J{-c:.6f}",
            "N9 M30\n",
        ]
    )


@pytest.mark.thorough
def test_the_run_and_the_circular_test_agree(tmp_path: Path):
    program = tmp_path / "both_ways.nc"
    program.write_text(both_ways(), encoding="utf-8")
    run = Run(prepare(program, dialect="mefi", machine="mill4_light"))
    (pair,) = run.execute(None, no_progress).figures.bidirectional
    found = circular_test(read_machine(machine_file("mill4_light")), RADIUS, FEED)
    assert found.hysteresis_um > 1.0
    assert pair.circular_deviation_um == pytest.approx(found.circular_deviation_um, rel=0.01)
    assert pair.hysteresis_um == pytest.approx(found.hysteresis_um, rel=0.01)
    assert pair.mean_radial_deviation_um == pytest.approx(found.mean_radius_error_um, rel=0.01)
