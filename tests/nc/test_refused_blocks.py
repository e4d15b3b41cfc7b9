"""A block that is refused has moved nothing and reported nothing, whatever word it is refused for."""

import string

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.five_axes import on_machine, settings, trunnion
from tests.nc.running import bad, run
from twin.nc.control.settings import ToolData
from twin.nc.dialects import OWN

NUMBERS = [
    "5",
    "5.",
    ".5",
    "-5",
    "+5",
    "05",
    "0",
    "1e3",
    "1e308",
    "1E-3",
    "--5",
    "5,5",
    "5.5.5",
    "1O",
    "O1",
    "[5]",
    "#1",
    "-",
    ".",
    "=5",
    "[1+1]",
    "0x1F",
    "99999999999",
    "²",
    "٣",
]
LETTERS = (*string.ascii_uppercase, *string.ascii_lowercase, ",R", ",C", "$", "@", "Ж", "")
WORDS = st.builds(str.__add__, st.sampled_from(LETTERS), st.sampled_from(NUMBERS))
BLOCKS = (
    "G1 X30 F1000", "G0 X30", "G2 X30 R15 F1000", "X30", "M3 S100", "G81 X30 Z-5 R2 F100",
    "M3 S100 G1 X30 F1000", "M8 X30", "T1 M6 G0 X30",
)  # fmt: skip
LINE = 3
TOOL = ToolData(2.0, 60.0)


@given(st.sampled_from(sorted(OWN)), st.sampled_from(BLOCKS), WORDS, st.booleans())
def test_a_refused_block_has_moved_nothing(
    dialect: str, block: str, word: str, before: bool
) -> None:
    written = f"{word} {block}" if before else f"{block} {word}"
    outcome = run(f"G90\nG1 X20 F500\n{written}\nM2\n", dialect)
    if outcome.error is not None and outcome.error.line == LINE:
        assert LINE not in outcome.moves.line
        assert all(event.line != LINE for event in outcome.events)
        assert 2 in outcome.moves.line or ",R" in word or ",C" in word  # corners hold it back


FIVE_AXES = settings(on_machine(trunnion()))
STATES = {
    "fanuc": (
        "G43.4 H1",
        "G43.5 H1",
        "G68.2 X0 Y0 Z0 I0 J30. K0 G53.1",
        "G41 D1 G1 X5. F500.",
        "G16",
    ),
    "haas": ("G234 H1", "G254", "G41 D1 G1 X5. F500.", "G81 X1. Y1. Z-5. R2. F100."),
    "linuxcnc": ("M428", "G43 H1", "G41.1 D4 G1 X5 F500", "G81 X1 Y1 Z-5 R2 F100"),
    "sinumerik": ("TRAORI", "ROT X30", "MCALL CYCLE81(10,0,2,-5)", "G41 D1 G1 X5 F500"),
    "fagor8070": ("#RTCP ON", "#CS ON [1] [MODE 1,0,0,0,0,30,0]", "G81 Z2 I-5 F100"),
    "heidenhain": ("M128", "PLANE SPATIAL SPA+0 SPB+30 SPC+0 STAY", "L X+5 RL F500"),
}
"""What is in force when the block comes, on a machine with axes A and C."""
OF_FIVE_AXES = (
    "G1 X30. A5. C5. F1000",
    "G0 A30 B4",
    "G1 X9 I0 J0 K1",
    "G53 Z0 A0",
    "G28 X0",
    "X30",
)
OF_KLARTEXT = (
    "L X+30 A+5 C+5 F500 M3",
    "L Z+5 FMAX",
    "CALL LBL 5",
    "LN X+1 Y+1 Z+1 TX+0 TY+0 TZ+1 F9",
)


