"""Statements, tables and words of the Fagor CNC 8070 as published post-processors write them."""

import dataclasses

import numpy as np
import pytest

from tests.nc.running import WITH_TABLES, bad, good, run
from twin.nc.dialects import dialect_named
from twin.nc.dialects.fagor8070.known_statements import ENDED_ONLY, PASSED_OVER, REFUSED
from twin.nc.interpreter import Interpretation
from twin.nc.text.source import source_from_text

POST = """; MADE AFTER THE OUTPUT OF A PUBLISHED POST-PROCESSOR
#MCS OFF
#CS OFF
#RTCP OFF
#HSC OFF
#KIN ID[0]
G90 G94 G17
G71
G51 A45 E0.002
#MCS G0 Z-10
T1 D1 M6
; 6 MM FLAT
S5000 M3
G501 A60 E0.012 J100 M1
G54
#DGWZ[-50,50,-30,30,-20,0]
#MSG["OPT1: POCKET; ROUGH (1)"]
P100=500
P101=250 (PLUNGE)
G0 X10 Y5
Z15
M8
#CALL L100
G98 G81 X0 Y0 Z5 I-10 K0.5 F300
X10
G80
G98 G82 X20 Y0 Z5 I-10 B3 D2 H1 J2 K0.1 L1 R0.8 F200
G80
G98 G83 X30 Y0 Z5 I-5 J3 F200
G80
G98 G84 X40 Y0 Z5 I-15 R1 F500
G80
#MSG[""]
G500
G61
M5
M9
#MCS G0 Z-10
#MCS G0 X-5 Y-5
M30
%L 100
G1 Z-2 FP101
X20 FP100
G3 X20 Y15 I0 J5
G1 X10
M17
M29
"""


def test_the_output_of_a_post_processor_runs() -> None:
    outcome = good(POST, "fagor8070", settings=WITH_TABLES)
    assert set(outcome.codes) == {"passed-over"}
    assert outcome.end(0)["Z"] == 290.0
    assert outcome.position == pytest.approx({"X": -5.0, "Y": -5.0, "Z": 290.0, "C": 0.0})
    arcs = outcome.moves.sweep[~np.isnan(outcome.moves.center[:, 0])]
    assert arcs.tolist() == [180.0]
    assert {500.0, 250.0} <= set(outcome.moves.feed.tolist())


def test_what_changes_nothing_is_no_error_with_strict() -> None:
    outcome = run(POST, "fagor8070", settings=dataclasses.replace(WITH_TABLES, strict=True))
    assert outcome.error is None


@pytest.mark.parametrize("keyword", PASSED_OVER)
def test_a_statement_without_effect_is_told_once(keyword: str) -> None:
    outcome = good(f"{keyword} [1]\nG0 X1\n{keyword}\nM30", "fagor8070")
    assert outcome.codes == ["passed-over"]
    assert keyword in outcome.warnings[0].message


@pytest.mark.parametrize("keyword", ENDED_ONLY)
def test_what_has_not_begun_can_be_ended_only(keyword: str) -> None:
    assert good(f"{keyword} OFF\nG0 X1\nM30", "fagor8070").codes == []
    assert bad(f"{keyword} ON\nG0 X1\nM30", "fagor8070").code == "unsupported-statement"


@pytest.mark.parametrize("keyword", REFUSED)
def test_other_statements_are_refused_with_their_reason(keyword: str) -> None:
    refusal = bad(f"G0 X1\n{keyword.replace(' ', '  ')} [1,2]", "fagor8070")
    assert (refusal.code, refusal.line, refusal.column) == ("unsupported-statement", 2, 1)
    assert REFUSED[keyword] in refusal.message


def test_machine_coordinates_need_machine_zero() -> None:
    assert bad("#MCS G0 Z0", "fagor8070").code == "no-machine-zero"


def test_machine_coordinates_know_no_mirror_scale_or_rotation() -> None:
    text = "G11\nG72 S2\nG73 Q90\n#MCS G0 X10 Y20 Z-300\nG0 X1\nM30"
    outcome = good(text, "fagor8070", settings=WITH_TABLES)
    assert outcome.end(0) == pytest.approx({"X": 10.0, "Y": 20.0, "Z": 0.0, "C": 0.0})
    before = good("G11\nG72 S2\nG73 Q90\nG0 X1\nM30", "fagor8070", settings=WITH_TABLES)
    here = outcome.end(1)
    assert here["Y"] == pytest.approx(before.end(0)["Y"])


def test_machine_coordinates_wait_for_the_end_of_compensation() -> None:
    text = "G41 G1 X10 F100\nY10\n#MCS G0 Z0"
    assert bad(text, "fagor8070", settings=WITH_TABLES).code == "compensation-change"


