"""Which lines of a program have changed since its baseline, and what followed from each."""

import difflib
import re
from collections.abc import Iterable, Iterator, Sequence

from twin.compare.verdict import Reason

_CODE = re.compile(r"(?<![A-Z0-9#&%@_])([DGHPQ]) ?(\d+(?:\.\d+)?)", re.IGNORECASE)
"""A code, the number of an offset, or what tells a code apart (``G54.1 P2``, ``G5.1 Q1``)."""


def numbered(lines: Sequence[str]) -> tuple[list[int], list[str]]:
    """The lines that say anything, their numbers from 1 before them."""
    said = [number for number, line in enumerate(lines, 1) if line]
    return said, [lines[number - 1] for number in said]


def changed_lines(before: Sequence[str], now: Sequence[str]) -> list[int]:
    """Lines of a program that were changed or are new, and those before which one was lost, from 1.

    Args:
        before: The lines of the stored program that say anything, without comments.
        now: All lines of the program, without comments.
    """
    numbers, texts = numbered(now)
    found = set[int]()
    matcher = difflib.SequenceMatcher(None, before, texts, autojunk=False)
    for what, _, _, begin, end in matcher.get_opcodes():
        if what == "delete":
            found.update(numbers[begin : begin + 1] or numbers[-1:])
        elif what != "equal":
            found.update(numbers[begin:end])
    return sorted(found)


def changed_codes(before: Sequence[str], now: Sequence[str]) -> Iterator[tuple[int, str]]:
    """Lines that differ in codes and numbers of offsets alone, with what was said and what is said now.

    Another offset with the same value moves nothing differently today, and does on the machine tomorrow; so does a
    code that changes nothing here, such as another smoothness. Another spelling is no difference, nor is a code more or
    less: a repeated modal one.

    Args:
        before: As in ``changed_lines``.
        now: As in ``changed_lines``.
    """
    numbers, texts = numbered(now)
    matcher = difflib.SequenceMatcher(None, before, texts, autojunk=False)
    for what, first, last, begin, end in matcher.get_opcodes():
        if what != "replace" or last - first != end - begin:
            continue
        pairs = zip(before[first:last], texts[begin:end], numbers[begin:end], strict=True)
        for there, here, line in pairs:
            said, says = _codes(there), _codes(here)
            offsets = {code[0] for code in said ^ says} & {"D", "H"}
            if _CODE.sub(" ", there).split() == _CODE.sub(" ", here).split() and (
                offsets or len(said) == len(says) > len(said & says)
            ):
                yield line, f"{_as_text(says - said)}, baseline {_as_text(said - says)}"


def _codes(line: str) -> set[tuple[str, float]]:
    return {(letter.upper(), float(value)) for letter, value in _CODE.findall(line)}


def _as_text(codes: set[tuple[str, float]]) -> str:
    return " ".join(f"{letter}{value:g}" for letter, value in sorted(codes)) or "no offset"


def differences_by_line(reasons: Iterable[Reason], changed: Sequence[int]) -> Iterator[Reason]:
    """Differences of blocks, gathered at the changed lines that they follow from.

    A word of a cycle changes all its holes, a word in a loop all its rounds: a changed line is one finding, with the
    first difference of each kind and how many there are. A difference belongs to its own line if that has changed, or
    else to the last changed line before it, or to the first behind it.

    Args:
        reasons: One for each block that differs.
        changed: The lines that have changed; none: nothing is gathered.
    """
    if not changed:
        yield from reasons
        return
    by_line: dict[int, list[Reason]] = {}
    for reason in reasons:
        line = max((each for each in changed if each <= reason.line), default=changed[0])
        by_line.setdefault(line, []).append(reason)
    for line, found in by_line.items():
        kinds: dict[str, str] = {}
        for reason in found:
            where = "" if reason.line == line else f"line {reason.line} "
            kinds.setdefault(reason.what, where + reason.message)
        more = len(found) - len(kinds)
        message = "; ".join(kinds.values()) + (f" (and {more} more of this change)" if more else "")
        yield Reason(found[0].what, message, line, found[0].time_s)
