"""Lines come out as they went in, however they are paged, packed and encoded."""

import random
import re
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from twin.nc.dialects import dialect_named
from twin.nc.text import lines as room
from twin.nc.text.lines import Lines
from twin.nc.text.source import read_source, source_from_pieces, source_from_text

CUTS = st.lists(st.integers(1, 40), max_size=8)
TEXTS = st.text("GX1 .Ж\r\n\n", max_size=200)


def plain_lines(text: str) -> list[str]:
    """Lines as Python divides them, by LF, CR and CR LF alone."""
    ends = text.replace("\r\n", "\n").replace("\r", "\n")
    return ends.removesuffix("\n").split("\n") if text else []


def pieces(data: bytes, cuts: list[int]) -> list[bytes]:
    found = []
    for cut in cuts:
        found.append(data[:cut])
        data = data[cut:]
    return [*found, data]


@pytest.fixture(autouse=True)
def _small_pages(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(room, "PAGE", 16)
    monkeypatch.setattr(room, "UNPACKED_PAGES", 2)
    monkeypatch.setattr(room, "_OPEN_PAGES", 2)


@settings(derandomize=True, max_examples=300)
@given(text=TEXTS, cuts=CUTS)
def test_lines_are_those_of_the_text(text: str, cuts: list[int]) -> None:
    lines = Lines(pieces(text.encode(), cuts))
    wanted = plain_lines(text)
    assert (len(lines), list(lines)) == (len(wanted), wanted)
    assert [lines[-1 - i] for i in range(len(lines))] == wanted[::-1]
    assert lines[1:5] == wanted[1:5]
    assert lines.size == len(text.encode())


@settings(derandomize=True, max_examples=200)
@given(text=TEXTS, cuts=CUTS)
def test_pages_follow_each_other(text: str, cuts: list[int]) -> None:
    pages = list(Lines(pieces(text.encode(), cuts)).pages())
    assert b"".join(page.text for page in pages) == text.encode()
    first = 0
    for page in pages:
        assert page.lines.start == first
        first = page.lines.stop


@settings(derandomize=True, max_examples=200)
@given(text=TEXTS)
def test_searching_finds_each_line_once(text: str) -> None:
    lines = Lines([text.encode()])
    held = [(number, line) for number, line in enumerate(plain_lines(text)) if "X1" in line]
    assert list(lines.holding("X1")) == held
    assert lines.any_holds(re.compile(rb"X1")) == bool(held)


@pytest.mark.parametrize(
    ("encoding", "dialect"),
    [("utf-8", "gost"), ("utf-8-sig", "gost"), ("cp1251", "gost"), ("cp1250", "mefi")],
)
def test_every_page_is_read_in_the_encoding_of_the_whole(
    tmp_path: Path, encoding: str, dialect: str
) -> None:
    letter = "Ж" if dialect == "gost" else "ř"
    text = "G0 X1\n" * 20 + f"$ {letter}\n" + "G1 X2\n" * 20
    path = tmp_path / "old.nc"
    path.write_bytes(text.encode(encoding))
    assert list(read_source(path, dialect_named(dialect)).lines) == plain_lines(text)


def test_one_byte_beyond_the_code_page_and_all_bytes_count_as_they_are() -> None:
    data = b"$ \xc6\n" * 20 + b"$ \x98\n"  # 0x98 is nothing in cp1251
    lines = source_from_pieces([data], "p.nc", dialect_named("gost")).lines
    assert lines[0] == "$ Æ"


@pytest.mark.parametrize("data", [b"", b"\xef\xbb\xbf"])
def test_nothing_has_no_lines(data: bytes) -> None:
    assert list(source_from_pieces([data], "p.nc").lines) == []


def test_jumping_about_in_a_packed_program() -> None:
    chance = random.Random(2)  # noqa: S311 (no cryptography)
    lines = Lines([b"".join(b"N%d\n" % number for number in range(500))])
    for _ in range(300):
        number = chance.randrange(500)
        assert lines[number] == f"N{number}"


@pytest.mark.parametrize("end", ["", "\n", "\r"])
def test_another_file_follows_on_a_line_of_its_own(end: str) -> None:
    both = source_from_text(f"G0 X1\nG0 X2{end}").followed_by("% A", source_from_text("G0 X3", "a"))
    assert list(both.lines) == ["G0 X1", "G0 X2", "% A", "G0 X3"]
    assert both.place(4) == ("a", 1)
    assert both.text == "G0 X1\nG0 X2\n% A\nG0 X3"
