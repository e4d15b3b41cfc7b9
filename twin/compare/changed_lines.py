"""Which lines of a program have changed since its baseline, and what followed from each."""

import difflib
import re
from collections.abc import Iterable, Iterator, Sequence

from twin.compare.verdict import Reason

_COMMENT = re.compile(r"\([^()]*\)|;.*")
"""What most controls read as a comment; a line that differs in nothing else has not changed."""

_OFFSET = re.compile(r"(?<![A-Z#&%@_])[DH] ?\d+", re.IGNORECASE)
"""The number of an offset of a tool's radius or length."""


_PATH = "baseline-path"


def without_comments(lines: Iterable[str]) -> list[str]:
    """The lines of a program as they are compared: without comments, blanks once; empty ones stay."""
    return [" ".join(_COMMENT.sub(" ", line).split()) for line in lines]


def changed_lines(before: Sequence[str], now: Sequence[str]) -> list[int]:
    """Lines of a program that were changed or are new, and those before which one was lost, from 1.

    Args:
        before: The lines of the stored program that say anything, without comments.
    """
    numbered = [(n, line) for n, line in enumerate(without_comments(now), 1) if line]
    numbers, texts = [n for n, _ in numbered], [line for _, line in numbered]
    found = set[int]()
    matcher = difflib.SequenceMatcher(None, before, texts, autojunk=False)
    for what, _, _, begin, end in matcher.get_opcodes():
        if what == "delete":
            found.update(numbers[begin : begin + 1] or numbers[-1:])
        elif what != "equal":
            found.update(numbers[begin:end])
    return sorted(found)


def changed_offsets(before: Sequence[str], now: Sequence[str]) -> Iterator[tuple[int, str]]:
    """Lines that differ in a word D or H alone, with what was said and what is said now.

    Another offset with the same value moves nothing differently today, and does on the machine tomorrow.

    Args:
        before: As in ``changed_lines``.
        now: As in ``changed_lines``.
    """
    numbered = [(n, line) for n, line in enumerate(without_comments(now), 1) if line]
    texts = [line for _, line in numbered]
    matcher = difflib.SequenceMatcher(None, before, texts, autojunk=False)
    for what, first, last, begin, end in matcher.get_opcodes():
        if what != "replace" or last - first != end - begin:
            continue
        for there, (line, here) in zip(before[first:last], numbered[begin:end], strict=True):
            if _OFFSET.sub(" ", there).split() == _OFFSET.sub(" ", here).split():
                said, says = (" ".join(_OFFSET.findall(each)) for each in (there, here))
                yield line, f"{says or 'no offset'}, baseline {said or 'no offset'}"


def differences_by_line(reasons: Iterable[Reason], changed: Sequence[int]) -> Iterator[Reason]:
    """Differences of blocks, gathered at the changed lines that they follow from.

    A word of a cycle changes all its holes, a word in a loop all its rounds: each code is reported once a
    changed line, with the first difference and how many there are. A difference belongs to its own line
    if that has changed, or else to the last changed line before it, or to the first behind it; what follows in
    unchanged lines from a path that differs is one finding with it, whatever it is.

    Args:
        reasons: One for each block that differs.
        changed: The lines that have changed; none: nothing is gathered.
    """
    if not changed:
        yield from reasons
        return
    first: dict[tuple[int, str], Reason] = {}
    count: dict[tuple[int, str], int] = {}
    for reason in reasons:
        line = max((each for each in changed if each <= reason.line), default=changed[0])
        follows = reason.line != line and (line, _PATH) in first
        key = line, _PATH if follows else reason.what
        first.setdefault(key, reason)
        count[key] = count.get(key, 0) + 1
    for (line, what), reason in first.items():
        message, more = reason.message, count[line, what] - 1
        if reason.line != line:
            message = f"line {reason.line} {message}"
        if more:
            message += f" (and {more} more of this change)"
        yield Reason(what, message, line, reason.time_s)
