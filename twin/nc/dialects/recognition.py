"""Which dialects a raw program may be written in, by its words and by what its head calls itself."""

import re
from collections.abc import Mapping
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

_COMMENT = re.compile(r"\(([^()]*)(?:\)|$)|;(.*)|^%(.*)|^\s*\d*\s*\*\s*-(.*)")


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
    if not any(without_comments(line).strip() for line in source.lines):
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
    return "\n".join(
        each for line in islice(source.lines, HEAD_LINES) for each in comments_of(line)
    )


def comments_of(line: str) -> list[str]:
    """The comments of a line, as most controls and posts write them."""
    return [" ".join(filter(None, match.groups())).strip() for match in _COMMENT.finditer(line)]


def without_comments(line: str) -> str:
    """A line without what ``comments_of`` gives."""
    return _COMMENT.sub("", line)
