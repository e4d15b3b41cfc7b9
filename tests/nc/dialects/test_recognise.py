from pathlib import Path

import pytest

from tests.nc.running import ROOT, run
from twin.errors import UsageError
from twin.nc.dialects import DIALECTS, dialect_named, marks_found, recognise
from twin.nc.dialects.recognition import raw_text
from twin.nc.text.source import read_source, source_from_text

OWN = {
    "gost": ["G102 C360", "G102 C180\nG102 C360", "G0 X1 $ подход", "G0 X1 $ approach", "G1 C5 F100 $"],
    "codesys": [
        "N10 G1 X1 N20 G2 X5 R5", "N10 G2 I50 J0 T180\nG4 T1", "N10 G2 I50 J0 T90.5", "G1 X$a$", "LET #x : LREAL", "G4 T1",
        "G1 X5 F10 E20 E-30", "SUBPROGRAM A{}", "G20 L5", "L!1", "G51 D2", "G52 D3", "G16 I0 J0 K1",
        "G36 O$n$ D5", "G1 X5 FF10", "N20 G8 X10 Y10 I5 J0 K45 R0.5", "N20 G9 X-30 I-30 K0 R.5",
        "N20 G71 L6", "G1 X50 H1 O20", "G1 X50 H-2 L0.5", "G1 XSIN(0.5)",
    ],
    "fagor8070": [
        "G01 R50 Q30", "G30 I5 J5", "$IF P1==1", "P1=5", "G01 X20I", "G01 X1=5", "#RPT[N1,N2]",
        "G263=50", "G81 Z5 I-10", "G137", "G158 X5", "G72 S2", "%L sub", "LL contour", "NR 5", "#MCS G0 Z0", "#HSC ON", "G51 A5 E0.1", "G501", "G500\nNR 5",
        "V.A.ORGT[1].Z=1", "Y1=5", "G83 Z5 I2 ; comment\nNR 5", "G36 I5\nNR 5", "G39 I2\nNR 5",
        "G73 Q45\nNR 5", "G102 X5\nNR 5", "G103 P1\nNR 5", "G112\nNR 5", "G136\nNR 5", "G187 P1\nNR 5",
        "G31 X1 Q5\nNR 5", "G87 Z5 I2\nNR 5",
    ],
    "linuxcnc": [
        "o100 sub", "o<hole> call [1]", "#<depth>=5", "G61.1", "G43.2 H5", "G59.3", "G64 P0.01",
        "G0 @5 ^30", "O100\nG1 X1 ; comment\n#<a>=1", "G43.1 Z5\nG61.1", "#3000=1\nG61.1", "G41.1\nG61.1", "G43.1 Z1\nG61.1",
        "G87 X1 R2 Z1 I1 J1 K1\nG61.1", "G28.1\nG61.1", "G2 I5 J0 T1\nG61.1",
    ],
    "fanuc": [
        "G54.1 P2", "G5.1 Q1", "G5 P10000", "G51.1 X0", "M98 P00022000", "M98 <POCKET>", "G7.1 C20.",
        "G43.4 H1", "IF[#1EQ1]GOTO5\nG5.1 Q1", "WHILE[#1LT5]DO1\nG5.1 Q1", "G65 P100\nG41.1", "G65 P1\nG43.1",
        "#3000=1\nG5.1 Q1", "X10.,R5.\nG5.1 Q1", "O1\nG107 C20.\nG5.1 Q1", "G65 P1\nG39 I5",
        "G65 P1\nG31 X5 Q1", "G65 P1\nG87 I1", "G110\nG54.1 P1", ":1000\nG54.1 P1",
    ],
    "haas": [
        "G154 P2", "M97 P100", "G12 I5. D1", "O01000\nG187 P1", "G65 P1\nG103 P1", "G83 Z-5. I2.\nO1",
        "G154 P1\nG110", "G36 I1.\nX5.,C1.", "G102 X1\nG65 P1", "G136\nG65 P1", "G107 C5.\nG83 I1.",
        "IF[#1EQ1]GOTO5\nG187 P1", "WHILE[#1LT5]DO1\nG187", "#3000=1\nG187", ":1\nG187",
    ],
    "sinumerik": [
        "%_N_PART_MPF", ";$PATH=/_N_WKS_DIR", "CYCLE81(10,0,2,-5)", "LONGHOLE(5,0,1,-2)", 'MSG("ready")', "MCALL", "TRANS X10",
        "ROT", "G0 SUPA Z0", "COMPCAD", "G2 X5 Y0 CR=5", "CIP X5 I1=2", "X=IC(5)", 'T="MILL"', "GOTOF END", "DEF REAL DEPTH",
        "R1=5", "R1=$P_UIFR[1,X,TR]", "G505", "G641 ADIS=1", "G500\nSUPA", "MCALL ; over", "G110 X5\nMCALL",
    ],
    "heidenhain": [
        "BEGIN PGM A MM", "BLK FORM 0.1 Z X+0 Y+0 Z-9", "4 CYCL DEF 7.0 DATUM SHIFT", "LBL 1", "12 FN 0: Q1 = +5", "APPR LT X+0 Y+0 LEN5 RL",
        "7 L X+10 Y+5 R0 FMAX M3", "L Z+50 FMAX ; text", "CALL LBL 5 REP 2",
    ],
    "grbl": ["$H", "$X", "$J=G91 X5 F100", "$X\nG43.1 Z5", "$H\nG28.1", "$H\nG1 X5 ; comment"],
    "mefi": ['G00 X1 "pohyb', "N5 X0 G73 L5 Q2", "G09 G02 X0 I100\nG73 Q2", "N5 X0 G73 Q2 L5"],
}  # fmt: skip


