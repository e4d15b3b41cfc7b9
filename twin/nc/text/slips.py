"""What was meant by a line that cannot be read: the slips that are made most."""

import difflib
import re
from collections.abc import Iterable
from typing import NamedTuple

_MOST_NEAR = 4
NESTED_COMMENT = "close the first comment before, or leave the inner ( ) out"


class Slip(NamedTuple):
    """One slip.

    Attributes:
        pattern: What a line holds at the place that cannot be read.
        statement: Of a dialect that it is looked for in; empty: of any.
        foreign: It is looked for where the dialect lacks that statement.
    """

    pattern: re.Pattern[str]
    hint: str
    statement: str = ""
    foreign: bool = False


def _slip(pattern: str, hint: str, statement: str = "", *, foreign: bool = False) -> Slip:
    return Slip(re.compile(pattern, re.IGNORECASE), hint, statement, foreign)


SLIPS: tuple[Slip, ...] = (
    _slip(r"\([^()]*\([^()]*\)[^()]*\)", NESTED_COMMENT),
    _slip(
        r"(?<![A-Z])[A-Z][ \t]*[-+]?[0-9.]*O[O0-9.]*(?![A-Z<\[#])",
        "the letter O is no 0",
    ),
    _slip(
        r"\b(?:IF|WHILE|UNTIL)[ \t]*(?!\[)",
        "a condition is written in brackets: IF [#1 EQ 2] GOTO 5",
        "IF",
    ),
    _slip(
        r"\b(?:IF|WHILE|GOTO|THEN|END[123])\b",
        "macros of Fanuc and Haas write so: --dialect fanuc",
        "IF",
        foreign=True,
    ),
    _slip(
        r"\bG[ \t]*[0-9]+",
        "Klartext has no G codes: a line is L X+10 F500; DIN/ISO of the same controls is not read",
        "BEGIN PGM",
    ),
    _slip(r"\$[A-Z$#]", "a command of Grbl: --dialect grbl reads it"),
    _slip(
        r"[A-Z][ \t]*=[ \t]*[-+.0-9]", "a word is its letter and its number, such as X10, without ="
    ),
    _slip(r"[0-9]*\.[0-9]*\.", "a number has one point"),
    _slip(r";[ \t]*[A-Z][ \t]*[-+.0-9]", "every block on a line of its own"),
    _slip(r"[-+][ \t]*[-+]", "a number has one sign"),
)
"""The first that lies over the place counts."""


def slip_at(line: str, at: int, statements: Iterable[str] = ()) -> str | None:
    """What to write in place of what is at a place of a line, from 0, in a dialect with these statements; None: no known slip."""
    known = set(statements)
    for slip in SLIPS:
        if slip.statement and (slip.statement in known) == slip.foreign:
            continue
        if any(found.start() <= at <= found.end() for found in slip.pattern.finditer(line)):
            return slip.hint
    return None


def near(name: str, known: Iterable[str], dialect: str) -> str:
    """Names that are like one that is unknown, and where all of them are listed."""
    alike = difflib.get_close_matches(name, list(known), _MOST_NEAR, 0.5)
    listed = f"all of them: twin dialects {dialect}"
    return f"near it: {', '.join(alike)}; {listed}" if alike else listed
