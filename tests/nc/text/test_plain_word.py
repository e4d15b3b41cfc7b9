"""Words and comments are read alike from text and from bytes."""

import dataclasses
import re

from hypothesis import given
from hypothesis import strategies as st

from twin.nc.dialects import dialect_named
from twin.nc.text.comments import (
    OPEN_COMMENT,
    closed_comment,
    comment_end,
    comment_marks,
    comments_of,
)
from twin.nc.text.diagnostics.reporter import Reporter
from twin.nc.text.grammar import Grammar
from twin.nc.text.lexer import Lexer
from twin.nc.text.plain_word import NUMBER, SIGNED_NUMBER
from twin.nc.text.source import source_from_text

DIALECT = dialect_named("codesys")
"""``codesys`` has comments of every kind: of two characters, of one, up to the end, of a whole line."""


def test_blanks_within_numbers_are_closed_up_and_those_of_comments_are_not():
    report = Reporter(source_from_text(""), strict=False)
    (block,) = Lexer(dialect_named("linuxcnc"), report).blocks("X1 2 (3 4; 5) Y6 7 ;(8 9", 1)
    assert [(word.address, word.value) for word in block.words] == [("X", 12.0), ("Y", 67.0)]


@given(st.text("( *)/;%1 X", max_size=12))
def test_comments_do_not_overlap_and_outside_of_them_alone_text_is_replaced(line: str):
    grammar, marks = Grammar(DIALECT), comment_marks(DIALECT.syntax.comments)
    closed = [each for each in comments_of(line, marks) if each[1] != OPEN_COMMENT]
    assert [place for each in closed for place in each] == sorted(
        place for each in closed for place in each
    )
    replaced = grammar.outside_comments(re.compile("."), lambda _: "_", line)
    for at, character in enumerate(line):
        inside = any(begin <= at < end for begin, end in closed)
        assert replaced[at] == (character if inside else "_")


@given(st.text("( *)/;%1 X\t\v\x01é", max_size=12), st.integers(0, 12), st.booleans())
def test_a_closed_comment_is_the_same_to_its_pattern_and_from_byte_to_byte(
    line: str, at: int, holds_opening: bool
):
    kinds = (each for each in DIALECT.syntax.comments if not each.whole_line)
    marks = comment_marks(
        [dataclasses.replace(each, holds_opening=holds_opening) for each in kinds]
    )
    found = re.compile(closed_comment(marks)).match(line, at)
    end = comment_end(line.encode("ascii", "replace"), 0, at, len(line), marks)
    assert (found.end() if found else None) == (end if end >= 0 else None)


@given(st.text("0159.+-", max_size=6))
def test_a_number_has_digits_one_sign_and_one_point_at_most(text: str):
    plain = text.lstrip("+-")
    is_number = plain.count(".") <= 1 and plain.replace(".", "").isdecimal()
    is_signed = is_number and len(text) - len(plain) <= 1
    assert bool(re.fullmatch(NUMBER, text)) == (is_number and text == plain)
    assert bool(re.fullmatch(SIGNED_NUMBER, text)) == is_signed
