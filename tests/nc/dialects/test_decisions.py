"""Every decision and rule of the four dialects, with results worked out by hand."""

import math
from typing import Any

import numpy as np
import pytest

from tests.nc.running import MILL, Outcome, bad, good
from twin.nc.canonical import Axes, Corner, Dwell, Function, Shape
from twin.nc.control.settings import ToolData

# --- gost


@pytest.mark.parametrize(
    ("first", "second", "move"),
    [("720", "0", 0.0), ("1080.5", "-1", -1.5), ("-1439.999", "0", 359.999), ("721", "10", 9.0)],
)
def test_gost_recalculation_by_formula(first: str, second: str, move: float) -> None:
    outcome = good(f"G102 C360\nG1 C{first} F1200\nG1 C{second}", "gost")
    physical = float(first) + move
    assert outcome.position["C"] == pytest.approx(physical, abs=1e-9)
    assert outcome.display["C"] == pytest.approx(float(second), abs=1e-9)


def test_gost_without_recalculation_goes_back_all_the_way() -> None:
    assert good("G1 C721 F1200\nC10", "gost").delta(-1)["C"] == pytest.approx(-711.0)


def test_gost_rapid_is_not_recalculated_unless_the_machine_says_so() -> None:
    text = "G102 C360\nG1 C721 F1200\nG0 C10"
    assert good(text, "gost").delta(-1)["C"] == pytest.approx(-711.0)
    assert good(text, "gost", recalculate_on_rapid=True).delta(-1)["C"] == pytest.approx(9.0)


def test_gost_three_thirds_are_a_turn() -> None:
    outcome = good("G102 C360\nG91 G1 C120 F1200\nC120\nC120\nG90 C10", "gost")
    assert outcome.delta(-1)["C"] == pytest.approx(10.0, abs=1e-9)
    tenths = good("G102 C360\nG91 G1 F1200\n" + "C0.1\n" * 3600 + "G90 C10", "gost")
    assert tenths.delta(-1)["C"] == pytest.approx(10.0, abs=1e-9)


def test_gost_label_stays_when_recalculation_ends() -> None:
    outcome = good("G102 C360\nG1 C721 F1200\nC10\nG102 C0\nG0 C0", "gost")
    assert outcome.delta(-1)["C"] == pytest.approx(-10.0)
    assert outcome.position["C"] == pytest.approx(720.0)


def test_gost_increments_are_not_touched_and_linear_axes_move_along() -> None:
    outcome = good("G102 C360\nG1 C721 F1200\nG91 X10 C5", "gost")
    assert outcome.delta(-1) == pytest.approx({"X": 10.0, "Y": 0.0, "Z": 0.0, "C": 5.0})
    assert outcome.display["C"] == pytest.approx(6.0)
    assert outcome.moves.length[-1] == 10.0


def test_gost_block_without_the_axis_relabels_too() -> None:
    outcome = good("G102 C360\nG1 C721 F1200\nX10", "gost")
    assert outcome.display["C"] == pytest.approx(1.0)
    assert outcome.position["C"] == 721.0


def test_gost_several_periodic_axes() -> None:
    axes = Axes(("X", "Y", "Z", "A", "C"), ("linear", "linear", "linear", "rotary", "rotary"))
    outcome = good(
        "G102 C360\nG102 A180\nG1 A181 C721 F100\nA10 C10",
        "gost",
        axes=axes,
        periodic=frozenset({"A", "C"}),
    )
    assert outcome.delta(-1)["A"] == pytest.approx(9.0)
    assert outcome.delta(-1)["C"] == pytest.approx(9.0)


def test_gost_corners() -> None:
    moves = good("G1 X1 F100\nG61 X2\nX3\nG64 X4\nG9 X5\nX6\nG0 X7", "gost").moves
    stop, path = Corner.EXACT_STOP, Corner.EXACT_PATH
    assert moves.corner.tolist() == [path, stop, stop, path, stop, path, stop]


@pytest.mark.parametrize("line", ["$", "G1 X5 F100$", "G1 X5 F100 $ G1 X9", "$G1 X9\nG1 X5 F100"])
def test_gost_dollar_ends_a_block_anywhere(line: str) -> None:
    outcome = good(line, "gost")
    assert outcome.position["X"] in (0.0, 5.0)


# --- the base of ISO 6983-1


