"""Where comments begin and end."""

import re
from collections.abc import Iterator, Sequence
from typing import NamedTuple, TypeAlias

import numpy as np
import numpy.typing as npt

from twin.compilation.compilable import compilable
from twin.nc.text.plain_word import IS_BLANK
from twin.nc.text.syntax import Comment

Characters: TypeAlias = "bytes | npt.NDArray[np.uint8]"
Marks: TypeAlias = "Sequence[Sequence[int]] | npt.NDArray[np.uint8]"
NO_COMMENT, OPEN_COMMENT = -1, -2
"""None begins there; it is not closed, or holds what it may not hold."""
_CONTROL = 32
_TAB, _VERTICAL_TAB, _FORM_FEED = 9, 11, 12
_LINE_END = r"\Z"


class CommentMarks(NamedTuple):
    """How comments are marked.

    Attributes:
        openings: What begins each kind, one or two characters, 0 where there is none, shape (c, 2).
        closings: What ends it; 0, 0: the end of the line.
        whole_line: It can only begin its line, shape (c,).
        holds_opening: Its own opening may be in it, shape (c,).
    """

    openings: Marks
    closings: Marks
    whole_line: "Sequence[bool] | npt.NDArray[np.bool_]"
    holds_opening: "Sequence[bool] | npt.NDArray[np.bool_]"

    @property
    def columns(self) -> "CommentMarks":
        """Them as kernels read them."""
        return CommentMarks(
            np.array(self.openings, np.uint8).reshape(-1, 2),
            np.array(self.closings, np.uint8).reshape(-1, 2),
            np.array(self.whole_line, np.bool_),
            np.array(self.holds_opening, np.bool_),
        )


def comment_marks(comments: Sequence[Comment]) -> CommentMarks:
    """The marks of these kinds."""
    return CommentMarks(
        [[*comment.opening.encode("ascii"), 0, 0][:2] for comment in comments],
        [[*comment.closing.encode("ascii"), 0, 0][:2] for comment in comments],
        [comment.whole_line for comment in comments],
        [comment.holds_opening for comment in comments],
    )


@compilable
def is_control(character: int) -> bool:
    """Whether no line may hold a character."""
    return character < _CONTROL and character not in (_TAB, _VERTICAL_TAB, _FORM_FEED)


def closed_comment(marks: CommentMarks) -> str:
    """Regular expression of a comment that is closed, as ``comment_end`` finds it from these marks.

    Comments that can only begin their line are not among them.
    """
    controls = [chr(each) for each in range(_CONTROL) if is_control(each)]
    branches, others = ["(?!)"], ""
    for opening, closing, whole_line, holds_opening in zip(*marks, strict=True):
        begin, end = ([chr(each) for each in mark if each] for mark in (opening, closing))
        without = [*controls, *end[:1], *([] if holds_opening or not end else begin[:1])]
        within = f"[^{_escaped(without)}]"
        if end[1:]:
            within = f"(?:{within}|(?!{_escaped(end)}){_escaped(end[:1])})"
        if not whole_line:
            branches.append(f"{others}{_escaped(begin)}{within}*{_escaped(end) or _LINE_END}")
        others += f"(?!{_escaped(begin)})"
    return f"(?:{'|'.join(branches)})"


def _escaped(characters: Sequence[str]) -> str:
    return re.escape("".join(characters))


@compilable
def comment_end(line: Characters, begin: int, at: int, end: int, marks: CommentMarks) -> int:
    """The place behind the comment that begins at a place.

    Args:
        line: Holds the line, a byte for each character or as UTF-8: what marks comments is ASCII.
        end: Behind its last character.

    Returns:
        The place, ``NO_COMMENT`` or ``OPEN_COMMENT``.
    """
    for kind in range(len(marks.openings)):
        behind = _behind(line, at, end, marks.openings[kind])
        if behind == NO_COMMENT or (marks.whole_line[kind] and not _is_blank(line, begin, at)):
            continue
        closing = marks.closings[kind]
        place = _find_stop(line, behind, end, closing[0])
        while place < end:
            if is_control(line[place]):
                return OPEN_COMMENT
            closed = _behind(line, place, end, closing)
            if closed != NO_COMMENT:
                return closed if _may_hold(line, behind, place, kind, marks) else OPEN_COMMENT
            place = _find_stop(line, place + 1, end, closing[0])
        return end if closing[0] == 0 else OPEN_COMMENT
    return NO_COMMENT


@compilable
def _may_hold(line: Characters, begin: int, end: int, kind: int, marks: CommentMarks) -> bool:
    """Whether a comment of a kind may hold what is between two places."""
    if marks.holds_opening[kind]:
        return True
    return _find_stop(line, begin, end, marks.openings[kind][0]) == end


@compilable
def _find_stop(line: Characters, begin: int, end: int, closing: int) -> int:
    """The first place that holds a character, or one that no line may hold; ``end`` where none does."""
    for place in range(begin, end):
        character = line[place]
        if character == closing or (character < _CONTROL and is_control(character)):
            return place
    return end


@compilable
def _is_blank(line: Characters, begin: int, end: int) -> bool:
    """Whether blanks alone stand between two places."""
    blank = True
    for place in range(begin, end):
        character = line[place]
        blank = blank and character < len(IS_BLANK) and IS_BLANK[character]
    return blank


@compilable
def _behind(line: Characters, at: int, end: int, mark: Sequence[int]) -> int:
    """The place behind a mark of one or two characters; ``NO_COMMENT`` where it does not stand here."""
    if at >= end or line[at] != mark[0]:
        return NO_COMMENT
    if mark[1] == 0:
        return at + 1
    if at + 1 < end and line[at + 1] == mark[1]:
        return at + 2
    return NO_COMMENT


def comments_of(line: str, marks: CommentMarks) -> Iterator[tuple[int, int]]:
    """Where the comments of a line begin, and what ``comment_end`` says of each."""
    text, behind = line.encode("ascii", "replace"), 0
    for opening in re.finditer(_first_characters(marks), text):
        if (at := opening.start()) >= behind:
            end = comment_end(text, 0, at, len(text), marks)
            if end != NO_COMMENT:
                yield at, end
            behind = max(behind, end)


def without_comments(line: str, marks: CommentMarks) -> tuple[str, int]:
    """A line with blanks in place of its comments.

    Returns:
        The line, and where the comment begins that is wrong; ``NO_COMMENT`` where none is.
    """
    for begin, end in comments_of(line, marks):
        if end == OPEN_COMMENT:
            return line, begin
        line = line[:begin] + " " * (end - begin) + line[end:]
    return line, NO_COMMENT


def _first_characters(marks: CommentMarks) -> bytes:
    return b"[" + re.escape(bytes({int(opening[0]) for opening in marks.openings})) + b"]"