@pytest.mark.parametrize("words", ["#MCS", "#MCS $IF 1", "#MCS #MCS G0 X1"])
def test_machine_coordinates_need_a_move(words: str) -> None:
    assert bad(words, "fagor8070", settings=WITH_TABLES).code == "machine-coordinates"


def test_a_loop_with_machine_coordinates_runs_as_without_the_compiled_tier() -> None:
    text = (
        "$FOR P1=1,30,1\nG54 G1 XP1 Y[P1*2] F100\n#MCS G0 Z-10\nG1 Z=P1\n"
        "V.A.ORGT[1].X=P1\n$ENDFOR\nM30"
    )
    outcome = good(text, "fagor8070", settings=WITH_TABLES)
    assert len(outcome.moves) == 90
    assert outcome.end(87) == pytest.approx({"X": 59.0, "Y": 60.0, "Z": 30.0, "C": 0.0}, abs=60.0)


def test_the_offset_table_is_read_and_written_by_computed_rows() -> None:
    text = "P3=2\nV.A.ORGT[P3].Y=4\nG159=P3\nG0 X0 Y0\nP1=V.A.ORGT[2].Y\nX=P1\nM30"
    outcome = good(text, "fagor8070", settings=WITH_TABLES)
    assert outcome.end(0) == pytest.approx({"X": 20.0, "Y": 4.0, "Z": 0.0, "C": 0.0})
    assert outcome.end(1)["X"] == pytest.approx(24.0)


@pytest.mark.parametrize(
    ("line", "code"),
    [
        ("V.A.ORGT[0].X=1", "no-offset"),
        ("V.A.ORGT[21].X=1", "no-offset"),
        ("V.A.ORGT[1].W=1", "no-such-axis"),
        ("V.A.ORGT[P9].X=1", "unknown-variable"),
        ("V.G.FIX=1", "control-variable"),
        ("V.A.FIXT[1].X=1", "control-variable"),
        ("P1=V.G.FIX", "unknown-variable"),
        ("V.A.ORGT[1].X=1 X5", "assignment"),
    ],
)
def test_other_variables_of_the_control_are_refused(line: str, code: str) -> None:
    assert bad(line, "fagor8070", settings=WITH_TABLES).code == code


def test_the_tool_in_the_spindle_can_be_read() -> None:
    text = "P1=V.TM.TOOL\nT2 M6\nP2=V.G.TOOL\nT0 M6\nP3=V.TM.TOOL\nG0 XP1 YP2 ZP3\nM30"
    end = good(text, "fagor8070", settings=WITH_TABLES).end(0)
    assert end == pytest.approx({"X": 1.0, "Y": 2.0, "Z": 0.0, "C": 0.0})


def test_tapping_goes_by_passes_to_the_bottom() -> None:
    text = "G0 Z20\nG99 G84 X5 Z2 I-10 B5 H1 R1 F200\nM30"
    outcome = good(text, "fagor8070")
    heights = [outcome.end(row)["Z"] for row in range(2, len(outcome.moves))]
    assert heights == [2.0, -3.0, -2.0, -8.0, -7.0, -10.0, 2.0]
    words = [getattr(event, "word", "") for event in outcome.events]
    assert words == ["M4", "M3"] * 3 + ["M30"]


@pytest.mark.parametrize("words", ["B0", "B-0", "B2 H-1", "B2 R0", "B2 J2", "B2 K-1", "B0.0001"])
def test_tapping_refuses_passes_that_are_none(words: str) -> None:
    text = f"G0 Z20\nG84 X5 Z2 I-10 {words} F200\nM30"
    assert bad(text, "fagor8070").code in ("cycle-depth", "unsupported-word", "dwell")


@pytest.mark.parametrize(
    ("line", "code", "column"),
    [
        ("G74 Z X Y", "unsupported-g", 1),
        ("N20 /X20", "label", 5),
        ("G0\u00a0X10", "unreadable", 3),
        ("G81 X1 Z2 I-5 A1", "unsupported-word", 15),
    ],
)
def test_messages_name_what_was_meant(line: str, code: str, column: int) -> None:
    refusal = bad(line, "fagor8070")
    assert (refusal.code, refusal.column) == (code, column)


def test_a_no_break_space_is_named() -> None:
    assert "U+00A0" in bad("G0\u00a0X10", "fagor8070").message


def test_a_number_with_a_colon_is_a_label() -> None:
    source = source_from_text("$GOTO N20\nG0 X1\nN20: G0 X2\nM30")
    interpretation = Interpretation(source, dialect_named("fagor8070"), WITH_TABLES)
    assert [x for chunk in interpretation.chunks() for x in chunk.moves.end[:, 0]] == [2.0]


def test_a_code_without_effect_is_told_at_its_own_place() -> None:
    (notice,) = good("G90 G51 A45 E0.002\nM30", "fagor8070").warnings
    assert (notice.code, notice.column, notice.width) == ("passed-over", 5, 3)
