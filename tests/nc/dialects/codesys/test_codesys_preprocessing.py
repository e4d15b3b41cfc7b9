"""Words of CODESYS SoftMotion that its path preprocessing acts on: tool length, planes, limits of axes."""

import numpy as np
import pytest

from tests.nc.running import WITH_TABLES, bad, good
from twin.nc.control.settings import MachineFunction


def test_the_move_behind_g43_leads_into_the_length() -> None:
    moves = good("N10 G0 X0 N20 G43 K10 N30 G1 X10 F5 N40 X20 N50 G43 K0 N60 X30", "codesys").moves
    assert moves.end[:, 2].tolist() == [10.0, 10.0, 0.0]
    assert moves.start[:, 2].tolist() == [0.0, 10.0, 10.0]


def test_a_shift_between_keeps_the_length_to_be_led_into() -> None:
    moves = good("N10 G43 K10 N20 G54 X5 Z1 N30 G1 X10 Z0 F5 N40 X11", "codesys").moves
    assert moves.end[:, [0, 2]].tolist() == [[15.0, 11.0], [16.0, 11.0]]
    moves = good("N10 G43 K10 N20 G54 X5 N30 G1 X10 F5", "codesys").moves
    assert moves.end[0].tolist() == [15.0, 0.0, 10.0, 0.0]


def test_an_arc_leads_into_a_length_across_its_plane_only() -> None:
    arc = "G2 X20 Y0 I10 J0 F10"
    moves = good(f"N10 G0 X0 Y0 N20 G43 K5 N30 {arc}", "codesys").moves
    assert moves.end[-1, 2] == 5.0
    assert bad(f"N10 G0 X0 Y0 N20 G43 I5 N30 {arc}", "codesys").code == "length-ramp"


def test_the_length_stays_while_compensation_is_in_force() -> None:
    text = "N10 G41 D2 N20 G1 X10 F5 N30 G43 K5"
    assert bad(text, "codesys").code == "compensation-change"


@pytest.mark.parametrize("plane", ["G17", "G16 I0 J0 K1", "G15"])
def test_a_plane_chosen_after_g41_is_that_of_the_contour(plane: str) -> None:
    contour = "G1 X10 Y0 F10\nN5 X20 Y10\nN6 G40\nN7 X30"
    before = good(f"N1 {plane}\nN2 G41 D2\nN4 {contour}", "codesys").moves
    behind = good(f"N1 G41 D2\nN2 {plane}\nN4 {contour}", "codesys").moves
    assert np.array_equal(before.end, behind.end)


@pytest.mark.parametrize("plane", ["G18", "G16 I0 J1 K0", "G16 I1 J1 K1"])
def test_no_plane_can_be_chosen_within_the_contour(plane: str) -> None:
    text = f"N1 G41 D2\nN2 G1 X10 F10\nN3 {plane}\nN4 X20"
    assert bad(text, "codesys").code == "compensation-plane"
    good(f"N1 G41 D2\nN2 {plane}\nN3 G1 X10 Y0 Z5 F10\nN4 X20 Y10\nN5 G40\nN6 X30", "codesys")


def test_a_code_that_is_reported_and_no_more_takes_the_time_that_the_builder_says() -> None:
    declared = {8: MachineFunction("coolant, its pressure waited for", 1.5)}
    events = good("G1 X1 F100\nX2\nM8\nX3\nX4\nM30", "fanuc", m_functions=declared).events
    shown = [getattr(event, "word", getattr(event, "seconds", None)) for event in events]
    assert shown == ["M8", 1.5, "M30"]


def test_an_axis_has_an_acceleration_and_a_deceleration() -> None:
    moves = good("N1 G1 X10 F5 EX10 EX-13\nN2 X20 Y10\nN3 X30 EX0\nN4 X40 EX7", "codesys").moves
    assert moves.acceleration[0] == 10.0
    assert moves.deceleration[0] == 13.0
    assert moves.acceleration[1] == pytest.approx(10.0 * np.sqrt(2.0))
    assert np.isnan(moves.acceleration[2])
    assert (moves.acceleration[3], moves.deceleration[3]) == (7.0, 7.0)


def test_declared_functions_wait() -> None:
    declared = {22: MachineFunction("pallet", 2.5), 10: MachineFunction("clamp")}
    text = "G0 X1\nM10\nM22\nX2\nM30"
    events = good(text, "fagor8070", settings=WITH_TABLES, m_functions=declared).events
    shown = [getattr(event, "word", getattr(event, "seconds", None)) for event in events]
    assert shown == ["M10", "M22", 2.5, "M30"]
    assert "[m_functions] M10" in str(bad(text, "fagor8070").hint)
    waiting = good("N1 G0 X1\nN2 M22\nN3 X2", "codesys", m_functions=declared).events
    assert len(waiting) == 2


@pytest.mark.parametrize("dialect", ["gost", "mefi", "fagor8070"])
def test_a_feed_per_revolution_needs_a_turning_spindle(dialect: str) -> None:
    start = "S500\nG95 F0.2\n"
    moving = start + "M3\n" + "G1 X1\nX2\n" * 20
    assert good(moving + "M30", dialect).moves.feed[-1] == pytest.approx(100.0)
    for text in (start + "G1 X1", moving + "M5\nX9", start + "M3\nM5\nG1 X1"):
        assert bad(text, dialect).code == "feed-per-revolution"
