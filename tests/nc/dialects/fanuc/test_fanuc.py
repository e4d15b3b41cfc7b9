"""Rules of Fanuc and Haas controls, with results worked out by hand."""

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from tests.nc.running import WITH_TABLES, bad, good
from twin.nc.canonical import Dwell, Event, Function, Shape
from twin.nc.control.settings import ToolData
from twin.nc.dialects import dialect_named
from twin.nc.text.source import read_source

ZERO = {"X": 0.0, "Y": 0.0, "Z": 0.0}


def ends(text: str, dialect: str = "fanuc", **changes: Any) -> list[tuple[float, float, float]]:
    """Where each move ends, X, Y and Z rounded to a nanometre."""
    moves = good(f"O1\n{text}\nM30", dialect, **changes).moves
    return [(round(x, 6) + 0.0, round(y, 6) + 0.0, round(z, 6) + 0.0) for x, y, z, _ in moves.end]


# --- the decimal point


@pytest.mark.parametrize(
    ("word", "increments", "calculator"),
    [("X10", 0.01, 10.0), ("X10.", 10.0, 10.0), ("X.5", 0.5, 0.5), ("X0", 0.0, 0.0)],
)
def test_a_number_without_a_point_counts_increments_unless_the_job_says_otherwise(
    word: str, increments: float, calculator: float
) -> None:
    for setting, value in (
        (None, increments),
        ("increments", increments),
        ("calculator", calculator),
    ):
        outcome = good(f"O1\nG0 {word}\nM30", "fanuc", decimal_point=setting)
        assert outcome.position["X"] == value
        assert ("decimal-point" in outcome.codes) == (value == 0.01)


def test_increments_of_angles_inches_and_radii() -> None:
    assert good("O1\nG0 C90000\nM30", "fanuc").position["C"] == pytest.approx(90.0)
    assert good("O1\nG20 G0 X10000\nM30", "fanuc").position["X"] == pytest.approx(25.4)
    arc = good("O1\nG0 X10.\nG2 X0. Y10. R10000 F100.\nM30", "fanuc").moves
    assert arc.radius[-1] == pytest.approx(10.0)


@pytest.mark.parametrize(
    ("text", "seconds"), [("G4 P1500", 1.5), ("G4 X1.5", 1.5), ("G4 X500", 0.5)]
)
def test_a_dwell_counts_milliseconds_without_a_point(text: str, seconds: float) -> None:
    (dwell,) = good(f"O1\n{text}\nM30", "fanuc").events[:1]
    assert isinstance(dwell, Dwell)
    assert dwell.seconds == pytest.approx(seconds)


def test_feeds_without_a_point() -> None:
    assert good("O1\nG1 X10. F300\nM30", "fanuc").moves.feed[0] == 300.0
    inch = good("O1\nG20 G1 X1. F1000\nM30", "fanuc").moves.feed[0]
    assert inch == pytest.approx(254.0)


# --- programs


def test_subprograms_by_both_forms_of_m98() -> None:
    sub = "M30\nO2000\nG91 G0 X1.\nG90\nM99"
    assert good(f"O1\nM98 P2000 L3\n{sub}", "fanuc").position["X"] == 3.0
    assert good(f"O1\nM98 P00032000\n{sub}", "fanuc").position["X"] == 3.0
    assert good(f"O1\nM98 P2000\n{sub}", "fanuc").position["X"] == 1.0


def test_m99_with_p_returns_to_a_block_of_the_caller() -> None:
    text = "O1\nN10 M98 P2\nG0 X5.\nN30 G0 Y7.\nM30\nO2\nN30 G0 Z1.\nM99 P30"
    assert good(text, "fanuc").position == pytest.approx({"X": 0.0, "Y": 7.0, "Z": 1.0, "C": 0.0})


def test_labels_belong_to_their_program() -> None:
    text = "O1\nM98 P2\nM99 P90\nN80 G0 X1.\nN90 M30\nO2\nN90 G0 Y1.\nM99"
    assert good(text, "fanuc").position["X"] == 0.0


