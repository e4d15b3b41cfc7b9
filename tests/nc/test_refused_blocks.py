"""A block that is refused has moved nothing and reported nothing, whatever word it is refused for."""

import string

from hypothesis import given
from hypothesis import strategies as st

from tests.nc.running import run
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
BLOCKS = ("G1 X30 F1000", "G0 X30", "G2 X30 R15 F1000", "X30", "M3 S100", "G81 X30 Z-5 R2 F100")
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
