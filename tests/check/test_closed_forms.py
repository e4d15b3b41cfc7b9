"""A circle on the whole chain against the formula of the position loop."""

from pathlib import Path

import pytest

from tests.check.test_check_runs import write_job
from twin import api
from twin.files.shipped import machine_file
from twin.machine.load import read_machine
from twin.units import kv_per_second


@pytest.mark.seconds("circles are run at the machine")
@pytest.mark.parametrize(("radius", "feed"), [(20.0, 3000.0), (50.0, 6000.0)])
def test_a_circle_shrinks_as_the_loop_gains_say(tmp_path: Path, radius: float, feed: float):
    """The gain of a position loop around a velocity loop that integrates, at the circle's frequency.

    With position gain Kv, velocity gain a, both per moved mass, and reset time Tn the axis follows by

        G(s) = (a Kv s + a Kv/Tn) / (s³ + a s² + a (Kv + 1/Tn) s + a Kv/Tn),

    the radius changes by R (abs(G(jv/R)) - 1), and the lag along the path is v / Kv.
    """
    text = f"N10 X0 Y0 Z0 G00\nN20 G01 F{feed:g}\nN30 G02 X0 Y0 I{radius:g} J0\nN40 M30\n"
    outcome = api.run(write_job(tmp_path, "circle", text), out=tmp_path / "out").outcome
    axis = read_machine(machine_file("mill4")).axis("X")
    gain = kv_per_second(axis.kv)
    velocity_gain, reset = 4.0 * axis.damping_ratio**2 * gain, 1.0 / axis.reset_time_s
    s = 1j * feed / 60.0 / radius
    told = velocity_gain * gain * (s + reset)
    shrinking = abs(told / (s**3 + velocity_gain * (s**2 + reset * s) + told)) - 1.0
    (arc,) = outcome.figures.arcs
    assert arc.radius_mm == radius
    assert arc.radial_deviation_um == pytest.approx(shrinking * radius * 1e3, abs=0.1)
    assert outcome.figures.features["arc"].max == pytest.approx(-shrinking * radius * 1e3, abs=0.1)
    assert outcome.figures.tracking["Y"].max == pytest.approx(feed / 60.0 / gain * 1e3, rel=0.01)