def test_subprograms_are_read_from_files_beside_the_program(tmp_path: Path) -> None:
    (tmp_path / "main.nc").write_text("%\nO1\nM98 P2000\nM98 P30\nM30\n%\n")
    (tmp_path / "O2000.nc").write_text("%\nO2000 (SUB)\nG91 G0 X1.\nG90\nM99\n%\n")
    (tmp_path / "0030.NC").write_text("G0 Y4.\nM99\n")
    fanuc = dialect_named("fanuc")
    assert fanuc.library is not None
    source = fanuc.library(read_source(tmp_path / "main.nc"), tmp_path, fanuc)
    outcome = good(source.text, "fanuc")
    assert (outcome.position["X"], outcome.position["Y"]) == (1.0, 4.0)


def test_programs_are_called_by_name_in_the_file_and_beside_it(tmp_path: Path) -> None:
    main = "%\nO<MAIN>\nM98 <pocket_1> L3\nG65<RIM-2.B>A5.\nM98 P7\nM98 <O30>\nM30\nO<POCKET_1>\nG91 G0 X1.\nG90\nM99\n"
    (tmp_path / "main.nc").write_text(main)
    (tmp_path / "Rim-2.b.nc").write_text("%\nO<Rim-2.b> (SUB)\nG0 Y#1\nM98 <LIFT>\nM99\n%\n")
    (tmp_path / "lift.tap").write_text("G0 Z2.\nM99\n")
    (tmp_path / "O0007.nc").write_text("G91 G0 X10.\nG90\nM99\n")
    (tmp_path / "O30.nc").write_text("G91 G0 X20.\nG90\nM99\n")
    fanuc = dialect_named("fanuc")
    assert fanuc.library is not None
    source = fanuc.library(read_source(tmp_path / "main.nc"), tmp_path, fanuc)
    assert good(source.text, "fanuc").position == pytest.approx(
        {"X": 33.0, "Y": 5.0, "Z": 2.0, "C": 0.0}
    )


@pytest.mark.parametrize(
    ("text", "code"),
    [
        ("O<A>\nM98 <>\nM30", "call-values"),
        (f"O<A>\nM98 <{'B' * 33}>\nM30", "call-values"),
        ("O<A>\nG65 <A/B>\nM30", "call-values"),
        ("O<A B>\nM30", "call-values"),
        ("O<A>\nM98 <B>\nM30", "unknown-subprogram"),
        ("O<A>\nG66 <B> Z1.\nM30", "unknown-subprogram"),
        ("O<A>\nM98 <B\nM30", "unreadable"),
        ("O<A>\nM98 <B> <B>\nM30\nO<B>\nM99", "duplicate-word"),
        ("O<A>\nG0 X1. <B>\nM30", "unused-word"),
        ("O<A>\nG0 X1.\nO<B>\nM99", "program-end"),
        ("O<A>\nO<A>\nM30", "program-end"),
        ("O<A> G0 X1.\nM30", "program-end"),
    ],
)
def test_names_of_programs_are_refused(text: str, code: str) -> None:
    assert bad(text, "fanuc").code == code


def test_a_haas_has_names_of_programs_and_no_calls_by_them() -> None:
    assert good("O<PLATE>\nG0 X1.\nM30", "haas").position["X"] == 1.0
    assert bad("O1\nM98 <SUB>\nM30\nO<SUB>\nM99", "haas").code == "unreadable"


def test_the_number_of_a_program_with_a_name_is_0() -> None:
    assert good("O<A>\nG0 X[#4115+1.]\nM30", "fanuc").position["X"] == 1.0


def test_blocks_are_skipped_by_their_number() -> None:
    text = "O1\n/G0 X1.\n/2 G0 Y1.\n/3 G0 Z1.\nM30"
    assert good(text, "fanuc", block_skip=True).position == pytest.approx({**ZERO, "C": 0.0})
    outcome = good(text, "fanuc", block_skip_levels=frozenset({1, 3}))
    assert outcome.position == pytest.approx({**ZERO, "Y": 1.0, "C": 0.0})