@pytest.mark.parametrize("dialect", ["gost", "mefi"])
def test_inches_planes_and_presets(dialect: str) -> None:
    outcome = good("G70 G1 X1 F10\nG71 X30\nG92 X0 Z5\nX1", dialect)
    assert outcome.end(0)["X"] == 25.4
    assert outcome.moves.feed[0] == 254.0
    assert outcome.position == pytest.approx({"X": 31.0, "Y": 0.0, "Z": 0.0, "C": 0.0})
    assert outcome.display == pytest.approx({"X": 1.0, "Y": 0.0, "Z": 5.0, "C": 0.0})


@pytest.mark.parametrize("dialect", ["gost", "mefi"])
@pytest.mark.parametrize(
    ("plane", "end", "center", "normal"),
    [
        ("G17", "X10 Y10 I10", [10.0, 0.0, 0.0], [0.0, 0.0, 1.0]),
        ("G18", "X10 Z10 I10", [10.0, 0.0, 0.0], [0.0, 1.0, 0.0]),
        ("G19", "Y10 Z10 J10", [0.0, 10.0, 0.0], [1.0, 0.0, 0.0]),
    ],
)
def test_quarter_arcs_in_every_plane(
    dialect: str, plane: str, end: str, center: list[float], normal: list[float]
) -> None:
    # Clockwise about the normal: G17 and G19 turn from the second axis to the first, which is a
    # quarter; in G18 the abscissa is Z, so that the way from X-10 to Z+10 is three quarters.
    moves = good(f"{plane} G2 {end} F100", dialect).moves
    assert moves.center[0] == pytest.approx(center, abs=1e-12)
    assert moves.normal[0].tolist() == normal
    assert moves.sweep[0] == pytest.approx(-270.0 if plane == "G18" else -90.0)


def test_negative_radius_is_the_larger_arc() -> None:
    small = good("G2 X10 Y10 R10 F100", "gost").moves
    large = good("G2 X10 Y10 R-10 F100", "gost").moves
    assert small.sweep[0] == pytest.approx(-90.0)
    assert large.sweep[0] == pytest.approx(-270.0)
    assert large.center[0].tolist() == pytest.approx([0.0, 10.0, 0.0])


def test_work_offsets_end_a_preset() -> None:
    outcome = good("G92 X100\nG55 G0 X1\nG54 X2", "gost", offsets={"G55": {"X": 10.0, "C": 90.0}})
    assert outcome.end(0)["X"] == 11.0
    assert outcome.end(1)["X"] == 2.0


def test_g53_counts_from_machine_zero() -> None:
    outcome = good("G0 Z5\nG53 Z0", "gost", machine_zero={"Z": 300.0})
    assert outcome.position["Z"] == 300.0


def test_dwell_function_and_their_places() -> None:
    outcome = good("S100\nM3\nG0 X1\nG4 P2.5\nM5 G0 X2\nT2\nM6\nM30\nG0 X9", "gost")
    assert outcome.position["X"] == 2.0
    found = [
        (event.before, event.seconds if isinstance(event, Dwell) else event.word)
        for event in outcome.events
    ]
    assert found == [(0, "S"), (0, "M3"), (1, 2.5), (2, "M5"), (2, "T2"), (2, "M6"), (2, "M30")]
    spindle = outcome.events[1]
    assert isinstance(spindle, Function)
    assert dict(spindle.arguments) == {"S": 100.0}


def test_tool_length_moves_z_by_the_difference() -> None:
    tools = {1: ToolData(5.0, 60.0), 2: ToolData(5.0, 72.5)}
    outcome = good("G43 H2 G0 Z10\nG49 Z10", "gost", tools=tools)
    assert outcome.end(0)["Z"] == 22.5
    assert outcome.end(1)["Z"] == 10.0


def test_drilling_returns_by_g98_and_g99() -> None:
    text = "G0 Z20\nG99 G81 X1 Z-5 R2 F100\nX2\nG98 X3\nG80 G0 X4"
    moves = good(text, "gost").moves
    heights = moves.end[moves.end[:, 0] > 0.0][:, 2].tolist()
    assert heights == [20.0, 2.0, -5.0, 2.0, 2.0, -5.0, 2.0, 2.0, -5.0, 20.0, 20.0]


def test_drilling_in_pecks_and_tapping() -> None:
    pecks = good("G0 Z5\nG83 X1 Z-5 R1 Q2.5 F100", "gost").moves
    assert pecks.end[pecks.motion == 1][:, 2].tolist() == [-1.5, -4.0, -5.0]
    tapping = good("S50 M3\nG0 Z5\nG84 X1 Z-5 R1 P1 F100", "gost")
    words = [event.word for event in tapping.events if isinstance(event, Function)]
    assert words == ["M3", "M4", "M3"]


