"""In which order a block takes effect, and which of its codes exclude each other.

Modal codes by group, then set-up actions, modal words (F, S, T), early M functions, the motion or what
stands in its place, late M functions, jumps. In some dialects the words come before the actions.
"""

from collections.abc import Sequence
from typing import NamedTuple, Protocol

from twin.nc.control.codes import GCode, MCode
from twin.nc.text.blocks import Word

Codes = Sequence[tuple[Word, GCode]]
Functions = Sequence[tuple[Word, MCode]]


class SortedBlock(NamedTuple):
    """A block by what its words are; the others are those of its control.

    Attributes:
        codes: Its G codes, in the order in which they take effect.
        functions: Its M functions, in the order of the text.
    """

    codes: Codes
    functions: Functions


class BlockSteps(Protocol):
    """What a tier does at each step: it acts, or it writes instructions."""

    def act(self, word: Word, code: GCode, /) -> None:
        """What a code does before the block moves."""
        ...

    def modal_words(self, reserved: str) -> None:
        """What words such as F, S and T do, but for those that the motion wants."""
        ...

    def run_function(self, word: Word, function: MCode) -> None:
        """An M function."""
        ...

    def move(self, instead: GCode | None) -> None:
        """The motion, or what a code does in its place."""
        ...

    def follow(self, word: Word, code: GCode, /) -> None:
        """What a code does when the block has moved."""
        ...


def run_in_order(
    steps: BlockSteps, codes: Codes, functions: Functions, *, words_first: bool
) -> None:
    """Take the steps of a block.

    Args:
        steps: What is done at each.
        codes: Its G codes as ``in_order`` has them.
        functions: Its M functions in the order of the text.
        words_first: Words and early functions take effect before the actions of G codes.
    """
    instead = None
    for word, code in codes:
        if not words_first:
            steps.act(word, code)
        if code.perform is not None:
            instead = code
    steps.modal_words("" if instead is None else instead.takes)
    for word, function in functions:
        if not function.late:
            steps.run_function(word, function)
    if words_first:
        for word, code in codes:
            steps.act(word, code)
    steps.move(instead)
    for word, code in codes:
        if code.after is not None:
            steps.follow(word, code)
    for word, function in functions:
        if function.late:
            steps.run_function(word, function)


def in_order(codes: Codes, groups: Sequence[str]) -> list[tuple[Word, GCode]]:
    """G codes as they take effect: by the order of their groups, those without one at last."""
    order = {group: rank for rank, group in enumerate(groups)}
    return sorted(codes, key=lambda pair: order.get(pair[1].group, len(order)))


def codes_that_count(codes: Codes, *, last_of_group: bool) -> list[tuple[Word, GCode]]:
    """G codes without those that another one of their modal group overrules.

    Args:
        codes: As they are written.
        last_of_group: The last one overrules all others; else each overrules those that yield.
    """
    strong = {code.group for _, code in codes if not code.yields}
    last = {code.group: word for word, code in codes}

    def counts(word: Word, code: GCode) -> bool:
        if code.yields and code.group in strong:
            return False
        return last[code.group] is word or not (code.yields or last_of_group)

    return [(word, code) for word, code in codes if not code.group or counts(word, code)]


class Conflict(NamedTuple):
    """Two codes that cannot share a block.

    Attributes:
        first: One of them.
        second: The other.
        group: Their modal group, or empty.
        performs: Both want to stand in the motion's place.
    """

    first: Word
    second: Word
    group: str = ""
    performs: bool = False


def conflict_of(codes: Codes, functions: Functions) -> Conflict | None:
    """The first codes of a block that exclude each other, or None."""
    seen: dict[str, Word] = {}
    performing: Word | None = None
    for word, code in codes:
        if code.group and code.group in seen:
            return Conflict(seen[code.group], word, code.group)
        seen[code.group] = word
        if code.perform is not None:
            if performing is not None:
                return Conflict(performing, word, performs=True)
            performing = word
    seen = {}
    for word, function in functions:
        other = seen.setdefault(function.group or word.text, word)
        if other is not word:
            return Conflict(other, word)
    return None