def test_a_block_is_skipped_behind_its_number_which_stays_a_target() -> None:
    text = "O1\nGOTO 7\nG0 X9.\nN7/X5.\nN8 /2 Y1.\nG0 Z1.\nM30"
    assert good(text, "fanuc").position == pytest.approx({"X": 5.0, "Y": 1.0, "Z": 1.0, "C": 0.0})
    skipped = good(text, "fanuc", block_skip_levels=frozenset({2})).position
    assert skipped == pytest.approx({"X": 5.0, "Y": 0.0, "Z": 1.0, "C": 0.0})


# --- offsets and reference points


def test_g92_and_g52_hold_in_every_work_offset() -> None:
    offsets = {"G54": {"X": 100.0}, "G55": {"X": 200.0}}
    assert ends("G92 X0.\nG0 X1.\nG55 X1.", offsets=offsets, start={"X": 110.0}) == [
        (111.0, 0.0, 0.0),
        (211.0, 0.0, 0.0),
    ]
    assert ends("G52 X5.\nG0 X1.\nG55 X1.", offsets=offsets)[-1] == (206.0, 0.0, 0.0)


def test_g54_is_in_force_when_the_program_starts() -> None:
    assert ends("G0 X1.", offsets={"G54": {"X": 10.0}}) == [(11.0, 0.0, 0.0)]


HOME = {"X": -50.0, "Y": 0.0, "Z": 200.0}
LONGER = {1: ToolData(5.0, 60.0), 2: ToolData(5.0, 85.0)}


def heights(text: str, dialect: str = "fanuc", **changes: Any) -> list[float]:
    """Where Z ends in each move, with a tool 25 mm longer than the first."""
    outcome = good(f"O1\n{text}\nM30", dialect, machine_zero=HOME, tools=LONGER, **changes)
    return [float(end[2]) for end in outcome.moves.end]


def test_g28_goes_by_its_point_and_cancels_the_length() -> None:
    made = ends(
        "G0 X10. Z5.\nG43 Z10. H2\nG91 G28 X2. Z1.\nG90 G0 Z10.", machine_zero=HOME, tools=LONGER
    )
    assert made == [
        (10.0, 0.0, 5.0),
        (10.0, 0.0, 35.0),
        (12.0, 0.0, 36.0),
        (-50.0, 0.0, 200.0),
        (-50.0, 0.0, 10.0),
    ]


def test_a_cancelled_length_comes_back_by_g43_or_h_or_a_parameter() -> None:
    for home in ("G91 G28 Z0", "G91 G30 P2 Z0", "G53 Z0"):
        start = f"G43 Z10. H2\n{home}\nG90 G0"
        assert heights(f"{start} Z10.") == [35.0, 200.0, 10.0]
        assert heights(f"{start} G43 H2 Z10.") == [35.0, 200.0, 35.0]
        assert heights(f"{start} H2 Z10.") == [35.0, 200.0, 35.0]
        assert heights(f"{start} Z10.", length_returns="next block") == [35.0, 200.0, 35.0]


def test_g28_without_z_cancels_a_length_on_a_haas_alone() -> None:
    text = "G43 Z10. H2\nG91 G28 X0\nG90 G0 Z10."
    assert heights(text) == [35.0, 35.0]
    assert heights(text, "haas") == [35.0, 35.0, 10.0]
    assert heights("G43 Z10. H2\nG53 Z0\nG0 Z10.", "haas") == [35.0, 200.0, 35.0]


def test_g53_of_a_fanuc_is_rapid_and_of_a_haas_follows_the_motion_code() -> None:
    text = "O1\nG1 X1. F100.\nG53 Z-5.\nM30"
    zero = {"Z": 10.0}
    assert good(text, "fanuc", machine_zero=zero).moves.end[-1, 2] == 5.0
    assert math.isnan(good(text, "fanuc", machine_zero=zero).moves.feed[-1])


# --- cycles


def test_a_cycle_drills_as_often_as_k_says() -> None:
    text = "G0 Z10.\nG91 G99 G81 X5. R-8. Z-7. K3 F100."
    holes = [place for place in ends(text) if place[2] == -5.0]
    assert holes == [(5.0, 0.0, -5.0), (10.0, 0.0, -5.0), (15.0, 0.0, -5.0)]