def test_feed_per_revolution() -> None:
    assert good("G95 S200 M3 G1 X1 F0.5", "gost").moves.feed.tolist() == [100.0]


def test_a_feed_per_revolution_behind_a_tool_change_needs_the_spindle_started_anew() -> None:
    turning = "G95 S200 M3 F0.5\nT1 M6\n"
    assert bad(f"{turning}G1 X1", "gost").code == "feed-per-revolution"
    assert good(f"{turning}M3 G1 X1", "gost").moves.feed.tolist() == [100.0]


def test_default_feeds_warn_once_and_strict_refuses() -> None:
    outcome = good("G1 X1\nC5\nX2", "gost", default_feed=700.0, default_rotary_feed=90.0)
    assert outcome.moves.feed.tolist() == [700.0, 90.0, 700.0]
    assert outcome.codes == ["no-feed"]
    assert bad("G1 X1", "gost", strict=True).code == "no-feed"


def test_block_skip() -> None:
    assert good("/G0 X5", "gost").position["X"] == 5.0
    assert good("/G0 X5", "gost", block_skip=True).position["X"] == 0.0


# --- mefi


def test_mefi_lead_goes_up_for_both_senses_and_scales_with_the_sweep() -> None:
    text = "Z4 G10\nG09 G{0} X0 Y0 I10 F100\nG{0} X20 I10"
    for code, quarter in (("02", -1.0), ("03", -1.0)):
        outcome = good(text.format(code), "mefi")
        assert outcome.end(0)["Z"] == pytest.approx(4.0)
        assert outcome.end(1)["Z"] == pytest.approx(6.0)
        assert abs(outcome.moves.sweep[1]) == 180.0 * -quarter


def test_mefi_leads_of_several_axes_and_of_c() -> None:
    outcome = good("Z-2 C90 G10\nG09 G03 X0 Y0 J5 F100", "mefi")
    assert outcome.position == pytest.approx({"X": 0.0, "Y": 0.0, "Z": -2.0, "C": 90.0})


@pytest.mark.parametrize(
    ("plane", "dragged", "center"), [("G17", "Z", "I5"), ("G18", "Y", "K5"), ("G19", "X", "J5")]
)
def test_mefi_helix_in_every_plane(plane: str, dragged: str, center: str) -> None:
    outcome = good(f"{plane} {dragged}3 G10\nG09 G02 {center} F100", "mefi")
    assert outcome.position[dragged] == pytest.approx(3.0)


def test_mefi_straight_blocks_are_not_dragged_and_the_lead_stays() -> None:
    text = "Z1 G10\nG09 G02 X0 Y0 I5 F100\nG01 X5\nG98\nG02 X5 Y0 I5\nG09 G02 X5 Y0 I5"
    outcome = good(text, "mefi")
    assert outcome.moves.end[:, 2].tolist() == pytest.approx([1.0, 1.0, 1.0, 2.0])


def test_mefi_nested_repeats_start_anew() -> None:
    # The inner block runs 3 times in each of the 2 runs of the outer loop.
    text = "N1 G91 G00 X1\nN2 Y1 G73 L2 Q2\nN3 X1 G73 L1 Q1"
    outcome = good(text, "mefi")
    assert outcome.position["Y"] == 6.0
    assert outcome.position["X"] == 4.0


def test_mefi_forward_jump_and_missing_count() -> None:
    outcome = good("N1 G91 G00 X1 G73 L3\nN2 Y5\nN3 Z1", "mefi")
    # N1 jumps once to N3, so that N2 is left out; nothing leads back to N1.
    assert outcome.position == pytest.approx({"X": 1.0, "Y": 0.0, "Z": 1.0, "C": 0.0})


# --- codesys


def test_codesys_centre_within_ten_per_cent_is_projected() -> None:
    outcome = good("N10 G2 X100 I49 J0 F10", "codesys")
    assert outcome.codes == ["arc-center-corrected"]
    assert outcome.moves.center[0].tolist() == [50.0, 0.0, 0.0]
    exact = good("N10 G2 X100 I50 J3 F10", "codesys")
    assert exact.codes == []
    assert exact.moves.center[0].tolist() == [50.0, 3.0, 0.0]


@pytest.mark.parametrize("words", ["I40 J0", "R49.9", "I0 J0", ""])
def test_codesys_contradicting_arcs_become_lines(words: str) -> None:
    outcome = good(f"N10 G2 X100 {words} F10", "codesys")
    assert outcome.codes == ["arc-replaced"]
    assert outcome.moves.shape.tolist() == [Shape.LINE]
    assert outcome.position["X"] == 100.0


