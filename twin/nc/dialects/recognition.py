"""Which dialects a raw program may be written in, by its words and by what its head calls itself."""

import re
from collections.abc import Iterator, Mapping
from functools import lru_cache
from itertools import islice
from typing import NamedTuple

from twin.errors import EmptyProgramError, UsageError
from twin.nc.dialects import DIALECTS, marks_found
from twin.nc.dialects.foreign import control_of_head, is_prose
from twin.nc.text.source import LEADER, Source

HEAD_LINES = 60
"""Lines at the beginning in which comments may name the control or the post."""

_NAMES: Mapping[str, str] = {
    "fanuc": r"\bfanuc|\bmpfan\b|\brobodrill\b",
    "haas": r"\bhaas",
    "linuxcnc": r"linuxcnc|\bemc ?2?\b",
    "fagor8070": r"\bfagor\b",
    "codesys": r"\bcodesys\b|softmotion",
    "mefi": r"\bmefi\b",
    "heidenhain": r"heidenhain|\b(?:i?tnc ?[3-7]\d\d)\b",
    "grbl": r"\bgrbl",
    "sinumerik": r"sinumerik|siemens|(?<!\d)8[124]0 ?d(?:sl)?\b|828d",
}
"""What comments call the controls, and posts for them."""

_SHARED_CODES = ("linuxcnc",)
"""A dialect among whose marks are codes that controls like Fanuc's have too, such as G61.1."""

MOST_LINES = 200_000
"""So many lines of blocks are looked at."""
_COMMENT = re.compile(
    r"\(([^()\n]*)(?:\)|$)|;(.*)|^%(.*)|^[^\S\n]*\d*[^\S\n]*\*[^\S\n]*-(.*)", re.MULTILINE
)
"""Comments, as most controls and posts write them."""


class Reading(NamedTuple):
    """What a program says about its dialect.

    Attributes:
        candidates: Dialects that it may be written in; one: it is given.
    """

    candidates: tuple[str, ...]
    reason: str


_TAPE = LEADER.decode("ascii")


def reading_of(source: Source) -> Reading:
    """Tell by a program's words and by its head in which dialects it may be written.

    Raises:
        UsageError: It is written for a control that is not known here, is prose, or holds nothing.
    """
    for dialect in DIALECTS.values():
        if dialect.suffixes and source.name.lower().endswith(dialect.suffixes):
            return Reading((dialect.name,), "by the end of its file's name")
    if not any(line.strip().strip(_TAPE).strip() for line in source.lines):
        raise EmptyProgramError(f"{source.name}: the program is empty")
    if not any(text.strip() for text in block_pages(source)):
        raise EmptyProgramError(f"{source.name}: the program is empty: it holds comments alone")
    marks = {name: shown for name, shown in marks_found(source).items() if shown}
    everything = {mark for shown in marks.values() for mark in shown}
    complete = tuple(name for name, shown in marks.items() if everything <= set(shown))
    head = head_of(source).replace("_", " ")  # as in linuxcnc_post
    named = [name for name, pattern in _NAMES.items() if re.search(pattern, head, re.IGNORECASE)]
    foreign = None if named else control_of_head(head)
    shared = foreign is not None and complete == _SHARED_CODES and "fanuc" in foreign.advice
    if len(complete) == 1 and not shared:
        return Reading(complete, f"by {', '.join(marks[complete[0]])}")
    if len(named) == 1 and (not marks or named[0] in marks):
        return Reading((named[0],), f"its head names {named[0]}")
    if foreign is not None:
        raise UsageError(f"{source.name}: its head says that it is {foreign[0]}: {foreign[1]}")
    if complete:
        return Reading(complete, f"{', '.join(marks[complete[0]])}")
    if marks:
        seen = "; ".join(f"{', '.join(shown)} ({name})" for name, shown in marks.items())
        return Reading(tuple(marks), f"words of several: {seen}")
    first = "\n".join(islice(source.lines, 2000))
    if is_prose(first):
        raise UsageError(
            f"{source.name}: looks like prose: an NC program is text of blocks such as G1 X10 F100"
        )
    return Reading(tuple(DIALECTS), "no word of one control alone")


def head_of(source: Source) -> str:
    """The comments at a program's beginning, a line each."""
    return "\n".join(text for line, text in raw_text(source).comments if line <= HEAD_LINES)


class RawText(NamedTuple):
    """A program, with its comments apart from its blocks.

    Attributes:
        blocks: Its first ``MOST_LINES`` lines without comments.
        comments: All of them, each with its line, from 1.
    """

    blocks: str
    comments: tuple[tuple[int, str], ...]


@lru_cache(maxsize=2)
def raw_text(source: Source) -> RawText:
    """The text of a program, read once for all that look at it."""
    blocks: list[str] = []
    comments: list[tuple[int, str]] = []
    for page in source.lines.pages():
        text, line, passed = page.joined, page.lines.start + 1, 0
        for found in _COMMENT.finditer(text):
            line, passed = line + text.count("\n", passed, found.start()), found.start()
            comments.append((line, " ".join(filter(None, found.groups())).strip()))
        room = MOST_LINES - page.lines.start
        if room > 0:
            text = _COMMENT.sub("", text)
            whole = len(page.lines) <= room
            blocks.append(text if whole else "\n".join(text.split("\n", room)[:room]))
    return RawText("".join(blocks), tuple(comments))


def block_pages(source: Source) -> Iterator[str]:
    """All lines without comments, in texts of many lines each."""
    return (_COMMENT.sub("", page.joined) for page in source.lines.pages())


def lines_with(text: str, pattern: re.Pattern[str]) -> Iterator[str]:
    """The lines of a text in which a pattern is found that matches no line ends."""
    at = 0
    while (found := pattern.search(text, at)) is not None:
        begin, at = text.rfind("\n", 0, found.start()) + 1, text.find("\n", found.end())
        at = at if at >= 0 else len(text)
        yield text[begin:at]