@given(st.data(), st.sampled_from(sorted(STATES)), WORDS)
def test_a_refused_block_of_five_axes_has_moved_nothing(
    data: st.DataObject, dialect: str, word: str
) -> None:
    klartext = dialect == "heidenhain"
    state = data.draw(st.sampled_from(STATES[dialect]))
    block = data.draw(st.sampled_from(OF_KLARTEXT if klartext else OF_FIVE_AXES))
    text = f"O1\nG90 T1\n{state}\n{block} {word}\nM2\n"
    if klartext:
        head = "BEGIN PGM A MM\nTOOL CALL 1 Z S1000\n"
        text = f"{head}{state}\n{block} {word}\nM30\nLBL 5\nL X+3 F100\nLBL 0\nEND PGM A MM\n"
    elif dialect in ("linuxcnc", "sinumerik", "fagor8070"):
        text = text.replace("O1\n", "\n")
    outcome = run(text, dialect, FIVE_AXES, machine_zero=dict.fromkeys("XYZAC", 0.0))
    if outcome.error is not None and outcome.error.line == LINE + 1:
        assert LINE + 1 not in outcome.moves.line
        assert all(event.line != LINE + 1 for event in outcome.events)


@given(st.sampled_from(("fanuc", "haas")), st.sampled_from(BLOCKS), WORDS)
def test_the_bad_second_line_of_a_subprogram_has_moved_nothing(
    dialect: str, block: str, word: str
) -> None:
    outcome = run(f"O1\nG90 F500\nM98 P5\nM30\nO5\nG1 X20.\n{block} {word}\nM99\n", dialect)
    if outcome.error is not None and outcome.error.line == 7:
        assert 7 not in outcome.moves.line
        assert all(event.line != 7 for event in outcome.events)
        assert 6 in outcome.moves.line or ",R" in word or ",C" in word


@pytest.mark.parametrize(
    ("dialect", "block"),
    [
        ("fanuc", "G81 X30. Z-5. R2. F100. ,R2."),
        ("fanuc", "G0 X30. ,C2."),
        ("sinumerik", "G0 X30 RND=2"),
    ],
)
def test_a_corner_without_a_feed_move_before_it_is_refused_in_its_own_block(
    dialect: str, block: str
) -> None:
    text = f"G90 F500.\nG1 X20.\n{block}\nG1 X50. Y5.\nM30\n"
    error = bad(text, dialect)
    assert (error.code, error.line) == ("blend", 3)
    assert 3 not in run(text, dialect).moves.line


@pytest.mark.parametrize(
    ("dialect", "block"),
    [
        ("fanuc", "M3 S1000 G1 X30. F100. ,C.5"),
        ("haas", "M3 S1000 M8 G1 X30. F100. ,R.5"),
        ("sinumerik", "M3 S1000 G1 X30 F100 RND=2"),
    ],
)
@pytest.mark.parametrize("behind", ["", "M9\n", "G0 X50.\n", "E5 Q7 G77\n"])
def test_a_corner_that_cannot_be_made_starts_no_spindle(
    dialect: str, block: str, behind: str
) -> None:
    text = f"M8\nG90 G1 X20. F500.\n{block}\n{behind}M30\n"
    outcome = run(text, dialect)
    assert outcome.error is not None
    assert outcome.error.line == (4 if behind[:1] in ("G", "E") else 3)
    assert [event.line for event in outcome.events] == [1]
    assert 3 not in outcome.moves.line


def test_what_a_block_with_a_corner_does_comes_before_its_move() -> None:
    text = "M8\nG90 G1 X20. F500.\nM3 S1000 X30. ,R2.\nY20.\nM30\n"
    outcome = run(text, "fanuc")
    assert outcome.error is None
    assert outcome.moves.line.tolist() == [2, 3, 3, 4]
    assert [(event.line, event.before) for event in outcome.events] == [(1, 0), (3, 1), (5, 4)]


def test_what_was_let_go_of_earlier_blocks_stays() -> None:
    text = "O1\nG41 D1 G1 X10. Y0. F500.\nX20.\nG40 X30. Y5. E5\nM30"
    outcome = run(text, "fanuc", tools={1: TOOL})
    assert outcome.error is not None
    assert outcome.error.code == "unknown-word"
    assert outcome.moves.line.tolist() == [2, 3]


def test_events_keep_their_places_before_a_refused_block() -> None:
    text = "O1\nM8\nG1 X10. F500.\nM9\nM3 S100 G1 X20. E5\nM30"
    outcome = run(text, "haas")
    assert [event.line for event in outcome.events] == [2, 4]
    assert [event.before for event in outcome.events] == [0, 1]