def test_codesys_ten_per_cent_is_the_limit() -> None:
    # r_s = 50 - d, r_e = 50 + d; 2 d <= 0.1 (50 + d) holds up to d = 5 / 1.9 = 2.63.
    assert good("N10 G2 X100 I47.4 J0 F10", "codesys").codes == ["arc-center-corrected"]
    assert good("N10 G2 X100 I47.3 J0 F10", "codesys").codes == ["arc-replaced"]


def test_codesys_radius_takes_the_smaller_arc_whatever_its_sign() -> None:
    for radius in ("R60", "R-60"):
        sweep = good(f"N10 G2 X100 {radius} F10", "codesys").moves.sweep[0]
        assert sweep == pytest.approx(-2.0 * math.degrees(math.asin(50.0 / 60.0)))


def test_codesys_full_circle_by_centre() -> None:
    moves = good("N10 G3 X0 Y0 I50 F10", "codesys").moves
    assert moves.sweep.tolist() == [360.0]


def test_codesys_opening_angle_wins_over_a_target() -> None:
    outcome = good("N10 G2 X7 Y7 I50 J0 T90 F10", "codesys")
    assert outcome.codes == ["arc-opening-wins"]
    assert outcome.position["X"] == pytest.approx(50.0)
    assert outcome.position["Y"] == pytest.approx(50.0)


def test_codesys_opening_angle_with_z_is_a_helix() -> None:
    moves = good("N10 G3 I-20 J0 T810 Z9 F10", "codesys").moves
    assert moves.sweep.tolist() == [810.0]
    assert moves.end[0, :3] == pytest.approx([-20.0, 20.0, 9.0])
    assert moves.length[0] == pytest.approx(math.hypot(math.radians(810.0) * 20.0, 9.0))


def test_codesys_any_plane() -> None:
    # The normal +X+Z over the square root of 2; a full circle about a centre in that plane.
    moves = good("N10 G16 I1 J0 K1 N20 G3 I10 J0 K-10 T360 F10", "codesys").moves
    half = math.sqrt(0.5)
    assert moves.normal[0] == pytest.approx([half, 0.0, half])
    assert moves.radius[0] == pytest.approx(10.0 * math.sqrt(2.0))
    assert moves.sweep.tolist() == [360.0]


def test_codesys_feed_per_second_and_accelerations() -> None:
    moves = good(
        "N10 G1 X10 F1 E10 E-20 N20 C90 N30 G0 X0 N40 G0 FF5 X1 N50 G0 FF0 X2", "codesys"
    ).moves
    assert moves.feed[:2].tolist() == [60.0, 60.0]
    assert moves.feed[2:].tolist() == [60.0, 300.0, 60.0]
    assert np.isnan(good("N10 G0 X1", "codesys").moves.feed[0])
    assert moves.acceleration[0] == 10.0
    assert moves.deceleration[0] == 20.0


def test_codesys_axis_limits_slow_the_path_down() -> None:
    # Along 3-4-5 the axis X takes 0.6 of the speed: 3 mm/s in X are 5 mm/s along the path.
    moves = good("N10 G1 X30 Y40 F100 FX3 EX6 N20 G1 Y100", "codesys").moves
    assert moves.feed.tolist() == [300.0, 6000.0]
    assert moves.acceleration[0] == 10.0
    assert np.isnan(moves.acceleration[1])


def test_codesys_modulo_axis_takes_the_shortest_way() -> None:
    outcome = good("N10 PC360 N20 G1 C270 F10 N30 C45 N40 C225", "codesys")
    assert outcome.moves.end[:, 3].tolist() == [-90.0, 45.0, 225.0]
    assert outcome.display["C"] == 225.0


def test_codesys_shifts_and_positions() -> None:
    outcome = good(
        "N10 G92 X10 N20 G1 X11 F1 N30 G54 X100 N40 X0 N50 G55 X5 Y1 N60 X0 Y0 N70 G53 "
        "N80 G56 X50 N90 X51",
        "codesys",
    )
    assert outcome.moves.start[0, 0] == 10.0
    assert outcome.moves.end[:, 0].tolist() == [11.0, 100.0, 105.0, 106.0]
    assert outcome.end(2)["Y"] == 1.0


def test_codesys_loops_count_backwards_by_the_internal_variable() -> None:
    text = "N10 G36 D3\nN20 G91 G1 X1 F1\nN30 G37 D-1\nN40 G20 L20"
    assert good(text, "codesys").position["X"] == 3.0