@pytest.mark.parametrize(("dialect", "text"), [(d, t) for d, texts in OWN.items() for t in texts])
def test_own_words_decide(dialect: str, text: str) -> None:
    assert recognise(source_from_text(f"G0 X0\n{text}\nX1")).name == dialect


def test_every_mark_has_a_line_that_it_decides() -> None:
    everything = [text for texts in OWN.values() for text in texts]
    for name in OWN:
        found = {mark for text in everything for mark in marks_found(source_from_text(text))[name]}
        assert found == {mark.shown for mark in DIALECTS[name].marks}


SHARED = (
    ("G83 Z-5 I2 J1 K1", ("fagor8070", "haas")),
    ("G87 X0 Z-5 R2 I1 J1 K1", ("fagor8070", "fanuc", "linuxcnc")),
    ("G102 C180", ("fagor8070", "gost", "haas")),
    ("G102 X0", ("fagor8070", "gost", "haas")),
    ("G103 P1", ("fagor8070", "haas")),
    ("G112", ("fagor8070", "fanuc", "haas", "sinumerik")),
    ("G136", ("fagor8070", "haas")),
    ("G187 P1", ("fagor8070", "haas")),
    ("G107 C20.", ("fanuc", "haas")),
    ("G41.1", ("fanuc", "linuxcnc")),
    ("G43.1 Z5", ("fanuc", "grbl", "linuxcnc")),
    ("G28.1", ("grbl", "linuxcnc")),
    ("G31 X5 Q1", ("fagor8070", "fanuc")),
    ("G36 I5", ("fagor8070", "haas")),
    ("G39 I2", ("fagor8070", "fanuc")),
    ("G73 Q45", ("fagor8070", "mefi")),
    ("#3000=1", ("fanuc", "haas", "linuxcnc")),
    ("O1000", ("fanuc", "haas", "linuxcnc")),
    ("G65 P100", ("fanuc", "haas")),
    (":1000", ("fanuc", "haas")),
    ("G09 G02 X0 I100", ("fanuc", "haas", "mefi")),
    ("G2 I50 J0 T180", ("codesys", "fanuc", "haas", "linuxcnc")),
    (
        "G1 X5 ; comment",
        ("fagor8070", "fanuc", "grbl", "haas", "linuxcnc", "heidenhain", "sinumerik"),
    ),
)
"""Words that several controls know."""
UNTOLD = (
    "G54 P1", "G8 P1", "G64 P1", "G1 X1 E5", "G73 X1 Z-5. R1. Q2.", "Z-5. R1. Q2. F100", "G65 X1. R1. Q2.",
)  # fmt: skip
"""Words that tell no control from another."""