def test_left_hand_tapping_turns_the_other_way() -> None:
    events = good("O1\nS500 M4\nG74 X5. Z-6. R3. F500.\nM30", "fanuc").events
    words = [event.word for event in events if isinstance(event, Function)]
    assert words == ["M4", "M3", "M4", "M30"]


# --- transformations


def test_mirror_then_scale_then_rotation() -> None:
    # (3, 4) mirrored at X0: (-3, 4); doubled: (-6, 8); turned by 90 degrees: (-8, -6)
    assert ends("G51.1 X0\nG51 X0 Y0 P2.\nG68 X0 Y0 R90.\nG0 X3. Y4.")[-1] == (-8.0, -6.0, 0.0)


def test_the_centre_of_a_rotation_is_scaled_too() -> None:
    # (10, 0) is the centre (20, 0) once doubled; the point (12, 0) lies at (24, 0), turned (20, 4)
    assert ends("G51 X0 Y0 P2.\nG68 X10. Y0 R90.\nG0 X12. Y0.")[-1] == (20.0, 4.0, 0.0)


def test_a_second_rotation_turns_about_where_the_tool_stands() -> None:
    # turned by 30 degrees, X10 lies at (8.660254, 5): about it, 2 mm along X turned by 90 degrees
    made = ends("G0 X0 Y0\nG68 R30.\nX10.\nG68 R90.\nG91 X2.")
    assert made[-1] == (8.660254, 7.0, 0.0)


def test_polar_coordinates_count_from_the_origin_or_from_the_tool() -> None:
    made = ends("G16\nG0 X10. Y90.\nG91 Y-30.\nX10. Y0.\nG15")
    half = math.sqrt(3.0) / 2.0
    assert made[1] == pytest.approx((10.0 * 0.5, 10.0 * half, 0.0), abs=1e-6)
    assert made[2] == pytest.approx((20.0 * 0.5, 20.0 * half, 0.0), abs=1e-6)


# --- compensation


def test_compensation_starts_square_and_extends_outside_corners() -> None:
    tools = {1: ToolData(2.0, 60.0)}
    made = ends("G0 X-20. Y-10.\nG41 G1 X0. Y0. D1 F100.\nY20.\nX20.\nG40 Y40.", tools=tools)
    assert made[1:4] == [(-2.0, 0.0, 0.0), (-2.0, 22.0, 0.0), (20.0, 22.0, 0.0)]


def test_d_that_was_given_before_holds_for_a_bare_g41() -> None:
    tools = {1: ToolData(2.0, 60.0), 2: ToolData(3.0, 60.0)}
    made = ends("D2\nG0 X-20.\nG41 G1 X0. Y0. F100.\nY20.\nG40 X-20.", tools=tools)
    assert made[1] == (-3.0, 0.0, 0.0)


def test_both_arc_words_take_the_radius() -> None:
    arc = good("O1\nG0 X10.\nG3 X0. Y10. R10. I-7. F100.\nM30", "fanuc").moves
    assert arc.shape[-1] == Shape.ARC
    assert arc.radius[-1] == pytest.approx(10.0)


def test_h_without_a_tool_is_refused() -> None:
    assert bad("O1\nG43 H7 Z1.\nM30", "fanuc", tools=WITH_TABLES.tools).code == "no-such-tool"


# --- macros


def value(expression: str, before: str = "", **changes: Any) -> float:
    """What an expression comes to."""
    return good(f"O1\n{before}\n#100={expression}\nG0 X#100\nM30", "fanuc", **changes).position["X"]