def test_codesys_bare_jump_jumps_before_g36() -> None:
    assert good("N10 G20 L30\nN20 G1 X5 F1\nN30 G1 Y5 F1", "codesys").position["X"] == 0.0


def test_codesys_labels_lie_ahead_or_end_the_program() -> None:
    text = "N10 G20 L?4 N20 G1 X5 F1 N30 L!4 N40 G1 Y5 F1"
    assert good(text, "codesys").position == {"X": 0.0, "Y": 5.0, "Z": 0.0, "C": 0.0}
    lost = good("N10 G1 X1 F1 N20 G20 L?5 N30 X2", "codesys")
    assert lost.codes == ["label-not-found"]
    assert lost.position["X"] == 1.0


def test_codesys_application_variables_come_from_the_job() -> None:
    text = "N10 G1 X$g_x$ Y(2+3)*2 Z-SQRT(16) F10 (a comment)"
    outcome = good(text, "codesys", variables={"g_x": 7.0})
    assert outcome.position == {"X": 7.0, "Y": 10.0, "Z": -4.0, "C": 0.0}


def test_codesys_subprograms_restore_what_they_say() -> None:
    body = "\nN1 G91 X#a\nN2 Y#b\nEND_SUBPROGRAM"
    main = "N10 G1 F1\nSTEP{1, 2}\nN20 X1 Y1\nN30 G20 L99\n"
    end = "\nN99 G75"
    restored = good(
        main + "SUBPROGRAM STEP{#a : LREAL, #b : LREAL} RESTORE" + body + end, "codesys"
    )
    kept = good(main + "SUBPROGRAM STEP{#a : LREAL, #b : LREAL}" + body + end, "codesys")
    assert (restored.position["X"], restored.position["Y"]) == (1.0, 1.0)
    assert (kept.position["X"], kept.position["Y"]) == (2.0, 3.0)


def test_codesys_switch_points_lie_on_the_path() -> None:
    outcome = good("N10 G1 X10 F10 H1 O0.25 H-2 L8 H3 L-1", "codesys")
    found = [(e.word, dict(e.arguments), e.at) for e in outcome.events if isinstance(e, Function)]
    assert found == [("H1", {"on": 1.0}, 0.25), ("H2", {"on": 0.0}, 0.8), ("H3", {"on": 1.0}, 0.9)]


def test_codesys_m_carries_its_words() -> None:
    outcome = good("N10 M77 K1.5 L2 O3", "codesys")
    (event,) = outcome.events
    assert isinstance(event, Function)
    assert (event.word, dict(event.arguments)) == ("M77", {"K": 1.5, "L": 2.0, "O": 3.0})


def test_codesys_parabola_and_ellipse_keep_to_their_curves() -> None:
    parabola = good("N10 G6 X20 Y0 I10 J10 F10", "codesys").moves.end
    np.testing.assert_allclose(
        parabola[:, 1], parabola[:, 0] * (20 - parabola[:, 0]) / 10, atol=1e-9
    )
    ellipse = good("N10 G0 X30 N20 G9 X-30 I-30 J0 K0 R0.5 F10", "codesys").moves
    cut = ellipse.end[1:]
    np.testing.assert_allclose((cut[:, 0] / 30) ** 2 + (cut[:, 1] / 15) ** 2, 1.0, atol=1e-9)
    assert cut[:, 1].max() == pytest.approx(15.0, abs=1e-2)
    middles = (ellipse.start[1:] + ellipse.end[1:]) / 2
    inside = np.sqrt((middles[:, 0] / 30) ** 2 + (middles[:, 1] / 15) ** 2)
    assert (1.0 - inside).max() * 30.0 < 2e-3


# --- fagor8070


def fagor(text: str, **changes: Any) -> Outcome:
    return good(f"{text}\nM30", "fagor8070", **changes)


def test_fagor_start_state_moves_by_g01_in_g90() -> None:
    outcome = fagor("X10 F100\nX5")
    assert outcome.moves.motion.tolist() == [1, 1]
    assert outcome.position["X"] == 5.0


def test_fagor_omitted_words_after_a_cartesian_move_and_g30() -> None:
    # After the Cartesian move R is 5 about (0, 0); after G30 it is seen from (3, 0).
    outcome = fagor("G00 R50 Q90\nX3 Y4\nQ0\nX3 Y4\nG30 I3 J0\nQ0")
    assert outcome.end(2)["X"] == pytest.approx(5.0)
    assert outcome.position["X"] == pytest.approx(7.0)
    assert outcome.position["Y"] == pytest.approx(0.0)