@pytest.mark.parametrize(("line", "dialects"), SHARED)
def test_a_word_of_several_controls_asks_which(line: str, dialects: tuple[str, ...]) -> None:
    found = marks_found(source_from_text(f"G0 X0\n{line}\nX1"))
    assert {name for name, marks in found.items() if marks} == set(dialects)
    with pytest.raises(UsageError, match="--dialect"):
        recognise(source_from_text(line))


@pytest.mark.parametrize("line", UNTOLD)
def test_words_without_a_control_of_their_own_ask(line: str) -> None:
    with pytest.raises(UsageError, match="could be any dialect"):
        recognise(source_from_text(line))


@pytest.mark.parametrize(("dialect", "text"), [(d, t) for d, texts in OWN.items() for t in texts])
def test_no_other_control_runs_what_decides(dialect: str, text: str) -> None:
    program = f"G90 F100 S100 M3\nG0 X0 Y0 Z0\n{text}\nM30"
    for other in OWN:
        if other != dialect and text[0] not in "%$;":  # a heading or a comment elsewhere
            assert run(program, other).error is not None, other


@pytest.mark.parametrize(
    ("dialect", "line"),
    [
        ("fagor8070", 'G1 X1I ; "finish" costs 5 $ more'),
        ("mefi", 'N10 G0 X1 " 5 $ ; or so'),
        ("gost", 'G0 X1 $ "чисто"; готово'),
    ],
)
def test_marks_within_a_comment_decide_nothing(dialect: str, line: str) -> None:
    assert recognise(source_from_text(line)).name == dialect


def test_a_line_behind_slashes_decides_nothing() -> None:
    found = marks_found(source_from_text("//T1  D=50. CR=0. - ZMIN=1. - face mill\nG0 X1"))
    assert not any(found.values())


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
    with pytest.raises(UsageError, match=r"--dialect(?s:.*)gost: (?s:.*)mefi: "):
        recognise(source_from_text('G102 C360\nG0 X1 "text'))


def test_an_unknown_dialect_names_the_known() -> None:
    with pytest.raises(
        UsageError, match="gost, codesys, fagor8070, mefi, fanuc, haas, linuxcnc, grbl, heidenhain"
    ):
        dialect_named("dialog11")


WRITTEN_FOR_ANOTHER = {"haas/unknown-g.nc"}
"""Bad programs whose fault is that they are another control's."""
GOLDEN, BAD = (ROOT / "tests/golden").glob("*/*/*.nc"), (ROOT / "tests/bad").glob("*/*.nc")


@pytest.mark.parametrize(
    "path",
    sorted(
        path for path in (*GOLDEN, *BAD) if "/".join(path.parts[-2:]) not in WRITTEN_FOR_ANOTHER
    ),
    ids=str,
)
def test_no_program_is_taken_for_another_dialects(path: Path) -> None:
    own = path.parts[path.parts.index("tests") + 2]
    try:
        found = recognise(read_source(path)).name
    except UsageError as error:
        said = str(error).split(":", 1)[1]
        named = "could be any dialect" in said or "is empty" in said or own in said
        found = own if named else said
    assert found == own


def test_words_of_a_family_ask_which_of_it() -> None:
    with pytest.raises(UsageError, match=r"could be fanuc or haas \(G65"):
        recognise(source_from_text("%\nG65 P1\nM30\n%"))


@pytest.mark.parametrize("line", ["G12 G2 X10 Y0 I5 J0", "G13 X10 I5", "G12.1 X10. I5."])
def test_a_mirror_with_an_arc_is_no_round_pocket_of_a_haas(line: str) -> None:
    assert not marks_found(source_from_text(line))["haas"]


def test_blocks_and_comments_are_told_apart_line_by_line() -> None:
    text = "%\r\nO1 (A (B\nG1 X1 (C) Y2 ; D\n\n 12 * - E\n%F\rG0 (G\nX3)\n"
    found = raw_text(source_from_text(text))
    assert found.blocks.split("\n") == ["", "O1 (A ", "G1 X1  Y2 ", "", "", "", "G0 ", "X3)", ""]
    told = ((1, ""), (2, "B"), (3, "C"), (3, "D"), (5, "E"), (6, "F"), (7, "G"))
    assert found.comments == told


def test_a_mark_is_found_in_its_own_line_alone() -> None:
    assert not any(marks_found(source_from_text("G0 X1 ;\nG1 Y2 (\nG102) C5\n"))["fagor8070"])