@pytest.mark.parametrize(
    ("expression", "result"),
    [
        ("2+3*4", 14.0),
        ("[2+3]*4", 20.0),
        ("7 MOD 3", 1.0),
        ("-7 MOD 3", -1.0),
        ("12 AND 10", 8.0),
        ("12 OR 10", 14.0),
        ("12 XOR 10", 6.0),
        ("SIN[30]*2", 1.0),
        ("ACOS[0.5]", 60.0),
        ("ATAN[1]/[-1]", 135.0),
        ("ATAN[-1]/[1]", 315.0),
        ("ATAN[-1,1]", 315.0),
        ("ATAN[-1]", -45.0),
        ("SQRT[16]+SQR[9]", 7.0),
        ("ABS[-2.5]", 2.5),
        ("ROUND[2.5]", 3.0),
        ("ROUND[-2.5]", -3.0),
        ("FIX[-1.2]", -1.0),
        ("FIX[1.2]", 1.0),
        ("FUP[1.2]", 2.0),
        ("FUP[-1.2]", -2.0),
        ("LN[EXP[2]]", 2.0),
        ("POW[2,10]", 1024.0),
        ("BIN[16]", 10.0),
        ("BCD[10]", 16.0),
        ("-[3-5]", 2.0),
    ],
)
def test_operators_and_functions(expression: str, result: float) -> None:
    assert value(expression) == pytest.approx(result, abs=1e-12)


def test_round_in_a_word_goes_to_the_least_increment() -> None:
    assert good("O1\n#1=1.23456\nG0 X[ROUND[#1]]\nM30", "fanuc").position["X"] == pytest.approx(
        1.235
    )
    inch = good("O1\nG20\n#1=1.23456\nG0 X[ROUND[#1]]\nM30", "fanuc").position["X"]
    assert inch == pytest.approx(1.2346 * 25.4)


def test_arguments_of_both_kinds() -> None:
    sub = "M30\nO9\nG0 X#{} Y#{} Z#{}\nM99"
    letters = good("O1\nG65 P9 A1. I2. Z3.\n" + sub.format(1, 4, 26), "fanuc").position
    assert (letters["X"], letters["Y"], letters["Z"]) == (1.0, 2.0, 3.0)
    groups = good("O1\nG65 P9 I1. J2. I3. K4. I5.\n" + sub.format(7, 9, 10), "fanuc").position
    assert (groups["X"], groups["Y"], groups["Z"]) == (3.0, 4.0, 5.0)
    later = good("O1\nG65 P9 I1. I2. D5.\n" + sub.format(7, 4, 9), "fanuc").position
    assert (later["X"], later["Y"]) == (5.0, 1.0)


def test_an_argument_without_a_point_counts_increments() -> None:
    text = "O1\nG65 P9 A1000 D7\nM30\nO9\nG0 X#1 Y#7\nM99"
    outcome = good(text, "fanuc")
    assert (outcome.position["X"], outcome.position["Y"]) == (1.0, 7.0)
    assert good(text, "fanuc", decimal_point="calculator").position["X"] == 1000.0


def test_a_macro_gives_the_path_of_its_unrolled_program() -> None:
    macro = (
        "O1\n#1=0\nWHILE [#1 LT 360] DO1\n#1=#1+45\nG1 X[20*COS[#1]] Y[20*SIN[#1]] F100.\nEND1\nM30"
    )
    rows = [
        (20.0 * math.cos(math.radians(a)), 20.0 * math.sin(math.radians(a)))
        for a in range(45, 361, 45)
    ]
    assert np.allclose(good(macro, "fanuc").moves.end[:, :2], rows, rtol=0.0, atol=1e-12)


def test_a_modal_call_runs_behind_each_move_of_its_program() -> None:
    text = "O1\nG66 P9 Z2.\nG0 X1.\nX2.\nG67\nX3.\nM30\nO9\nG91 G0 Z#26\nG90\nM99"
    outcome = good(text, "fanuc")
    assert (outcome.position["X"], outcome.position["Z"]) == (3.0, 4.0)


def test_goto_takes_the_next_block_of_its_number_else_the_first() -> None:
    assert good("O1\nN1 G0 X1.\nGOTO 1\nN1 Y1.\nM30", "fanuc").position["Y"] == 1.0
    text = "O1\nN1 #1=#1+1\nIF [#1 LT 3] GOTO 1\nG0 X#1\nM30"
    assert good(text, "fanuc").position["X"] == 3.0


