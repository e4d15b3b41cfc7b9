"""A line takes no longer than its length asks for, whatever is in it."""

import contextlib
import time

import pytest

from tests.nc.running import SETTINGS
from twin.nc.dialects import DIALECTS
from twin.nc.interpreter import Interpretation
from twin.nc.iso.base import is_ellipsis
from twin.nc.text.diagnostics.diagnostics import ProgramError
from twin.nc.text.source import source_from_pieces

PIECES = [
    ".",
    " ",
    "\t",
    "A",
    "7",
    "(",
    "[",
    "-",
    "X.",
    "N1",
    "$",
    '"',
    "a b",
    "... ",
    "Ж",
    "X ...",
]
PATIENCE_S = 30.0
"""For lines that would take hours were their pieces shared out in all ways."""


@pytest.mark.parametrize("dialect", sorted(DIALECTS))
def test_a_long_line_is_read_in_time(dialect: str) -> None:
    began = time.process_time()
    for piece in PIECES:
        for end in ("G284 X360", "!", "X..5"):
            text = f"%\nG0 X1\n{piece * 400}{end}\nM30\n".encode()
            running = Interpretation(
                source_from_pieces([text], "long.nc"), DIALECTS[dialect], SETTINGS
            )
            with contextlib.suppress(ProgramError):
                for _ in running.chunks():
                    pass
    assert time.process_time() - began < PATIENCE_S


@pytest.mark.parametrize(
    ("line", "dots"),
    [
        ("...", True), ("  N10 ...", True), ("N5...", True), ("N10 X... Y ....", True), ("N...", True),
        ("X..... $ text", True), ("..", False), ("X1...", False), ("N10 G1 X...", False), ("... X", False),
        (".... . ...", False),
    ],
)  # fmt: skip
def test_an_ellipsis_is_dots_alone_or_in_place_of_values(line: str, dots: bool) -> None:
    assert is_ellipsis(line) is dots
