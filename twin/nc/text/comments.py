"""Where comments begin and end, for both tiers."""

import re
from collections.abc import Sequence
from typing import NamedTuple, TypeAlias

import numpy as np
import numpy.typing as npt

from twin.compilation.compilable import compilable
from twin.nc.text.plain_word import IS_BLANK
from twin.nc.text.syntax import Comment

Characters: TypeAlias = "bytes | npt.NDArray[np.uint8]"
Marks: TypeAlias = "Sequence[Sequence[int]] | npt.NDArray[np.uint8]"
NO_COMMENT, OPEN_COMMENT = -1, -2
"""None begins there; it is not closed, or holds what no line may hold."""
_CONTROL = 32
_TAB, _VERTICAL_TAB, _FORM_FEED = 9, 11, 12


class CommentMarks(NamedTuple):
    """How comments are marked.

    Attributes:
        openings: What begins each kind, one or two characters, 0 where there is none, shape (c, 2).
        closings: What ends it; 0, 0: the end of the line.
        whole_line: It can only begin its line, shape (c,).
    """

    openings: Marks
    closings: Marks
    whole_line: "Sequence[bool] | npt.NDArray[np.bool_]"

    @property
    def columns(self) -> "CommentMarks":
        """Them as kernels read them."""
        return CommentMarks(
            np.array(self.openings, np.uint8).reshape(-1, 2),
            np.array(self.closings, np.uint8).reshape(-1, 2),
            np.array(self.whole_line, np.bool_),
        )


def comment_marks(comments: Sequence[Comment]) -> CommentMarks:
    """The marks of these kinds."""
    return CommentMarks(
        [[*comment.opening.encode("ascii"), 0, 0][:2] for comment in comments],
        [[*comment.closing.encode("ascii"), 0, 0][:2] for comment in comments],
        [comment.whole_line for comment in comments],
    )


@compilable
def is_control(character: int) -> bool:
    """Whether no line may hold a character."""
    return character < _CONTROL and character not in (_TAB, _VERTICAL_TAB, _FORM_FEED)


def closed_comment(marks: CommentMarks) -> str:
    """Regular expression of a comment that is closed, as ``comment_end`` finds it from these marks.

    Comments that can only begin their line are not among them.
    """
    controls = "".join(re.escape(chr(each)) for each in range(_CONTROL) if is_control(each))
    ways, others = ["(?!)"], ""
    for opening, closing, whole_line in zip(*marks, strict=True):
        begin = "".join(re.escape(chr(each)) for each in opening if each)
        end = [re.escape(chr(each)) for each in closing if each]
        within = (
            f"(?:(?!{''.join(end)})[^{controls}])*" if end[1:] else f"[^{controls}{''.join(end)}]*"
        )
        if not whole_line:
            ways.append(others + begin + within + ("".join(end) or r"\Z"))
        others += f"(?!{begin})"
    return f"(?:{'|'.join(ways)})"


@compilable
def comment_end(line: Characters, begin: int, at: int, end: int, marks: CommentMarks) -> int:
    """The place behind the comment that begins at a place.

    Args:
        line: Holds the line, a byte for each character or as UTF-8: what marks comments is ASCII.
        begin: Where it begins.
        at: The place.
        end: Behind its last character.
        marks: How comments are marked.

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
                return closed
            place = _find_stop(line, place + 1, end, closing[0])
        return end if closing[0] == 0 else OPEN_COMMENT
    return NO_COMMENT


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