ZEROED: dict[str, Any] = {"machine_zero": {"X": -100.0, "Y": 0.0, "Z": 50.0}}


def test_positions_are_read() -> None:
    tools = {1: ToolData(5.0, 60.0), 2: ToolData(5.0, 70.0)}
    text = "G54\nG0 X10. Y5.\nG43 Z20. H2"
    offsets = {"G54": {"X": 3.0}}
    for variable, wanted in (("#5001", 10.0), ("#5021", 113.0), ("#5043", 30.0), ("#5083", 10.0)):
        made = value(variable, text, tools=tools, offsets=offsets, **ZEROED)
        assert made - 3.0 == pytest.approx(wanted), variable


def test_offsets_are_read_and_written_from_machine_zero() -> None:
    assert value("#5221", offsets={"G54": {"X": 3.0}}, **ZEROED) - 3.0 == pytest.approx(103.0)
    made = good("O1\n#5241=-90.\nG55 G0 X1.\nM30", "fanuc", **ZEROED)
    assert made.position["X"] == pytest.approx(-100.0 - 90.0 + 1.0)
    made = good("O1\n#7002=7.\nG54.1 P1 G0 Y1.\nM30", "fanuc", **ZEROED)
    assert made.position["Y"] == pytest.approx(8.0)


def test_modal_codes_and_words_are_read() -> None:
    before = "G91\nG55\nG90 F250. S900 T1"
    offsets = {"G55": {"X": 0.0}}
    wanted = {
        "#4003": 90.0,
        "#4014": 55.0,
        "#4109": 250.0,
        "#4119": 900.0,
        "#4120": 1.0,
        "#4115": 1.0,
    }
    for variable, result in wanted.items():
        assert value(variable, before, offsets=offsets) == result, variable


def test_tool_offsets_are_read_and_written() -> None:
    tools = {1: ToolData(5.0, 60.0), 2: ToolData(4.0, 70.0)}
    assert value("#11002", tools=tools) == 70.0
    assert value("#13002", tools=tools) == 4.0
    made = good("O1\n#10002=0.5\nG43 G0 Z0. H2\nM30", "fanuc", tools=tools)
    assert made.position["Z"] == pytest.approx(10.5)


def test_what_the_job_gives_is_read() -> None:
    assert value("#1005", variables={"#1005": 4.0}) == 4.0
    assert value("#500", variables={"#500": 8.0}) == 8.0


def test_a_program_raises_its_own_alarm() -> None:
    error = bad("O1\nIF [#1 EQ #0] THEN #3000=5 (NO VALUE)\nM30", "fanuc")
    assert error.code == "program-alarm"
    assert "3005: NO VALUE" in error.message


# --- contours on a cylinder

DEGREE = 180.0 / math.pi
"""A radius on which a degree is a millimetre [mm]."""


def test_a_feed_on_a_cylinder_counts_along_its_surface() -> None:
    moves = good(f"O1\nG107 C{DEGREE:.9f}\nG1 C10. F300.\nZ10. C20.\nM30", "fanuc").moves
    assert moves.feed[0] == pytest.approx(300.0)
    assert moves.feed[1] == pytest.approx(300.0 / math.sqrt(2.0))


def test_an_arc_on_a_cylinder_keeps_its_radius() -> None:
    text = f"O1\nG18 G107 C{DEGREE:.9f}\nG1 Z5. C0. F300.\nG2 Z0. C5. R5.\nM30"
    moves = good(text, "fanuc").moves
    arc = moves.end[1:]
    # From Z5 C0 clockwise to Z0 C5, less than half a turn: about Z5 C5
    away = np.hypot(arc[:, 2] - 5.0, arc[:, 3] - 5.0)
    assert np.allclose(away, 5.0, rtol=0.0, atol=1e-6)
    chords = np.hypot(*np.diff(np.vstack([[5.0, 0.0], arc[:, 2:]]), axis=0).T)
    assert (5.0 - np.sqrt(25.0 - chords**2 / 4.0)).max() <= 0.001


# --- haas


