"""Comments behind statements hold what they like."""

import pytest

from tests.nc.running import good


@pytest.mark.parametrize(
    ("dialect", "text"),
    [
        ("fanuc", "IF [1 EQ 1] GOTO 5 (50 % done)\nN5 G1 X5. F100.\nM30"),
        ("fagor8070", "P1=5 (a;b)\nG1 XP1 F100\nM30"),
        ("fagor8070", "P1=5 (a;b) ; and (this\nG1 XP1 F100\nM30"),
        ("codesys", "LET #a : LREAL := 5 (* 50 % or // *)\nG1 X(#a) F100"),
    ],
)
def test_a_comment_behind_a_statement_may_hold_the_mark_of_another_kind(dialect, text):
    assert good(text, dialect).position["X"] == 5.0