def test_fagor_angles_count_modulo_360() -> None:
    for text in ("Q60", "Q420", "Q-300"):
        outcome = fagor(f"G00 R10 Q0\n{text}")
        assert outcome.position["X"] == pytest.approx(5.0)


def test_fagor_radius_zero_only_for_lines() -> None:
    assert fagor("G00 R5 Q0\nG01 R0 Q90 F100").position["X"] == 0.0
    assert bad("G00 R5 Q0\nG03 R0 Q90 F100", "fagor8070").code == "polar-radius"


def test_fagor_incremental_words() -> None:
    outcome = fagor("G00 X10 Y10\nX5I Y1=3\nG91 X1\nG90 R20 Q0\nR-5I Q90I")
    assert outcome.end(1) == pytest.approx({"X": 15.0, "Y": 3.0, "Z": 0.0, "C": 0.0})
    assert outcome.end(2)["X"] == 16.0
    assert outcome.position["Y"] == pytest.approx(15.0)


def test_fagor_axes_by_number_take_computed_values() -> None:
    outcome = good("P1=10\nG1 X1=P1 Y1=[P1/2] F100\nX1=[P1]I Y = -P1\nM30", "fagor8070")
    assert outcome.moves.end[:, :2].tolist() == [[10.0, 5.0], [20.0, -10.0]]


def test_fagor_pole_follows_current_position_and_plane() -> None:
    outcome = fagor("G00 X10 Y10\nG30\nR5 Q90\nG18\nR5 Q90\nG17 R5 Q0")
    assert outcome.end(1) == pytest.approx({"X": 10.0, "Y": 15.0, "Z": 0.0, "C": 0.0})
    # G18: abscissa Z, ordinate X, and the origin is part zero again.
    assert outcome.end(2) == pytest.approx({"X": 5.0, "Y": 15.0, "Z": 0.0, "C": 0.0})
    assert outcome.end(3) == pytest.approx({"X": 5.0, "Y": 0.0, "Z": 0.0, "C": 0.0})


def test_fagor_arc_forms_of_the_same_quarter() -> None:
    forms = [
        "G03 X0 Y10 I-10 J0", "G03 X0 Y10 I-10", "G03 X0 Y10 R10", "G03 X0 Y10 R1=10",
        "G263=10\nG03 X0 Y10", "G06 G03 X0 Y10 I0 J0", "G261\nG03 X0 Y10 I0 J0", "G03 R10 Q90",
        "G03 Q90", "G91 G03 X-10 Y10 I-10", "G91 G03 Q90", "G31 G03 Q90 I-10",
        "G91 G31 G03 Q90 I-10", "G09 X0 Y10 I6 J8", "G91 G09 X-10 Y10 I-4 J8",
        "G01 Y-1 F100\nY0\nG08 X0 Y10",
    ]  # fmt: skip
    for form in forms:
        moves = fagor(f"G00 X10 Y0\nF100\n{form}").moves
        assert moves.sweep[-1] == pytest.approx(90.0), form
        assert moves.center[-1] == pytest.approx([0.0, 0.0, 0.0], abs=1e-9), form
        assert moves.end[-1] == pytest.approx([0.0, 10.0, 0.0, 0.0], abs=1e-9), form


def test_fagor_chord_by_coordinate_and_angle() -> None:
    assert fagor("X10 Q45 F100").position["Y"] == pytest.approx(10.0)
    assert fagor("Y10 Q30 F100").position["X"] == pytest.approx(10.0 * math.sqrt(3.0))
    arc = fagor("G02 X10 Q0 R5 F100").moves
    assert arc.sweep[0] == pytest.approx(-180.0)


def test_fagor_helix_by_pitch_alone() -> None:
    outcome = fagor("G02 I50 J0 Z100 K37 F100", start={"X": -50.0})
    assert outcome.position["X"] == pytest.approx(14.6411, abs=1e-4)
    assert outcome.position["Y"] == pytest.approx(-47.8083, abs=1e-4)
    assert outcome.moves.sweep[0] == pytest.approx(-360.0 * 100.0 / 37.0)


def test_fagor_helix_end_point_wins_over_the_pitch() -> None:
    # Half a turn and whole ones: 4.4 turns by the pitch are nearest to 4.5.
    outcome = fagor("G03 X-50 Y0 I-50 J0 Z44 K10 F100", start={"X": 50.0})
    assert outcome.codes == ["helix-pitch"]
    assert outcome.moves.sweep[0] == pytest.approx(4.5 * 360.0)
    down = fagor("G03 X50 Y0 I-50 J0 Z-90 K45 F100", start={"X": 50.0})
    assert down.codes == []
    assert down.moves.sweep[0] == pytest.approx(720.0)