def test_haas_feeds_and_dwells_without_a_point() -> None:
    assert good("O1\nG1 X1. F300000\nM30", "haas").moves.feed[0] == pytest.approx(300.0)
    seconds = [
        e.seconds for e in good("O1\nG4 P2\nG4 P2.\nM30", "haas").events if isinstance(e, Dwell)
    ]
    assert seconds == [0.002, 2.0]


def test_haas_blocks_run_as_a_subprogram() -> None:
    text = "O1\nM97 P10 L3\nG0 Y1.\nM30\nN10 G91 G0 X1.\nG90\nM99"
    position = good(text, "haas").position
    assert (position["X"], position["Y"]) == (3.0, 1.0)


def test_haas_pocket_clears_up_to_its_radius() -> None:
    tools = {1: ToolData(3.0, 60.0)}
    moves = good("O1\nG0 X5.\nG13 I5. K10. Q3. Z-1. D1 F100.\nM30", "haas", tools=tools).moves
    whole = [(r, s) for r, s in zip(moves.radius, moves.sweep, strict=True) if abs(s) == 360.0]
    assert whole == [(2.0, 360.0), (5.0, 360.0), (7.0, 360.0)]
    assert moves.end[-1, :2].tolist() == [5.0, 0.0]


def test_haas_p_of_m98_is_the_program_alone() -> None:
    assert bad("O1\nM98 P00022000\nM30\nO2000\nM99", "haas").code == "unknown-subprogram"


def test_haas_offsets_beyond_g59() -> None:
    offsets = {"G54.1 P2": {"X": 7.0}}
    for code in ("G154 P2", "G111"):
        assert ends(f"{code}\nG0 X1.", "haas", offsets=offsets) == [(8.0, 0.0, 0.0)]


def test_haas_tool_variables_have_their_own_numbers() -> None:
    tools = {1: ToolData(5.0, 60.0), 2: ToolData(4.0, 70.0)}
    for variable, wanted in (("#2002", 70.0), ("#2402", 4.0)):
        made = good(f"O1\n#100={variable}\nG0 X#100\nM30", "haas", tools=tools)
        assert made.position["X"] == wanted


@pytest.mark.parametrize("cycle", ["G81", "G81.", "G 81", "g081.0"])
def test_a_motion_behind_a_cycle_counts_however_the_cycle_is_written(cycle: str) -> None:
    outcome = good(f"G90 F100.\nG0 X0. Y0. Z5.\n{cycle} X10. R1. G1 Z-1.\nM30\n", "fanuc")
    assert "cycle-overruled" in outcome.codes
    assert outcome.position == {"X": 10.0, "Y": 0.0, "Z": -1.0, "C": 0.0}


def _turns(events: list[Event]) -> list[str]:
    words = [each.word for each in events if isinstance(each, Function)]
    return [word for word in words if word in ("M3", "M4", "M5")]


@pytest.mark.parametrize(
    ("dialect", "before"), [("fanuc", "M29 S300\n"), ("haas", "S300\n"), ("haas", "M3 S300\n")]
)
def test_rigid_tapping_turns_the_spindle_itself(dialect: str, before: str) -> None:
    """M29 of a Fanuc, and G84 of a Haas without any word (its manual); a spindle that turns goes on."""
    made = good(f"O1\nG21 G90 G17\n{before}G84 X1. Y0. Z-6. R3. F300.\nX9.\nG80\nM30\n", dialect)
    turns = _turns(made.events)
    own = ["M3", "M4", "M3"] if "M3" in before else ["M4", "M3"]
    assert turns == (own + own[1:] if "M3" in before else ["M3", *own, "M5"] * 2)


def test_tapping_without_m29_starts_no_spindle() -> None:
    text = "O1\nG21 G90 G17\nM29 S300\nG84 X1. Y0. Z-6. R3. F300.\nG80\nG84 X9. Z-6. R3. F300.\nG80\nM30\n"
    made = good(text, "fanuc")
    turns = _turns(made.events)
    assert turns == ["M3", "M4", "M3", "M5", "M4", "M3"]
