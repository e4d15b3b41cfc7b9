from pathlib import Path

import pytest

from tests.nc.running import ROOT
from twin.errors import UsageError
from twin.nc.dialects import DIALECTS, dialect_named, marks_found, recognise
from twin.nc.text.source import read_source, source_from_text

OWN = {
    "gost": ["G102 C360", "G0 X1 $ подход", "G0 X1 $ approach", "G1 C5 F100 $"],
    "codesys": [
        "N10 G1 X1 N20 G2 X5 R5", "N10 G2 I50 J0 T180", "G1 X$a$", "LET #x : LREAL", "G4 T1",
        "G1 X5 F10 E20 E-30", "SUBPROGRAM A{}", "G20 L5", "L!1", "G51 D2", "G52 D3", "G16 I0 J0 K1",
        "G36 O$n$ D5", "G1 X5 FF10", "N20 G8 X10 Y10 I5 J0 K45 R0.5", "N20 G9 X-30 I-30 K0 R.5",
        "N20 G71 L6", "G1 X50 H1 O20", "G1 X50 H-2 L0.5", "G1 XSIN(0.5)",
    ],
    "fagor8070": [
        "G01 R50 Q30", "G30 I5 J5", "$IF P1==1", "P1=5", "G01 X20I", "G01 X1=5", "#RPT[N1,N2]",
        "G01 X5 ; comment", "G263=50", "G81 Z5 I-10", "G36 I5", "G39 I2", "G137", "G158 X5", "G72 S2",
        "G73 Q45", "%L sub", "LL contour", "NR 5", "#MCS G0 Z0", "#HSC ON", "G51 A5 E0.1", "G500",
        "V.A.ORGT[1].Z=1", "Y1=5",
    ],
    "linuxcnc": [
        "o100 sub", "o<hole> call [1]", "#<depth>=5", "G61.1", "G43.1 Z5", "G59.3", "G64 P0.01",
        "G0 @5 ^30",
    ],
    "fanuc": [
        "G54.1 P2", "G5.1 Q1", "G51.1 X0", "M98 P00022000", "O1\nG107 C20.",
        "G43.4 H1", "G8 P1", "IF[#1EQ1]GOTO5\nG8 P1", "WHILE[#1LT5]DO1\nG8 P1", "G65 P100\nG8 P1",
        "#3000=1\nG8 P1", "X10.,R5.\nG8 P1",
    ],
    "haas": ["G154 P2", "G187 P1", "M97 P100", "O01000\nG112", "G110", "G12 I5. D1", "G103 P1"],
    "mefi": ['G00 X1 "pohyb', "N5 X0 G73 L5 Q2", "G09 G02 X0 I100"],
}  # fmt: skip


@pytest.mark.parametrize(("dialect", "text"), [(d, t) for d, texts in OWN.items() for t in texts])
def test_own_words_decide(dialect: str, text: str) -> None:
    assert recognise(source_from_text(f"G0 X0\n{text}\nX1")).name == dialect


def test_every_mark_has_a_line_that_it_decides() -> None:
    everything = [text for texts in OWN.values() for text in texts]
    for name in OWN:
        found = {mark for text in everything for mark in marks_found(source_from_text(text))[name]}
        assert found == {mark.shown for mark in DIALECTS[name].marks}


@pytest.mark.parametrize(
    ("dialect", "line"),
    [
        ("fagor8070", 'G1 X1 ; "finish" costs 5 $ more'),
        ("mefi", 'N10 G0 X1 " 5 $ ; or so'),
        ("gost", 'G0 X1 $ "чисто"; готово'),
    ],
)
def test_marks_within_a_comment_decide_nothing(dialect: str, line: str) -> None:
    assert recognise(source_from_text(line)).name == dialect


def test_no_words_of_its_own_ask() -> None:
    with pytest.raises(UsageError) as raised:
        recognise(source_from_text("G0 X1\nG1 Y2 F100", "plain.nc"))
    message = str(raised.value)
    assert "plain.nc" in message
    assert "--dialect" in message
    for name, dialect in DIALECTS.items():
        assert f"{name}: {dialect.marks[0].shown}" in message


def test_comments_in_brackets_decide_nothing() -> None:
    with pytest.raises(UsageError, match="could be any"):
        recognise(source_from_text("G0 X1 (from N10 to N20, G102 C360)"))


def test_words_of_two_dialects_ask() -> None:
    with pytest.raises(UsageError, match=r"--dialect(?s:.*)gost: .*\n.*mefi: "):
        recognise(source_from_text('G102 C360\nG0 X1 "text'))


def test_an_unknown_dialect_names_the_known() -> None:
    with pytest.raises(UsageError, match="gost, codesys, fagor8070, mefi, fanuc, haas, linuxcnc"):
        dialect_named("heidenhain")


@pytest.mark.parametrize("path", sorted((ROOT / "tests/golden").glob("*/*/*.nc")), ids=str)
def test_no_program_is_taken_for_another_dialects(path: Path) -> None:
    try:
        found = recognise(read_source(path)).name
    except UsageError as error:
        said = str(error).split(":", 1)[1]
        named = "could be any dialect" in said or path.parts[-3] in said
        found = path.parts[-3] if named else said
    assert found == path.parts[-3]


def test_words_of_a_family_ask_which_of_it() -> None:
    with pytest.raises(UsageError, match=r"could be fanuc or haas \(O1000"):
        recognise(source_from_text("%\nO1234 (PART)\nG0 X1.\nM30\n%"))


@pytest.mark.parametrize("line", ["G12 G2 X10 Y0 I5 J0", "G13 X10 I5", "G12.1 X10. I5."])
def test_a_mirror_with_an_arc_is_no_round_pocket_of_a_haas(line: str) -> None:
    assert not marks_found(source_from_text(line))["haas"]