def test_fagor_full_circle_where_end_is_start() -> None:
    assert fagor("G02 X0 Y0 I10 F100").moves.sweep.tolist() == [-360.0]
    assert fagor("G02 I10 F100").moves.sweep.tolist() == [-360.0]


def test_fagor_corners() -> None:
    moves = fagor("F100\nX1\nG05 X2\nG60 X3\nX4\nG07 X5\nG61 X6\nG50 X7").moves
    stop, path, round_ = Corner.EXACT_STOP, Corner.EXACT_PATH, Corner.CONTINUOUS
    assert moves.corner.tolist() == [path, round_, stop, round_, stop, round_, path]


def test_fagor_feed_modes() -> None:
    moves = fagor("G93 F2 X10\nG94 F50 X20\nG95 S100 M3 F0.2 X30").moves
    assert moves.feed.tolist() == pytest.approx([300.0, 50.0, 20.0])


def test_fagor_mirror_scale_rotation() -> None:
    outcome = fagor("G00 G11 X10 Y5\nG10 G72 S2\nX10\nG72\nG73 Q90 I10 J0\nX20 Y0\nG73")
    assert outcome.end(0) == pytest.approx({"X": -10.0, "Y": 5.0, "Z": 0.0, "C": 0.0})
    assert outcome.end(1)["X"] == 20.0
    assert outcome.end(2) == pytest.approx({"X": 10.0, "Y": 10.0, "Z": 0.0, "C": 0.0})


def test_fagor_a_mirror_turns_arcs_round() -> None:
    moves = fagor("G11\nG00 X10\nG03 X0 Y10 I-10 F100").moves
    assert moves.sweep[-1] == pytest.approx(-90.0)
    assert moves.end[-1] == pytest.approx([0.0, 10.0, 0.0, 0.0], abs=1e-9)


def test_fagor_offsets() -> None:
    offsets = {"G54": {"X": 100.0}, "G159=7": {"Y": 3.0}}
    outcome = fagor("G00 G54 X1\nG159=7 Y1\nG158 Y10\nY1\nG158\nG92 X0 Y0\nX1 Y1", offsets=offsets)
    assert outcome.end(0)["X"] == 101.0
    assert outcome.end(1)["Y"] == 4.0
    assert outcome.end(2)["Y"] == 14.0
    assert outcome.position["Y"] == 15.0


def test_fagor_any_plane_turns_from_abscissa_to_ordinate() -> None:
    moves = fagor("G20 Y1 X2\nG00 Y10\nG03 Y0 X10 I-10 F100").moves
    assert moves.normal[-1].tolist() == [0.0, 0.0, -1.0]
    assert moves.sweep[-1] == pytest.approx(90.0)


@pytest.mark.parametrize(
    ("target", "end"), [("C90", 90.0), ("C-90", -270.0), ("C0", 0.0), ("C350", 350.0)]
)
def test_fagor_module_axis_turns_by_its_sign(target: str, end: float) -> None:
    outcome = fagor(f"G00 {target}", module_rotary=True)
    assert outcome.position["C"] == pytest.approx(end)
    assert fagor(f"G00 {target}").position["C"] == float(target[1:])


def test_fagor_module_axis_goes_on_from_where_it_is() -> None:
    outcome = fagor("G00 C350\nC10\nC-350\nG91 C720", module_rotary=True)
    assert outcome.moves.end[:, 3].tolist() == pytest.approx([350.0, 370.0, 350.0, 1070.0])


def test_fagor_parameters_and_functions() -> None:
    outcome = fagor("P1=3 P2=4\nP100=SQRT[P1*P1+P2**2]\nP[P1+2]=-P100\nG00 XP100 YP5 Z[ARG[1,1]/9]")
    assert outcome.position == pytest.approx({"X": 5.0, "Y": -5.0, "Z": 5.0, "C": 0.0})


def test_fagor_flow() -> None:
    text = (
        "P1=0 P2=0\n$FOR P1=1,5,1\n$IF P1==2\n$CONTINUE\n$ENDIF\n$IF P1==5\n$BREAK\n$ENDIF\n"
        "P2=P2+P1\n$ENDFOR\n$DO\nP2-=1\n$ENDDO P2>6\n$SWITCH P2\n$CASE 1\nG00 X1\n$BREAK\n$CASE 6\n"
        "G00 X6\n$BREAK\n$ENDSWITCH\n$IF P2<>6 $GOTO N9\nN9 Y1"
    ).replace("<>", "!=")
    # 1 + 3 + 4 = 8, counted down to 6.
    assert fagor(f"G00\n{text}").position["X"] == 6.0


