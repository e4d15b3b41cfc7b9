"""CODESYS SoftMotion as its manual's examples show it; results by the manual's own words."""

from pathlib import Path

import pytest

from tests.nc.running import SETTINGS, bad, good
from twin.nc.canonical import Motion, concatenate
from twin.nc.dialects.codesys import CODESYS
from twin.nc.dialects.codesys.subprograms import LIBRARY
from twin.nc.interpreter import Interpretation
from twin.nc.text.diagnostics.diagnostics import ProgramError
from twin.nc.text.source import read_source
from twin.run.dry_run.dry_run import InterpretedProgram
from twin.run.preparing.preparation import prepare

COUNTED = """
N00 G36 D10          (set counter to 10)
N10 G91              (relative mode)
N20 G01 X10 Y10 F100 (movement by distance 10/10)
N30 G37 D-1          (decrement counter)
N40 G20 L20          (jump, if counter != 0)
"""
LABELS = """
N0 G16 F100 E100 E-100
N10 G20 L?4      //unconditional jump to the unknown target with index 4
N15 G20 L60
N20 G1 X1
N30 G1 X1 L!5    //resolution unknown jump target with index 5
N40 G1 Z1 L!4    //resolution unknown jump target with index 4
N50 G20 L15
N55 G1 Y1
N60 G0 X0 Y0 Z0
"""
CIRCLES = """SUBPROGRAM CNC2{#RADIUS : LREAL}
N010 G91
N020 G02 X#RADIUS*2 Y0 R#RADIUS Z2.5 F100 E-100 E100
N030 G02 X-#RADIUS*2 Y0 R#RADIUS Z7.5
END_SUBPROGRAM
"""
MAIN = "N0 G01 X40 Y0 F50 E30 E-30\nN10 G01 X0 Y30\nN20 CNC2{25}\nN30 G01 X0 Y-200\n"


def test_ten_lines_by_a_counter_lead_to_100_100() -> None:
    moves = good(COUNTED, "codesys").moves
    assert len(moves) == 10
    assert moves.end[-1, :2].tolist() == [100.0, 100.0]


def test_labels_ahead_and_numbers_back() -> None:
    moves = good(LABELS, "codesys").moves
    assert moves.line.tolist() == [7, 10]


def test_switch_points_by_share_and_by_distance() -> None:
    events = good(
        "N90 G1 X20 F10 N100 G1 X100 H2 L20 H-2 L-10 N110 X20 Y20 N120 G1 X100 Y40 H-2 O0.25",
        "codesys",
    ).events
    # Switched on at X 40 and off at X 90, between X 20 and X 100.
    assert [getattr(event, "at", None) for event in events] == [0.25, 0.875, 0.25]


def test_a_series_of_g92_is_its_last_and_the_first_begins_the_path() -> None:
    moves = good("N10 G92 X1 N20 G92 X100 Y50 N30 G1 X110 F10", "codesys").moves
    assert moves.start[:, :2].tolist() == [[100.0, 50.0]]


def test_a_jump_on_the_way_is_travelled() -> None:
    moves = good("N10 G1 X10 F10 FF3 N20 G92 Y1 N30 G92 X0 N40 G1 X5", "codesys").moves
    assert moves.end[:, :2].tolist() == [[10.0, 0.0], [0.0, 0.0], [5.0, 0.0]]
    assert moves.motion.tolist() == [Motion.FEED, Motion.RAPID, Motion.FEED]
    assert moves.feed[1] != moves.feed[1]


def started(program: Path) -> list[float]:
    preparation = prepare(program)
    return InterpretedProgram(preparation, preparation.interpretation().chunks()).start.tolist()


def test_the_machine_stands_where_the_path_begins(tmp_path: Path) -> None:
    program = tmp_path / "begin.nc"
    program.write_text("N10 G92 X20 Z5 N20 G1 X30 F10 E5 E-5\n")
    assert started(program) == [20.0, 0.0, 5.0, 0.0]
    program.write_text("N10 G1 X30 F10 E5 E-5\n")
    assert started(program) == [0.0] * 4


def test_a_subprogram_is_a_file_of_its_own(tmp_path: Path) -> None:
    (tmp_path / "main.cnc").write_text(MAIN)
    (tmp_path / "cnc2.cnc").write_text(CIRCLES)
    source = LIBRARY(read_source(tmp_path / "main.cnc", CODESYS), tmp_path, CODESYS)
    chunks = Interpretation(source, CODESYS, SETTINGS).chunks()
    moves = concatenate((chunk.moves for chunk in chunks), SETTINGS.axes)
    # Two half circles, and without RESTORE the caller goes on in relative mode.
    assert moves.end[-2:, :3].tolist() == [
        pytest.approx([0.0, 30.0, 10.0]),
        pytest.approx([0.0, -170.0, 10.0]),
    ]
    assert good(MAIN + CIRCLES, "codesys").moves.end.tolist() == moves.end.tolist()


def test_an_error_names_the_subprograms_file(tmp_path: Path) -> None:
    (tmp_path / "main.cnc").write_text("N10 Bore{}")
    (tmp_path / "bore.cnc").write_text("SUBPROGRAM Bore{}\nN10 G1 X#a F10\nEND_SUBPROGRAM")
    source = LIBRARY(read_source(tmp_path / "main.cnc", CODESYS), tmp_path, CODESYS)
    with pytest.raises(ProgramError) as raised:
        list(Interpretation(source, CODESYS, SETTINGS).chunks())
    assert str(raised.value).startswith(f"{tmp_path / 'bore.cnc'}:2:8: error unknown-variable")


def test_a_missing_file_is_asked_for() -> None:
    assert "bore.cnc" in str(bad("N10 Bore{5}", "codesys"))


def test_labels_belong_to_their_program() -> None:
    text = (
        "N10 G36 D2\nN20 G1 X10 F10\nN30 Step{}\nN40 G20 L100 K1\nN50 X99\nN100 X20\n"
        "SUBPROGRAM Step{}\nN20 G91 G1 Y1\nN30 G37 D-1\nN40 G20 L20\nN50 G20 L?1 K1\nN60 X99\n"
        "N100 L!1 G90\nEND_SUBPROGRAM\nN110 L!1 X5"
    )
    moves = good(text, "codesys").moves
    assert moves.end[:, :2].tolist() == [[10, 0], [10, 1], [10, 2], [20, 2], [5, 2]]
