"""Rules of Fanuc and Haas controls, with results worked out by hand."""

import math
from pathlib import Path

import pytest

from tests.nc.running import WITH_TABLES, bad, good
from twin.nc.canonical import Dwell, Function, Shape
from twin.nc.control.settings import ToolData
from twin.nc.dialects import dialect_named
from twin.nc.text.source import read_source

ZERO = {"X": 0.0, "Y": 0.0, "Z": 0.0}


def ends(text: str, dialect: str = "fanuc", **changes: object) -> list[tuple[float, float, float]]:
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
    source = fanuc.library(read_source(tmp_path / "main.nc"), tmp_path)
    outcome = good(source.text, "fanuc")
    assert (outcome.position["X"], outcome.position["Y"]) == (1.0, 4.0)


def test_blocks_are_skipped_by_their_number() -> None:
    text = "O1\n/G0 X1.\n/2 G0 Y1.\n/3 G0 Z1.\nM30"
    assert good(text, "fanuc", block_skip=True).position == pytest.approx({**ZERO, "C": 0.0})
    outcome = good(text, "fanuc", block_skip_levels=frozenset({1, 3}))
    assert outcome.position == pytest.approx({**ZERO, "Y": 1.0, "C": 0.0})


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


def test_g28_goes_by_its_point_and_leaves_the_length_alone() -> None:
    zero = {"X": -50.0, "Y": 0.0, "Z": 200.0}
    tools = {1: ToolData(5.0, 60.0), 2: ToolData(5.0, 85.0)}
    made = ends(
        "G0 X10. Z5.\nG43 Z10. H2\nG91 G28 X2. Z1.\nG90 G0 Z10.", machine_zero=zero, tools=tools
    )
    assert made == [
        (10.0, 0.0, 5.0),
        (10.0, 0.0, 35.0),
        (12.0, 0.0, 36.0),
        (-50.0, 0.0, 200.0),
        (-50.0, 0.0, 35.0),
    ]


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