def test_fagor_subroutines_have_their_own_parameters() -> None:
    text = (
        "%L STEP\nG91 X[P0] Y[P1]\nG90\nP0=99\nM17\n%MAIN\nP0=1\nG00 X0\n#PCALL STEP A5 B6\n"
        "X[P0]I\n#MCALL STEP A1 B1\nX0\n#MDOFF\nX0 Y0 Z7"
    )
    outcome = fagor(text)
    assert outcome.end(0) == pytest.approx({"X": 5.0, "Y": 6.0, "Z": 0.0, "C": 0.0})
    assert outcome.end(1)["X"] == 6.0
    assert outcome.moves.end[:, 0].tolist() == pytest.approx([5.0, 6.0, 0.0, 1.0, 0.0])


def test_fagor_repeats() -> None:
    text = "G91 G00\nN10 X1\nN15 Y1\nN20\n#RPT[N10,N20,3]\nZ1 NR4"
    assert fagor(text).position == pytest.approx({"X": 4.0, "Y": 4.0, "Z": 4.0, "C": 0.0})


def test_fagor_comments_do_not_act() -> None:
    text = "G00 X1 (X2) ;X3\n#COMMENT BEGIN\nX9 nonsense\n#COMMENT END\nY1"
    outcome = fagor(text)
    assert outcome.position == {"X": 1.0, "Y": 1.0, "Z": 0.0, "C": 0.0}


def test_fagor_missing_end_warns() -> None:
    assert good("G00 X1", "fagor8070").codes == ["no-end"]


def test_fagor_g137_extends_corners_and_g136_rounds_them() -> None:
    tools = {1: ToolData(2.0, 60.0)}
    text = "G138 G42 G01 X10 F100\nX20\nY10\nG40 Y20"
    square = fagor(text, tools=tools).moves
    assert square.end[:, :2].tolist() == [[10.0, -2.0], [22.0, -2.0], [22.0, 10.0], [20.0, 20.0]]
    rounded = fagor("G136\n" + text, tools=tools).moves
    assert rounded.shape.tolist() == [0, 0, 1, 0, 0]


def test_mill_has_the_axes_of_these_tests() -> None:
    assert MILL.names == ("X", "Y", "Z", "C")


def test_codesys_slopes_of_additional_axes_are_refused() -> None:
    error = bad("N10 G1 X100 C100 W1.5 F10", "codesys")
    assert (error.code, error.column, error.width) == ("unsupported-word", 18, 4)


def test_fagor_exist_tells_whether_a_parameter_has_a_value() -> None:
    text = "P1=3\n$IF EXIST[P1]==1\nG00 X1\n$ENDIF\n$IF EXIST[P2]==1\nY1\n$ENDIF"
    assert fagor(text).position == {"X": 1.0, "Y": 0.0, "Z": 0.0, "C": 0.0}


@pytest.mark.parametrize(
    ("text", "code"),
    [
        ("G53 G00 R5 Q0", "polar-origin"),
        ("G31\nG01 X1 F100", "temporary-origin"),
        ("G93 I5 J5", "polar-origin"),
        ("%PART,MX,\nG00 X1", "heading"),
        ("N10 G01 X1 F100\nN20 Y1\n#RPT[N10,N20,2]", "repeat-range"),
    ],
)
def test_fagor_refuses_what_the_error_list_refuses(text: str, code: str) -> None:
    assert bad(f"{text}\nM30", "fagor8070", machine_zero={"Z": 300.0}).code == code


def test_codesys_rapids_have_accelerations_of_their_own() -> None:
    moves = good("N10 G0 X1 E5 E-6 EF7 EF-8 N20 G1 X2 F1 N30 G0 X3 EF0", "codesys").moves
    assert moves.acceleration.tolist() == [7.0, 5.0, 5.0]
    assert moves.deceleration.tolist() == [8.0, 6.0, 6.0]


def test_prose_behind_a_block_is_left_out_with_a_warning() -> None:
    outcome = good("N10 G1 X10 F10 first straight line N20 Y5", "codesys")
    assert outcome.codes == ["trailing-prose"]
    assert (outcome.position["X"], outcome.position["Y"]) == (10.0, 5.0)
